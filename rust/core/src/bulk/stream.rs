//! Scans a stream in bulk: first the seam between two calls, then a chunk block by block.

use super::block::{BLOCK, Block, Found, LANES, MARGIN, Quick};
use super::lanes::Lanes;
use super::spans::{Noise, Runs, Spans};
use crate::frame::Frame;
use crate::judge::Rules;
use crate::legal::{BELIEVED, Heading};
use crate::reason::Reason;
use crate::scan::{Sink, scan};
use crate::seam::Seam;
use crate::tally::Tally;
use cobotwire_simd::SEEN;

/// A shorter block is scanned position by position: its lanes would need more memory than it has.
const WORTH: usize = 1 << 15;

/// Receives the frames of a stream in order, in portions.
pub(crate) trait Collect {
    /// Receive frames, lane after lane. Their positions count from the start of `block`, which is
    /// at `offset` in the stream.
    fn take(&mut self, offset: u64, block: &Block, found: [&[Found]; LANES]);
}

/// Finds the frames of a stream and accounts for the rest.
#[derive(Clone)]
pub(crate) struct Stream {
    rules: Rules,
    seam: Seam,
    tally: Tally,
    noise: Noise,
    space: Space,
}

/// Memory for scanning, which is made on first use. Between two calls nothing in it matters.
#[derive(Clone, Default)]
pub(crate) struct Space {
    lanes: Option<Lanes>,
    scratch: Option<Scratch>,
}

/// Buffers for scanning less than a block.
#[derive(Clone)]
struct Scratch {
    block: Box<Block>,
    found: Vec<Found>,
    runs: Runs,
}

impl Scratch {
    fn new() -> Self {
        Self {
            block: Box::new([0; BLOCK + MARGIN]),
            found: Vec::new(),
            runs: Runs::default(),
        }
    }
}

impl Stream {
    pub(crate) fn new(rules: Rules) -> Self {
        Self {
            rules,
            seam: Seam::default(),
            tally: Tally::default(),
            noise: Noise::default(),
            space: Space::default(),
        }
    }

    /// Reuse the memory of `old` noise. Nothing has been fed yet.
    pub(crate) fn reusing(mut self, old: Spans) -> Self {
        self.noise = Noise::new(old);
        self
    }

    /// Count offsets from `offset` on. Nothing has been fed yet.
    pub(crate) fn start_at(&mut self, offset: u64) {
        self.seam = Seam::at(offset);
    }

    pub(crate) fn pending(&self) -> usize {
        self.seam.pending()
    }

    pub(crate) fn tally(&self) -> &Tally {
        &self.tally
    }

    pub(crate) fn rules(&self) -> &Rules {
        &self.rules
    }

    /// Exchange the memory for scanning: streams that are read in turn need it only once.
    pub(crate) fn exchange(&mut self, space: &mut Space) {
        std::mem::swap(&mut self.space, space);
    }

    pub(crate) fn noise(&self) -> &Noise {
        &self.noise
    }

    /// Return the spans of noise that a frame has ended.
    pub(crate) fn take_noise(&mut self) -> Spans {
        self.noise.take()
    }

    /// Return the start and the end of the noise that no frame has ended yet.
    pub(crate) fn open_noise(&self) -> Option<(u64, u64)> {
        self.noise.open()
    }

    pub(crate) fn feed(&mut self, chunk: &[u8], collect: &mut impl Collect) {
        self.cut(chunk, false, collect);
    }

    pub(crate) fn flush(&mut self, collect: &mut impl Collect) {
        self.cut(&[], true, collect);
        self.noise.end();
    }

    fn cut(&mut self, chunk: &[u8], at_end: bool, collect: &mut impl Collect) {
        self.tally.bytes += chunk.len() as u64;
        let crossing = self.seam.cross(chunk, self.rules.longest());
        let (seam, offset) = (crossing.seam, crossing.offset);
        let mut at = self.scan(offset, &crossing.data, seam, at_end, collect);
        if at >= seam {
            at += self.blocks(
                offset + at as u64,
                chunk.get(at - seam..).unwrap_or_default(),
                collect,
            );
            // The rest is shorter than a block, or has to be scanned piece by piece.
            while let Some(rest) = chunk.get(at - seam..).filter(|rest| !rest.is_empty()) {
                let passed = self.scan(offset + at as u64, rest, rest.len(), at_end, collect);
                at += passed;
                if passed == 0 {
                    break;
                }
            }
        }
        self.noise.settle(offset + at as u64, &mut self.tally);
        self.seam.keep(crossing, chunk, at);
    }

    /// Scan the blocks at the start of `data`, the last of which may be short; return the end of it.
    fn blocks(&mut self, offset: u64, data: &[u8], collect: &mut impl Collect) -> usize {
        let Some(quick) = Quick::new(&self.rules) else {
            return 0;
        };
        let mut at = 0;
        loop {
            let Space { lanes, scratch } = &mut self.space;
            let rest = data.get(at..).unwrap_or_default();
            let (block, stop) = match rest.first_chunk() {
                Some(block) => (block, BLOCK),
                None => {
                    let stop = rest.len().saturating_sub(self.rules.longest().max(SEEN));
                    if stop < WORTH {
                        break;
                    }
                    let scratch = scratch.get_or_insert_with(Scratch::new);
                    if let Some(start) = scratch.block.get_mut(..rest.len()) {
                        start.copy_from_slice(rest);
                    }
                    (&*scratch.block, stop)
                }
            };
            let lanes = lanes.get_or_insert_with(Lanes::new);
            let (counted, end) = lanes.run(quick, block, stop);
            let start = offset + at as u64;
            let mut found = [&[][..]; LANES];
            for (found, lane) in found.iter_mut().zip(lanes.first(counted)) {
                *found = lane.found;
                for (total, count) in self.tally.frames.iter_mut().zip(lane.ids) {
                    *total += u64::from(*count);
                }
                self.noise.add(start, lane.noise, &mut self.tally);
            }
            collect.take(start, block, found);
            at += end;
        }
        at
    }

    /// Scan the positions of `data` up to `stop`, or as many as a block has. Return the first
    /// position that was not scanned.
    fn scan(
        &mut self,
        offset: u64,
        data: &[u8],
        stop: usize,
        at_end: bool,
        collect: &mut impl Collect,
    ) -> usize {
        // What starts before the stop ends in the block; kept bytes are always scanned whole.
        let stop = stop.min(BLOCK.min((BLOCK + MARGIN).saturating_sub(self.rules.longest())));
        if stop == 0 {
            return 0;
        }
        let scratch = self.space.scratch.get_or_insert_with(Scratch::new);
        let Scratch { block, found, runs } = scratch;
        found.clear();
        runs.clear();
        let mut finds = Finds {
            rules: &self.rules,
            tally: &mut self.tally,
            found,
            runs,
        };
        let at = scan(&self.rules, data, 0, stop, at_end, &mut finds);
        let bytes = data.get(..at).unwrap_or_default();
        if let Some(start) = block.get_mut(..bytes.len()) {
            start.copy_from_slice(bytes);
        }
        let mut all = [&[][..]; LANES];
        all[0] = found.as_slice();
        collect.take(offset, block, all);
        self.noise.add(offset, runs, &mut self.tally);
        at
    }
}

/// The finds of a scan, in the form of a lane.
struct Finds<'a> {
    rules: &'a Rules,
    tally: &'a mut Tally,
    found: &'a mut Vec<Found>,
    runs: &'a mut Runs,
}

impl<'a> Sink<'a> for Finds<'_> {
    fn frame(&mut self, at: usize, frame: Frame<'a>) {
        let group = match self.rules.legal().wide_heading(frame.length(), frame.id()) {
            Heading::Group(group) => group,
            _ => BELIEVED,
        };
        self.found.push(Found::new(at, group));
        self.tally.add_frames(frame.id(), 1);
    }

    fn noise(&mut self, from: usize, to: usize, reason: Reason) {
        self.runs.span(from, to);
        self.runs.count(reason, to - from);
    }
}
