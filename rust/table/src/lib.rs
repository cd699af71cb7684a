//! Reads the `edition.json` of a protocol: the table of `cobotwire-core`, with its names, units,
//! labels, roles and limits.
//!
//! The file may come from an untrusted source: [`Edition::read`] checks every property on which
//! this crate and the core rely. `python/cobotwire/protocol/loading.py` is its specification.

#![no_std]

extern crate alloc;

mod commands;
mod explain;
mod frame;
mod json;
mod messages;
mod rejection;
mod texts;
mod types;
mod value;

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use cobotwire_core::exchange::{Protocol, Safety};
use cobotwire_core::{Direction, Table};

use crate::json::Record;
use crate::messages::Messages;

pub use crate::explain::Explained;
pub use crate::texts::{bad_argument, error_text, link_error};
pub use crate::value::Value;

/// The version of the format.
const VERSION: i64 = 3;
/// The largest file. In memory, a JSON value takes up to 32 times the size of its text.
const LARGEST: usize = 4 << 20;

/// A protocol as data. Commands are in the order of the table.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Edition {
    pub name: String,
    pub baudrate: u32,
    /// What codec and exchange interpret.
    pub protocol: Protocol,
    pub commands: Vec<Command>,
}

/// The properties of a command that error texts and clients need.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Command {
    pub name: String,
    /// A short description; a table for clients lacks it.
    pub title: String,
    pub family: String,
    pub safety: Safety,
    /// The role in which clients use it; empty: none.
    pub role: String,
    /// The query that reads back what it sets.
    pub read_by: Option<String>,
    /// The states in which the device stores its arguments.
    pub stores: Vec<String>,
    /// The variants of its request, and of its reply.
    pub request: Vec<Vec<Field>>,
    pub reply: Vec<Vec<Field>>,
}

impl Command {
    /// Return the variants in one direction.
    #[must_use]
    pub fn variants(&self, direction: Direction) -> &[Vec<Field>] {
        match direction {
            Direction::Request => &self.request,
            Direction::Reply => &self.reply,
        }
    }
}

/// The properties of a field that error texts and clients need.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Field {
    pub name: String,
    /// The labels of its choices, in the same order; empty: the choices have none.
    pub labels: Vec<String>,
    /// Ranges of raw values, each with a text for the values in it; `{number}` is the raw value.
    pub meanings: Vec<(i64, i64, String)>,
    /// The numbers of each case. For a list, bytes or a text they are those of one element;
    /// [`Field::number`] finds the number at any index.
    pub cases: Vec<Vec<Number>>,
    /// The smallest and the largest number of elements, if they differ.
    pub sizes: Option<(usize, usize)>,
    /// If it is a count: the name of the field with the counted elements.
    pub counts: Option<String>,
    /// Whether it is a constant; `default` is its value.
    pub constant: bool,
    /// The value of an argument that is left out, in physical units.
    pub default: Option<Value>,
}

impl Field {
    /// Return the number at an index of the field's numbers.
    #[must_use]
    pub fn number(&self, case: usize, index: usize) -> Option<&Number> {
        let numbers = self.cases.get(case)?;
        numbers.get(index.checked_rem(numbers.len())?)
    }
}

/// The properties of a number that error texts need: its name in a named tuple, its unit, and the
/// labels of its choices. Each may be empty.
#[derive(Clone, Debug, Default)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Number {
    pub name: String,
    pub unit: String,
    pub labels: Vec<String>,
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
        let document: Result<serde_json::Value, _> = serde_json::from_slice(json);
        let document = document.or_else(BadEdition::because);
        let root = Record(&document.within("the file is not JSON", "")?);
        let version: i64 = root.get("version")?;
        if version != VERSION {
            return BadEdition::because(format!(
                "the file has version {version} of the format, not {VERSION}"
            ));
        }
        let (frame, described) = (root.at("frame"), root.at("edition"));
        let addresses = frame::addresses(frame).within("frame", "")?;
        let format = frame::frame_format(frame, &addresses, json).within("frame", "")?;
        let last = if format.layout.id.wide { 0xFFFF } else { 0xFF };
        let (mut wire, mut facts, mut commands) = (Vec::new(), Vec::new(), Vec::new());
        let (messages, mut names) = (Messages::new(root)?, BTreeSet::new());
        for record in root.records("commands")? {
            let name = record.name().within("a command", "")?;
            if !names.insert(name) {
                return BadEdition::because("the file defines it twice").within("command", name);
            }
            let parts = commands::command(record, &messages, last).within("command", name)?;
            wire.push(parts.0);
            facts.push(parts.1);
            commands.push(parts.2);
        }
        let table = Table::new(format, wire).or_else(|error| {
            let command: Option<&Command> = commands.get(error.command);
            let name = command.map_or("", |command| &command.name);
            BadEdition::because(error.misfit).within("command", name)
        })?;
        let protocol = Protocol {
            table,
            facts,
            reports_ends: commands.iter().any(|each| each.role == "motion ended"),
            addresses,
            joints: described.get::<u8>("joints")?.into(),
        };
        Ok(Self {
            name: described.get("name")?,
            baudrate: frame.within("baudrate", 1..=100_000_000)?,
            protocol,
            commands,
        })
    }
}

/// Why a file is not the table of a protocol: a sentence that names the position of the mistake.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadEdition(String);

impl BadEdition {
    /// Return the error with this sentence, as an outcome.
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

/// A result, or why the file was rejected.
pub(crate) type Outcome<T> = Result<T, BadEdition>;

/// Adds the position of the mistake to an error.
pub(crate) trait Within {
    /// Prefix the error with the position of the mistake.
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
