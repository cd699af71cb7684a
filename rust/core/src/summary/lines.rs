//! Writes frames and noise as lines of JSON, as `cobotwire decode --json` prints them.

use std::sync::Arc;

use super::memo::Memo;
use super::readings::{Names, Readings};
use super::{Sink, firmware_text, repr, servo_text};
use crate::direction::Listening;
use crate::frame::Frame;
use crate::noise::{Expected, Kind, ServoBus, fitting};
use crate::reason::Reason;
use crate::table::Table;

/// The texts of the lines, in JSON.
#[derive(Clone, Debug)]
pub struct Texts {
    /// Follows the brace that starts a line: nothing, or a key with its value and a comma.
    pub first: String,
    /// The names of commands and fields.
    pub names: Names,
}

/// Noise with few different descriptions. Python writes them, and they are cached.
#[derive(Clone, Copy, Debug)]
pub struct Described<'a> {
    /// Its class.
    pub kind: Kind,
    /// Its first reason.
    pub reason: Reason,
    /// Its bytes.
    pub data: &'a [u8],
    /// The id of a damaged frame, if it was received.
    pub id: Option<u16>,
}

/// A finding with its position in the stream.
pub(super) struct Noise<'a> {
    pub(super) described: Described<'a>,
    pub(super) spans: &'a [(u64, u64)],
    pub(super) continued: bool,
}

/// The values that a description depends on; the others are 0.
#[derive(PartialEq, Eq, Hash)]
struct DescriptionKey {
    kind: Kind,
    reason: Reason,
    id: Option<u16>,
    size: usize,
    fitting: usize,
}

/// Appends lines to a buffer.
pub(super) struct Writer {
    first: String,
    readings: Readings,
    bus: Arc<ServoBus>,
    /// What the next status packets of the servo bus hold.
    pub(super) expected: Expected,
    descriptions: Memo<DescriptionKey>,
}

impl Writer {
    pub(super) fn new(
        texts: Texts,
        table: Arc<Table>,
        listening: Listening,
        bus: Arc<ServoBus>,
    ) -> Self {
        Self {
            first: texts.first,
            readings: Readings::new(table, texts.names, listening),
            bus,
            expected: Expected::new(),
            descriptions: Memo::default(),
        }
    }

    /// Append the line of a frame.
    pub(super) fn frame(
        &mut self,
        out: &mut Vec<u8>,
        offset: u64,
        frame: Frame<'_>,
        sink: &mut impl Sink,
    ) {
        self.begin(out, "frame", offset, frame.bytes());
        let start = out.len();
        out.extend_from_slice(b"\", \"legal\": true, \"readings\": [");
        if !self.readings.messages(out, frame) {
            out.truncate(start);
            out.extend_from_slice(b"\", \"legal\": false, \"readings\": [");
            self.readings.all(out, frame.bytes(), sink);
        }
        out.extend_from_slice(b"]}\n");
    }

    fn begin(&self, out: &mut Vec<u8>, kind: &str, offset: u64, data: &[u8]) {
        out.push(b'{');
        out.extend_from_slice(self.first.as_bytes());
        out.extend_from_slice(b"\"kind\": \"");
        out.extend_from_slice(kind.as_bytes());
        out.extend_from_slice(b"\", \"offset\": ");
        repr::natural(out, offset);
        out.extend_from_slice(b", \"data\": \"");
        repr::hex(out, data.iter().copied());
    }

    /// Append the line of noise.
    pub(super) fn noise(&mut self, out: &mut Vec<u8>, noise: &Noise<'_>, sink: &mut impl Sink) {
        let described = &noise.described;
        let first = noise.spans.first().map_or(0, |(from, _)| *from);
        self.begin(out, "noise", first, described.data);
        out.extend_from_slice(b"\", \"legal\": false, \"reason\": \"");
        out.extend_from_slice(described.reason.word().as_bytes());
        out.extend_from_slice(b"\", \"readings\": [");
        self.readings.all(out, described.data, sink);
        out.extend_from_slice(b"], \"finding\": \"");
        out.extend_from_slice(described.kind.word().as_bytes());
        out.extend_from_slice(b"\", ");
        self.describe(out, described, sink);
        out.extend_from_slice(b", \"pieces\": ");
        repr::list(out, noise.spans.iter(), |out, (from, to)| {
            repr::list(out, [*from, to - from].into_iter(), repr::natural);
        });
        out.extend_from_slice(b", \"continued\": ");
        out.extend_from_slice(if noise.continued {
            b"true}\n"
        } else {
            b"false}\n"
        });
    }

    /// Append text and facts of noise. Only servo packets and texts have many different
    /// descriptions, so these are written here.
    fn describe(&mut self, out: &mut Vec<u8>, noise: &Described<'_>, sink: &mut impl Sink) {
        match noise.kind {
            Kind::Text => firmware_text::append(out, noise.data),
            Kind::Servo => {
                if let Some(packet) = self.bus.read(noise.data, &mut self.expected) {
                    servo_text::append(out, &self.bus, &packet);
                }
            }
            _ => {
                let text = self
                    .descriptions
                    .text(key_of(noise), || sink.describe(noise));
                out.extend_from_slice(text.as_bytes());
            }
        }
    }
}

fn key_of(noise: &Described<'_>) -> DescriptionKey {
    let size = noise.data.len();
    let (id, size, fitting) = match noise.kind {
        Kind::Damaged | Kind::Unlisted => (noise.id, 0, 0),
        Kind::Opposite => (noise.id, size, 0),
        Kind::Nuls => (None, size, 0),
        Kind::Garbage => (None, size, fitting(noise.data)),
        _ => (None, 0, 0),
    };
    DescriptionKey {
        kind: noise.kind,
        reason: noise.reason,
        id,
        size,
        fitting,
    }
}
