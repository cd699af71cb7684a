//! Bulk reading has the same results as framer and decoder, for every frame and byte.

use std::sync::Arc;

use crate::common::Dice;
use crate::records::Edition;
use cobotwire_core::{
    Cells, ColumnReader, Columns, Direction, Event, Framer, Listening, Numbers, OffsetReader,
    Plans, Spans, Table, Tally, Value, VariantId, decode,
};

/// The results of framer and decoder.
#[derive(Default)]
struct Slow {
    frames: Vec<(u64, Vec<u8>)>,
    noise: Spans,
    tally: Option<Tally>,
}

fn slowly(table: &Table, listening: Listening, stream: &[u8]) -> Slow {
    let mut slow = Slow::default();
    let mut framer = Framer::new(table.rules(listening).clone());
    let mut note = |event: Event<'_>| match event {
        Event::Frame { offset, frame } => slow.frames.push((offset, frame.bytes().to_vec())),
        Event::Noise { offset, data, .. } => {
            let size = data.iter().map(|piece| piece.len() as u64).sum();
            let end = slow.noise.offsets.last().zip(slow.noise.sizes.last());
            if end.is_some_and(|(start, size)| start + size == offset) {
                *slow.noise.sizes.last_mut().unwrap() += size;
            } else {
                slow.noise.offsets.push(offset);
                slow.noise.sizes.push(size);
            }
        }
    };
    framer.feed(stream, &mut note);
    framer.flush(&mut note);
    slow.tally = Some(framer.tally().clone());
    slow
}

/// A frame's variant, its address if it has one, and its physical values.
type Read = (VariantId, Option<u8>, Vec<f64>);

/// Read a frame by the decoder; `None`: no variant allows its values.
fn read(table: &Table, listening: Listening, frame: &[u8]) -> Option<Read> {
    let ways = match listening {
        Listening::To(way) => vec![way],
        Listening::Both => vec![Direction::Request, Direction::Reply],
    };
    let mut found = ways
        .iter()
        .filter_map(|way| decode(table, *way, frame, None).ok());
    let decoded = found.next()?;
    let number = |value: &Value| match value {
        Value::Integer(integer) => Some(*integer as f64),
        Value::Real(real) => Some(*real),
        _ => None,
    };
    Some((
        decoded.variant,
        decoded.address,
        decoded.values.iter().filter_map(number).collect(),
    ))
}

/// Return each row of columns, with the place where it starts.
fn rows(columns: &Columns) -> Vec<(u64, Read)> {
    let mut all = Vec::new();
    for rows in &columns.rows {
        assert!([0, rows.offsets.len()].contains(&rows.addresses.len()));
        for (index, offset) in rows.offsets.iter().enumerate() {
            let cells = |cells: &Cells| {
                let values = floats(cells);
                let each = values.len() / rows.offsets.len();
                values[index * each..(index + 1) * each].to_vec()
            };
            let read = (
                rows.variant,
                rows.addresses.get(index).copied(),
                rows.fields.iter().flat_map(cells).collect(),
            );
            all.push((*offset, read));
        }
    }
    all.sort_by_key(|(offset, ..)| *offset);
    all
}

fn floats(cells: &Cells) -> Vec<f64> {
    fn cast<T: Copy + Into<f64>>(all: &[T]) -> Vec<f64> {
        all.iter().map(|value| (*value).into()).collect()
    }
    match cells {
        Cells::F64(all) => all.clone(),
        Cells::U8(all) => cast(all),
        Cells::I8(all) => cast(all),
        Cells::U16(all) => cast(all),
        Cells::I16(all) => cast(all),
        Cells::U32(all) => cast(all),
        Cells::I32(all) => cast(all),
        Cells::I64(all) => all.iter().map(|value| *value as f64).collect(),
    }
}

pub const LISTENING: [Listening; 3] = [
    Listening::To(Direction::Request),
    Listening::To(Direction::Reply),
    Listening::Both,
];

fn check(table: &Arc<Table>, stream: &[u8], dice: &mut Dice) {
    for listening in LISTENING {
        let slow = slowly(table, listening, stream);
        let offsets: Vec<u64> = slow.frames.iter().map(|(offset, _)| *offset).collect();

        let mut reader = OffsetReader::new(table.rules(listening).clone(), None);
        let (mut frames, mut noise) = (Vec::new(), Spans::default());
        for chunk in dice.chunks(stream) {
            reader.feed(chunk);
            let found = reader.take();
            frames.extend(found.frames);
            noise.offsets.extend(found.noise.offsets);
            noise.sizes.extend(found.noise.sizes);
        }
        reader.flush();
        let found = reader.take();
        frames.extend(found.frames);
        noise.offsets.extend(found.noise.offsets);
        noise.sizes.extend(found.noise.sizes);
        assert_eq!(frames, offsets);
        assert_eq!(noise, slow.noise);
        assert_eq!(Some(reader.tally()), slow.tally.as_ref());

        let plans = Arc::new(Plans::new(table, listening));
        let mut reader = ColumnReader::new(Arc::clone(table), plans, Numbers::Physical, None);
        reader.feed(stream);
        reader.flush();
        let columns = reader.take();
        let mut expected = Vec::new();
        let mut rejected = Vec::new();
        for (offset, frame) in &slow.frames {
            match read(table, listening, frame) {
                Some(read) => expected.push((*offset, read)),
                None => rejected.push(*offset),
            }
        }
        assert_eq!(columns.rejected, rejected);
        assert_eq!(rows(&columns), expected);
        assert_eq!(columns.noise, slow.noise);
        assert_eq!(Some(reader.tally()), slow.tally.as_ref());
    }
}

/// Return a stream of an edition's frames and of bytes that are hard to frame.
pub fn stream(dice: &mut Dice, frames: &[Vec<u8>], size: usize, noise: usize) -> Vec<u8> {
    let mut stream = Vec::new();
    while stream.len() < size {
        if dice.roll(100) < noise {
            match dice.roll(4) {
                0 => stream.extend(dice.stream()),
                1 => stream.resize(stream.len() + dice.roll(600), 0),
                2 => stream.resize(stream.len() + dice.roll(40), 0xFE),
                _ => stream.extend((0..dice.roll(40)).map(|_| dice.byte())),
            }
        }
        let mut frame = frames[dice.roll(frames.len())].clone();
        if dice.roll(100) < noise {
            // The result is often still a frame, with other values, legal or not.
            let index = dice.roll(frame.len());
            frame[index] = dice.byte();
        }
        stream.extend(frame);
    }
    stream
}

#[test]
fn bulk_reading_equals_framer_and_decoder() {
    let mut dice = Dice(4);
    for name in ["mycobot", "mycobot280"] {
        let edition = Edition::generated(name);
        let table = Arc::new(edition.table);
        let frames: Vec<Vec<u8>> = edition
            .vectors
            .iter()
            .filter_map(|vector| vector.frame.clone())
            .collect();
        for (size, noise) in [
            (0, 0),
            (100, 50),
            (3_000, 20),
            (300_000, 0),
            (300_000, 3),
            (200_000, 60),
        ] {
            check(&table, &stream(&mut dice, &frames, size, noise), &mut dice);
        }
        check(&table, &vec![0xFE; 150_000], &mut dice);
        check(&table, &[0xFE, 0xFE, 0x0E, 0x20].repeat(40_000), &mut dice);
        check(&table, &frames[0].repeat(40_000), &mut dice);
    }
}

/// The addresses of several devices, in frames that are read one by one and in groups.
#[test]
fn rows_of_several_devices_have_their_addresses() {
    let edition = Edition::generated("mybuddy");
    let table = Arc::new(edition.table);
    let vectors = edition.vectors.iter();
    let frames: Vec<Vec<u8>> = vectors.filter_map(|vector| vector.frame.clone()).collect();
    let mut dice = Dice(6);
    for (size, noise) in [(100, 50), (100_000, 0), (100_000, 20)] {
        check(&table, &stream(&mut dice, &frames, size, noise), &mut dice);
    }
}

/// Every frame contains frames here, so a guess in the middle of a block can be wrong. Even shifts
/// suffice: one of the second and third lanes starts an even number of bytes after the shift, and the
/// other one an odd number.
#[test]
fn frames_that_hold_frames_do_not_mislead_the_lanes() {
    let edition = Edition::generated("mycobot");
    let inner = [0xFE, 0xFE, 0x03, 0x12, 0x01, 0xFA];
    let outer = [&[0xFE, 0xFE, 0x0E, 0x20][..], &inner, &inner, &[0xFA]].concat();
    let table = Arc::new(edition.table);
    let mut dice = Dice(5);
    for shift in (0..outer.len()).step_by(2) {
        let stream = [vec![0; shift], outer.repeat(8_000)].concat();
        check(&table, &stream, &mut dice);
    }
}

#[test]
fn raw_columns_hold_raw_values_in_small_types() {
    let edition = Edition::generated("mycobot280");
    let table = Arc::new(edition.table);
    let plans = Arc::new(Plans::new(&table, Listening::To(Direction::Reply)));
    let reader = |old| ColumnReader::new(Arc::clone(&table), Arc::clone(&plans), Numbers::Raw, old);
    let frame = [
        0xFE, 0xFE, 0x0E, 0x23, 0, 1, 0xFF, 0xFF, 0x80, 0, 0x7F, 0xFF, 0, 0, 1, 0, 0xFA,
    ];
    let mut first = reader(None);
    first.feed(&frame);
    first.feed(&frame);
    let columns = first.take();
    let rows = columns
        .rows
        .iter()
        .find(|rows| !rows.offsets.is_empty())
        .unwrap();
    let row = [1, -1, -32768, 32767, 0, 256];
    assert_eq!(rows.offsets, [0, 17]);
    assert_eq!(rows.fields, [Cells::I16([row, row].concat())]);

    // The next reader reuses its memory.
    let mut second = reader(Some(columns));
    second.feed(&frame);
    let again = second.take();
    let rows = again
        .rows
        .iter()
        .find(|rows| !rows.offsets.is_empty())
        .unwrap();
    assert_eq!(rows.fields, [Cells::I16(row.to_vec())]);
}
