//! Makes streams from a byte script: legal frames, damaged frames, and other bytes that occur on a
//! transport.
//!
//! Random bytes rarely form a long legal frame, and never a noisy stream full of frames. A script
//! of a few bytes produces both, so the fuzzer reaches the code that handles them.

use cobotwire_core::{
    Command, Direction, Field, FrameFormat, Number, Order, Part, Table, Variant, VariantId,
};

use crate::bytes::Bytes;
use crate::oracle::{check_of, length_of};

/// The largest stream, in bytes: a script can repeat its own output.
const LIMIT: usize = 1024;

const SERVO: &[u8] = b"\xff\xff\x01\x04\x02\x38\x02\xbe";
const TEXT: &[u8] = b"cmd_len error\r\nGuru Meditation Error: Core 1 panic'ed (LoadProhibited)";

/// Return the stream that a script makes from a table's frames.
pub fn play(table: &Table, variants: &[VariantId], mut script: Bytes<'_>) -> Vec<u8> {
    let mut stream = Vec::new();
    while !script.is_done() && stream.len() < LIMIT {
        step(table, variants, &mut script, &mut stream);
    }
    stream.truncate(LIMIT);
    stream
}

fn step(table: &Table, variants: &[VariantId], script: &mut Bytes<'_>, stream: &mut Vec<u8>) {
    let format = table.frame();
    match script.byte() % 16 {
        0..=3 => stream.extend(legal(table, variants, script)),
        4 => stream.extend(any_data(table, variants, script)),
        5 => {
            let mut frame = any_data(table, variants, script);
            let place = script.pick(frame.len());
            if let Some(byte) = frame.get_mut(place) {
                *byte ^= script.byte() | 1;
            }
            stream.extend(frame);
        }
        6 => {
            let frame = any_data(table, variants, script);
            stream.extend(&frame[..script.pick(frame.len())]);
        }
        7 => {
            let claim = [script.byte(), script.byte()];
            let [length, id] = claim.map(u16::from);
            stream.extend(head(format, length, Some(id)));
            stream.extend(script.take(usize::from(claim[0] & 7)));
        }
        8 => {
            let frame = any_data(table, variants, &mut Bytes(script.take(2)));
            stream.extend(&frame[..frame.len().min(format.layout.data_at)]);
        }
        9 => stream.extend(vec![format.header[0]; 1 + script.pick(40)]),
        10 => stream.extend(&SERVO[..=script.pick(SERVO.len())]),
        11 => {
            let size = script.pick(32);
            stream.extend(script.take(size));
        }
        12 => stream.extend(&TEXT[..script.pick(TEXT.len())]),
        13 => stream.truncate(stream.len().saturating_sub(script.pick(8))),
        14 => {
            let tail = tail(stream, 1 + script.pick(64));
            stream.extend(tail.repeat(script.pick(64)));
        }
        // A frame inside a frame.
        _ => {
            let inner = tail(stream, 1 + script.pick(32));
            stream.extend(around(table, variants, script, &inner));
        }
    }
}

fn tail(stream: &[u8], size: usize) -> Vec<u8> {
    stream[stream.len().saturating_sub(size)..].to_vec()
}

/// Return a frame with legal values.
fn legal(table: &Table, variants: &[VariantId], script: &mut Bytes<'_>) -> Vec<u8> {
    build(table, variants, script, data)
}

/// Return a frame that a framer finds, whether or not its values are legal.
fn any_data(table: &Table, variants: &[VariantId], script: &mut Bytes<'_>) -> Vec<u8> {
    build(table, variants, script, |variant, script| {
        script.take(variant.size()).to_vec()
    })
}

/// Return a legal frame of each variant; each takes its values from other bytes.
pub fn every(table: &Table, variants: &[VariantId]) -> Vec<Vec<u8>> {
    let numbered = variants.iter().zip(0_usize..);
    let made = numbered.map(|(variant, number)| {
        let script: Vec<u8> = (0..256).map(|at| (at * number) as u8).collect();
        legal(table, &[*variant], &mut Bytes(&script))
    });
    made.collect()
}

fn around(table: &Table, variants: &[VariantId], script: &mut Bytes<'_>, inner: &[u8]) -> Vec<u8> {
    build(table, variants, script, |_, _| inner.to_vec())
}

fn build(
    table: &Table,
    variants: &[VariantId],
    script: &mut Bytes<'_>,
    fill: impl FnOnce(&Variant, &mut Bytes<'_>) -> Vec<u8>,
) -> Vec<u8> {
    let Some(variant) = variants.get(script.pick(variants.len())) else {
        return vec![];
    };
    let command: &Command = &table.commands()[variant.command];
    let direction: Direction = variant.direction;
    let variant = &command.variants(direction)[variant.variant];
    let mut data = fill(variant, script);
    data.resize(variant.size(), 0);
    finished(table.frame(), command.id, direction, &data)
}

/// Return a whole frame around data bytes.
pub fn finished(format: &FrameFormat, id: u16, direction: Direction, data: &[u8]) -> Vec<u8> {
    // Tables with longer frames are rejected.
    let length = length_of(format, direction, data.len()) as u16;
    let mut frame = head(format, length, format.has_id(direction).then_some(id));
    frame.extend(data);
    frame.extend(check_of(format, &frame));
    frame
}

fn head(format: &FrameFormat, length: u16, id: Option<u16>) -> Vec<u8> {
    let mut head = format.header.clone();
    head.resize(format.layout.data_at, 0);
    if let (Some(at), Some(address)) = (format.layout.address_at, format.addresses.first()) {
        head[at] = *address;
    }
    put(&mut head, format.layout.length, length);
    match id {
        Some(id) => put(&mut head, format.layout.id, id),
        None => head.truncate(format.layout.id.at),
    }
    head
}

fn put(head: &mut [u8], part: Part, number: u16) {
    let [low, high] = number.to_le_bytes();
    match (part.wide, part.order) {
        (false, _) => head[part.at] = low,
        (true, Order::Little) => head[part.at..part.end()].copy_from_slice(&[low, high]),
        (true, Order::Big) => head[part.at..part.end()].copy_from_slice(&[high, low]),
    }
}

/// Return data bytes that the variant allows, if its table is consistent.
fn data(variant: &Variant, script: &mut Bytes<'_>) -> Vec<u8> {
    let fields = variant.fields();
    let mut raw_values: Vec<Vec<i64>> = fields
        .iter()
        .map(|field| of_case(field, 0, script))
        .collect();
    for (index, field) in fields.iter().enumerate() {
        let picked = field
            .selector
            .and_then(|at| raw_values[at].first().copied());
        let mut cases = field.cases.iter();
        let case = cases.position(|case| picked.is_some_and(|picked| case.when.contains(&picked)));
        raw_values[index] = match case {
            Some(case) if case > 0 => of_case(field, case, script),
            _ => continue,
        };
    }
    let mut bytes = Vec::new();
    for (field, raw_values) in fields.iter().zip(&raw_values) {
        // The cases of a field have the same size, but may divide it into different numbers.
        let mut cases = field.cases.iter();
        let case = cases.find(|case| case.numbers.len() == raw_values.len());
        let numbers = case.map_or(&[][..], |case| &case.numbers);
        for (number, raw) in numbers.iter().zip(raw_values) {
            write(number, *raw, &mut bytes);
        }
    }
    bytes
}

fn of_case(field: &Field, case: usize, script: &mut Bytes<'_>) -> Vec<i64> {
    let numbers = field.cases[case].numbers.iter();
    numbers.map(|number| raw(field, number, script)).collect()
}

fn raw(field: &Field, number: &Number, script: &mut Bytes<'_>) -> i64 {
    for choices in [&field.choices, &number.choices] {
        if !choices.is_empty() {
            return choices[script.pick(choices.len())];
        }
    }
    let taken = script.take(number.width).iter();
    let offset = taken.fold(0, |word: i64, byte| word << 8 | i64::from(*byte));
    let count = number.maximum - number.minimum + 1;
    number.minimum + offset.checked_rem(count).unwrap_or_default()
}

fn write(number: &Number, raw: i64, bytes: &mut Vec<u8>) {
    let mut word = raw.to_le_bytes()[..number.width].to_vec();
    if number.order == Order::Big {
        word.reverse();
    }
    bytes.extend(word);
}
