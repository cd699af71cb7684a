//! Finds only the positions of the frames of a stream.

use super::block::{Block, Found, LANES};
use super::cells::{Advise, reserve};
use super::sample::expected;
use super::search::Collect;
use super::spans::Spans;
use super::speculative::{Share, Workers};
use super::stream::Stream;
use crate::rules::Rules;
use crate::tally::Tally;

/// The frames of a segment of a stream.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Offsets {
    /// Where each frame starts.
    pub frames: Vec<u64>,
    /// The noise between them.
    pub noise: Spans,
}

/// Finds the frames of a stream.
#[derive(Clone)]
pub struct OffsetReader {
    stream: Stream,
    workers: Workers,
    collected: Collected,
}

#[derive(Clone)]
struct Collected {
    frames: Vec<u64>,
}

impl OffsetReader {
    /// Return a reader for a new stream; it reuses the memory of `old` offsets.
    #[must_use]
    pub fn new(rules: Rules, old: Option<Offsets>) -> Self {
        let Offsets { mut frames, noise } = old.unwrap_or_default();
        frames.clear();
        Self {
            stream: Stream::new(rules).reusing(noise),
            workers: Workers::ONE,
            collected: Collected { frames },
        }
    }

    /// Read large chunks with several threads; the results stay the same.
    pub fn set_workers(&mut self, workers: Workers) {
        self.workers = workers;
    }

    /// Return the number of threads that read large chunks.
    #[must_use]
    pub fn workers(&self) -> Workers {
        self.workers
    }

    /// Reserve memory for the frames of `data`; their number is estimated from samples of it.
    pub fn expect(&mut self, data: &[u8], advise: Advise) {
        let rules = self.stream.rules();
        let counts = expected(rules, rules.legal().groups().len(), data);
        reserve(&mut self.collected.frames, counts.iter().sum(), advise);
    }

    /// Feed bytes; [`OffsetReader::take`] returns the frames that more bytes cannot change.
    pub fn feed(&mut self, chunk: &[u8]) {
        self.stream
            .feed_with(self.workers, chunk, &mut self.collected);
    }

    /// Reject the pending candidate.
    pub fn flush(&mut self) {
        self.stream.flush(&mut self.collected);
    }

    /// Return everything found since the last call.
    pub fn take(&mut self) -> Offsets {
        Offsets {
            frames: std::mem::take(&mut self.collected.frames),
            noise: self.stream.take_noise(),
        }
    }

    /// Return the counts since the start of the stream.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        self.stream.tally()
    }

    /// Return the number of bytes that may still become part of a frame.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.stream.pending()
    }
}

impl Collect for Collected {
    #[inline]
    fn take(&mut self, offset: u64, _: &Block, found: [&[Found]; LANES]) {
        for lane in found {
            let places = lane.iter().map(|frame| offset + u64::from(frame.at()));
            self.frames.extend(places);
        }
    }
}

impl Share for Collected {
    fn part(&self) -> Self {
        Self { frames: Vec::new() }
    }

    fn append(&mut self, part: &mut Self) {
        self.frames.append(&mut part.frames);
    }

    fn clear(&mut self) {
        self.frames.clear();
    }
}
