//! Messages: values as bytes. A value begins with a byte that states its kind.

use cobotwire::Value;

/// Return the next value of a message; `None`: the message is incomplete, or the kind is unknown.
pub fn read(message: &mut &[u8]) -> Option<Value> {
    let [kind] = take(message)?;
    Some(match kind {
        0 => Value::Absent,
        1 => Value::Integer(i64::from_le_bytes(take(message)?)),
        2 => Value::Real(f64::from_le_bytes(take(message)?)),
        3 => Value::Flag(take::<1>(message)? == [1]),
        4 => Value::Text(String::from_utf8(bytes(message)?).ok()?),
        5 => Value::Bytes(bytes(message)?),
        6 => {
            let size = u32::from_le_bytes(take(message)?);
            Value::Row((0..size).map(|_| read(message)).collect::<Option<_>>()?)
        }
        _ => return None,
    })
}

fn take<const N: usize>(message: &mut &[u8]) -> Option<[u8; N]> {
    let (found, rest) = message.split_first_chunk()?;
    *message = rest;
    Some(*found)
}

fn bytes(message: &mut &[u8]) -> Option<Vec<u8>> {
    let size = u32::from_le_bytes(take(message)?) as usize;
    let (found, rest) = message.split_at_checked(size)?;
    *message = rest;
    Some(found.into())
}

/// Append a value to a message.
pub fn write(value: &Value, message: &mut Vec<u8>) {
    let sized = |message: &mut Vec<u8>, kind, size: usize, bytes: &[u8]| {
        message.push(kind);
        message.extend((size as u32).to_le_bytes());
        message.extend(bytes);
    };
    match value {
        Value::Integer(whole) => {
            message.push(1);
            message.extend(whole.to_le_bytes());
        }
        Value::Real(real) => {
            message.push(2);
            message.extend(real.to_le_bytes());
        }
        Value::Flag(set) => message.extend([3, u8::from(*set)]),
        Value::Text(text) => sized(message, 4, text.len(), text.as_bytes()),
        Value::Bytes(bytes) => sized(message, 5, bytes.len(), bytes),
        Value::Row(row) => {
            sized(message, 6, row.len(), &[]);
            row.iter().for_each(|each| write(each, message));
        }
        Value::Absent | Value::Counted => message.push(0),
    }
}
