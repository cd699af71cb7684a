//! Reads the `edition.json` of a protocol: the table of `cobotwire-core`, with its names, units,
//! labels, roles and limits.
//!
//! The file may come from a stranger: [`Edition::read`] checks every property on which this crate
//! and the core rely. `python/cobotwire/protocol/loading.py` is its specification.

#![no_std]

extern crate alloc;

mod commands;
mod frame;
mod json;
mod messages;
mod named;
mod rejection;
mod robot;
mod shown;
mod texts;
mod types;

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use cobotwire_core::Table;
use cobotwire_core::exchange::{Addressee, Protocol, Replier, Safety};
use serde_json::Value;

use crate::json::Record;
use crate::messages::Messages;

pub use crate::named::Filled;
pub use crate::robot::Link;
pub use crate::shown::{Quote, Shown, general};
pub use crate::texts::{bad_argument, error_text, link_error};

/// The version of the format.
const VERSION: i64 = 3;
/// The largest file. A value of JSON takes up to 32 times its text in memory.
const LARGEST: usize = 4 << 20;

/// A protocol as data.
#[derive(Clone, Debug)]
pub struct Edition {
    /// Its name, for example `mycobot280`.
    pub name: String,
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
    /// The links of the arm, from the base on, if they are known.
    pub geometry: Option<Vec<Link>>,
}

/// What texts and clients need of a command.
#[derive(Clone, Debug)]
pub struct Command {
    /// Its id.
    pub id: u16,
    /// Its name.
    pub name: String,
    /// The family that it belongs to.
    pub family: String,
    /// What it does to the arm.
    pub safety: Safety,
    /// The role in which clients use it; empty: none.
    pub role: String,
    /// The query that reads back what it sets.
    pub read_by: Option<String>,
    /// The states that it stores arguments in.
    pub stores: Vec<String>,
    /// The variants of its request.
    pub request: Vec<Vec<Field>>,
    /// The variants of its reply.
    pub reply: Vec<Vec<Field>>,
}

/// What texts and clients need of a field.
#[derive(Clone, Debug, Default)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// Its kind: `number`, `enum`, `flag`, `bytes` or `text`.
    pub kind: &'static str,
    /// Whether a reply repeats an argument in it.
    pub echo: bool,
    /// The words of its choices, in their order; empty: they have none.
    pub labels: Vec<String>,
    /// What raw values from the first to the second stand for; `{number}` is the raw value.
    pub meanings: Vec<(i64, i64, String)>,
    /// The numbers of each case. A list, bytes or a text has those of one element:
    /// [`Field::number`] finds the number of any.
    pub cases: Vec<Vec<Number>>,
    /// The least and the most elements, if they differ or are counted.
    pub sizes: Option<(usize, usize)>,
    /// The field whose elements it counts.
    pub counts: Option<String>,
    /// The raw value of a constant.
    pub constant: Option<i64>,
    /// The value of an argument that is left out, in physical units.
    pub default: Option<Vec<f64>>,
}

impl Field {
    /// Return the number at an index of the field's numbers.
    #[must_use]
    pub fn number(&self, case: usize, index: usize) -> Option<&Number> {
        let numbers = self.cases.get(case)?;
        numbers.get(index.checked_rem(numbers.len())?)
    }
}

/// What texts need of a number.
#[derive(Clone, Debug, Default)]
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
    pub replier: Replier,
    /// How many joints the device has; 0: those of the edition.
    pub joints: usize,
}

impl Edition {
    /// Read the bytes of an `edition.json`.
    ///
    /// # Errors
    /// It is not the table of a protocol; the error says where and why.
    pub fn read(json: &[u8]) -> Result<Self, BadEdition> {
        if json.len() > LARGEST {
            return BadEdition::because(format!("the file has more than {LARGEST} bytes"));
        }
        let document: Value = serde_json::from_slice(json)
            .or_else(BadEdition::because)
            .within("the file is not JSON", "")?;
        let root = Record(&document);
        let version: i64 = root.get("version")?;
        if version != VERSION {
            return BadEdition::because(format!(
                "the file has version {version} of the format, not {VERSION}"
            ));
        }
        let (frame, described) = (root.at("frame"), root.at("edition"));
        let format = frame::frame_format(frame, json).within("frame", "")?;
        let addresses = frame::addresses(frame).within("frame", "")?;
        let last = if format.layout.id.wide { 0xFFFF } else { 0xFF };
        let (mut wire, mut facts, mut commands) = (Vec::new(), Vec::new(), Vec::new());
        let mut messages = Messages::new(root)?;
        let mut names = BTreeSet::new();
        for record in root.records("commands")? {
            let name = record.name().within("a command", "")?;
            if !names.insert(name) {
                return BadEdition::because("the file has it twice").within("command", name);
            }
            let parts = commands::command(record, &mut messages, last).within("command", name)?;
            wire.push(parts.0);
            facts.push(parts.1);
            commands.push(parts.2);
        }
        let table = Table::new(format, wire).map_err(|error| {
            let at = commands.get(error.command);
            let name = at.map_or("", |command: &Command| &command.name);
            BadEdition(format!("command {}: {}", short(name), error.misfit))
        })?;
        let addressees = addresses.iter().map(|each| Addressee {
            value: each.value,
            replier: each.replier,
            joints: each.joints,
        });
        let joints = described.get::<u8>("joints")?.into();
        let links = described.some("geometry").map(|each| each.records("links"));
        let links = links
            .transpose()?
            .map(|all| all.into_iter().map(robot::link).collect());
        let mut roles = commands.iter().map(|command| &*command.role);
        let protocol = Protocol {
            table,
            facts,
            reports_ends: roles.any(|role| role == "motion ended"),
            addresses: addressees.collect(),
            joints,
        };
        Ok(Self {
            name: described.get("name")?,
            joints,
            baudrate: frame.within("baudrate", 1..=100_000_000)?,
            protocol,
            commands,
            addresses,
            geometry: links.transpose().within("geometry", "")?,
        })
    }
}

/// Why a file is not the table of a protocol, as a sentence that says where it is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadEdition(String);

impl BadEdition {
    /// Return the error of that sentence, as an outcome.
    pub(crate) fn because<T>(sentence: impl ToString) -> Outcome<T> {
        Err(Self(short(&sentence.to_string())))
    }
}

impl fmt::Display for BadEdition {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.0)
    }
}

impl core::error::Error for BadEdition {}

/// What was made, or why it could not be.
pub(crate) type Outcome<T> = Result<T, BadEdition>;

/// Says in an error where the mistake is.
pub(crate) trait Within {
    /// Put the name of a place before the sentence of an error.
    fn within(self, what: &str, name: &str) -> Self;
}

impl<T> Within for Outcome<T> {
    fn within(self, what: &str, name: &str) -> Self {
        let space = if name.is_empty() { "" } else { " " };
        self.map_err(|error| BadEdition(format!("{what}{space}{}: {error}", short(name))))
    }
}

/// Return a text of the file for an error: short, and without control characters.
pub(crate) fn short(text: &str) -> String {
    let text = text.chars().filter(|char| !char.is_control());
    text.take(200).collect()
}
