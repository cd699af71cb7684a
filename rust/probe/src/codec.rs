//! Answers the questions of docs/codec-protocol.md with the codec of the core.

use cobotwire_core::{
    Choice, DecodeError, Decoded, Direction, Encoding, Event, Framer, Listening,
    Value as CoreValue, decode, encode,
};
use cobotwire_table::{Edition, Field};
use serde_json::{Map, Value, json};

use crate::values::Sample;

const ABILITIES: [&str; 9] = [
    "encode request",
    "encode reply",
    "decode request",
    "decode reply",
    "stream request",
    "stream reply",
    "stream both",
    "noise",
    "reasons",
];

/// Return the answer to one question; a question that is not one has an `unsupported` answer.
pub fn answer(edition: &Edition, question: &Value) -> Value {
    let found = match question["do"].as_str() {
        Some("hello") => Some(json!({
            "protocol": 1,
            "name": "cobotwire in Rust",
            "edition": edition.name,
            "can": ABILITIES,
        })),
        Some("encode") => encoded(edition, question),
        Some("decode") => decoded(edition, question),
        Some("stream") => streamed(edition, question),
        _ => None,
    };
    let mut answer = found.unwrap_or_else(|| json!({"unsupported": "this is not a question"}));
    answer["id"] = question["id"].clone();
    answer
}

fn encoded(edition: &Edition, question: &Value) -> Option<Value> {
    let direction = direction(&question["direction"])?;
    let index = index(edition, &question["command"])?;
    let table = &edition.protocol.table;
    let command = table.commands().get(index)?;
    let fields = question["fields"].as_object()?;
    for (index, variant) in variants(edition, index, direction)?.iter().enumerate() {
        let names_it = |field: &Field| fields.contains_key(&field.name);
        if variant.len() != fields.len() || !variant.iter().all(names_it) {
            continue;
        }
        // The values choose among variants that differ in sizes.
        let sized = variant.iter().any(|field| field.sizes.is_some());
        let choice = Choice {
            variant: (!sized).then_some(index),
            address: None,
        };
        let values = variant
            .iter()
            .map(|field| value_of(field, &fields[&field.name]));
        let row = Sample(Value::Array(values.collect()));
        if let Ok(frame) = encode::<Sample>(table.frame(), command, direction, &row, choice) {
            return Some(json!({"bytes": hex(&frame)}));
        }
        if sized {
            break;
        }
    }
    Some(json!({"error": "bad-value"}))
}

/// Return a value of the question as the core's encoder takes it.
fn value_of(field: &Field, given: &Value) -> Value {
    match (field.kind, given) {
        // Here null would leave the number to the encoder.
        (_, Value::Null) => json!({}),
        ("flag", Value::Array(parts)) => parts.iter().map(|part| value_of(field, part)).collect(),
        ("flag", number) if number == 0 || number == 1 => json!(number == 1),
        ("bytes", Value::String(digits)) => json!({ "bytes": digits }),
        ("bytes" | "text", _) => given.clone(),
        (_, Value::Array(parts)) => parts.iter().map(|part| value_of(field, part)).collect(),
        (_, Value::String(word)) => json!({ "real": word }),
        _ => given.clone(),
    }
}

fn decoded(edition: &Edition, question: &Value) -> Option<Value> {
    let direction = direction(&question["direction"])?;
    let bytes = bytes(&question["bytes"])?;
    let of = match &question["command"] {
        Value::Null => None,
        name => Some(index(edition, name)?),
    };
    match decode(&edition.protocol.table, direction, &bytes, of) {
        Ok(decoded) => fields(edition, &decoded),
        Err(DecodeError::Frame { reason, offset }) => {
            Some(json!({"error": reason.word(), "offset": offset}))
        }
        Err(DecodeError::Raw(bad)) => Some(json!({"error": "bad-value", "offset": bad.offset})),
    }
}

/// Return the command and the fields of a message.
pub fn fields(edition: &Edition, decoded: &Decoded) -> Option<Value> {
    let id = decoded.variant;
    let variant = variants(edition, id.command, id.direction)?.get(id.variant)?;
    let mut values = decoded.values.iter();
    let fields = variant
        .iter()
        .map(|field| Some((field.name.clone(), plain(&mut values)?)));
    let fields: Map<String, Value> = fields.collect::<Option<_>>()?;
    let command = &edition.commands.get(id.command)?.name;
    Some(json!({"command": command, "fields": fields}))
}

/// Return the next value as JSON.
fn plain<'a>(values: &mut impl Iterator<Item = &'a CoreValue>) -> Option<Value> {
    Some(match values.next()? {
        CoreValue::Integer(integer) => json!(integer),
        CoreValue::Real(real) if real.is_finite() => json!(real),
        CoreValue::Real(real) => json!(real.to_string().to_lowercase()),
        CoreValue::Row(count) | CoreValue::Rows(count) => {
            let row: Option<Vec<Value>> = (0..*count).map(|_| plain(values)).collect();
            Value::Array(row?)
        }
        CoreValue::Bytes(count) => json!(hex(&raw(values, *count))),
        CoreValue::Text(count, encoding) => {
            let raw = raw(values, *count);
            json!(match encoding {
                Encoding::Latin1 => raw.iter().map(|byte| char::from(*byte)).collect(),
                _ => String::from_utf8(raw).ok()?,
            })
        }
    })
}

fn raw<'a>(values: &mut impl Iterator<Item = &'a CoreValue>, count: usize) -> Vec<u8> {
    let byte = |value: &CoreValue| match value {
        CoreValue::Integer(byte) => u8::try_from(*byte).unwrap_or_default(),
        _ => 0,
    };
    values.take(count).map(byte).collect()
}

fn streamed(edition: &Edition, question: &Value) -> Option<Value> {
    let listening = match question["direction"].as_str()? {
        "both" => Listening::Both,
        _ => Listening::To(direction(&question["direction"])?),
    };
    let mut framer = Framer::new(edition.protocol.table.rules(listening).clone());
    let mut events = Vec::new();
    for chunk in question["chunks"].as_array()? {
        let mut certain = Vec::new();
        let sink = |found: Event<'_>| certain.push(event(found));
        match chunk {
            Value::Null => framer.flush(sink),
            chunk => framer.feed(&bytes(chunk)?, sink),
        }
        events.push(Value::Array(certain));
    }
    Some(json!({ "events": events }))
}

fn event(event: Event<'_>) -> Value {
    match event {
        Event::Frame { offset, frame } => json!({"frame": hex(frame.bytes()), "offset": offset}),
        Event::Noise {
            offset,
            reason,
            data,
        } => {
            json!({"noise": hex(&data.concat()), "offset": offset, "reason": reason.word()})
        }
    }
}

fn variants(edition: &Edition, command: usize, direction: Direction) -> Option<&[Vec<Field>]> {
    let command = edition.commands.get(command)?;
    Some(match direction {
        Direction::Request => &command.request,
        Direction::Reply => &command.reply,
    })
}

fn index(edition: &Edition, name: &Value) -> Option<usize> {
    let mut names = edition.commands.iter();
    names.position(|command| *name == *command.name)
}

fn direction(word: &Value) -> Option<Direction> {
    match word.as_str()? {
        "request" => Some(Direction::Request),
        "reply" => Some(Direction::Reply),
        _ => None,
    }
}

/// Return bytes as hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}

/// Return the bytes of hexadecimal digits.
pub fn bytes(digits: &Value) -> Option<Vec<u8>> {
    let digits: Vec<char> = digits
        .as_str()?
        .chars()
        .filter(|digit| *digit != ' ')
        .collect();
    let pair = |pair: &[char]| match pair {
        [high, low] => u8::try_from(high.to_digit(16)? << 4 | low.to_digit(16)?).ok(),
        _ => None,
    };
    digits.chunks(2).map(pair).collect()
}
