//! How requests end.

use alloc::string::String;
use alloc::vec::Vec;

use super::matching::{fields, same};
use super::{Event, Nanos, Protocol, ReplyError};
use crate::decode::Decoded;
use crate::message::VariantId;
use crate::number::Value;

/// A reply, or the fields of a reply that was text.
pub(super) type Got = (Option<Decoded>, Vec<String>);

/// The result of a request that succeeded.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the names of the times explain them
pub struct Answer {
    /// The reply; `None`: it was text, or the request has only an acknowledgement.
    pub decoded: Option<Decoded>,
    /// The fields of a reply that was text, in their order.
    pub texts: Vec<String>,
    pub requested_at: Nanos,
    pub replied_at: Nanos,
}

/// What a request waited for when its caller's deadline passed: its turn, the end of the time in
/// which a late reply could be mistaken for its own (hold), a transport that took no bytes (line),
/// or its reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub enum WaitedFor {
    Turn,
    Hold,
    Line,
    Reply,
}

/// A frame, or adjacent noise, that was received while a request waited.
#[derive(Clone, Debug, PartialEq)]
pub struct Received {
    /// What it is; of noise the first 24 bytes.
    pub event: Event,
    /// How many bytes it has.
    pub size: usize,
}

/// Why a request failed.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// No reply came in time.
    Timeout {
        /// How long it waited: since it was sent, or with `waited_for` since the call.
        waited: Nanos,
        /// How often it was sent. 0 without `waited_for`: bytes came faster than they can be read,
        /// and a late reply may be among the unread ones.
        attempts: usize,
        /// What it waited for when its caller's deadline passed; `None`: it has not passed.
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
        /// Its value; of several numbers, the first.
        value: Value,
    },
    /// The transport failed.
    Link,
}

impl Failure {
    /// Return the failure that a reply reports by a status; `None`: it reports success.
    ///
    /// If the command has no accepted values, a status that is 0 reports failure, unless it repeats
    /// an argument.
    pub(super) fn refusal(protocol: &Protocol, reply: &Decoded) -> Option<Self> {
        let (variant, facts) = (reply.variant, protocol.facts.get(reply.variant.command)?);
        let own = fields(facts.reply.get(variant.variant)?, reply).enumerate();
        let mut statuses = own.filter(|(_, (named, _))| named.status);
        let is = |value: &[Value], raw: i64| same(value, &[Value::Integer(raw)]);
        let (field, value) = if facts.accepted.is_empty() {
            let (field, _) = statuses.find(|(_, (named, value))| !named.echo && is(value, 0))?;
            // The status is reported as an integer, whatever the scale of the field is.
            (field, Value::Integer(0))
        } else {
            let (last, (_, value)) = statuses.last()?;
            if facts.accepted.iter().any(|raw| is(value, *raw)) {
                return None;
            }
            (last, *value.first()?)
        };
        Some(Self::Refused {
            variant,
            field,
            value,
        })
    }
}
