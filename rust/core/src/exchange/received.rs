//! What was received while a reply was waited for: data, from which others make a text.

use alloc::vec::Vec;

use super::events::Event;
use crate::reason::Reason;

/// At most this many items are kept, and this many bytes of each.
const ITEMS: usize = 20;
const SHOWN: usize = 24;

/// What an item is. `command` is an index in the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // of fields, whose names say what they are
pub enum Kind {
    /// Bytes of no frame; the first was rejected for this reason.
    Noise(Reason),
    /// A late reply.
    Late { command: usize },
    /// A message that the device sent by itself.
    DeviceEvent { command: usize },
    /// An acknowledgement.
    Ack {
        command: usize,
        perhaps_earlier: bool,
    },
    /// The bytes of a request.
    Echo,
    /// A frame that replies to nothing.
    Unexpected,
    /// More than could be read, and a late reply may be among it; this item has no bytes.
    Unread,
}

/// One frame or adjacent noise.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Received {
    /// What it is.
    pub kind: Kind,
    /// Its first bytes.
    pub shown: Vec<u8>,
    /// How many bytes it has.
    pub size: usize,
}

impl Received {
    /// Return the item of bytes that were not read.
    pub(super) fn unread() -> Self {
        let (kind, shown, size) = (Kind::Unread, Vec::new(), 0);
        Self { kind, shown, size }
    }

    fn add(&mut self, data: &[u8]) {
        let missing = SHOWN.saturating_sub(self.shown.len());
        let first = data.get(..missing).unwrap_or(data);
        self.shown.extend_from_slice(first);
        self.size = self.size.saturating_add(data.len());
    }
}

/// The last frames and spans of noise.
#[derive(Clone, Debug, Default)]
pub(super) struct ReceivedMeanwhile(Vec<Received>);

impl ReceivedMeanwhile {
    /// Note one event, for a request with this id. Adjacent noise becomes one item.
    pub(super) fn add(&mut self, event: &Event) {
        let (kind, data) = match event {
            Event::Noise { reason, data, .. } => (Kind::Noise(*reason), data.as_slice()),
            Event::Late { command, frame } => (Kind::Late { command: *command }, frame.bytes()),
            Event::DeviceEvent { command, frame, .. } => {
                (Kind::DeviceEvent { command: *command }, frame.bytes())
            }
            Event::Ack { command, frame, .. } => {
                let (command, perhaps_earlier) = (*command, false);
                let kind = Kind::Ack {
                    command,
                    perhaps_earlier,
                };
                (kind, frame.bytes())
            }
            Event::Echo { frame } => (Kind::Echo, frame.bytes()),
            Event::Unexpected { frame } => (Kind::Unexpected, frame.bytes()),
            Event::Matched { .. } | Event::Rejected { .. } | Event::Expired { .. } => return,
        };
        match (self.0.last_mut(), kind) {
            (Some(last), Kind::Noise(_)) if matches!(last.kind, Kind::Noise(_)) => last.add(data),
            _ => {
                if self.0.len() == ITEMS {
                    self.0.remove(0);
                }
                let mut item = Received {
                    kind,
                    ..Received::unread()
                };
                item.add(data);
                self.0.push(item);
            }
        }
    }

    /// Return the items, oldest first. `doubtful` says whether an acknowledgement of a command may
    /// be that of an earlier request.
    pub(super) fn items(mut self, doubtful: impl Fn(usize) -> bool) -> Vec<Received> {
        for item in &mut self.0 {
            if let Kind::Ack {
                command,
                perhaps_earlier,
            } = &mut item.kind
            {
                *perhaps_earlier = doubtful(*command);
            }
        }
        self.0
    }
}
