//! The types of arguments and replies, and their conversion from and to values.

pub use cobotwire_table::Value;

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
