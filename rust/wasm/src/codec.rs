//! The codec of an edition: frames of messages, messages of frames, frames of a stream.

use cobotwire::Value;
use cobotwire::machine::Encoder;
use cobotwire_core::{Choice, DecodeError, Direction, Event, Framer, Listening, decode, encode};

use crate::client::flat;
use crate::{number, whole};

pub const FUNCTIONS: [&str; 3] = ["encode", "decode", "frames"];

/// Answer a question; `None`: it is wrong.
pub fn answer(encoder: &Encoder, what: &str, given: &[Value]) -> Option<Value> {
    let [Value::Text(word), given @ ..] = given else {
        return None;
    };
    let direction = match &**word {
        "request" => Direction::Request,
        _ => Direction::Reply,
    };
    let index = |name: &Value| match name {
        Value::Text(name) => encoder.command(name).ok(),
        _ => None,
    };
    match (what, given) {
        ("encode", [command, variant, Value::Row(names), Value::Row(values)]) => {
            let which = (index(command)?, number(variant));
            encoded(encoder, direction, which, (names, values))
        }
        ("decode", [Value::Bytes(frame), of]) => {
            Some(decoded(encoder, direction, frame, index(of)))
        }
        ("frames", chunks) => Some(frames(encoder, direction, chunks)),
        _ => None,
    }
}

/// Return the frame of the first variant, or of that one, that has these fields and allows their
/// values.
fn encoded(
    encoder: &Encoder,
    direction: Direction,
    (index, only): (usize, Option<usize>),
    (names, values): (&[Value], &[Value]),
) -> Option<Value> {
    let (table, record) = (
        &encoder.edition.protocol.table,
        encoder.edition.commands.get(index)?,
    );
    let variants = match direction {
        Direction::Request => &record.request,
        Direction::Reply => &record.reply,
    };
    for (at, variant) in variants.iter().enumerate() {
        let value = |name: &str| {
            let mut names = names.iter();
            let at = names.position(|each| matches!(each, Value::Text(each) if each == name))?;
            values.get(at).cloned()
        };
        let row: Option<Vec<_>> = variant.iter().map(|field| value(&field.name)).collect();
        // The values choose among variants that differ in sizes.
        let sized = variant.iter().any(|field| field.sizes.is_some());
        let choice = Choice {
            variant: (!sized).then_some(at),
            address: None,
        };
        let fits = only.is_none_or(|only| only == at);
        if let Some(row) = row.filter(|row| fits && row.len() == names.len()) {
            let (command, row) = (table.commands().get(index)?, Value::Row(row));
            let made = encode::<Value>(table.frame(), command, direction, &row, choice);
            if let Ok(frame) = made {
                return Some(Value::Bytes(frame));
            }
        }
    }
    Some(Value::Absent)
}

/// Return the command and its fields, or the reason and the offset of what is wrong.
fn decoded(encoder: &Encoder, direction: Direction, frame: &[u8], of: Option<usize>) -> Value {
    let edition = &encoder.edition;
    let (what, rest) = match decode(&edition.protocol.table, direction, frame, of) {
        Ok(decoded) => {
            let command = edition.commands.get(decoded.variant.command);
            let name = command.map_or("", |command| &command.name);
            (name, flat(encoder.named(&decoded)))
        }
        Err(DecodeError::Frame { reason, offset }) => (reason.word(), whole(offset)),
        Err(DecodeError::Raw(bad)) => ("bad-value", whole(bad.offset)),
    };
    Value::Row(vec![Value::Text(what.to_owned()), rest])
}

/// Return the events that each chunk of a stream made certain; an absent chunk is a silence.
fn frames(encoder: &Encoder, direction: Direction, chunks: &[Value]) -> Value {
    let rules = encoder
        .edition
        .protocol
        .table
        .rules(Listening::To(direction));
    let mut framer = Framer::new(rules.clone());
    let mut made = |chunk: &Value| {
        let mut certain = Vec::new();
        let sink = |event: Event<'_>| {
            let (bytes, offset, reason) = match event {
                Event::Frame { offset, frame } => (frame.bytes().to_vec(), offset, Value::Absent),
                Event::Noise {
                    offset,
                    reason,
                    data,
                } => (data.concat(), offset, Value::Text(reason.word().to_owned())),
            };
            let offset = Value::Integer(offset as i64);
            certain.push(Value::Row(vec![Value::Bytes(bytes), offset, reason]));
        };
        match chunk {
            Value::Bytes(data) => framer.feed(data, sink),
            _ => framer.flush(sink),
        }
        Value::Row(certain)
    };
    Value::Row(chunks.iter().map(&mut made).collect())
}
