//! Searches contiguous bytes for frames, block by block, and records the rest as noise.

use super::block::{BLOCK, Block, Found, LANES, MARGIN, Quick};
use super::lanes::Lanes;
use super::spans::{Noise, Runs};
use crate::frame::Frame;
use crate::legal::{ACCEPTED, Heading};
use crate::reason::Reason;
use crate::rules::Rules;
use crate::scan::{Sink, scan};
use crate::tally::Tally;
use cobotwire_simd::SEEN;

/// A shorter block is scanned position by position: its lanes would need more memory than the
/// bytes.
const WORTH: usize = 1 << 15;

/// Receives the frames of a stream in order, in portions.
pub(crate) trait Collect {
    /// Receive frames, lane after lane. Their positions count from the start of `block`, which is
    /// at `offset` in the stream.
    fn take(&mut self, offset: u64, block: &Block, found: [&[Found]; LANES]);
}

/// Finds frames, and counts them and the noise between them.
#[derive(Clone)]
pub(crate) struct Search {
    pub(crate) rules: Rules,
    pub(crate) tally: Tally,
    pub(crate) noise: Noise,
    pub(crate) space: Space,
}

/// Memory for scanning, which is made on first use. No call reads what an earlier call left in it.
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

impl Search {
    pub(crate) fn new(rules: Rules) -> Self {
        Self {
            rules,
            tally: Tally::default(),
            noise: Noise::default(),
            space: Space::default(),
        }
    }

    /// Append what another search has found after this one, and clear it.
    pub(crate) fn append(&mut self, other: &mut Self) {
        self.tally.append(&mut other.tally);
        self.noise.append(&mut other.noise, &mut self.tally);
    }

    /// Forget what was found.
    pub(crate) fn clear(&mut self) {
        self.tally = Tally::default();
        self.noise.clear();
    }

    /// Search the positions of `data`, which is at `offset` in the stream, up to `stop`. Return the
    /// first position that was not searched: more bytes must decide it, or it is the end of the
    /// last frame, which may be after `stop`. With `at_end`, no more bytes come.
    pub(crate) fn through(
        &mut self,
        offset: u64,
        data: &[u8],
        stop: usize,
        at_end: bool,
        collect: &mut impl Collect,
    ) -> usize {
        let mut at = self.blocks(offset, data, stop, collect);
        // The rest is shorter than a block, or has to be scanned piece by piece.
        while at < stop
            && let Some(rest) = data.get(at..)
        {
            let passed = self.scan(offset + at as u64, rest, stop - at, at_end, collect);
            at += passed;
            if passed == 0 {
                break;
            }
        }
        at
    }

    /// Scan the blocks of `data` up to `stop`; the last one may be short. Return its end.
    fn blocks(
        &mut self,
        offset: u64,
        data: &[u8],
        stop: usize,
        collect: &mut impl Collect,
    ) -> usize {
        let Some(quick) = Quick::new(&self.rules) else {
            return 0;
        };
        let mut at = 0;
        while at < stop {
            let left = stop - at;
            let Space { lanes, scratch } = &mut self.space;
            let rest = data.get(at..).unwrap_or_default();
            let (block, stop) = match rest.first_chunk() {
                Some(block) => (block, left.min(BLOCK)),
                None => {
                    let most = rest.len().saturating_sub(self.rules.longest().max(SEEN));
                    let stop = most.min(left);
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
            let (used, end) = lanes.run(quick, block, stop);
            let start = offset + at as u64;
            let mut found = [&[][..]; LANES];
            for (found, lane) in found.iter_mut().zip(lanes.first(used)) {
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
    pub(crate) fn scan(
        &mut self,
        offset: u64,
        data: &[u8],
        stop: usize,
        at_end: bool,
        collect: &mut impl Collect,
    ) -> usize {
        // A frame that starts before `stop` must end in the block. A stream keeps fewer bytes than
        // a block has, so one call scans all of them.
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

/// What a scan found, stored as for a lane.
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
            _ => ACCEPTED,
        };
        self.found.push(Found::new(at, group));
        self.tally.add_frames(frame.id(), 1);
    }

    fn noise(&mut self, from: usize, to: usize, reason: Reason) {
        self.runs.span(from, to);
        self.runs.count(reason, to - from);
    }
}
