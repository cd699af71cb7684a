//! How requests end.

use alloc::string::String;
use alloc::vec::Vec;

use super::events::ReplyError;
use super::facts::Nanos;
use super::received::Received;
use crate::decode::Decoded;
use crate::message::VariantId;
use crate::number::Value;

/// What a request that has succeeded has got.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The reply; `None`: it was text, or the request has only an acknowledgement.
    pub decoded: Option<Decoded>,
    /// The fields of a reply that was text, in their order.
    pub texts: Vec<String>,
    /// When the request was first sent.
    pub requested_at: Nanos,
    /// When the reply or the acknowledgement was received, or the time of silence after it was over.
    pub replied_at: Nanos,
}

/// What a request waited for when its caller's deadline passed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitedFor {
    /// Its turn.
    Turn,
    /// The end of the time in which a late reply could pass for its own.
    Hold,
    /// The line, which took no bytes.
    Line,
    /// Its reply.
    Reply,
}

/// Why a request has no answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// No reply came in time.
    Timeout {
        /// How long it waited: since it was sent; since the call, if `waited_for` is there.
        waited: Nanos,
        /// How often it was sent.
        attempts: usize,
        /// What it waited for when its caller's deadline passed; `None`: the arm's time was over.
        waited_for: Option<WaitedFor>,
        /// What was received meanwhile, oldest first.
        received: Vec<Received>,
    },
    /// The reply is illegal.
    Reply {
        /// What is wrong.
        error: ReplyError,
        /// Its bytes, or the first ones of a text that is too long.
        data: Vec<u8>,
    },
    /// The acknowledgement says that the arm did not carry out the request.
    Refused {
        /// The message that says so.
        variant: VariantId,
        /// The index of the field that says so.
        field: usize,
        /// Its value; the first part of a row.
        value: Value,
    },
    /// The transport failed.
    Link,
}

impl Failure {
    /// Return the failure of a one-way request whose caller's deadline passed while the line took
    /// no bytes, so that it was never sent.
    #[must_use]
    pub fn unsent(waited: Nanos) -> Self {
        Self::Timeout {
            waited,
            attempts: 0,
            waited_for: Some(WaitedFor::Line),
            received: Vec::new(),
        }
    }
}
