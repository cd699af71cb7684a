//! Damages the file of an edition.

use serde_json::Value;

use crate::bytes::Bytes;

/// The values that replace others; the long integers are the bounds of 64 bits.
const OTHERS: &str = r#"[null, true, -1, 0, 1, 2, 8, 255, 16384, 1e300, 0.5, "1/0", "", [], {},
    -9223372036854775808, 9223372036854775807, 18446744073709551615, "9223372036854775807/3",
    "text", "bits", "joint", "float", [[]], [0, 1]]"#;

/// Return the file of an edition with at most eight of its commands. Up to three random values in
/// it are replaced by values of the same or of another type.
pub fn changed(document: &Value, bytes: &mut Bytes<'_>) -> Vec<u8> {
    let mut changed = document.clone();
    let commands = changed["commands"].as_array_mut().unwrap();
    let first = bytes.pick(commands.len());
    commands.rotate_left(first);
    commands.truncate(8);
    let others: Vec<Value> = serde_json::from_str(OTHERS).unwrap();
    for _ in 0..bytes.pick(4) {
        *place(&mut changed, bytes) = others[bytes.pick(others.len())].clone();
    }
    changed.to_string().into_bytes()
}

/// Return a random value inside a document.
fn place<'a>(at: &'a mut Value, bytes: &mut Bytes<'_>) -> &'a mut Value {
    let size = match at {
        Value::Array(items) => items.len(),
        Value::Object(members) => members.len(),
        _ => 0,
    };
    if size == 0 || bytes.pick(9) == 0 {
        return at;
    }
    let index = bytes.pick(size);
    match at {
        Value::Array(items) => place(&mut items[index], bytes),
        Value::Object(members) => place(members.values_mut().nth(index).unwrap(), bytes),
        other => other,
    }
}
