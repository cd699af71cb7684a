//! Where noise stands between frames, and how much of it there is.

use crate::error::Reason;
use crate::tally::Tally;

/// Stretches of noise, adjacent ones joined: where they start in the stream, and their sizes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Spans {
    /// Where each starts.
    pub offsets: Vec<u64>,
    /// Its bytes.
    pub sizes: Vec<u64>,
}

/// Noise as it is found: in pieces that may touch each other.
#[derive(Clone, Debug, Default)]
pub(crate) struct Noise {
    /// The span that may go on: from where, to where.
    open: Option<(u64, u64)>,
    /// Where a span was ended by a flush, and no frame has come since.
    flushed: Option<u64>,
    closed: Spans,
}

/// The noise of one lane or scan, not yet known to count.
#[derive(Clone, Debug, Default)]
pub(crate) struct Runs {
    pub(crate) spans: Vec<(u32, u32)>,
    pub(crate) reasons: [u64; Reason::ALL.len()],
}

impl Runs {
    pub(crate) fn clear(&mut self) {
        self.spans.clear();
        self.reasons = Default::default();
    }

    /// Noise from `from` to before `to`, which may touch the last.
    #[inline]
    pub(crate) fn span(&mut self, from: usize, to: usize) {
        let (from, to) = (from as u32, to as u32);
        match self.spans.last_mut() {
            Some((_, end)) if *end == from => *end = to,
            _ => self.spans.push((from, to)),
        }
    }

    #[inline]
    pub(crate) fn count(&mut self, reason: Reason, bytes: usize) {
        if let Some(entry) = self.reasons.get_mut(reason as usize) {
            *entry += bytes as u64;
        }
    }
}

impl Noise {
    /// Take over what was found from stream offset `base` on.
    pub(crate) fn add(&mut self, base: u64, runs: &Runs, tally: &mut Tally) {
        for (total, count) in tally.noise.iter_mut().zip(runs.reasons) {
            *total += count;
        }
        for (from, to) in &runs.spans {
            let (from, to) = (base + u64::from(*from), base + u64::from(*to));
            match &mut self.open {
                Some((_, end)) if *end == from => *end = to,
                _ => {
                    self.close(from, tally);
                    self.open = Some((from, to));
                }
            }
        }
    }

    /// All before stream offset `done` is accounted for: a span that ends earlier was followed by a
    /// frame.
    pub(crate) fn settle(&mut self, done: u64, tally: &mut Tally) {
        if self.open.is_none_or(|(_, end)| end < done) {
            self.close(done, tally);
        }
    }

    /// The noise so far is over; if there is a frame between it and `next`, that one resynced.
    fn close(&mut self, next: u64, tally: &mut Tally) {
        self.end();
        if self.flushed.take_if(|end| *end < next).is_some() {
            tally.resyncs += 1;
        }
    }

    /// The stream was flushed: its noise is over, though more may touch it.
    pub(crate) fn end(&mut self) {
        if let Some((from, to)) = self.open.take() {
            self.closed.offsets.push(from);
            self.closed.sizes.push(to - from);
            self.flushed = Some(to);
        }
    }

    /// The spans that are over.
    pub(crate) fn take(&mut self) -> Spans {
        std::mem::take(&mut self.closed)
    }
}
