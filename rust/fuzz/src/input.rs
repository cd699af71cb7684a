//! Turns fuzz bytes into a table, a direction, a stream and its chunks.
//! The first four bytes decide everything but the stream, so four bytes and a stream make a seed.

use cobotwire_core::{Framer, Rules};

use crate::bytes::Bytes;
use crate::oracle::Oracle;
use crate::script;
use crate::subjects::{self, LISTENING, Subject};

/// One case for the targets that cut streams.
pub struct Input {
    pub subject: &'static Subject,
    /// Index in [`LISTENING`].
    pub listening: usize,
    pub unknown: bool,
    pub stream: Vec<u8>,
    /// Whether targets that support long streams make one from this stream.
    pub long: bool,
    pub cutting: Cutting,
}

/// Bits of the second byte; its low two bits pick the directions.
const UNKNOWN: u8 = 4;
const SCRIPT: u8 = 8;
const FLUSHES: u8 = 16;
const LONG: u8 = 32;

impl Input {
    pub fn read(data: &[u8]) -> Self {
        let mut bytes = Bytes(data);
        let subject = &subjects::all()[bytes.pick(subjects::all().len())];
        let flags = bytes.byte();
        let cutting = Cutting {
            class: bytes.byte(),
            seed: bytes.byte(),
            flushes: flags & FLUSHES != 0,
        };
        let stream = if flags & SCRIPT == 0 {
            bytes.0.to_vec()
        } else {
            script::play(&subject.table, &subject.variants, bytes)
        };
        Self {
            subject,
            listening: usize::from(flags & 3) % LISTENING.len(),
            unknown: flags & UNKNOWN != 0,
            long: flags & LONG != 0,
            stream,
            cutting,
        }
    }

    /// Return the first bytes of an input; its stream follows them unchanged, and is fed whole.
    pub fn head(subject: usize, listening: usize, unknown: bool) -> [u8; 4] {
        let flags = if unknown { UNKNOWN } else { 0 };
        [subject as u8, listening as u8 | flags, 0, 0]
    }

    pub fn rules(&self) -> &Rules {
        self.subject.rules(self.listening, self.unknown)
    }

    pub fn oracle(&self) -> &Oracle {
        self.subject.oracle(self.listening, self.unknown)
    }

    pub fn framer(&self) -> Framer {
        Framer::new(self.rules().clone())
    }

    /// Return the chunks in which the stream is fed.
    pub fn chunks(&self) -> Vec<Chunk<'_>> {
        self.cutting.cut(&self.stream)
    }
}

/// A part of a stream as it is fed, and whether silence follows it.
#[derive(Clone, Copy, Debug)]
pub struct Chunk<'a> {
    pub bytes: &'a [u8],
    pub flush: bool,
}

/// How a stream is cut.
#[derive(Clone, Copy, Debug)]
pub struct Cutting {
    /// Picks the size of the largest chunk.
    pub class: u8,
    /// Picks the sizes of the chunks.
    pub seed: u8,
    /// Whether silence follows some chunks.
    pub flushes: bool,
}

/// Zero: the whole stream at once.
const LARGEST: [usize; 6] = [0, 1, 3, 17, 64, 1000];
/// Streams of this length are cut into larger chunks, to save time.
const LONG_STREAM: usize = 50_000;
const LARGEST_OF_LONG: [usize; 6] = [0, 7_000, 30_000, 70_000, 100_000, 140_000];

impl Cutting {
    /// Return a stream of at least `size` bytes, made of pieces of this one.
    pub fn grown(self, stream: &[u8], size: usize) -> Vec<u8> {
        let mut dice = Dice(u32::from(self.seed));
        let mut grown = Vec::with_capacity(size + stream.len());
        while grown.len() < size && !stream.is_empty() {
            let cut = match dice.roll(4) {
                0 => dice.roll(stream.len()),
                _ => 0,
            };
            grown.extend(&stream[cut..]);
        }
        grown
    }

    pub fn cut(self, mut stream: &[u8]) -> Vec<Chunk<'_>> {
        let largest = match stream.len() {
            LONG_STREAM.. => LARGEST_OF_LONG,
            _ => LARGEST,
        };
        let largest = largest[usize::from(self.class) % largest.len()];
        let mut dice = Dice(u32::from(self.seed));
        let mut chunks = Vec::new();
        while !stream.is_empty() {
            let size = match largest {
                0 => stream.len(),
                1 => 1,
                // Some chunks are empty.
                _ => dice.roll(largest + 1).min(stream.len()),
            };
            let (bytes, rest) = stream.split_at(size);
            chunks.push(Chunk {
                bytes,
                flush: self.flushes && dice.roll(4) == 0,
            });
            stream = rest;
        }
        chunks
    }
}

struct Dice(u32);

impl Dice {
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) as usize % sides
    }
}
