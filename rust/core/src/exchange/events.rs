//! What the exchange makes of received bytes.

use alloc::string::String;
use alloc::vec::Vec;

use super::facts::Nanos;
use super::text::TextError;
use crate::decode::{DecodeError, Decoded};
use crate::frame::{Frame, FrameFormat};
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

    pub(super) fn get(&self, format: &FrameFormat) -> Frame<'_> {
        self.frame.get(format)
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

/// What received bytes are, or what time has ended. `command` is an index in the table.
#[derive(Clone, Debug, PartialEq)]
pub enum Event {
    /// Bytes that belong to no frame, all rejected for the same reason.
    Noise {
        /// The position of the first one in the stream.
        offset: u64,
        /// Why they were rejected.
        reason: Reason,
        /// The bytes.
        data: Vec<u8>,
    },
    /// The reply that was waited for.
    Matched {
        /// The command.
        command: usize,
        /// Its message; `None`: it was text outside any frame.
        decoded: Option<Decoded>,
        /// The fields of a text.
        texts: Vec<String>,
        /// The frame; `None`: an earlier event has reported the bytes, as noise or as an echo.
        frame: Option<SeenFrame>,
    },
    /// The reply that was waited for, with values that the protocol does not allow.
    Rejected {
        /// The command.
        command: usize,
        /// What is wrong.
        error: ReplyError,
        /// The frame; `None`: earlier events have reported the bytes, as noise.
        frame: Option<SeenFrame>,
    },
    /// The reply to a request that was given up, or to an earlier attempt of one that has ended.
    Late {
        /// The command.
        command: usize,
        /// The frame.
        frame: SeenFrame,
    },
    /// The acknowledgement of a one-way request.
    Ack {
        /// The command.
        command: usize,
        /// Its message.
        decoded: Decoded,
        /// The frame.
        frame: SeenFrame,
    },
    /// A message that the device sends without a request.
    DeviceEvent {
        /// The command.
        command: usize,
        /// The message.
        decoded: Decoded,
        /// The frame.
        frame: SeenFrame,
    },
    /// A legal frame that replies to nothing.
    Unexpected {
        /// The frame.
        frame: SeenFrame,
    },
    /// The request's own bytes: an echo, or a reply that looks the same.
    Echo {
        /// The frame.
        frame: SeenFrame,
    },
    /// The deadline of a request that was sent has passed.
    Expired {
        /// The command.
        command: usize,
        /// When it was first sent.
        requested_at: Nanos,
        /// How often it was sent.
        attempts: usize,
    },
}
