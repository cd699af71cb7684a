//! The events that the exchange reports for received bytes.

use alloc::string::String;
use alloc::vec::Vec;

use super::{Nanos, TextError};
use crate::decode::{DecodeError, Decoded};
use crate::framer;
use crate::owned::OwnedFrame;
use crate::reason::Reason;

/// A legal frame that was received.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SeenFrame {
    /// The position of its first byte in the stream.
    pub offset: u64,
    /// The frame.
    pub frame: OwnedFrame,
}

impl SeenFrame {
    /// Return all of it, from header to check.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        self.frame.bytes()
    }
}

/// What is wrong with a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReplyError {
    /// Its frame.
    Frame(DecodeError),
    /// Its text.
    Text(TextError),
}

/// What received bytes are, or which wait timed out. `command` is an index in the table.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the names of the fields explain them
pub enum Event {
    /// Bytes that belong to no frame, all rejected for the same reason.
    Noise {
        offset: u64,
        reason: Reason,
        data: Vec<u8>,
    },
    /// The reply that was waited for.
    Matched {
        command: usize,
        decoded: Option<Decoded>,
        texts: Vec<String>,
        frame: Option<SeenFrame>,
    },
    /// The reply that was waited for, with values that the protocol does not allow.
    Rejected {
        command: usize,
        error: ReplyError,
        frame: Option<SeenFrame>,
    },
    /// The reply to a request that was given up, or to one more attempt of a request that has
    /// ended.
    Late { command: usize, frame: SeenFrame },
    /// The acknowledgement of a one-way request.
    Ack {
        command: usize,
        decoded: Decoded,
        frame: SeenFrame,
    },
    /// A message that the device sends without a request.
    DeviceEvent {
        command: usize,
        decoded: Decoded,
        frame: SeenFrame,
    },
    /// A legal frame that matches no request.
    Unexpected { frame: SeenFrame },
    /// The request's own bytes: an echo, or a reply that looks the same.
    Echo { frame: SeenFrame },
    /// The deadline of a request that was sent has passed.
    Expired {
        command: usize,
        requested_at: Nanos,
        attempts: usize,
    },
}

impl From<framer::Event<'_>> for Event {
    /// Return an event that owns its bytes; a frame is unexpected until it is matched.
    fn from(event: framer::Event<'_>) -> Self {
        match event {
            framer::Event::Frame { offset, frame } => {
                let frame = frame.into();
                let frame = SeenFrame { offset, frame };
                Self::Unexpected { frame }
            }
            framer::Event::Noise {
                offset,
                reason,
                data,
            } => Self::Noise {
                offset,
                reason,
                data: data.concat(),
            },
        }
    }
}

impl Event {
    /// Return the received bytes that this event reports: noise, or a frame.
    #[must_use]
    pub fn data(&self) -> &[u8] {
        match self {
            Self::Noise { data, .. } => data,
            Self::Matched { frame, .. } | Self::Rejected { frame, .. } => {
                frame.as_ref().map_or(&[], SeenFrame::bytes)
            }
            Self::Late { frame, .. }
            | Self::Ack { frame, .. }
            | Self::DeviceEvent { frame, .. }
            | Self::Unexpected { frame }
            | Self::Echo { frame } => frame.bytes(),
            Self::Expired { .. } => &[],
        }
    }
}
