//! The positions and sizes of the noise between frames.

use crate::reason::Reason;
use crate::tally::Tally;

/// Spans of noise, adjacent ones joined: their positions in the stream, and their sizes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Spans {
    /// The position of each span.
    pub offsets: Vec<u64>,
    /// The number of bytes of each span.
    pub sizes: Vec<u64>,
}

/// Collects noise that is found in adjacent pieces.
#[derive(Clone, Debug, Default)]
pub(crate) struct Noise {
    /// The start and the end of the span that may continue.
    open: Option<(u64, u64)>,
    /// The end of a span that a flush ended, until it is known that a frame follows.
    flushed: Option<u64>,
    closed: Spans,
}

/// The noise of one lane or scan, before it is known whether the results of the lane are used.
#[derive(Clone, Debug, Default)]
pub(crate) struct Runs {
    /// The start and the end of each span; a frame lies between any two.
    pub(crate) spans: Vec<(u32, u32)>,
    pub(crate) reasons: [u64; Reason::ALL.len()],
}

impl Runs {
    pub(crate) fn clear(&mut self) {
        self.spans.clear();
        self.reasons = Default::default();
    }

    /// Add the noise from `from` up to, but not including, `to`. It may touch the last span.
    #[inline]
    pub(crate) fn span(&mut self, from: usize, to: usize) {
        let (from, to) = (from as u32, to as u32);
        match self.spans.last_mut() {
            Some((_, end)) if *end == from => *end = to,
            _ => self.spans.push((from, to)),
        }
    }

    /// Return whether the last noise ends at `at`.
    #[inline]
    pub(crate) fn end_at(&self, at: usize) -> bool {
        self.spans.last().is_some_and(|(_, end)| *end == at as u32)
    }

    #[inline]
    pub(crate) fn count(&mut self, reason: Reason, bytes: usize) {
        if let Some(entry) = self.reasons.get_mut(reason as usize) {
            *entry += bytes as u64;
        }
    }
}

impl Noise {
    /// Return an empty collector, which reuses the memory of `old` spans.
    pub(crate) fn new(mut old: Spans) -> Self {
        old.offsets.clear();
        old.sizes.clear();
        Self {
            closed: old,
            ..Self::default()
        }
    }

    /// Add the noise found from stream offset `base` on.
    pub(crate) fn add(&mut self, base: u64, runs: &Runs, tally: &mut Tally) {
        for (total, count) in tally.noise.iter_mut().zip(runs.reasons) {
            *total += count;
        }
        let Some(((from, to), rest)) = runs.spans.split_first() else {
            return;
        };
        let (from, to) = (base + u64::from(*from), base + u64::from(*to));
        match &mut self.open {
            Some((_, end)) if *end == from => *end = to,
            _ => {
                self.close(from, tally);
                self.open = Some((from, to));
            }
        }
        // A frame precedes each of the other spans.
        if let [next, ..] = rest
            && let [others @ .., last] = rest
        {
            self.close(base + u64::from(next.0), tally);
            let offsets = others.iter().map(|(from, _)| base + u64::from(*from));
            let sizes = others.iter().map(|(from, to)| u64::from(to - from));
            self.closed.offsets.extend(offsets);
            self.closed.sizes.extend(sizes);
            tally.resyncs += others.len() as u64;
            self.open = Some((base + u64::from(last.0), base + u64::from(last.1)));
        }
    }

    /// Append the noise that another search found after this one, and clear it.
    pub(crate) fn append(&mut self, other: &mut Self, tally: &mut Tally) {
        let Self { open, closed, .. } = other;
        let first = closed.offsets.first().zip(closed.sizes.first());
        let first = first.map(|(from, size)| (*from, from + size)).or(*open);
        let Some((from, to)) = first else {
            return;
        };
        let joined = self.open.take_if(|(_, end)| *end == from);
        if joined.is_none() {
            self.close(from, tally);
        }
        let from = joined.map_or(from, |(from, _)| from);
        match (closed.offsets.first_mut(), closed.sizes.first_mut()) {
            (Some(offset), Some(size)) => {
                (*offset, *size) = (from, to - from);
                self.flushed = None;
                self.closed.offsets.append(&mut closed.offsets);
                self.closed.sizes.append(&mut closed.sizes);
                self.open = open.take();
            }
            _ => {
                self.open = Some((from, to));
                *open = None;
            }
        }
    }

    /// Remove all noise, but keep its memory.
    pub(crate) fn clear(&mut self) {
        *self = Self::new(self.take());
    }

    /// Take note that everything before stream offset `done` was scanned: if the open span ends
    /// earlier, a frame follows it.
    pub(crate) fn settle(&mut self, done: u64, tally: &mut Tally) {
        if self.open.is_none_or(|(_, end)| end < done) {
            self.close(done, tally);
        }
    }

    /// End the open span; if a frame lies between it and `next`, count a resync.
    fn close(&mut self, next: u64, tally: &mut Tally) {
        self.end();
        if self.flushed.take_if(|end| *end < next).is_some() {
            tally.resyncs += 1;
        }
    }

    /// End the open span at a flush; noise after it begins a new span.
    pub(crate) fn end(&mut self) {
        if let Some((from, to)) = self.open.take() {
            self.closed.offsets.push(from);
            self.closed.sizes.push(to - from);
            self.flushed = Some(to);
        }
    }

    /// Return the positions of the completed spans.
    pub(crate) fn closed(&self) -> &[u64] {
        &self.closed.offsets
    }

    /// Return the start and the end of the span that may continue.
    pub(crate) fn open(&self) -> Option<(u64, u64)> {
        self.open
    }

    /// Return the completed spans.
    pub(crate) fn take(&mut self) -> Spans {
        std::mem::take(&mut self.closed)
    }
}
