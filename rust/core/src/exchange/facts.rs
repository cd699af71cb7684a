//! What the exchange must know of a protocol besides its frames.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::table::Table;

/// A time of a monotonic clock, or a duration, in nanoseconds.
pub type Nanos = u64;

/// What a command does to the arm.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Safety {
    /// It only reads: it may be sent again.
    Query,
    /// It changes a setting.
    Setting,
    /// It moves the arm.
    Motion,
    /// It switches power.
    Power,
    /// It writes a value that survives a power cycle.
    Persistent,
}

/// The name of a field. `echo`: the field of a reply repeats the argument of that name. `status`:
/// the field may report success or failure; only a constant without labels may not.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Named {
    pub name: Box<str>,
    pub echo: bool,
    pub status: bool,
}

/// A text outside any frame: `prefix field prefix field suffix`. A received text ends when nothing
/// comes for the time `silence`, which is 0 for a text that is sent.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct TextForm {
    pub prefixes: Vec<Box<str>>,
    pub fields: Vec<Box<str>>,
    pub suffix: Box<str>,
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
    /// The raw values with which the last status field of its reply reports success. If the list
    /// is empty, a 0 in any status field that is not an echo reports failure.
    pub accepted: Vec<i64>,
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
    /// One device, on behalf of all.
    Somebody,
    /// Nobody.
    Nobody,
}

/// An address of the frame format: its byte, who replies, and how many joints the device has. If
/// `joints` is 0, the device has all joints of the protocol.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Addressee {
    pub name: Box<str>,
    pub value: u8,
    pub replier: Replier,
    pub joints: usize,
}

/// A table, and what the exchange must know of each of its commands, in the same order.
#[derive(Clone, Debug)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Protocol {
    pub table: Table,
    pub facts: Vec<Facts>,
    /// Whether a message of the device reports the end of a motion, so that acknowledgements of
    /// motions come at once.
    pub reports_ends: bool,
    /// The addresses that the protocol describes. Any other address of the frame format belongs
    /// to one device with all joints.
    pub addresses: Vec<Addressee>,
    pub joints: usize,
}
