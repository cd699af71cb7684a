//! Values of arguments and replies, and their conversion from and to types of Rust.

use std::convert::Infallible;

use cobotwire_core::{Encoding, Given, Row, Unread, Value as Flat, ValueFault};
use cobotwire_table::{Quote, Shown};

/// The value of an argument or of a field of a reply.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// An integer, or a member of an enum.
    Integer(i64),
    /// A real number.
    Real(f64),
    /// A truth value.
    Flag(bool),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// A row of numbers, or a list.
    Row(Vec<Value>),
    /// The number of elements of a list, which the encoder counts.
    Counted,
    /// An argument that is left out, or a field that a reply does not have.
    Absent,
}

type Read<T> = Result<T, Unread<Infallible>>;
const WRONG_TYPE: Unread<Infallible> = Unread::Fault(ValueFault::Type);

impl Given for Value {
    type Error = Infallible;
    type Row = Value;

    fn integer(&self, flag: bool) -> Read<i64> {
        match self {
            Self::Integer(raw) => Ok(*raw),
            Self::Flag(set) if flag => Ok(i64::from(*set)),
            // An array of reals may have integers among them.
            Self::Real(real) if real.fract() == 0.0 => Ok(*real as i64),
            _ => Err(WRONG_TYPE),
        }
    }

    fn real(&self) -> Read<f64> {
        match self {
            Self::Integer(raw) => Ok(*raw as f64),
            Self::Real(real) => Ok(*real),
            _ => Err(WRONG_TYPE),
        }
    }

    fn row(&self) -> Read<Self> {
        match self {
            Self::Row(_) => Ok(self.clone()),
            _ => Err(WRONG_TYPE),
        }
    }

    fn counted(&self) -> bool {
        matches!(self, Self::Counted)
    }

    fn bytes(&self) -> Read<Option<Vec<u8>>> {
        match self {
            Self::Bytes(bytes) => Ok(Some(bytes.clone())),
            _ => Ok(None),
        }
    }

    fn text(&self, encoding: Encoding) -> Read<Vec<u8>> {
        let Self::Text(text) = self else {
            return Err(WRONG_TYPE);
        };
        let encoded = match encoding {
            Encoding::Utf8 => Some(text.clone().into_bytes()),
            Encoding::Ascii => text.is_ascii().then(|| text.clone().into_bytes()),
            Encoding::Latin1 => text.chars().map(|c| u8::try_from(c).ok()).collect(),
        };
        encoded.ok_or(Unread::Fault(ValueFault::Text))
    }
}

impl Row for Value {
    type Item = Value;

    fn count(&self) -> usize {
        match self {
            Self::Row(row) => row.len(),
            _ => 0,
        }
    }

    fn at(&self, index: usize) -> Option<Value> {
        match self {
            Self::Row(row) => row.get(index).cloned(),
            _ => None,
        }
    }

    fn into_value(self) -> Value {
        self
    }
}

impl Quote for Value {
    fn quote(&self) -> Shown {
        match self {
            Self::Integer(raw) => Shown::Integer(*raw),
            Self::Real(real) => Shown::Real(*real),
            Self::Flag(set) => Shown::Flag(*set),
            Self::Text(text) => Shown::Text(text.clone()),
            Self::Bytes(bytes) => Shown::Bytes(bytes.clone()),
            Self::Row(row) => Shown::List(row.iter().map(Quote::quote).collect()),
            Self::Counted | Self::Absent => Shown::Other("None".to_owned()),
        }
    }
}

/// Return the next value of a decoded message; a row takes those that follow it.
pub(crate) fn nested(flat: &mut impl Iterator<Item = Flat>) -> Option<Value> {
    Some(match flat.next()? {
        Flat::Integer(raw) => Value::Integer(raw),
        Flat::Real(real) => Value::Real(real),
        Flat::Row(size) | Flat::Rows(size) => {
            Value::Row((0..size).map(|_| nested(flat)).collect::<Option<_>>()?)
        }
        Flat::Bytes(size) => Value::Bytes(bytes(flat, size)?),
        Flat::Text(size, encoding) => {
            let bytes = bytes(flat, size)?;
            Value::Text(match encoding {
                Encoding::Latin1 => bytes.into_iter().map(char::from).collect(),
                _ => String::from_utf8(bytes).ok()?,
            })
        }
    })
}

fn bytes(flat: &mut impl Iterator<Item = Flat>, size: usize) -> Option<Vec<u8>> {
    let one = |value| match value {
        Flat::Integer(raw) => u8::try_from(raw).ok(),
        _ => None,
    };
    (0..size).map(|_| flat.next().and_then(one)).collect()
}

impl Value {
    /// Return the value with each number changed, in rows too.
    pub(crate) fn map(self, change: fn(f64) -> f64) -> Self {
        match self {
            Self::Real(real) => Self::Real(change(real)),
            Self::Integer(raw) => Self::Real(change(raw as f64)),
            Self::Row(row) => Self::Row(row.into_iter().map(|each| each.map(change)).collect()),
            other => other,
        }
    }
}

/// A type that arguments have.
pub trait IntoValue {
    /// Convert it.
    fn into_value(self) -> Value;
}

/// A type that fields of replies have.
pub trait FromValue: Sized {
    /// Convert a value; `None`: it is of another type.
    fn from_value(value: Value) -> Option<Self>;
}

macro_rules! scalars {
    ($($type:ty: $made:ident, $($pattern:pat => $result:expr),+;)*) => {$(
        impl IntoValue for $type {
            fn into_value(self) -> Value {
                Value::$made(self)
            }
        }
        impl FromValue for $type {
            fn from_value(value: Value) -> Option<Self> {
                match value {
                    $($pattern => Some($result),)+
                    _ => None,
                }
            }
        }
    )*};
}

scalars! {
    i64: Integer, Value::Integer(raw) => raw;
    f64: Real, Value::Real(real) => real, Value::Integer(raw) => raw as f64;
    bool: Flag, Value::Flag(set) => set, Value::Integer(raw) => raw != 0;
    String: Text, Value::Text(text) => text;
    Vec<u8>: Bytes, Value::Bytes(bytes) => bytes;
}

impl IntoValue for Value {
    fn into_value(self) -> Value {
        self
    }
}

impl FromValue for Value {
    fn from_value(value: Value) -> Option<Self> {
        Some(value)
    }
}

impl FromValue for () {
    fn from_value(_: Value) -> Option<Self> {
        Some(())
    }
}

impl<T: IntoValue> IntoValue for Option<T> {
    fn into_value(self) -> Value {
        self.map_or(Value::Absent, IntoValue::into_value)
    }
}

impl<T: FromValue> FromValue for Option<T> {
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Absent => Some(None),
            value => T::from_value(value).map(Some),
        }
    }
}

impl<T: IntoValue> IntoValue for Vec<T> {
    fn into_value(self) -> Value {
        Value::Row(self.into_iter().map(IntoValue::into_value).collect())
    }
}

impl<T: FromValue> FromValue for Vec<T> {
    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Row(row) => row.into_iter().map(T::from_value).collect(),
            _ => None,
        }
    }
}

impl<T: IntoValue, const N: usize> IntoValue for [T; N] {
    fn into_value(self) -> Value {
        Value::Row(self.into_iter().map(IntoValue::into_value).collect())
    }
}

impl<T: FromValue, const N: usize> FromValue for [T; N] {
    fn from_value(value: Value) -> Option<Self> {
        Vec::from_value(value)?.try_into().ok()
    }
}
