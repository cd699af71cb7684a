//! The codec of an edition: frames of messages, messages of frames, frames of a stream.

use cobotwire::Value;
use cobotwire_core::{
    Choice, DecodeError, Direction, Event, Framer, Listening, decode, encode,
};
use cobotwire_table::{Edition, Field};

use crate::{whole};

/// Answer a question; `None`: it is wrong.
pub fn answer(edition: &Edition, what: &str, given: &[Value]) -> Option<Value> {
    let [Value::Text(direction), given @ ..] = given else { return None };
    let direction = match &**direction {
        "request" => Direction::Request,
        "reply" => Direction::Reply,
        "both" if what == "frames" => return frames(edition, Listening::Both, given),
        _ => return None,
    };
    match (what, given) {
        ("encode", [Value::Text(command), Value::Row(names), Value::Row(values)]) => {
            encoded(edition, direction, index(edition, command)?, (names, values))
        }
        ("decode", [Value::Bytes(frame), of]) => {
            let of = match of {
                Value::Text(command) => Some(index(edition, command)?),
                _ => None,
            };
            Some(decoded(edition, direction, frame, of))
        }
        ("frames", given) => frames(edition, Listening::To(direction), given),
        _ => None,
    }
}

/// Return the frame of the first variant that has these fields and allows their values.
fn encoded(
    edition: &Edition,
    direction: Direction,
    index: usize,
    (names, values): (&[Value], &[Value]),
) -> Option<Value> {
    let table = &edition.protocol.table;
    for (at, variant) in variants(edition, index, direction)?.iter().enumerate() {
        let place = |field: &Field| names.iter().position(|name| *name == Value::Text(field.name.clone()));
        let row: Option<Vec<Value>> = variant.iter().map(|field| values.get(place(field)?).cloned()).collect();
        let Some(row) = row.filter(|row| row.len() == names.len()) else { continue };
        // The values choose among variants that differ in sizes.
        let sized = variant.iter().any(|field| field.sizes.is_some());
        let choice = Choice { variant: (!sized).then_some(at), address: None };
        let command = table.commands().get(index)?;
        if let Ok(frame) = encode::<Value>(table.frame(), command, direction, &Value::Row(row), choice) {
            return Some(Value::Bytes(frame));
        }
    }
    Some(Value::Absent)
}

/// Return the command and its fields, or the reason and the offset of what is wrong.
fn decoded(edition: &Edition, direction: Direction, frame: &[u8], of: Option<usize>) -> Value {
    let (what, rest) = match decode(&edition.protocol.table, direction, frame, of) {
        Ok(decoded) => {
            let id = decoded.variant;
            let command = edition.commands.get(id.command).map_or("", |command| &command.name);
            let fields = variants(edition, id.command, direction).and_then(|all| all.get(id.variant));
            let mut values = decoded.values.into_iter();
            let named = fields.into_iter().flatten().filter_map(|field| {
                Some([Value::Text(field.name.clone()), Value::nested(&mut values)?])
            });
            (command, Value::Row(named.flatten().collect()))
        }
        Err(DecodeError::Frame { reason, offset }) => (reason.word(), whole(offset)),
        Err(DecodeError::Raw(bad)) => ("bad-value", whole(bad.offset)),
    };
    Value::Row(vec![Value::Text(what.into()), rest])
}

/// Return the events that each chunk of a stream made certain; an absent chunk is a silence.
fn frames(edition: &Edition, listening: Listening, chunks: &[Value]) -> Option<Value> {
    let mut framer = Framer::new(edition.protocol.table.rules(listening).clone());
    let mut all = Vec::new();
    for chunk in chunks {
        let mut certain = Vec::new();
        let sink = |event: Event<'_>| certain.push(match event {
            Event::Frame { offset, frame } => {
                Value::Row(vec![Value::Bytes(frame.bytes().to_vec()), whole(offset as usize)])
            }
            Event::Noise { offset, reason, data } => Value::Row(vec![
                Value::Bytes(data.concat()),
                whole(offset as usize),
                Value::Text(reason.word().into()),
            ]),
        });
        match chunk {
            Value::Bytes(data) => framer.feed(data, sink),
            _ => framer.flush(sink),
        }
        all.push(Value::Row(certain));
    }
    Some(Value::Row(all))
}

fn index(edition: &Edition, name: &str) -> Option<usize> {
    edition.commands.iter().position(|command| command.name == name)
}

fn variants(edition: &Edition, command: usize, direction: Direction) -> Option<&[Vec<Field>]> {
    let command = edition.commands.get(command)?;
    Some(match direction {
        Direction::Request => &command.request,
        Direction::Reply => &command.reply,
    })
}
