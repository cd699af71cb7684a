//! What generated modules are made of: the types of requests, events and their fields.

use std::sync::Arc;

use cobotwire_table::Edition;
pub use cobotwire_table::Value;

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

/// A type of arguments and of the fields of replies.
pub trait Typed: Sized {
    /// Convert this value.
    fn into_value(self) -> Value;

    /// Convert a value; `None`: it is of another type.
    fn from_value(value: Value) -> Option<Self>;
}

macro_rules! typed {
    ($($type:ty, $self:ident => $into:expr, $($pattern:pat => $result:expr),+;)*) => {$(
        impl Typed for $type {
            fn into_value($self) -> Value {
                $into
            }

            fn from_value(value: Value) -> Option<Self> {
                match value {
                    $($pattern => Some($result),)+
                    #[allow(unreachable_patterns)] // `Value` accepts every value
                    _ => None,
                }
            }
        }
    )*};
}

typed! {
    i64, self => Value::Integer(self), Value::Integer(raw) => raw;
    f64, self => Value::Real(self), Value::Real(real) => real, Value::Integer(raw) => raw as f64;
    bool, self => Value::Flag(self), Value::Flag(set) => set, Value::Integer(raw) => raw != 0;
    String, self => Value::Text(self), Value::Text(text) => text;
    Vec<u8>, self => Value::Bytes(self), Value::Bytes(bytes) => bytes;
    Value, self => self, value => value;
    (), self => Value::Absent, _ => ();
}

impl<T: Typed> Typed for Option<T> {
    fn into_value(self) -> Value {
        self.map_or(Value::Absent, Typed::into_value)
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Absent => Some(None),
            value => T::from_value(value).map(Some),
        }
    }
}

impl<T: Typed> Typed for Vec<T> {
    fn into_value(self) -> Value {
        Value::Row(self.into_iter().map(Typed::into_value).collect())
    }

    fn from_value(value: Value) -> Option<Self> {
        let Value::Row(row) = value else { return None };
        row.into_iter().map(T::from_value).collect()
    }
}

impl<T: Typed, const N: usize> Typed for [T; N] {
    fn into_value(self) -> Value {
        Vec::from(self).into_value()
    }

    fn from_value(value: Value) -> Option<Self> {
        Vec::from_value(value)?.try_into().ok()
    }
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
