//! Answers the questions of docs/codec-protocol.md with the codec of the core.

use cobotwire_core::{
    Choice, DecodeError, Decoded, Direction, Event, Framer, Listening, decode, encode,
};
use cobotwire_table::{Edition, Field};
use serde_json::{Map, Value, json};

use crate::values::{Sample, from_hex, hex, nested};

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

/// Return the answer to one question, as lines; to what is no question, it is `unsupported`.
pub fn answer(edition: &Edition, line: &str) -> String {
    let question: &Value = &serde_json::from_str(line).unwrap_or_default();
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
    answer.to_string()
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
    let bytes = from_hex(&question["bytes"])?;
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
fn fields(edition: &Edition, decoded: &Decoded) -> Option<Value> {
    let id = decoded.variant;
    let variant = variants(edition, id.command, id.direction)?.get(id.variant)?;
    let names = variant.iter().map(|field| field.name.clone());
    let values = nested(&decoded.values).into_iter().map(plain);
    let fields: Map<String, Value> = names.zip(values).collect();
    let command = &edition.commands.get(id.command)?.name;
    Some(json!({"command": command, "fields": fields}))
}

/// Return a value as the protocol writes it: bytes and special floats are texts.
fn plain(value: Value) -> Value {
    match value {
        Value::Array(parts) => parts.into_iter().map(plain).collect(),
        Value::Object(mut typed) => match (typed.remove("bytes"), typed.remove("real")) {
            (Some(Value::String(bytes)), _) => json!(bytes.to_uppercase()),
            (_, Some(Value::String(word))) => json!(word.to_lowercase()),
            _ => Value::Null,
        },
        other => other,
    }
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
            chunk => framer.feed(&from_hex(chunk)?, sink),
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
