//! The values of decoded messages by field, and when two are equal.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::facts::Named;
use crate::decode::Decoded;
use crate::number::Value;

/// Values by the name of their field.
pub(super) type Arguments = Vec<(Box<str>, Vec<Value>)>;

/// Return the fields of a message with their values; a row is followed by its elements.
pub(super) fn fields<'a>(
    names: &'a [Named],
    decoded: &'a Decoded,
) -> impl Iterator<Item = (&'a Named, &'a [Value])> {
    let mut rest = decoded.values.as_slice();
    names.iter().map_while(move |named| {
        let (value, after) = rest.split_at_checked(size(rest))?;
        rest = after;
        (!value.is_empty()).then_some((named, value))
    })
}

/// Return how many of these values are the first field.
fn size(values: &[Value]) -> usize {
    match values.first() {
        None => 0,
        Some(Value::Integer(_) | Value::Real(_)) => 1,
        Some(Value::Row(count) | Value::Bytes(count) | Value::Text(count, _)) => 1 + count,
        Some(Value::Rows(count)) => {
            (0..*count).fold(1, |at, _| at + values.get(at..).map_or(0, size))
        }
    }
}

/// Return whether two fields have the same value, as numbers compare: 1 is 1.0.
pub(super) fn same(one: &[Value], other: &[Value]) -> bool {
    one.len() == other.len()
        && one.iter().zip(other).all(|pair| match pair {
            (Value::Integer(whole), Value::Real(real))
            | (Value::Real(real), Value::Integer(whole)) => *real == *whole as f64,
            (one, other) => one == other,
        })
}
