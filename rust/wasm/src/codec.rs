//! The codec of an edition: encodes messages, decodes frames, and finds frames in a stream.

use cobotwire::Value;
use cobotwire::machine::Handle;
use cobotwire_core::{
    Choice, DecodeError, Decoded, Direction, Event, Framer, Listening, Verdict, decode, encode,
};
use cobotwire_table::Explained;

use crate::client::flat;
use crate::{number, whole};

pub const FUNCTIONS: [&str; 3] = ["encode", "decode", "frames"];

/// Run a function of the codec; `None`: no function has this name and these arguments.
pub fn answer(handle: &Handle, what: &str, given: &[Value]) -> Option<Value> {
    let [Value::Text(word), given @ ..] = given else {
        return None;
    };
    let listening = match &**word {
        "request" => Listening::To(Direction::Request),
        "reply" => Listening::To(Direction::Reply),
        _ => Listening::Both,
    };
    let index = |name: &Value| match name {
        Value::Text(name) => handle.command(name).ok(),
        _ => None,
    };
    match (what, given) {
        ("encode", [command, variant, Value::Row(names), Value::Row(values)]) => {
            let Listening::To(direction) = listening else {
                return None;
            };
            let which = (index(command)?, number(variant));
            encoded(handle, direction, which, (names, values))
        }
        ("decode", [Value::Bytes(frame), of]) => Some(decoded(handle, listening, frame, index(of))),
        ("frames", chunks) => Some(frames(handle, listening, chunks)),
        _ => None,
    }
}

/// Return the frame of the first variant that has these fields and allows their values, or of the
/// chosen variant.
fn encoded(
    handle: &Handle,
    direction: Direction,
    (index, only): (usize, Option<usize>),
    (names, values): (&[Value], &[Value]),
) -> Option<Value> {
    let (table, record) = (
        &handle.edition.protocol.table,
        handle.edition.commands.get(index)?,
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
            let command = table.commands().get(index)?;
            let made = encode::<Value>(table.frame(), command, direction, &row, choice);
            if let Ok(frame) = made {
                return Some(Value::Bytes(frame));
            }
        }
    }
    Some(Value::Absent)
}

/// Return the fields of a frame, its explained bytes, and each command and direction that it can
/// have; the first one belongs to the fields. If the frame is illegal, return the reason, the
/// offset and the text of the error.
fn decoded(handle: &Handle, listening: Listening, frame: &[u8], of: Option<usize>) -> Value {
    let (edition, table) = (&handle.edition, &handle.edition.protocol.table);
    let mut found: Vec<Decoded> = Vec::new();
    if let Verdict::Frame(start) = table.rules(listening).validate(frame) {
        for id in table.rules(listening).variants(start) {
            let command = (id.direction, id.command);
            let same = |each: &Decoded| (each.variant.direction, each.variant.command) == command;
            if of.is_none_or(|of| of == id.command) && !found.iter().any(same) {
                found.extend(decode(table, id.direction, frame, Some(id.command)));
            }
        }
    }
    let Some(first) = found.first() else {
        return rejected(handle, listening, frame, of);
    };
    let part = |part: Explained| {
        let (name, meaning) = (Value::Text(part.name), Value::Text(part.meaning));
        let (at, size) = (whole(part.bytes.start), whole(part.bytes.len()));
        let raw = part.raw.map_or(Value::Absent, Value::Integer);
        Value::Row(vec![at, size, name, meaning, raw])
    };
    let reading = |message: &Decoded| {
        let (index, direction) = (message.variant.command, message.variant.direction);
        let is_event = edition
            .protocol
            .facts
            .get(index)
            .is_some_and(|facts| facts.event);
        let kind = if is_event { "event" } else { direction.word() };
        let name = edition
            .commands
            .get(index)
            .map_or("", |command| &command.name);
        Value::Row([name, kind].map(|text| Value::Text(text.to_owned())).into())
    };
    let parts = edition
        .explain(frame, first)
        .into_iter()
        .map(part)
        .collect();
    let readings = found.iter().map(reading).collect();
    let fields = flat(handle.edition.named(first));
    Value::Row(vec![fields, Value::Row(parts), Value::Row(readings)])
}

/// Return the reason, the offset and the text of what is wrong with a frame. A bad value in one
/// direction explains more than a LEN that does not fit the other.
fn rejected(handle: &Handle, listening: Listening, frame: &[u8], of: Option<usize>) -> Value {
    let (edition, mut found) = (&handle.edition, None);
    for direction in [Direction::Request, Direction::Reply] {
        if listening != Listening::Both && listening != Listening::To(direction) {
            continue;
        }
        let error = decode(&edition.protocol.table, direction, frame, of).err();
        let (reason, offset) = match error {
            Some(DecodeError::Frame { reason, offset }) => (reason.word(), offset),
            Some(DecodeError::Raw(bad)) => ("bad-value", bad.offset),
            None => continue,
        };
        let better =
            |(known, ..): &(&str, usize, String)| *known != "bad-value" && reason == "bad-value";
        if found.as_ref().is_none_or(better) {
            let text = error.map(|error| edition.decode_error(direction, error, frame));
            found = Some((reason, offset, text.unwrap_or_default()));
        }
    }
    let row = found.map(|(reason, offset, text)| {
        let reason = Value::Text(reason.to_owned());
        Value::Row(vec![reason, whole(offset), Value::Text(text)])
    });
    row.unwrap_or_default()
}

/// Return, for each chunk of a stream, the events that it completed. An absent chunk stands for
/// silence.
fn frames(handle: &Handle, listening: Listening, chunks: &[Value]) -> Value {
    let rules = handle.edition.protocol.table.rules(listening);
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
