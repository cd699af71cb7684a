//! Values as JSON, in both directions.

use cobotwire::Value;
use cobotwire_table::Edition;
use serde_json::{Value as Json, json};

/// Return a value of a caller: a number, a truth value, a text, `{"bytes": "FE"}`,
/// `{"real": "inf"}`, a row, null, or any other object for a number that the encoder counts.
pub fn value_of(json: &Json) -> Value {
    match json {
        Json::Null => Value::Absent,
        Json::Bool(set) => Value::Flag(*set),
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(row) => Value::Row(row.iter().map(value_of).collect()),
        Json::Number(number) => number
            .as_i64()
            .map_or_else(|| Value::Real(number.as_f64().unwrap()), Value::Integer),
        Json::Object(special) => match (special.get("bytes"), special.get("real")) {
            (Some(digits), _) => Value::Bytes(from_hex(digits)),
            (_, Some(real)) => Value::Real(real.as_str().unwrap().parse().unwrap()),
            _ => Value::Counted,
        },
    }
}

/// Return the values of a message.
pub fn row_of(json: &Json) -> Vec<Value> {
    let row = json.as_array().into_iter().flatten();
    row.map(value_of).collect()
}

/// Return a value of a reply.
pub fn shown(value: &Value) -> Json {
    match value {
        Value::Integer(raw) => json!(raw),
        Value::Real(real) => json!(real),
        Value::Flag(set) => json!(set),
        Value::Text(text) => json!(text),
        Value::Row(row) => row.iter().map(shown).collect(),
        _ => Json::Null,
    }
}

/// Return the index of a command.
pub fn index(edition: &Edition, name: &Json) -> usize {
    let mut commands = edition.commands.iter();
    commands.position(|command| *name == *command.name).unwrap()
}

/// Return bytes as hexadecimal digits.
pub fn hex(data: &[u8]) -> String {
    data.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Return the bytes of hexadecimal digits.
pub fn from_hex(digits: &Json) -> Vec<u8> {
    let digits = digits.as_str().unwrap().as_bytes().chunks(2);
    let bytes = digits.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16));
    bytes.collect::<Result<_, _>>().unwrap()
}
