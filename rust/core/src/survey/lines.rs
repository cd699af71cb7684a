//! Writes frames and noise as lines of JSON, as `cobotwire decode --json` prints them.

use super::repr;
use crate::decode;
use crate::direction::{Direction, Listening};
use crate::frame::Frame;
use crate::message::VariantId;
use crate::noise::Kind;
use crate::number::{Encoding, Value};
use crate::reason::Reason;
use crate::table::Table;

/// The texts of the lines, in JSON.
#[derive(Clone, Debug)]
pub struct Texts {
    /// Follows the brace that starts a line: nothing, or a key with its value and a comma.
    pub first: String,
    /// The name of each command.
    pub commands: Vec<String>,
    /// The names of the fields, by direction, command, variant and field.
    pub fields: [Vec<Vec<Vec<String>>>; 2],
    /// What a line says about unrecognised bytes.
    pub unrecognised: String,
    /// What it says about the firmware's error message.
    pub command_error: String,
}

/// Appends lines to a buffer.
pub(super) struct Writer {
    texts: Texts,
    ways: Vec<Direction>,
}

impl Writer {
    pub(super) fn new(texts: Texts, listening: Listening) -> Self {
        let ways = match listening {
            Listening::To(way) => vec![way],
            Listening::Both => vec![Direction::Request, Direction::Reply],
        };
        Self { texts, ways }
    }

    /// Append the line of a frame; append nothing if it is for Python, since no message is legal.
    pub(super) fn frame(
        &self,
        out: &mut Vec<u8>,
        table: &Table,
        offset: u64,
        frame: Frame<'_>,
    ) -> bool {
        let start = out.len();
        self.begin(out, "frame", offset);
        repr::hex(out, frame.bytes().iter().copied());
        out.extend_from_slice(b"\", \"legal\": true, \"readings\": [");
        let readings = out.len();
        for way in &self.ways {
            let rules = table.rules(Listening::To(*way));
            if rules.variants(frame).is_empty() {
                continue;
            }
            if let Ok(message) = decode::read(table, rules, frame, None) {
                if out.len() > readings {
                    out.extend_from_slice(b", ");
                }
                self.reading(out, &message);
            }
        }
        if out.len() == readings {
            out.truncate(start);
            return false;
        }
        out.extend_from_slice(b"]}\n");
        true
    }

    fn begin(&self, out: &mut Vec<u8>, kind: &str, offset: u64) {
        out.push(b'{');
        out.extend_from_slice(self.texts.first.as_bytes());
        out.extend_from_slice(b"\"kind\": \"");
        out.extend_from_slice(kind.as_bytes());
        out.extend_from_slice(b"\", \"offset\": ");
        repr::natural(out, offset);
        out.extend_from_slice(b", \"data\": \"");
    }

    /// Append one reading of a frame.
    fn reading(&self, out: &mut Vec<u8>, message: &decode::Decoded) {
        let id = message.variant;
        out.extend_from_slice(b"{\"direction\": \"");
        out.extend_from_slice(match id.direction {
            Direction::Request => b"request",
            Direction::Reply => b"reply",
        });
        out.extend_from_slice(b"\", \"command\": ");
        let command = self.texts.commands.get(id.command);
        out.extend_from_slice(command.map_or(&[], |name| name.as_bytes()));
        if let Some(address) = message.address {
            out.extend_from_slice(b", \"address\": ");
            repr::natural(out, u64::from(address));
        }
        out.extend_from_slice(b", \"fields\": {");
        let mut rest = message.values.as_slice();
        for (index, name) in self.names(id).iter().enumerate() {
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

    fn names(&self, id: VariantId) -> &[String] {
        let [request, reply] = &self.texts.fields;
        let commands = match id.direction {
            Direction::Request => request,
            Direction::Reply => reply,
        };
        let variants = commands.get(id.command).and_then(|all| all.get(id.variant));
        variants.map_or(&[], Vec::as_slice)
    }

    /// Append the line of noise of a class whose text is always the same.
    pub(super) fn noise(&self, out: &mut Vec<u8>, noise: &Noise<'_>) {
        let first = noise.spans.first().map_or(0, |(from, _)| *from);
        self.begin(out, "noise", first);
        repr::hex(out, noise.data.iter().copied());
        out.extend_from_slice(b"\", \"legal\": false, \"reason\": \"");
        out.extend_from_slice(noise.reason.word().as_bytes());
        out.extend_from_slice(b"\", \"readings\": [], \"finding\": \"");
        out.extend_from_slice(noise.kind.word().as_bytes());
        out.extend_from_slice(b"\", \"text\": ");
        let text = match noise.kind {
            Kind::CommandError => &self.texts.command_error,
            _ => &self.texts.unrecognised,
        };
        out.extend_from_slice(text.as_bytes());
        out.extend_from_slice(b", \"facts\": {}, \"pieces\": [");
        for (index, (from, to)) in noise.spans.iter().enumerate() {
            out.extend_from_slice(if index > 0 { b", [" } else { b"[" });
            repr::natural(out, *from);
            out.extend_from_slice(b", ");
            repr::natural(out, to - from);
            out.push(b']');
        }
        out.extend_from_slice(b"], \"continued\": ");
        out.extend_from_slice(if noise.continued {
            b"true}\n"
        } else {
            b"false}\n"
        });
    }
}

/// A finding with its place in the stream.
pub(super) struct Noise<'a> {
    pub(super) kind: Kind,
    pub(super) data: &'a [u8],
    pub(super) reason: Reason,
    pub(super) spans: &'a [(u64, u64)],
    pub(super) continued: bool,
}

/// Append a value; what it consists of is taken from `rest`.
fn append(out: &mut Vec<u8>, value: Value, rest: &mut &[Value]) {
    match value {
        Value::Integer(raw) => repr::integer(out, raw),
        Value::Real(real) => repr::real(out, real),
        Value::Row(count) | Value::Rows(count) => {
            out.push(b'[');
            for index in 0..count {
                if index > 0 {
                    out.extend_from_slice(b", ");
                }
                if let Some((value, more)) = rest.split_first() {
                    *rest = more;
                    append(out, *value, rest);
                }
            }
            out.push(b']');
        }
        Value::Text(count, encoding) => {
            let bytes: Vec<u8> = bytes(rest, count).collect();
            if encoding == Encoding::Utf8 {
                repr::text(out, String::from_utf8_lossy(&bytes).chars());
            } else {
                repr::text(out, bytes.into_iter().map(char::from));
            }
        }
        Value::Bytes(count) => {
            out.push(b'"');
            repr::hex(out, bytes(rest, count));
            out.push(b'"');
        }
    }
}

/// Take bytes from the values.
fn bytes<'a>(rest: &mut &'a [Value], count: usize) -> impl Iterator<Item = u8> + use<'a> {
    let (bytes, more) = rest.split_at_checked(count).unwrap_or_default();
    *rest = more;
    bytes.iter().map(|value| match value {
        Value::Integer(raw) => u8::try_from(*raw).unwrap_or_default(),
        _ => 0,
    })
}
