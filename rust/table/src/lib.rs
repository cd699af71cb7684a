//! Reads the `edition.json` of a protocol: the table of `cobotwire-core`, with its names, units,
//! labels, roles and limits.
//!
//! The file may come from a stranger: [`Edition::read`] checks every property on which this crate
//! and the core rely.

extern crate alloc;

mod rejection;
mod shown;
mod texts;

use cobotwire_core::exchange::{Protocol, Safety};

pub use shown::{Quote, Shown, general};
pub use texts::{as_call, bad_argument, error_text, link_error};

/// A protocol as data.
#[derive(Clone, Debug)]
pub struct Edition {
    /// Its name, for example `mycobot280`.
    pub name: String,
    /// What a person calls it.
    pub title: String,
    /// How many joints its arm has.
    pub joints: usize,
    /// The rate of its serial port.
    pub baudrate: u32,
    /// What codec and exchange interpret.
    pub protocol: Protocol,
    /// Its commands, in the order of the table.
    pub commands: Vec<Command>,
    /// Its named addresses.
    pub addresses: Vec<Address>,
}

/// What texts and clients need of a command.
#[derive(Clone, Debug)]
pub struct Command {
    /// Its id.
    pub id: u16,
    /// Its name.
    pub name: String,
    /// What it does to the arm.
    pub safety: Safety,
    /// The role in which clients use it; empty: none.
    pub role: String,
    /// The variants of its request.
    pub request: Vec<Vec<Field>>,
    /// The variants of its reply.
    pub reply: Vec<Vec<Field>>,
}

/// What texts and clients need of a field.
#[derive(Clone, Debug)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its kind: `number`, `enum`, `flag`, `bytes` or `text`.
    pub kind: String,
    /// The words of its choices, in their order; empty: they have none.
    pub labels: Vec<String>,
    /// The numbers of each case: name, unit, kind, labels.
    pub cases: Vec<Vec<Number>>,
    /// The least and the most elements, if they differ or are counted.
    pub sizes: Option<(usize, usize)>,
    /// The field whose elements it counts.
    pub counts: Option<String>,
    /// What raw values from the first to the second stand for; `{number}` is the value.
    pub meanings: Vec<(i64, i64, String)>,
    /// The raw value of a constant.
    pub constant: Option<i64>,
    /// The value of an argument that is left out, in physical units.
    pub default: Option<Vec<f64>>,
}

/// What texts need of a number.
#[derive(Clone, Debug)]
pub struct Number {
    /// Its name in a row; empty: none.
    pub name: String,
    /// Its unit; empty: none.
    pub unit: String,
    /// The words of its choices; empty: they have none.
    pub labels: Vec<String>,
}

/// An address with a name.
#[derive(Clone, Debug)]
pub struct Address {
    /// Its name.
    pub name: String,
    /// The byte.
    pub value: u8,
    /// Who replies to a request to it.
    pub replies: Replies,
    /// How many joints the device has; 0: those of the edition.
    pub joints: usize,
}

/// Who replies to a request to an address.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replies {
    /// The device of this address.
    Own,
    /// Every device.
    Any,
    /// One device.
    One,
    /// Nobody.
    None,
}
