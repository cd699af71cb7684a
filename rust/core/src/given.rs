//! What a caller hands over to be encoded, as far as the encoder has to know it.

use crate::error::ValueFault;

/// Why a value gave no number, or no row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unread<E> {
    /// It is not of that kind.
    Fault(ValueFault),
    /// It is a whole number so large that no bound and no choice reaches it.
    Beyond,
    /// Converting it failed by itself; this passes through.
    Foreign(E),
}

/// A value as the caller has it. It is converted when its turn comes, and not before: conversions
/// may run the caller's code, and the leftmost mistake is the one to report.
pub trait Given: Sized {
    /// How a conversion fails by itself.
    type Error;
    /// A row of such values.
    type Row: Row<Item = Self>;

    /// It as a whole number; a bool is one only for a flag.
    ///
    /// # Errors
    /// It is none.
    fn whole(&self, flag: bool) -> Result<i64, Unread<Self::Error>>;

    /// It as a real number.
    ///
    /// # Errors
    /// It is none.
    fn real(&self) -> Result<f64, Unread<Self::Error>>;

    /// It as a row, which from then on stays as it is.
    ///
    /// # Errors
    /// It is none.
    fn row(&self) -> Result<Self::Row, Unread<Self::Error>>;
}

/// A row of values.
pub trait Row {
    /// One of them.
    type Item;

    /// How many there are.
    fn count(&self) -> usize;

    /// One of them.
    fn at(&self, index: usize) -> Option<Self::Item>;

    /// The row itself as a value, to show to the caller.
    fn into_value(self) -> Self::Item;
}
