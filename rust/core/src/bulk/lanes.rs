//! Finds the frames of a block in three places at once.
//!
//! A scan has no memory: the verdict on a position depends only on the bytes from there on. But the
//! start of the next frame depends on this frame's LEN, and the processor waits for that. Therefore
//! a block is scanned in lanes. All lanes but the first start at a guess: a position at which a
//! frame seems to start. If a lane ends exactly where the next lane started, the guess was right,
//! and the two lanes found what one scan finds. If a guess was wrong, the lanes from there on are
//! discarded, and the next block starts at the end of the last lane that counts.

use super::block::{BLOCK, Block, Found, LANES, Look, MOST, Quick};
use super::spans::Runs;
use super::window::WINDOW;
use crate::reason::Reason;

/// The number of bytes that a guess may examine.
const GUESSING: usize = 512;

/// What one lane found.
#[derive(Clone)]
pub(crate) struct Lane {
    found: Box<[Found; MOST]>,
    count: usize,
    noise: Runs,
}

impl Lane {
    /// Return the frames, in order.
    pub(crate) fn found(&self) -> &[Found] {
        self.found.get(..self.count).unwrap_or_default()
    }

    /// Return the noise.
    pub(crate) fn noise(&self) -> &Runs {
        &self.noise
    }

    #[inline(always)]
    #[allow(clippy::indexing_slicing)] // in bounds by the mask
    fn push(&mut self, found: Found) {
        self.found[self.count % MOST] = found;
        self.count += 1;
    }
}

/// Memory for what the lanes find in a block.
#[derive(Clone)]
pub(crate) struct Lanes {
    lanes: [Lane; LANES],
}

impl Lanes {
    pub(crate) fn new() -> Self {
        let lane = Lane {
            found: Box::new([Found::new(0, 0); MOST]),
            count: 0,
            noise: Runs::default(),
        };
        Self {
            lanes: std::array::from_fn(|_| lane.clone()),
        }
    }

    /// Scan a block from its start, into which no earlier frame reaches. Return the lanes that
    /// count, and the end of the last of them.
    #[inline(never)]
    #[allow(clippy::indexing_slicing)] // by lane, below their number
    pub(crate) fn run(&mut self, quick: Quick<'_>, data: &Block) -> (&[Lane], usize) {
        let start: [usize; LANES] = std::array::from_fn(|lane| match lane {
            0 => 0,
            _ => guess(quick, data, lane * BLOCK / LANES),
        });
        let end: [usize; LANES] =
            std::array::from_fn(|lane| start.get(lane + 1).copied().unwrap_or(BLOCK));
        let mut at = start;
        let [first, second, third] = &mut self.lanes;
        for lane in [&mut *first, &mut *second, &mut *third] {
            lane.count = 0;
            lane.noise.clear();
        }
        while at[0] < end[0] && at[1] < end[1] && at[2] < end[2] {
            at[0] = step(quick, data, at[0], end[0], first);
            at[1] = step(quick, data, at[1], end[1], second);
            at[2] = step(quick, data, at[2], end[2], third);
        }
        for (index, lane) in self.lanes.iter_mut().enumerate() {
            while at[index] < end[index] {
                at[index] = step(quick, data, at[index], end[index], lane);
            }
        }
        let wrong = (1..LANES).find(|lane| at[lane - 1] != start[*lane]);
        let counted = wrong.unwrap_or(LANES);
        (&self.lanes[..counted], at[counted - 1])
    }
}

/// Pass over one frame, or over the noise before the next one.
#[inline(always)]
fn step(quick: Quick<'_>, data: &Block, at: usize, end: usize, lane: &mut Lane) -> usize {
    let here = at as u16;
    match quick.look(data, here) {
        Look::Frame(size, group) => {
            lane.push(Found::new(here, group));
            usize::from(here) + usize::from(size)
        }
        Look::Noise(_) => pass_noise(quick, data, at, end, &mut lane.noise),
    }
}

/// Account for the noise from `at` on. Return the position of the next frame, or `end`.
#[inline(never)]
fn pass_noise(quick: Quick<'_>, data: &Block, from: usize, end: usize, runs: &mut Runs) -> usize {
    let mut at = from;
    // Count in registers; the remaining bytes have the most common reason.
    let (mut lengths, mut ids, mut checks) = (0, 0, 0);
    'windows: while at < end {
        let window = quick.window(data, at as u16).first(end - at);
        let mut left = window;
        while let Some(index) = left.next() {
            match quick.look(data, (at + index) as u16) {
                Look::Frame(..) => {
                    lengths += window.first(index).bad_lengths();
                    at += index;
                    break 'windows;
                }
                Look::Noise(Reason::UnknownId) => ids += 1,
                Look::Noise(Reason::BadCheck) => checks += 1,
                Look::Noise(_) => lengths += 1,
            }
        }
        lengths += window.bad_lengths();
        at = end.min(at + WINDOW);
    }
    runs.span(from, at);
    runs.count(Reason::BadLength, lengths);
    runs.count(Reason::UnknownId, ids);
    runs.count(Reason::BadCheck, checks);
    runs.count(Reason::NoHeader, at - from - lengths - ids - checks);
    at
}

/// Return the first position from `at` on where a frame starts, or the end of the block if the
/// search takes too long: then the lane would cost more than it saves.
fn guess(quick: Quick<'_>, data: &Block, at: usize) -> usize {
    let enough = at + GUESSING;
    match pass_noise(quick, data, at, enough, &mut Runs::default()) {
        found if found < enough => found,
        _ => BLOCK,
    }
}
