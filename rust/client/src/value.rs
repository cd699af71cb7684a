//! Values of arguments and replies, and their conversion from and to types of Rust.

use std::convert::Infallible;

use cobotwire_core::{Encoding, Given, Row, Unread, ValueFault};
use cobotwire_table::{Quote, Shown};

/// The value of an argument or of a field of a reply.
#[derive(Clone, Debug, Default, PartialEq)]
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
    #[default]
    Absent,
}

type Read<T> = Result<T, Unread<Infallible>>;
const WRONG_TYPE: Unread<Infallible> = Unread::Fault(ValueFault::Type);
/// Below this number a real holds every integer.
const EXACT: f64 = (1_u64 << 53) as f64;

impl Given for Value {
    type Error = Infallible;
    type Row = Self;

    fn integer(&self, flag: bool) -> Read<i64> {
        match self {
            Self::Integer(raw) => Ok(*raw),
            Self::Flag(set) if flag => Ok(i64::from(*set)),
            // An array of reals may have integers among them.
            Self::Real(real) if real.fract() == 0.0 && real.abs() < EXACT => Ok(*real as i64),
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
        let row = Some(self).filter(|value| matches!(value, Self::Row(_)));
        row.cloned().ok_or(WRONG_TYPE)
    }

    fn counted(&self) -> bool {
        *self == Self::Counted
    }

    fn bytes(&self) -> Read<Option<Vec<u8>>> {
        Ok(Vec::from_value(self.clone()))
    }

    fn text(&self, encoding: Encoding) -> Read<Vec<u8>> {
        let Self::Text(text) = self else {
            return Err(WRONG_TYPE);
        };
        let encoded = match encoding {
            Encoding::Latin1 => text.chars().map(|c| u8::try_from(c).ok()).collect(),
            Encoding::Utf8 => Some(text.as_bytes().into()),
            Encoding::Ascii => text.is_ascii().then(|| text.as_bytes().into()),
        };
        encoded.ok_or(Unread::Fault(ValueFault::Text))
    }
}

impl Row for Value {
    type Item = Self;

    fn count(&self) -> usize {
        match self {
            Self::Row(row) => row.len(),
            _ => 0,
        }
    }

    fn at(&self, index: usize) -> Option<Self> {
        match self {
            Self::Row(row) => row.get(index).cloned(),
            _ => None,
        }
    }

    fn into_value(self) -> Self {
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
            Self::Row(row) => Shown::Tuple(row.iter().map(Quote::quote).collect()),
            Self::Counted | Self::Absent => Shown::Other("None".to_owned()),
        }
    }
}

impl From<Shown> for Value {
    fn from(shown: Shown) -> Self {
        match shown {
            Shown::Flag(set) => Self::Flag(set),
            Shown::Integer(raw) => Self::Integer(raw),
            Shown::Real(real) => Self::Real(real),
            Shown::Text(text) => Self::Text(text),
            Shown::Bytes(bytes) => Self::Bytes(bytes),
            Shown::Tuple(row) => Self::Row(row.into_iter().map(Self::from).collect()),
            Shown::Other(_) => Self::Absent,
        }
    }
}

impl Value {
    /// Return the value with each number changed, in rows too.
    pub fn map(self, change: fn(f64) -> f64) -> Self {
        match self {
            Self::Real(real) => Self::Real(change(real)),
            Self::Integer(raw) => Self::Real(change(raw as f64)),
            Self::Row(row) => Self::Row(row.into_iter().map(|each| each.map(change)).collect()),
            other => other,
        }
    }
}

/// A type that arguments and fields of replies have.
pub trait Typed: Sized {
    /// Convert it.
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
                    #[allow(unreachable_patterns)] // a value takes all
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
        if value == Value::Absent {
            Some(None)
        } else {
            T::from_value(value).map(Some)
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
