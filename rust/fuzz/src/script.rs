//! Streams from a byte script: legal frames, what resembles them, and what else a line carries.
//!
//! Random bytes hardly ever make a long legal frame, and never a noisy line full of them; a script
//! of a few bytes does, so that the fuzzer reaches what lies behind.

use cobotwire_core::{Command, Direction, Field, Form, FrameFormat, Layout, Number, Order, Table};

use crate::input::Bytes;
use crate::oracle::check_of;

/// A script can repeat what it has made; so far and no further.
const LIMIT: usize = 1024;

const SERVO: &[u8] = b"\xff\xff\x01\x04\x02\x38\x02\xbe";
const TEXT: &[u8] = b"cmd_len error\r\nGuru Meditation Error: Core 1 panic'ed (LoadProhibited)";

/// The stream that a script makes of a table's frames.
pub fn play(table: &Table, forms: &[Form], mut script: Bytes<'_>) -> Vec<u8> {
    let mut stream = Vec::new();
    while !script.is_done() && stream.len() < LIMIT {
        step(table, forms, &mut script, &mut stream);
    }
    stream.truncate(LIMIT);
    stream
}

fn step(table: &Table, forms: &[Form], script: &mut Bytes<'_>, stream: &mut Vec<u8>) {
    let format = table.frame();
    match script.byte() % 16 {
        0..=3 => stream.extend(legal(table, forms, script)),
        4 => stream.extend(any_data(table, forms, script)),
        5 => {
            let mut frame = any_data(table, forms, script);
            let place = script.pick(frame.len());
            if let Some(byte) = frame.get_mut(place) {
                *byte ^= script.byte() | 1;
            }
            stream.extend(frame);
        }
        6 => {
            let frame = any_data(table, forms, script);
            stream.extend(&frame[..script.pick(frame.len())]);
        }
        7 => {
            let claim = [script.byte(), script.byte()];
            stream.extend(head(format, claim[0], claim[1]));
            stream.extend(script.take(usize::from(claim[0] & 7)));
        }
        8 => {
            let frame = any_data(table, forms, &mut Bytes(script.take(2)));
            stream.extend(&frame[..frame.len().min(format.overhead() + 1)]);
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
        // A packet in a packet.
        _ => {
            let inner = tail(stream, 1 + script.pick(32));
            stream.extend(around(table, forms, script, &inner));
        }
    }
}

fn tail(stream: &[u8], size: usize) -> Vec<u8> {
    stream[stream.len().saturating_sub(size)..].to_vec()
}

/// A frame that decodes.
fn legal(table: &Table, forms: &[Form], script: &mut Bytes<'_>) -> Vec<u8> {
    build(table, forms, script, data)
}

/// A frame that is cut out of a stream, whether it decodes or not.
fn any_data(table: &Table, forms: &[Form], script: &mut Bytes<'_>) -> Vec<u8> {
    build(table, forms, script, |layout, script| {
        script.take(layout.size()).to_vec()
    })
}

fn around(table: &Table, forms: &[Form], script: &mut Bytes<'_>, inner: &[u8]) -> Vec<u8> {
    build(table, forms, script, |_, _| inner.to_vec())
}

fn build(
    table: &Table,
    forms: &[Form],
    script: &mut Bytes<'_>,
    fill: impl FnOnce(&Layout, &mut Bytes<'_>) -> Vec<u8>,
) -> Vec<u8> {
    let Some(form) = forms.get(script.pick(forms.len())) else {
        return vec![];
    };
    let command: &Command = &table.commands()[form.command];
    let direction: Direction = form.direction;
    let layout = &command.layouts(direction)[form.layout];
    let mut data = fill(layout, script);
    data.resize(layout.size(), 0);
    finished(table.frame(), command.id, &data)
}

/// A whole frame around those data bytes.
pub fn finished(format: &FrameFormat, id: u8, data: &[u8]) -> Vec<u8> {
    // Tables with longer frames are refused.
    let mut frame = head(format, format.length(data.len()) as u8, id);
    frame.extend(data);
    frame.extend(check_of(format, &frame));
    frame
}

fn head(format: &FrameFormat, length: u8, id: u8) -> Vec<u8> {
    let mut head = format.header.to_vec();
    head.extend(format.addresses.first());
    head.extend([length, id]);
    head
}

/// Data bytes that the layout allows, as far as its table makes sense.
fn data(layout: &Layout, script: &mut Bytes<'_>) -> Vec<u8> {
    let fields = layout.fields();
    let mut wholes: Vec<Vec<i64>> = fields
        .iter()
        .map(|field| of_case(field, 0, script))
        .collect();
    for (index, field) in fields.iter().enumerate() {
        let picked = field.selector.and_then(|at| wholes[at].first().copied());
        let mut cases = field.cases.iter();
        let case = cases.position(|case| picked.is_some_and(|picked| case.when.contains(&picked)));
        wholes[index] = match case {
            Some(case) if case > 0 => of_case(field, case, script),
            _ => continue,
        };
    }
    let mut bytes = Vec::new();
    for (field, wholes) in fields.iter().zip(&wholes) {
        // The cases of a field are equally wide together, yet may be divided otherwise.
        let mut cases = field.cases.iter();
        let case = cases.find(|case| case.numbers.len() == wholes.len());
        let numbers = case.map_or(&[][..], |case| &case.numbers);
        for (number, whole) in numbers.iter().zip(wholes) {
            write(number, *whole, &mut bytes);
        }
    }
    bytes
}

fn of_case(field: &Field, case: usize, script: &mut Bytes<'_>) -> Vec<i64> {
    let numbers = field.cases[case].numbers.iter();
    numbers.map(|number| whole(field, number, script)).collect()
}

fn whole(field: &Field, number: &Number, script: &mut Bytes<'_>) -> i64 {
    if !field.choices.is_empty() {
        return field.choices[script.pick(field.choices.len())];
    }
    let taken = script.take(number.width).iter();
    let offset = taken.fold(0, |word: i64, byte| word << 8 | i64::from(*byte));
    let count = number.maximum - number.minimum + 1;
    number.minimum + offset.checked_rem(count).unwrap_or_default()
}

fn write(number: &Number, whole: i64, bytes: &mut Vec<u8>) {
    let mut word = whole.to_le_bytes()[..number.width].to_vec();
    if number.order == Order::Big {
        word.reverse();
    }
    bytes.extend(word);
}
