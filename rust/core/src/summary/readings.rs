//! Writes what a frame or noise means as a message, or why it is not a message.

use std::sync::Arc;

use super::memo::Memo;
use super::values::append;
use super::{Sink, repr};
use crate::decode::{self, DecodeError, Decoded};
use crate::direction::{Direction, Listening};
use crate::frame::Frame;
use crate::message::VariantId;
use crate::reason::Reason;
use crate::rules::Claim;
use crate::table::Table;

/// The names that readings hold, in JSON.
#[derive(Clone, Debug)]
pub struct Names {
    /// The name of each command.
    pub commands: Vec<String>,
    /// The names of the fields, by direction, command, variant and field.
    pub fields: [Vec<Vec<Vec<String>>>; 2],
}

/// Appends readings to a buffer.
pub(super) struct Readings {
    table: Arc<Table>,
    names: Names,
    directions: Vec<Direction>,
    errors: Memo<Cause>,
}

/// The values that the text of an error depends on; the others are `None`.
#[derive(PartialEq, Eq, Hash)]
struct Cause {
    direction: Direction,
    reason: Reason,
    length: Option<u16>,
    id: Option<u16>,
    address: Option<u8>,
    size: Option<usize>,
}

impl Readings {
    pub(super) fn new(table: Arc<Table>, names: Names, listening: Listening) -> Self {
        let directions = match listening {
            Listening::To(direction) => vec![direction],
            Listening::Both => vec![Direction::Request, Direction::Reply],
        };
        let errors = Memo::default();
        Self {
            table,
            names,
            directions,
            errors,
        }
    }

    /// Append the messages that a frame can be; return false if there are none.
    pub(super) fn messages(&self, out: &mut Vec<u8>, frame: Frame<'_>) -> bool {
        let start = out.len();
        for direction in &self.directions {
            let rules = self.table.rules(Listening::To(*direction));
            if rules.variants(frame).is_empty() {
                continue;
            }
            if let Ok(message) = decode::read(&self.table, rules, frame, None) {
                separate(out, start);
                self.message(out, &message);
            }
        }
        out.len() > start
    }

    /// Append the readings of any bytes. Bytes without the header of a frame have no message.
    pub(super) fn all(&mut self, out: &mut Vec<u8>, data: &[u8], sink: &mut impl Sink) {
        if !data.starts_with(&self.table.frame().header) {
            return;
        }
        let read = |direction: &Direction| {
            (
                *direction,
                decode::decode(&self.table, *direction, data, None),
            )
        };
        let fitting: Vec<_> = self
            .directions
            .iter()
            .filter(|direction| self.fits(**direction, data))
            .collect();
        let found: Vec<_> = if fitting.is_empty() {
            self.directions.iter().map(read).collect()
        } else {
            fitting.into_iter().map(read).collect()
        };
        let any_message = found.iter().any(|(_, reading)| reading.is_ok());
        let start = out.len();
        for (direction, reading) in found {
            match reading {
                Ok(message) => {
                    separate(out, start);
                    self.message(out, &message);
                }
                Err(error) if !any_message => {
                    separate(out, start);
                    self.error(out, direction, error, data, sink);
                }
                Err(_) => {}
            }
        }
    }

    /// Return whether LEN and id are those of a message of that direction.
    fn fits(&self, direction: Direction, data: &[u8]) -> bool {
        let layout = self.table.frame().layout;
        let rules = self.table.rules(Listening::To(direction));
        let claim = layout.length.read(data).zip(layout.id.read(data));
        claim.is_some_and(|(length, id)| !rules.claimed(Claim { length, id }).is_empty())
    }

    fn message(&self, out: &mut Vec<u8>, message: &Decoded) {
        let id = message.variant;
        begin(out, id.direction);
        out.extend_from_slice(b"\"command\": ");
        let command = self.names.commands.get(id.command);
        out.extend_from_slice(command.map_or(&[], |name| name.as_bytes()));
        if let Some(address) = message.address {
            out.extend_from_slice(b", \"address\": ");
            repr::natural(out, u64::from(address));
        }
        out.extend_from_slice(b", \"fields\": {");
        let mut rest = message.values.as_slice();
        for (index, name) in self.fields(id).iter().enumerate() {
            if index > 0 {
                out.extend_from_slice(b", ");
            }
            out.extend_from_slice(name.as_bytes());
            out.extend_from_slice(b": ");
            if let Some((value, more)) = rest.split_first() {
                rest = more;
                append(out, *value, &mut rest);
            }
        }
        out.extend_from_slice(b"}}");
    }

    fn fields(&self, id: VariantId) -> &[String] {
        let [request, reply] = &self.names.fields;
        let commands = match id.direction {
            Direction::Request => request,
            Direction::Reply => reply,
        };
        let variants = commands.get(id.command).and_then(|all| all.get(id.variant));
        variants.map_or(&[], Vec::as_slice)
    }

    fn error(
        &mut self,
        out: &mut Vec<u8>,
        direction: Direction,
        error: DecodeError,
        data: &[u8],
        sink: &mut impl Sink,
    ) {
        begin(out, direction);
        out.extend_from_slice(b"\"error\": \"");
        let offset = match error {
            DecodeError::Raw(bad) => {
                repr::characters(out, sink.detail(direction, error, data).chars());
                bad.offset
            }
            DecodeError::Frame { reason, offset } => {
                let cause = self.cause(direction, reason, data);
                let make = || sink.detail(direction, error, data);
                repr::characters(out, self.errors.text(cause, make).chars());
                offset
            }
        };
        out.extend_from_slice(b" (at byte ");
        repr::natural(out, offset as u64);
        out.extend_from_slice(b" of ");
        repr::hex(out, data.iter().copied());
        out.extend_from_slice(b")\"}");
    }

    fn cause(&self, direction: Direction, reason: Reason, data: &[u8]) -> Cause {
        let layout = self.table.frame().layout;
        let length = layout.length.read(data);
        let id = layout.id.read(data);
        let address = layout.address_at.and_then(|at| data.get(at).copied());
        let (length, id, address, size) = match reason {
            Reason::NoHeader | Reason::BadCheck => (None, None, None, None),
            Reason::BadAddress => (None, None, address, None),
            Reason::BadLength => (length, id, None, None),
            Reason::UnknownId => (None, id, None, None),
            Reason::Truncated => (length, None, None, Some(data.len())),
            Reason::Trailing => (length, None, None, None),
        };
        Cause {
            direction,
            reason,
            length,
            id,
            address,
            size,
        }
    }
}

fn begin(out: &mut Vec<u8>, direction: Direction) {
    out.extend_from_slice(match direction {
        Direction::Request => b"{\"direction\": \"request\", ",
        Direction::Reply => b"{\"direction\": \"reply\", ",
    });
}

/// Append a comma, unless nothing was appended since `start`.
fn separate(out: &mut Vec<u8>, start: usize) {
    if out.len() > start {
        out.extend_from_slice(b", ");
    }
}
