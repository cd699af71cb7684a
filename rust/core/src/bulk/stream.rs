//! Scans a stream in bulk: first the seam between two chunks, then the rest of the new chunk.

use super::search::{Collect, Search, Space};
use super::spans::{Noise, Spans};
use super::speculative::{self, Share, Workers};
use crate::rules::Rules;
use crate::seam::Seam;
use crate::tally::Tally;

/// Finds the frames of a stream, and the noise between them.
#[derive(Clone)]
pub(crate) struct Stream {
    search: Search,
    seam: Seam,
}

impl Stream {
    pub(crate) fn new(rules: Rules) -> Self {
        Self {
            search: Search::new(rules),
            seam: Seam::default(),
        }
    }

    /// Reuse the memory of `old` noise. Call this before the first bytes are fed.
    pub(crate) fn reusing(mut self, old: Spans) -> Self {
        self.search.noise = Noise::new(old);
        self
    }

    /// Count offsets from `offset` on. Call this before the first bytes are fed.
    pub(crate) fn start_at(&mut self, offset: u64) {
        self.seam = Seam::at(offset);
    }

    pub(crate) fn pending(&self) -> usize {
        self.seam.pending()
    }

    pub(crate) fn tally(&self) -> &Tally {
        &self.search.tally
    }

    pub(crate) fn rules(&self) -> &Rules {
        &self.search.rules
    }

    /// Swap the memory for scanning with `space`: streams that are read in turn can share it.
    pub(crate) fn exchange(&mut self, space: &mut Space) {
        std::mem::swap(&mut self.search.space, space);
    }

    pub(crate) fn noise(&self) -> &Noise {
        &self.search.noise
    }

    /// Return the spans of noise that a frame has ended.
    pub(crate) fn take_noise(&mut self) -> Spans {
        self.search.noise.take()
    }

    /// Return the start and the end of the noise that no frame has ended yet.
    pub(crate) fn open_noise(&self) -> Option<(u64, u64)> {
        self.search.noise.open()
    }

    pub(crate) fn feed(&mut self, chunk: &[u8], collect: &mut impl Collect) {
        self.cut(chunk, false, collect, |_, _, _, _| 0);
    }

    /// Feed a chunk that several threads read, if it is large.
    pub(crate) fn feed_with(&mut self, workers: Workers, chunk: &[u8], collect: &mut impl Share) {
        self.cut(chunk, false, collect, |search, offset, data, collect| {
            speculative::read(workers, search, offset, data, collect)
        });
    }

    pub(crate) fn flush(&mut self, collect: &mut impl Collect) {
        self.cut(&[], true, collect, |_, _, _, _| 0);
        self.search.noise.end();
    }

    /// Scan the pending bytes, and then a chunk. `start` may scan bytes at the start of the chunk;
    /// it returns how many it scanned.
    fn cut<C: Collect>(
        &mut self,
        chunk: &[u8],
        at_end: bool,
        collect: &mut C,
        start: impl FnOnce(&mut Search, u64, &[u8], &mut C) -> usize,
    ) {
        let search = &mut self.search;
        search.tally.bytes += chunk.len() as u64;
        let crossing = self.seam.cross(chunk, search.rules.longest());
        let (seam, offset) = (crossing.seam, crossing.offset);
        let mut at = search.scan(offset, &crossing.data, seam, at_end, collect);
        if at >= seam {
            let rest = chunk.get(at - seam..).unwrap_or_default();
            at += start(search, offset + at as u64, rest, collect);
            let rest = chunk.get(at - seam..).unwrap_or_default();
            at += search.through(offset + at as u64, rest, rest.len(), at_end, collect);
        }
        search.noise.settle(offset + at as u64, &mut search.tally);
        self.seam.keep(crossing, chunk, at);
    }
}
