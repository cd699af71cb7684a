//! The values that a caller wants to encode, as the encoder sees them.

use alloc::vec::Vec;

use crate::number::Encoding;

/// What is wrong with a value that was to be encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueFault {
    /// It is not a number, or not a row of numbers.
    Type,
    /// It is infinite or not a number.
    NotFinite,
    /// It is below the minimum or above the maximum.
    Range,
    /// It is not one of the choices.
    Choice,
    /// The row has too few or too many elements.
    Count,
    /// An element of a list is not a row.
    ElementType,
    /// An element of a list has too few or too many numbers.
    ElementCount,
    /// It is a text that its encoding or padding cannot express.
    Text,
}

impl ValueFault {
    /// Return the fault's name, as programs see it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Type => "type",
            Self::NotFinite => "not-finite",
            Self::Range => "range",
            Self::Choice => "choice",
            Self::Count => "count",
            Self::ElementType => "element-type",
            Self::ElementCount => "element-count",
            Self::Text => "text",
        }
    }
}

/// Why a value is not a number, or not a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unread<E> {
    /// It is of another type, or not allowed.
    Fault(ValueFault),
    /// It is an integer of more than 64 bits, beyond all bounds and choices.
    Beyond,
    /// Converting it raised an error of its own, which is passed on.
    Foreign(E),
}

/// A value of the caller. The encoder converts each value only when its turn comes, since a
/// conversion may run the caller's code, and the leftmost mistake must be reported.
pub trait Given: Sized {
    /// The error of a conversion, other than a wrong type.
    type Error;
    /// A row of such values.
    type Row: Row<Item = Self>;

    /// Convert it to an integer; a bool is accepted only for a flag.
    ///
    /// # Errors
    /// It is not an integer.
    fn integer(&self, flag: bool) -> Result<i64, Unread<Self::Error>>;

    /// Convert it to a real number.
    ///
    /// # Errors
    /// It is not a real number.
    fn real(&self) -> Result<f64, Unread<Self::Error>>;

    /// Convert it to a row that the caller's code cannot change afterwards.
    ///
    /// # Errors
    /// It is not a row.
    fn row(&self) -> Result<Self::Row, Unread<Self::Error>>;

    /// Return whether this is the placeholder (`...` in Python) for a count that the encoder fills
    /// in.
    fn counted(&self) -> bool;

    /// Return the bytes of a bytes-like object; `None`: it is something else.
    ///
    /// # Errors
    /// Reading it raised an error.
    fn bytes(&self) -> Result<Option<Vec<u8>>, Unread<Self::Error>>;

    /// Return the bytes of a text.
    ///
    /// # Errors
    /// It is not text, or not of that encoding.
    fn text(&self, encoding: Encoding) -> Result<Vec<u8>, Unread<Self::Error>>;
}

/// A row of values.
pub trait Row {
    /// One of its values.
    type Item;

    /// Return the number of values.
    fn count(&self) -> usize;

    /// Return one of the values.
    fn at(&self, index: usize) -> Option<Self::Item>;

    /// Return the row itself as a value, for an error message.
    fn into_value(self) -> Self::Item;
}

impl<V: Clone + From<Vec<V>>> Row for Vec<V> {
    type Item = V;

    fn count(&self) -> usize {
        self.len()
    }

    fn at(&self, index: usize) -> Option<V> {
        self.get(index).cloned()
    }

    fn into_value(self) -> V {
        self.into()
    }
}
