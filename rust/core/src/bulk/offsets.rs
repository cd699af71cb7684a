//! Finds only the positions of the frames of a stream.

use super::block::{Block, Found, LANES};
use super::cells::{Advise, reserve};
use super::sample::expected;
use super::spans::Spans;
use super::stream::{Collect, Stream};
use crate::frame::Part;
use crate::judge::Rules;
use crate::tally::Tally;

/// The frames of a stretch of a stream.
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
    collected: Collected,
}

#[derive(Clone)]
struct Collected {
    frames: Vec<u64>,
    counts: Counts,
    /// The id in a frame.
    id: Part,
}

impl OffsetReader {
    /// Return a reader for a new stream; it reuses the memory of `old` offsets.
    #[must_use]
    pub fn new(rules: Rules, old: Option<Offsets>) -> Self {
        let id = rules.frame().layout.id;
        let mut frames = old.map(|old| old.frames).unwrap_or_default();
        frames.clear();
        Self {
            stream: Stream::new(rules),
            collected: Collected {
                frames,
                counts: Counts::default(),
                id,
            },
        }
    }

    /// Reserve memory for the frames of `data`, estimated from parts of it.
    pub fn expect(&mut self, data: &[u8], advise: Advise) {
        let rules = self.stream.rules();
        let counts = expected(rules, rules.legal().groups().len(), data);
        reserve(&mut self.collected.frames, counts.iter().sum(), advise);
    }

    /// Feed bytes; [`OffsetReader::take`] returns the frames that are certain.
    pub fn feed(&mut self, chunk: &[u8]) {
        self.stream.feed(chunk, &mut self.collected);
    }

    /// Refute the candidate that waits.
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

    /// Return the number of bytes fed that are not accounted for yet.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.stream.pending()
    }
}

impl Collect for Collected {
    #[inline]
    fn take(&mut self, offset: u64, block: &Block, found: [&[Found]; LANES], tally: &mut Tally) {
        for lane in found {
            let offsets = lane.iter().map(|frame| offset + u64::from(frame.at()));
            self.frames.extend(offsets);
        }
        if self.id.wide {
            for frame in found.into_iter().flatten() {
                let bytes = block.get(usize::from(frame.at())..).unwrap_or_default();
                tally.add_frames(self.id.read(bytes).unwrap_or_default(), 1);
            }
        } else {
            self.counts.add(block, found, self.id.at, tally);
        }
    }
}

/// Counts frames by id, separately for each lane: adding to one count again and again is slow.
#[derive(Clone)]
struct Counts([[u32; 256]; LANES]);

impl Default for Counts {
    fn default() -> Self {
        Self([[0; 256]; LANES])
    }
}

impl Counts {
    #[allow(clippy::indexing_slicing)] // in bounds: ids are bytes, and the block has a margin
    fn add(&mut self, block: &Block, found: [&[Found]; LANES], id_at: usize, tally: &mut Tally) {
        let id = |frame: &Found| usize::from(block[usize::from(frame.at()) + id_at]);
        let [a, b, c] = &mut self.0;
        let [first, second, third] = found;
        for ((first, second), third) in first.iter().zip(second).zip(third) {
            a[id(first)] += 1;
            b[id(second)] += 1;
            c[id(third)] += 1;
        }
        let common = found
            .map(<[Found]>::len)
            .into_iter()
            .min()
            .unwrap_or_default();
        for (counts, lane) in self.0.iter_mut().zip(found) {
            lane.iter()
                .skip(common)
                .for_each(|frame| counts[id(frame)] += 1);
        }
        for counts in &mut self.0 {
            for (total, count) in tally.frames.iter_mut().zip(counts) {
                *total += u64::from(std::mem::take(count));
            }
        }
    }
}
