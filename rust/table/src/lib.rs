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
use alloc::string::String;
use alloc::vec::Vec;

use cobotwire_core::exchange::{Protocol, Replier, Safety};
use cobotwire_core::{Misfit, Table, TableError};
use serde_json::Value;

use crate::json::{Node, Within};
use crate::messages::Messages;

pub use crate::json::BadEdition;
pub use crate::named::Filled;
pub use crate::robot::Link;
pub use crate::shown::{Quote, Shown, general};
pub use crate::texts::{as_call, bad_argument, error_text, link_error};

/// The version of the format.
const VERSION: i64 = 3;
/// The highest rate of a serial port.
const LARGEST_RATE: i64 = 100_000_000;
/// The largest file. A value of JSON takes up to 32 times its text in memory.
const LARGEST: usize = 4 << 20;

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
    /// The lowest and the highest angle of each joint, in degrees; empty: not stated.
    pub joint_limits: Vec<(f64, f64)>,
    /// The links of the arm, from the base on, if they are known.
    pub geometry: Option<Vec<Link>>,
    /// Why the links are not known, if the file says so.
    pub geometry_unknown: String,
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
    /// The order of its arguments; empty: that of the wire.
    pub arguments: Vec<String>,
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
            return Err(BadEdition::new(format!(
                "the file has more than {LARGEST} bytes"
            )));
        }
        let document: Value = serde_json::from_slice(json)
            .map_err(|error| BadEdition::new(format!("the file is not JSON: {error}")))?;
        let root = Node::root(&document).record()?;
        let version = root.need("version")?.integer()?;
        if version != VERSION {
            let text = format!("the file has version {version} of the format, not {VERSION}");
            return Err(BadEdition::new(text));
        }
        let frame = root.need("frame")?.record()?;
        let described = root.need("edition")?.record()?;
        let format = frame::frame_format(frame, json).within("frame", "")?;
        let (addresses, addressees) = frame::addresses(frame).within("frame", "")?;
        let most = frame
            .size("maximum_data", frame::LONGEST)
            .within("frame", "")?;
        let last = if format.layout.id.wide { 0xFFFF } else { 0xFF };
        let (mut wire, mut facts, mut commands) = (Vec::new(), Vec::new(), Vec::new());
        let mut messages = Messages::new(root, most)?;
        let mut names = BTreeSet::new();
        for record in root.records("commands")? {
            let name = record.name().within("a command", "")?;
            if !names.insert(name) {
                return Err(BadEdition::new("the file has it twice")).within("command", name);
            }
            let parts = commands::command(record, &mut messages, last).within("command", name)?;
            wire.push(parts.0);
            facts.push(parts.1);
            commands.push(parts.2);
        }
        let table = Table::new(format, wire).map_err(|error| rejected(error, &commands))?;
        let joints = described.size("joints", 255).within("edition", "")?;
        let protocol = Protocol {
            table,
            facts,
            reports_ends: commands
                .iter()
                .any(|command| command.role == "motion ended"),
            addresses: addressees,
            joints,
        };
        Ok(Self {
            name: described.name()?.into(),
            title: described.text("title")?.into(),
            joints,
            baudrate: u32::try_from(frame.within("baudrate", 1..=LARGEST_RATE)?)
                .unwrap_or_default(),
            protocol,
            commands,
            addresses,
            joint_limits: robot::joint_limits(described).within("edition", "")?,
            geometry: robot::geometry(described).within("geometry", "")?,
            geometry_unknown: described.text("geometry_unknown")?.into(),
        })
    }
}

/// Return the error of a command that the core cannot interpret.
fn rejected(error: TableError, commands: &[Command]) -> BadEdition {
    let name = commands
        .get(error.command)
        .map_or("", |command| &command.name);
    BadEdition::new(format!("command {name}: {}", why(error.misfit)))
}

/// Return the sentence of a mistake that the core found.
fn why(misfit: Misfit) -> &'static str {
    match misfit {
        Misfit::Width => "an integer must have one to four bytes, a float four or eight",
        Misfit::Scale => "a scale is zero, or too fine for an exact double",
        Misfit::Bounds => "a bound is an integer that a double cannot represent exactly",
        Misfit::Cases => {
            "all cases of a field must have one size, and one number unless it has many"
        }
        Misfit::Selector => "a selector must be the index of a field with one number",
        Misfit::Length => {
            "a variant is longer than LEN can express, or a reply without an id is shorter than an id"
        }
    }
}
