//! What generated modules are made of.

use std::sync::Arc;

use cobotwire_table::Edition;

pub use crate::value::{Typed, Value};

/// The table of an edition.
pub type Table = Arc<Edition>;

/// A request of a command, as a type.
pub trait Request: Clone + Send + 'static {
    /// What a call returns.
    type Reply: Typed + Send + 'static;
    /// The name of the command.
    const COMMAND: &'static str;
    /// The fields of the reply that the result is made of.
    const RESULTS: &'static [&'static str];
    /// The arguments and results in radians, which the wire carries in degrees.
    const RADIANS: &'static [&'static str];

    /// Return the arguments with their names.
    fn arguments(self) -> Vec<(&'static str, Value)>;
}

/// A message that the device sends without a request, as a type.
pub trait DeviceEvent: Typed + Send + 'static {
    /// The name of the command.
    const COMMAND: &'static str;
    /// Its fields.
    const FIELDS: &'static [&'static str];
}

/// Expands to its items if this crate has the feature `tokio`.
#[cfg(feature = "tokio")]
#[doc(hidden)]
#[macro_export]
macro_rules! with_tokio {
    ($($item:item)*) => { $($item)* };
}

/// Expands to nothing: the feature `tokio` is off.
#[cfg(not(feature = "tokio"))]
#[doc(hidden)]
#[macro_export]
macro_rules! with_tokio {
    ($($item:item)*) => {};
}
