//! Checks that bulk reading finds the same rows, noise and counts as the oracle finds frame by
//! frame: at once and in batches, with new and with reused memory.

use std::sync::Arc;

use cobotwire_core::{
    ColumnReader, Columns, Listening, Numbers, OffsetReader, Plans, Rules, Spans, Table, Value,
    Workers,
};

use super::rows::{Found, Rows, extend, key, variant_at};
use super::tally::Count;
use crate::input::{Chunk, Cutting, Input};
use crate::oracle::Oracle;
use crate::reading;
use crate::subjects::LISTENING;

/// More bytes than several blocks of bulk reading, so that every path of its code runs.
const SEVERAL_BLOCKS: usize = 150_000;

/// Several threads read a long chunk, cut into about this many pieces.
const PIECES: usize = 5;

/// A batch has rows for every variant of the table, so many batches would be slow.
const MOST_BATCHES: usize = 8;

pub fn columns_hold_the_values_of_their_frames(data: &[u8]) {
    let input = Input::read(data);
    let source = Source {
        table: &input.subject.table,
        plans: input.subject.plans(input.listening),
        listening: LISTENING[input.listening],
        oracle: input.subject.oracle(input.listening, false),
    };
    let any = (input.oracle(), input.rules());
    read(&source, any, &input.stream, input.long, input.cutting);
}

/// Check the columns of a stream, and the offsets that the rules in `any` give.
pub fn read(
    source: &Source<'_>,
    any: (&Oracle, &Rules),
    stream: &[u8],
    long: bool,
    cutting: Cutting,
) {
    let stream = if long {
        cutting.grown(stream, SEVERAL_BLOCKS)
    } else {
        stream.to_vec()
    };
    let mut chunks = cutting.cut(&stream);
    // Readers are flushed once, at the end of a capture.
    chunks.iter_mut().for_each(|chunk| chunk.flush = false);
    offsets_hold(any, &stream, &chunks);
    columns_hold(source, &stream, &chunks);
}

/// Return threads that cut a stream of that size into several pieces.
fn workers(size: usize) -> Workers {
    Workers::new(3).cutting_every(size / PIECES)
}

/// Check the offsets of frames and noise, for any rules.
fn offsets_hold((oracle, rules): (&Oracle, &Rules), stream: &[u8], chunks: &[Chunk<'_>]) {
    let (expected, count) = frames(oracle, stream);
    let mut reader = OffsetReader::new(rules.clone(), None);
    reader.set_workers(workers(stream.len()));
    let (mut found, mut noise) = (Vec::new(), Spans::default());
    for chunk in chunks {
        reader.feed(chunk.bytes);
        let part = reader.take();
        found.extend(part.frames);
        extend(&mut noise, part.noise);
    }
    reader.flush();
    let part = reader.take();
    found.extend(part.frames);
    extend(&mut noise, part.noise);
    let starts: Vec<u64> = expected.iter().map(|(at, _)| *at as u64).collect();
    assert_eq!(found, starts, "the oracle's frames");
    assert_eq!(noise, count.spans, "the oracle's noise");
    count.check(reader.tally());
    assert_eq!(reader.pending(), 0);
}

/// The table, plans and rules by which columns are read.
pub struct Source<'a> {
    pub table: &'a Arc<Table>,
    pub plans: &'a Arc<Plans>,
    pub listening: Listening,
    /// The oracle for the same directions, without unknown ids.
    pub oracle: &'a Oracle,
}

impl Source<'_> {
    fn reader(&self, numbers: Numbers, old: Option<Columns>) -> ColumnReader {
        let (table, plans) = (Arc::clone(self.table), Arc::clone(self.plans));
        ColumnReader::new(table, plans, numbers, old)
    }
}

/// Check the contents of columns.
fn columns_hold(source: &Source<'_>, stream: &[u8], chunks: &[Chunk<'_>]) {
    let (frames, count) = frames(source.oracle, stream);
    let whole = [Chunk {
        bytes: stream,
        flush: false,
    }];
    // Only columns of the same types reuse memory.
    let mut old = None;
    for (numbers, cuts) in [
        (Numbers::Physical, [&whole[..], chunks]),
        (Numbers::Raw, [chunks, &whole[..]]),
    ] {
        let (rows, rejected) = expected(source, &frames, numbers);
        for chunks in cuts {
            let mut reader = source.reader(numbers, old.take());
            reader.set_workers(workers(stream.len()));
            let mut found = Found::default();
            for (index, chunk) in chunks.iter().enumerate() {
                reader.feed(chunk.bytes);
                if index % (1 + chunks.len() / MOST_BATCHES) == 0 {
                    found.add(source.table, reader.take());
                }
            }
            reader.flush();
            let last = reader.take();
            found.add(source.table, last.clone());
            old = Some(last);
            found.rejected.sort_unstable();
            assert_eq!(found.rows, rows, "the oracle's rows as {numbers:?}");
            assert_eq!(found.rejected, rejected, "the oracle's rejections");
            assert_eq!(found.noise, count.spans, "the oracle's noise");
            count.check(reader.tally());
            assert_eq!(reader.pending(), 0);
        }
    }
}

/// Return the oracle's frames and counts.
fn frames<'a>(oracle: &Oracle, stream: &'a [u8]) -> (Vec<(usize, &'a [u8])>, Count) {
    let mut count = Count::default();
    let mut frames = Vec::new();
    let mut at = 0;
    for (size, reason) in oracle.spans(stream, true).0 {
        let bytes = &stream[at..at + size];
        count.add(oracle, bytes, reason);
        if reason.is_none() {
            frames.push((at, bytes));
        }
        at += size;
    }
    (frames, count)
}

/// Return each frame's row in the first variant that allows its values, requests before replies;
/// and the frames that no variant allows.
fn expected(source: &Source<'_>, frames: &[(usize, &[u8])], numbers: Numbers) -> (Rows, Vec<u64>) {
    let mut rows = Rows::default();
    let mut rejected = Vec::new();
    for (at, bytes) in frames {
        let Some(Ok((variant, read))) = reading::received(source.table, source.listening, bytes)
        else {
            rejected.push(*at as u64);
            continue;
        };
        let fields = variant_at(source.table, variant).fields().len();
        let (offsets, addresses, columns) = rows.entry(key(variant)).or_default();
        columns.resize(fields, vec![]);
        offsets.push(*at as u64);
        addresses.extend(source.table.frame().layout.address_at.map(|at| bytes[at]));
        for (field, raw, value) in read {
            columns[field].push(match (numbers, value) {
                (Numbers::Raw, _) => raw,
                (_, Value::Real(real)) => real.to_bits() as i64,
                _ => (raw as f64).to_bits() as i64,
            });
        }
    }
    (rows, rejected)
}
