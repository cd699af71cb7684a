//! What the exchange must know of a protocol besides its frames.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::table::Table;

/// Nanoseconds of a monotonic clock, or between two of its moments.
pub type Nanos = u64;

/// What a command does to the arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Deserialize),
    serde(rename_all = "lowercase")
)]
pub enum Safety {
    /// It only reads: it may be sent again.
    Query,
    /// It changes a setting.
    Setting,
    /// It moves the arm.
    Motion,
    /// It switches power.
    Power,
    /// It writes what remains without power.
    #[cfg_attr(feature = "serde", serde(rename = "persistent write"))]
    Persistent,
}

/// The name of a field, and whether a reply repeats the argument of that name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named {
    /// The name.
    pub name: Box<str>,
    /// Whether it repeats an argument of the request.
    pub echo: bool,
}

/// A text outside any frame: `prefix field prefix field suffix`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextForm {
    /// What precedes each field.
    pub prefixes: Vec<Box<str>>,
    /// The names of the fields.
    pub fields: Vec<Box<str>>,
    /// What follows the last field.
    pub suffix: Box<str>,
    /// How long a silence ends it; 0 for a text that is sent.
    pub silence: Nanos,
}

/// What the exchange must know of a command.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Facts {
    /// What it does to the arm.
    pub safety: Safety,
    /// How long the arm may take to reply.
    pub deadline: Nanos,
    /// Whether its reply is an acknowledgement, which may be missing.
    pub ack: bool,
    /// Whether the device sends it without a request.
    pub event: bool,
    /// The reply that is text, if it has one.
    pub text: Option<TextForm>,
    /// The text that follows its request, if any.
    pub request_text: Option<TextForm>,
    /// The fields of each variant of its request.
    pub request: Vec<Vec<Named>>,
    /// The fields of each variant of its reply.
    pub reply: Vec<Vec<Named>>,
    /// The raw values of the last status of its reply that mean success; empty: a field that is 0
    /// reports failure.
    pub accepted: Vec<i64>,
    /// For each variant of its reply, the indices of the fields that are statuses: those that are
    /// not constants, or have labels.
    pub statuses: Vec<Vec<usize>>,
}

/// Who replies to a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Replier {
    /// The arm: frames have no address.
    Unaddressed,
    /// The device with this address.
    Address(u8),
    /// Any device: each that received the request may reply.
    Anybody,
    /// One device for all.
    Somebody,
    /// Nobody.
    Nobody,
}

/// An address of the frame format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Addressee {
    /// The byte.
    pub value: u8,
    /// Who replies to a request to it.
    pub replier: Replier,
    /// How many joints the device has; 0: those of the protocol.
    pub joints: usize,
}

/// A table, and what the exchange must know of each of its commands, in the same order.
#[derive(Clone, Debug)]
pub struct Protocol {
    /// The table.
    pub table: Table,
    /// The facts of each command.
    pub facts: Vec<Facts>,
    /// Whether a message of the device reports the end of a motion, so that acknowledgements of
    /// motions come at once.
    pub reports_ends: bool,
    /// The addresses that the protocol describes. Any other address of the frame format is that of
    /// one device with all joints.
    pub addresses: Vec<Addressee>,
    /// How many joints the arm has.
    pub joints: usize,
}
