//! Checks recordings against a plain reader: however the file is cut, each byte belongs to a frame
//! or to noise, with its time.

use std::collections::BTreeMap;
use std::sync::Arc;

use cobotwire_core::{
    CaptureReader, Damage, Decoder, Decoders, Event, Framer, Interface, Listening, Numbers, Tally,
};

use crate::bytes::Bytes;
use crate::capture_script;
use crate::input::Cutting;
use crate::plain_capture::{self, Capture, Packet};
use crate::subjects::{self, LISTENING, Subject};

/// After this time without a byte, in nanoseconds, a direction stops waiting for the rest of a
/// frame.
const IDLE: i128 = 500_000_000;

/// The results for one stream: positions with their times.
#[derive(Debug, Default, PartialEq)]
struct Found {
    /// Position and time of each frame, including rejected ones.
    frames: Vec<(u64, i64)>,
    /// Position, size and time of each span of noise.
    noise: Vec<(u64, u64, i64)>,
    tally: Tally,
}

/// The results for a file: streams by interface and direction.
#[derive(Debug, PartialEq)]
struct All {
    streams: BTreeMap<(usize, usize), Found>,
    interfaces: Vec<Interface>,
    finished: bool,
    truncated_at: Option<u64>,
    damage: Option<Damage>,
}

struct Decoding {
    subject: &'static Subject,
    opened: usize,
}

impl Decoders for Decoding {
    fn decoder(&mut self, _: &Interface, listening: Listening) -> Option<Decoder> {
        self.opened += 1;
        let index = LISTENING.iter().position(|way| *way == listening)?;
        Some(Decoder {
            table: Arc::clone(&self.subject.table),
            plans: Arc::clone(self.subject.plans(index)),
        })
    }
}

/// Read a recording at once, in pieces, and plainly; the results must be the same.
pub fn captures_are_read_like_the_plain_reader_does(data: &[u8]) {
    let mut bytes = Bytes(data);
    let subject = &subjects::all()[bytes.pick(subjects::all().len())];
    let flags = bytes.byte();
    let unknown = usize::from(flags & 3) % LISTENING.len();
    let cutting = Cutting {
        class: bytes.byte(),
        seed: bytes.byte(),
        flushes: false,
    };
    let file = match flags & 4 {
        0 => capture_script::play(subject, bytes),
        _ => bytes.0.to_vec(),
    };
    let expected = plainly(subject, unknown, &file);
    assert_eq!(read(subject, unknown, &[&file]), expected, "at once");
    let chunks = cutting.cut(&file);
    let chunks: Vec<&[u8]> = chunks.iter().map(|chunk| chunk.bytes).collect();
    assert_eq!(read(subject, unknown, &chunks), expected, "in pieces");
}

fn read(subject: &'static Subject, unknown: usize, chunks: &[&[u8]]) -> All {
    let mut reader = CaptureReader::new(LISTENING[unknown], Numbers::Raw);
    let mut decoding = Decoding { subject, opened: 0 };
    let mut streams = BTreeMap::new();
    for (number, chunk) in chunks.iter().enumerate() {
        reader.feed(chunk, &mut decoding);
        // A batch has rows for every variant of the table, so many batches would be slow.
        if number % (1 + chunks.len() / 8) == 0 {
            add(&mut reader, &mut streams);
        }
    }
    reader.finish();
    add(&mut reader, &mut streams);
    assert_eq!(
        decoding.opened,
        streams.len(),
        "one decoder for each stream"
    );
    let size: usize = chunks.iter().map(|chunk| chunk.len()).sum();
    assert!(reader.size() <= size as u64);
    for found in streams.values_mut() {
        found.frames.sort_unstable();
    }
    All {
        streams,
        interfaces: reader.interfaces().to_vec(),
        finished: reader.finished(),
        truncated_at: reader.truncated_at(),
        damage: reader.damage(),
    }
}

fn add(reader: &mut CaptureReader, streams: &mut BTreeMap<(usize, usize), Found>) {
    for batch in reader.take() {
        let found = streams
            .entry((batch.interface, batch.direction as usize))
            .or_default();
        let (columns, times) = (batch.columns, batch.times);
        assert_eq!(columns.rows.len(), times.rows.len());
        let rows = columns.rows.iter().map(|rows| &rows.offsets);
        let lists = rows.chain([&columns.rejected]);
        for (offsets, times) in lists.zip(times.rows.iter().chain([&times.rejected])) {
            assert_eq!(offsets.len(), times.len(), "a time for each frame");
            found
                .frames
                .extend(offsets.iter().copied().zip(times.iter().copied()));
        }
        let spans = columns.noise.offsets.iter().zip(&columns.noise.sizes);
        assert_eq!(spans.len(), times.noise.len(), "a time for each span");
        let spans = spans.zip(&times.noise);
        found
            .noise
            .extend(spans.map(|((offset, size), time)| (*offset, *size, *time)));
        found.tally = batch.tally;
    }
}

fn plainly(subject: &Subject, unknown: usize, file: &[u8]) -> All {
    let capture = plain_capture::read(file);
    let mut streams: BTreeMap<(usize, usize), Stream> = BTreeMap::new();
    for packet in &capture.packets {
        for stream in streams.values_mut() {
            stream.flush_before(packet.first);
        }
        let listening = [unknown, 0, 1][packet.direction];
        let new = || Stream::new(Framer::new(subject.rules(listening, false).clone()));
        let key = (packet.interface, packet.direction);
        streams.entry(key).or_insert_with(new).add(packet);
    }
    let found = streams
        .into_iter()
        .map(|(key, stream)| (key, stream.finish()));
    let streams = found.collect();
    let Capture {
        interfaces,
        statistics,
        truncated_at,
        damage,
        ..
    } = capture;
    All {
        streams,
        interfaces,
        finished: !statistics.is_empty() && statistics.iter().all(|seen| *seen),
        truncated_at,
        damage,
    }
}

/// A stream that is framed packet by packet, with the time of each byte.
struct Stream {
    framer: Framer,
    times: Vec<i64>,
    last: i64,
    waiting: bool,
    /// Whether the last event was noise that more noise may join.
    in_noise: bool,
    found: Found,
}

impl Stream {
    fn new(framer: Framer) -> Self {
        Self {
            framer,
            times: vec![],
            last: 0,
            waiting: false,
            in_noise: false,
            found: Found::default(),
        }
    }

    fn flush_before(&mut self, time: i64) {
        if self.waiting && i128::from(time) >= i128::from(self.last) + IDLE {
            self.feed(&[], true);
            (self.waiting, self.in_noise) = (false, false);
        }
    }

    fn add(&mut self, packet: &Packet) {
        let bytes: Vec<u8> = packet.bytes.iter().map(|(byte, _)| *byte).collect();
        self.times
            .extend(packet.bytes.iter().map(|(_, time)| *time));
        (self.last, self.waiting) = (packet.last, true);
        self.feed(&bytes, false);
    }

    fn feed(&mut self, bytes: &[u8], flush: bool) {
        let Self {
            framer,
            times,
            in_noise,
            found,
            ..
        } = self;
        let take = |event: Event<'_>| match event {
            Event::Frame { offset, .. } => {
                found.frames.push((offset, times[offset as usize]));
                *in_noise = false;
            }
            Event::Noise { offset, data, .. } => {
                let size = data.map(<[u8]>::len).iter().sum::<usize>() as u64;
                match found.noise.last_mut() {
                    Some((_, all, _)) if *in_noise => *all += size,
                    _ => found.noise.push((offset, size, times[offset as usize])),
                }
                *in_noise = true;
            }
        };
        if flush {
            framer.flush(take);
        } else {
            framer.feed(bytes, take);
        }
    }

    fn finish(mut self) -> Found {
        self.feed(&[], true);
        self.found.tally = self.framer.tally().clone();
        self.found
    }
}
