//! Writes values as JSON, as Python does.

use super::repr;
use crate::number::{Encoding, Value};

/// Append a value; its elements, if any, are taken from `rest`.
pub(super) fn append(out: &mut Vec<u8>, value: Value, rest: &mut &[Value]) {
    match value {
        Value::Integer(raw) => repr::integer(out, raw),
        Value::Real(real) => repr::real(out, real),
        Value::Row(count) | Value::Rows(count) => {
            out.push(b'[');
            for index in 0..count {
                if index > 0 {
                    out.extend_from_slice(b", ");
                }
                if let Some((value, more)) = rest.split_first() {
                    *rest = more;
                    append(out, *value, rest);
                }
            }
            out.push(b']');
        }
        Value::Text(count, encoding) => {
            let bytes: Vec<u8> = bytes(rest, count).collect();
            if encoding == Encoding::Utf8 {
                repr::text(out, String::from_utf8_lossy(&bytes).chars());
            } else {
                repr::text(out, bytes.into_iter().map(char::from));
            }
        }
        Value::Bytes(count) => {
            out.push(b'"');
            repr::hex(out, bytes(rest, count));
            out.push(b'"');
        }
    }
}

/// Take bytes from the values.
fn bytes<'a>(rest: &mut &'a [Value], count: usize) -> impl Iterator<Item = u8> + use<'a> {
    let (bytes, more) = rest.split_at_checked(count).unwrap_or_default();
    *rest = more;
    bytes.iter().map(|value| match value {
        Value::Integer(raw) => u8::try_from(*raw).unwrap_or_default(),
        _ => 0,
    })
}
