//! The codec of an edition: frames of messages, messages of frames, frames of a stream.

use cobotwire::Value;
use cobotwire::machine::Encoder;
use cobotwire_core::{
    Choice, DecodeError, Decoded, Direction, Event, Framer, Listening, Verdict, decode, encode,
};
use cobotwire_table::Explained;

use crate::client::flat;
use crate::{number, whole};

pub const FUNCTIONS: [&str; 3] = ["encode", "decode", "frames"];

/// Answer a question; `None`: it is wrong.
pub fn answer(encoder: &Encoder, what: &str, given: &[Value]) -> Option<Value> {
    let [Value::Text(word), given @ ..] = given else {
        return None;
    };
    let listening = match &**word {
        "request" => Listening::To(Direction::Request),
        "reply" => Listening::To(Direction::Reply),
        _ => Listening::Both,
    };
    let index = |name: &Value| match name {
        Value::Text(name) => encoder.command(name).ok(),
        _ => None,
    };
    match (what, given) {
        ("encode", [command, variant, Value::Row(names), Value::Row(values)]) => {
            let Listening::To(direction) = listening else {
                return None;
            };
            let which = (index(command)?, number(variant));
            encoded(encoder, direction, which, (names, values))
        }
        ("decode", [Value::Bytes(frame), of]) => {
            Some(decoded(encoder, listening, frame, index(of)))
        }
        ("frames", chunks) => Some(frames(encoder, listening, chunks)),
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

/// Return the command of a frame, its fields, its direction or that it is an event, its title, its
/// bytes explained, and what else it can be; or the reason, the offset and the text of what is wrong.
fn decoded(encoder: &Encoder, listening: Listening, frame: &[u8], of: Option<usize>) -> Value {
    let (edition, table) = (&encoder.edition, &encoder.edition.protocol.table);
    let mut found: Vec<Decoded> = Vec::new();
    if let Verdict::Frame(start) = table.rules(listening).validate(frame) {
        for id in table.rules(listening).variants(start) {
            let message = (id.direction, id.command);
            let is_this =
                |each: &Decoded| (each.variant.direction, each.variant.command) == message;
            if of.is_none_or(|of| of == id.command) && !found.iter().any(is_this) {
                found.extend(decode(table, id.direction, frame, Some(id.command)));
            }
        }
    }
    let text = |text: &str| Value::Text(text.to_owned());
    let kind = |message: &Decoded| {
        let facts = edition.protocol.facts.get(message.variant.command);
        match facts {
            Some(facts) if facts.event => text("event"),
            _ => text(message.variant.direction.word()),
        }
    };
    let command = |message: &Decoded| edition.commands.get(message.variant.command);
    let name = |message: &Decoded| text(command(message).map_or("", |command| &command.name));
    let Some((first, others)) = found.split_first() else {
        return rejected(encoder, listening, frame, of);
    };
    let part = |part: Explained| {
        let raw = part.raw.map_or(Value::Absent, Value::Integer);
        let (at, size) = (whole(part.bytes.start), whole(part.bytes.len()));
        Value::Row(vec![
            at,
            size,
            Value::Text(part.name),
            Value::Text(part.meaning),
            raw,
        ])
    };
    let parts = edition.explain(frame, first).into_iter().map(part);
    let other = |each: &Decoded| Value::Row(vec![name(each), kind(each)]);
    Value::Row(vec![
        name(first),
        flat(encoder.named(first)),
        kind(first),
        text(command(first).map_or("", |command| &command.title)),
        Value::Row(parts.collect()),
        Value::Row(others.iter().map(other).collect()),
    ])
}

/// Return the reason, the offset and the text of what is wrong with a frame. A bad value in one
/// direction explains more than a LEN that does not fit the other.
fn rejected(encoder: &Encoder, listening: Listening, frame: &[u8], of: Option<usize>) -> Value {
    let directions = match listening {
        Listening::To(direction) => vec![direction],
        Listening::Both => vec![Direction::Request, Direction::Reply],
    };
    let table = &encoder.edition.protocol.table;
    let error = |way: Direction| Some((way, decode(table, way, frame, of).err()?));
    let errors: Vec<_> = directions.into_iter().filter_map(error).collect();
    let is_value = |(_, error): &&_| matches!(error, DecodeError::Raw(_));
    let Some((direction, error)) = errors.iter().find(is_value).or(errors.first()) else {
        return Value::Absent;
    };
    let (reason, offset) = match error {
        DecodeError::Frame { reason, offset } => (reason.word(), *offset),
        DecodeError::Raw(bad) => ("bad-value", bad.offset),
    };
    let text = encoder.edition.decode_error(*direction, *error, frame);
    Value::Row(vec![
        Value::Text(reason.to_owned()),
        whole(offset),
        Value::Text(text),
    ])
}

/// Return the events that each chunk of a stream made certain; an absent chunk is a silence.
fn frames(encoder: &Encoder, listening: Listening, chunks: &[Value]) -> Value {
    let rules = encoder.edition.protocol.table.rules(listening);
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
