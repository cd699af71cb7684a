//! Several threads find in a stream what one thread finds, wherever the stream is cut.

use std::sync::Arc;

use crate::common::{Dice, computed, crc16_modbus, field, frame_format, number, table_of};
use cobotwire_core::{
    Algorithm, Check, ColumnReader, Columns, Command, Direction, FrameFormat, Layout, Listening,
    Number, Numbers, OffsetReader, Offsets, Order, Part, Plans, Table, Tally, Variant, Workers,
};

const LISTENING: [Listening; 3] = [
    Listening::To(Direction::Request),
    Listening::To(Direction::Reply),
    Listening::Both,
];

/// What a reader reports after each chunk and after a flush.
#[derive(Debug, PartialEq)]
struct Report {
    offsets: Vec<(Offsets, usize, Tally)>,
    columns: Vec<(Columns, usize, Tally)>,
}

fn report(
    table: &Arc<Table>,
    plans: &Arc<Plans>,
    listening: Listening,
    chunks: &[&[u8]],
    workers: Workers,
) -> Report {
    let rules = table.rules(listening).clone();
    let mut reader = OffsetReader::new(rules, None);
    reader.set_workers(workers);
    let mut offsets = Vec::new();
    let mut note = |reader: &mut OffsetReader| {
        offsets.push((reader.take(), reader.pending(), reader.tally().clone()));
    };
    for chunk in chunks {
        reader.feed(chunk);
        note(&mut reader);
    }
    reader.flush();
    note(&mut reader);

    let (table, plans) = (Arc::clone(table), Arc::clone(plans));
    let mut reader = ColumnReader::new(table, plans, Numbers::Physical, None);
    reader.set_workers(workers);
    let mut columns = Vec::new();
    let mut note = |reader: &mut ColumnReader| {
        columns.push((reader.take(), reader.pending(), reader.tally().clone()));
    };
    for chunk in chunks {
        reader.feed(chunk);
        note(&mut reader);
    }
    reader.flush();
    note(&mut reader);
    Report { offsets, columns }
}

/// Compare several threads, which cut the stream at these strides, with one thread.
fn check(table: &Arc<Table>, chunks: &[&[u8]], cuts: impl IntoIterator<Item = (usize, usize)>) {
    let cuts: Vec<_> = cuts.into_iter().collect();
    for listening in LISTENING {
        let plans = Arc::new(Plans::new(table, listening));
        let alone = report(table, &plans, listening, chunks, Workers::ONE);
        for (count, stride) in &cuts {
            let workers = Workers::new(*count).cutting_every(*stride);
            let together = report(table, &plans, listening, chunks, workers);
            assert!(alone == together, "{count} threads, cut every {stride}");
        }
    }
}

/// Return a stream of an edition's frames and of bytes that are hard to frame.
fn stream(dice: &mut Dice, frames: &[Vec<u8>], size: usize, noise: usize) -> Vec<u8> {
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

/// The same seven frames in three formats: with a footer, with an address and a sum, and with a
/// CRC.
const FAMILIES: [[&str; 7]; 3] = [
    [
        "FE FE 02 20 FA",
        "FE FE 0E 20 00 64 FF 06 0B B8 F4 48 00 0A FF FF FA",
        "FE FE 0F 21 00 64 FF 06 0B B8 F4 48 00 0A 00 FE 32 FA",
        "FE FE 03 21 01 FA",
        "FE FE 03 22 03 FA",
        "FE FE 04 22 03 01 FA",
        "FE FE 03 22 FA FA",
    ],
    [
        "FE FE 01 02 20 20",
        "FE FE 01 0E 20 00 64 FF 06 0B B8 F4 48 00 0A FF FF 90",
        "FE FE 01 0F 21 00 64 FF 06 0B B8 F4 48 00 0A 00 FE 32 C3",
        "FE FE 01 03 21 01 22",
        "FE FE 01 03 22 03 25",
        "FE FE 01 04 22 03 01 26",
        "FE FE 01 03 22 FA 1C",
    ],
    [
        "FE FE 03 20 14 51",
        "FE FE 0F 20 00 64 FF 06 0B B8 F4 48 00 0A FF FF ED 28",
        "FE FE 10 21 00 64 FF 06 0B B8 F4 48 00 0A 00 FE 32 A2 02",
        "FE FE 04 21 01 6D A4",
        "FE FE 04 22 03 5C 25",
        "FE FE 05 22 03 01 E7 5D",
        "FE FE 04 22 FA 1E E5",
    ],
];

/// Return the table of a family, and its frames.
fn family(index: usize) -> (Arc<Table>, Vec<Vec<u8>>) {
    let addressed = index == 1;
    let format = FrameFormat {
        addresses: if addressed { vec![0, 1, 2] } else { vec![] },
        check: match index {
            0 => Check::Footer(0xFA),
            1 => computed(Algorithm::Sum, 1, 4),
            _ => crc16_modbus(),
        },
        maximum_length: 20,
        layout: Layout::usual(2, addressed),
        ..frame_format()
    };
    let byte = || field(vec![number(1, 1, 0, 255)], false);
    let word = Number {
        signed_at: 0x7FFF,
        ..number(2, 100, -0x8000, 0x7FFF)
    };
    let angles = || field(vec![word.clone(); 6], true);
    let messages = [
        (vec![], vec![vec![angles()]]),
        (vec![angles(), byte()], vec![vec![byte()]]),
        (vec![byte()], vec![vec![byte(), byte()], vec![byte()]]),
    ];
    let command = |(id, (request, reply)): (u16, (Vec<_>, Vec<_>))| Command {
        id,
        request: vec![Variant::new(request)],
        reply: reply.into_iter().map(Variant::new).collect(),
    };
    let commands = (0x20..).zip(messages).map(command).collect();
    let table = Table::new(format, commands).expect("the table is valid");
    let bytes = |text: &str| {
        let bytes = text.split(' ').map(|byte| u8::from_str_radix(byte, 16));
        bytes.collect::<Result<_, _>>().expect("hex digits")
    };
    let frames: Vec<Vec<u8>> = FAMILIES[index].iter().map(|text| bytes(text)).collect();
    let plans = Arc::new(Plans::new(&table, Listening::Both));
    let table = Arc::new(table);
    let found = report(
        &table,
        &plans,
        Listening::Both,
        &[&frames.concat()],
        Workers::ONE,
    );
    assert_eq!(found.offsets[0].0.frames.len(), frames.len());
    (table, frames)
}

#[test]
fn short_stream_cut_at_any_place_has_the_results_of_one_thread() {
    let mut dice = Dice(11);
    for index in 0..FAMILIES.len() {
        let (table, frames) = family(index);
        for noise in [0, 40] {
            let stream = stream(&mut dice, &frames, 1_600, noise);
            // The first cut is at each place of several frames.
            check(&table, &[&stream], (400..440).map(|stride| (3, stride)));
            // About the shortest stream that is cut at all: a guess examines 512 bytes after a cut.
            check(&table, &[&stream[..900]], [(3, 1), (3, 7)]);
        }
    }
}

#[test]
fn long_stream_cut_and_chunked_anywhere_has_the_results_of_one_thread() {
    let mut dice = Dice(12);
    for index in 0..FAMILIES.len() {
        let (table, frames) = family(index);
        for (size, noise) in [(400_000, 0), (300_000, 3), (150_000, 60)] {
            let stream = stream(&mut dice, &frames, size, noise);
            let chunks = dice.chunks(&stream);
            let strides = [1_000 + dice.roll(9_000), 40_000 + dice.roll(60_000)];
            let counts = [2, 5];
            check(&table, &chunks, counts.into_iter().zip(strides));
        }
    }
}

#[test]
fn noise_across_many_cuts_is_one_span() {
    let (table, frames) = family(0);
    for byte in [0x00, 0xFE] {
        let noise = vec![byte; 300_000];
        let stream = [&frames[0][..], &noise, &frames[0], &noise[..9_000]].concat();
        check(&table, &[&stream], [(2, 131_000), (4, 700)]);
        check(&table, &[&noise], [(2, 131_000), (4, 700)]);
    }
    check(&table, &[], [(2, 10)]);
    check(&table, &[&[], &[0xFE], &[]], [(2, 1)]);
}

/// The scan from a guessed offset finds other frames than the scan of the stream, and never agrees
/// with it: each frame contains the start of another one, which ends in the next frame.
#[test]
fn guess_that_never_agrees_with_the_scan_does_not_change_the_result() {
    let (table, _) = family(0);
    let mut frame = [0; 17];
    frame[..4].copy_from_slice(&[0xFE, 0xFE, 0x0E, 0x20]);
    frame[7] = 0xFA;
    frame[8..12].copy_from_slice(&[0xFE, 0xFE, 0x0E, 0x20]);
    frame[16] = 0xFA;
    let stream = frame.repeat(16_000);
    for shift in [0, 3, 8, 9, 16] {
        // Without the first header, the scan of the stream finds the other frames.
        check(&table, &[&stream[shift..]], [(2, 100_003)]);
    }
    let short = &stream[..750];
    check(&table, &[short], (1..40).map(|stride| (3, stride)));
}

/// Ids of two bytes are counted in another map than ids of one byte.
#[test]
fn wide_ids_are_counted_once() {
    let format = FrameFormat {
        layout: Layout {
            id: Part {
                at: 3,
                wide: true,
                order: Order::Big,
            },
            data_at: 5,
            ..Layout::usual(2, false)
        },
        ..frame_format()
    };
    let byte = vec![field(vec![number(1, 1, 0, 255)], false)];
    let table = Arc::new(table_of(format, vec![byte; 0x200]));
    let frame = |id: u16| {
        let [high, low] = id.to_be_bytes();
        [0xFE, 0xFE, 0x04, high, low, 0x07, 0xFA]
    };
    let stream: Vec<u8> = (0x20..0x220).cycle().take(20_000).flat_map(frame).collect();
    check(&table, &[&stream], [(2, 700), (3, 50_000)]);
}

/// Little input is read by one thread, even if more are requested.
#[test]
fn more_threads_than_pieces_are_not_started() {
    let (table, frames) = family(0);
    let stream = &frames.concat().repeat(40)[..2_000];
    let plans = Arc::new(Plans::new(&table, LISTENING[2]));
    let read = |workers| report(&table, &plans, LISTENING[2], &[stream], workers);
    assert_eq!(read(Workers::new(usize::MAX)), read(Workers::ONE));
    assert_eq!(read(Workers::new(0)), read(Workers::ONE));
    let many = Workers::new(usize::MAX).cutting_every(0);
    assert_eq!(read(many), read(Workers::ONE));
}
