//! Recordings: times, directions and damage. The Python tests and the fuzz target compare more.

use std::sync::Arc;

use crate::records::Edition;
use cobotwire_core::{
    CaptureReader, Damage, Decoder, Decoders, Fault, Interface, Listening, Numbers,
    PacketDirection, Plans, Table,
};

const REPLY: [u8; 17] = [
    0xFE, 0xFE, 14, 0x20, 0, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0xFA,
];

struct One(Arc<Table>);

impl Decoders for One {
    fn decoder(&mut self, _: &Interface, listening: Listening) -> Option<Decoder> {
        let plans = Arc::new(Plans::new(&self.0, listening));
        let table = Arc::clone(&self.0);
        Some(Decoder { table, plans })
    }
}

/// Write a block of words, bytes and more words in one byte order.
fn block(big: bool, kind: u32, words: &[u32], bytes: &[u8], more: &[u32]) -> Vec<u8> {
    let write = |words: &[u32]| -> Vec<u8> {
        let word = |word: &u32| match big {
            true => word.to_be_bytes(),
            false => word.to_le_bytes(),
        };
        words.iter().flat_map(word).collect()
    };
    let padding = vec![0; bytes.len().wrapping_neg() % 4];
    let body = [write(words), bytes.to_vec(), padding, write(more)].concat();
    let size = write(&[body.len() as u32 + 12]);
    [write(&[kind]), size.clone(), body, size].concat()
}

/// Return a recording of two frames in three packets. One byte of noise is before the first frame.
fn recording(big: bool) -> Vec<u8> {
    // Two numbers of 16 bits in a word.
    let halves = |first: u32, second: u32| match big {
        true => first << 16 | second,
        false => second << 16 | first,
    };
    let packet = |time: u32, data: &[u8]| {
        let size = data.len() as u32;
        let received = [halves(2, 4), 1];
        block(big, 6, &[0, 0, time, size, size], data, &received)
    };
    let magic = [0x1A2B_3C4D, halves(1, 0), u32::MAX, u32::MAX];
    [
        block(big, 0x0A0D_0D0A, &magic, &[], &[]),
        block(big, 1, &[halves(147, 0), 0], &[], &[]),
        packet(1, &[&[0][..], &REPLY[..5]].concat()),
        packet(2, &REPLY[5..]),
        packet(3, &REPLY),
    ]
    .concat()
}

fn reader() -> (CaptureReader, One) {
    let reader = CaptureReader::new(Listening::Both, Numbers::Raw);
    (reader, One(Arc::new(Edition::generated("mycobot").table)))
}

#[test]
fn messages_have_the_time_of_their_first_byte_in_either_byte_order() {
    for big in [false, true] {
        let file = recording(big);
        for piece in [1, 7, file.len()] {
            let (mut reader, mut one) = reader();
            for chunk in file.chunks(piece) {
                reader.feed(chunk, &mut one);
            }
            reader.finish();
            assert_eq!(reader.damage(), None);
            let [stream] = &reader.take()[..] else {
                panic!("there is one stream");
            };
            assert_eq!(stream.direction, PacketDirection::Received);
            let rows = stream.columns.rows.iter().zip(&stream.times.rows);
            let mut found = rows.filter(|(rows, _)| !rows.offsets.is_empty());
            let (rows, times) = found.next().expect("there is a message");
            // Times are in microseconds unless the file states something else.
            assert_eq!(rows.offsets, [1, 18]);
            assert_eq!(*times, [1000, 3000]);
            assert_eq!(found.count(), 0);
            assert_eq!(stream.times.noise, [1000]);
        }
    }
}

#[test]
fn damage_is_reported_with_its_offset_and_data_before_it_is_kept() {
    let mut file = recording(false);
    let whole = file.len() as u64;
    file.extend([6, 0, 0, 0, 13, 0, 0, 0]);
    let (mut reader, mut one) = reader();
    reader.feed(&file, &mut one);
    reader.finish();
    let damage = Damage {
        offset: whole,
        fault: Fault::BadLength(13, 12),
    };
    assert_eq!(reader.damage(), Some(damage));
    assert_eq!(reader.truncated_at(), None);
    assert_eq!(reader.take()[0].tally.bytes, 35);
}

#[test]
fn incomplete_block_at_the_end_counts_as_truncation_not_as_damage() {
    let file = recording(true);
    let (mut reader, mut one) = reader();
    reader.feed(&file[..file.len() - 1], &mut one);
    reader.finish();
    assert_eq!(reader.damage(), None);
    // The last packet has 28 bytes before its data, 20 for its data, and 12 after it.
    assert_eq!(reader.truncated_at(), Some(file.len() as u64 - 60));
}
