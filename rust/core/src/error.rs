//! What can go wrong, as data: a kind and a place. The sentences are made in Python, once for both
//! codecs, so nothing here has a `Display`.

use crate::given::Given;
use crate::legal::Form;

/// Why bytes are not a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The header is not there.
    NoHeader,
    /// The address byte is none of the format's.
    BadAddress,
    /// LEN is not legal, or not with that id.
    BadLength,
    /// The table lacks the id.
    UnknownId,
    /// The footer, CRC or sum that LEN points at is wrong.
    BadCheck,
    /// The bytes end before the frame does.
    Truncated,
    /// Bytes follow the frame; only [`crate::decode`] minds.
    Trailing,
}

impl Reason {
    /// Every reason; `reason as usize` is its place here.
    pub const ALL: [Self; 7] = [
        Self::NoHeader,
        Self::BadAddress,
        Self::BadLength,
        Self::UnknownId,
        Self::BadCheck,
        Self::Truncated,
        Self::Trailing,
    ];

    /// The reason's name, as programs see it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::NoHeader => "no-header",
            Self::BadAddress => "bad-address",
            Self::BadLength => "bad-length",
            Self::UnknownId => "unknown-id",
            Self::BadCheck => "bad-check",
            Self::Truncated => "truncated",
            Self::Trailing => "trailing",
        }
    }
}

/// What is wrong with a value that was to be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueFault {
    /// It is no number, or no row of numbers.
    Type,
    /// It is infinite or not a number.
    NotFinite,
    /// It is below the minimum or above the maximum.
    Range,
    /// It is none of the choices.
    Choice,
    /// The row has too few or too many elements.
    Count,
}

impl ValueFault {
    /// The fault's name, as programs see it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Type => "type",
            Self::NotFinite => "not-finite",
            Self::Range => "range",
            Self::Choice => "choice",
            Self::Count => "count",
        }
    }
}

/// A value that its field does not allow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadValue<V> {
    /// Index of the form among the command's in that direction.
    pub layout: usize,
    /// Index of the field.
    pub field: usize,
    /// Index of the field's case.
    pub case: usize,
    /// Index of the number in a row; `None`: the field as a whole.
    pub element: Option<usize>,
    /// What is wrong.
    pub fault: ValueFault,
    /// The culprit, as it was given.
    pub value: V,
    /// What it stands for on the wire, where that is the fault: it picks none of a field's cases.
    pub picked: Option<i64>,
}

/// Why nothing was encoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EncodeError<V: Given> {
    /// The frame format has no such address.
    Address,
    /// The command has no form with that many fields in that direction, or it is not the one chosen.
    Form,
    /// A value is not allowed.
    Value(BadValue<V>),
    /// Converting a value failed by itself; this passes through.
    Foreign(V::Error),
}

/// A number on the wire that the table does not allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadRaw {
    /// The form that rules it out.
    pub form: Form,
    /// Index of the field.
    pub field: usize,
    /// Index of the field's case.
    pub case: usize,
    /// Index of the number in the case.
    pub element: usize,
    /// What stands there, after the sign rule.
    pub whole: i64,
    /// Where it stands.
    pub offset: usize,
}

/// Why nothing was decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecodeError {
    /// The bytes are not one whole legal frame.
    Frame {
        /// Why not.
        reason: Reason,
        /// The byte that shows it.
        offset: usize,
    },
    /// The frame is legal, a number in it is not.
    Raw(BadRaw),
}

/// A part of a table that cannot be interpreted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misfit {
    /// A number is not one to four bytes wide.
    Width,
    /// A scale is zero, or too fine for an exact double.
    Scale,
    /// A bound is beyond the whole numbers that a double holds exactly.
    Bounds,
    /// A field has no case, cases of different sizes, or not one number where it takes one.
    Cases,
    /// A selector is not the index of a field of one number.
    Selector,
    /// A form is longer than LEN can say.
    Length,
}

/// Why a table was refused: a mistake in the table, not in any data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableError {
    /// Index of the command.
    pub command: usize,
    /// What is wrong with it.
    pub misfit: Misfit,
}
