//! Finds the frames of a block with three interleaved scans.
//!
//! A scan has no state: the verdict on a position depends only on the bytes from there on. But the
//! start of the next frame depends on this frame's LEN, and the processor waits for that. Therefore
//! a block is scanned in lanes. All lanes but the first start at a guess: a position at which a
//! frame seems to start. If a lane ends exactly where the next lane started, the guess was right,
//! and the two lanes found what one scan finds. If a guess was wrong, that lane and those after it
//! are discarded, and the next block starts at the end of the last lane that is used.

use super::block::{BLOCK, Block, Found, LANES, Look, MOST, Quick};
use super::spans::Runs;
use crate::reason::Reason;
use cobotwire_simd::WINDOW;

/// The number of bytes that a guess may examine.
const GUESSING: usize = 512;
/// How many bytes ahead of its position a lane asks the processor to load.
const AHEAD: usize = 512;

/// Memory for what the lanes find in a block: one struct, so that one register can point to it.
#[derive(Clone)]
pub(crate) struct Lanes {
    found: Box<[[Found; MOST]; LANES]>,
    /// How many frames each lane found, and how many of them have each id.
    counts: [usize; LANES],
    ids: Box<[[u32; 256]; LANES]>,
    noise: [Runs; LANES],
}

/// What one lane found.
#[derive(Clone, Copy)]
pub(crate) struct Lane<'a> {
    /// The frames, in order.
    pub(crate) found: &'a [Found],
    /// How many frames have each id.
    pub(crate) ids: &'a [u32; 256],
    pub(crate) noise: &'a Runs,
}

impl Lanes {
    pub(crate) fn new() -> Self {
        Self {
            found: Box::new([[Found::new(0, 0); MOST]; LANES]),
            counts: [0; LANES],
            ids: Box::new([[0; 256]; LANES]),
            noise: Default::default(),
        }
    }

    /// Return the first `used` lanes.
    pub(crate) fn first(&self, used: usize) -> impl Iterator<Item = Lane<'_>> + Clone {
        let all = self.found.iter().zip(&self.counts);
        let all = all.zip(self.ids.iter()).zip(&self.noise).take(used);
        all.map(|(((found, count), ids), noise)| Lane {
            found: found.get(..*count).unwrap_or_default(),
            ids,
            noise,
        })
    }

    /// Scan a block from its start, which must be no part of an earlier frame, up to `stop`. Return
    /// the number of lanes whose guess was right, and the end of the last of them.
    #[inline(never)]
    #[allow(clippy::indexing_slicing)] // indexes of lanes are below LANES
    pub(crate) fn run(&mut self, quick: Quick<'_>, data: &Block, stop: usize) -> (usize, usize) {
        let stop = stop.min(BLOCK);
        let start: [usize; LANES] = std::array::from_fn(|lane| match lane {
            0 => 0,
            _ => guess(quick, data, lane * stop / LANES, stop),
        });
        let end: [usize; LANES] =
            std::array::from_fn(|lane| start.get(lane + 1).copied().unwrap_or(stop));
        let mut at = start;
        let mut counts = [0; LANES];
        let Self {
            found, ids, noise, ..
        } = self;
        *ids.as_mut() = [[0; 256]; LANES];
        noise.iter_mut().for_each(Runs::clear);
        while (0..LANES).all(|lane| at[lane] < end[lane]) {
            for lane in 0..LANES {
                let here = at[lane] % BLOCK;
                cobotwire_simd::prefetch(data, at[lane] + AHEAD);
                at[lane] = match quick.look(data, here) {
                    Look::Frame { size, group, id } => {
                        found[lane][counts[lane] % MOST] = Found::new(here, group);
                        counts[lane] += 1;
                        ids[lane][usize::from(id)] += 1;
                        here + usize::from(size)
                    }
                    Look::Noise(reason) => {
                        pass_noise(quick, data, at[lane], end[lane], reason, &mut noise[lane])
                    }
                };
            }
        }
        for lane in 0..LANES {
            while at[lane] < end[lane] {
                let here = at[lane] % BLOCK;
                at[lane] = match quick.look(data, here) {
                    Look::Frame { size, group, id } => {
                        found[lane][counts[lane] % MOST] = Found::new(here, group);
                        counts[lane] += 1;
                        ids[lane][usize::from(id)] += 1;
                        here + usize::from(size)
                    }
                    Look::Noise(reason) => {
                        pass_noise(quick, data, at[lane], end[lane], reason, &mut noise[lane])
                    }
                };
            }
        }
        self.counts = counts;
        let wrong = (1..LANES).find(|lane| at[lane - 1] != start[*lane]);
        let used = wrong.unwrap_or(LANES);
        (used, at[used - 1])
    }
}

/// Record noise: the position `from`, rejected for `reason`, and those after it where no frame can
/// start. Return the first position where one may start, or `end`.
#[inline(never)]
fn pass_noise(
    quick: Quick<'_>,
    data: &Block,
    from: usize,
    end: usize,
    reason: Reason,
    runs: &mut Runs,
) -> usize {
    if runs.end_at(from) {
        // The noise before ended where a frame could start, but none did.
        return pass_headers(quick, data, from, end, reason, runs);
    }
    let (at, lengths) = next(quick, data, from, end);
    runs.span(from, at);
    runs.count(reason, 1);
    runs.count(Reason::BadLength, lengths);
    runs.count(Reason::NoHeader, at - from - 1 - lengths);
    at
}

/// Record noise that is full of headers: the position `from`, rejected for `reason`, and all up to
/// the next frame. Return the position of that frame, or `end`.
#[inline(never)]
fn pass_headers(
    quick: Quick<'_>,
    data: &Block,
    from: usize,
    end: usize,
    reason: Reason,
    runs: &mut Runs,
) -> usize {
    let (mut at, mut lengths, mut validated) = (from + 1, 0, 1);
    runs.count(reason, 1);
    let mut frame = false;
    while at < end && !frame {
        let window = quick.window(data, at).first(end - at);
        let mut passed = WINDOW.min(end - at);
        let mut candidates = window.candidates;
        while candidates != 0 && !frame {
            let place = candidates.trailing_zeros() as usize;
            match quick.look(data, at + place) {
                Look::Frame { .. } => (passed, frame) = (place, true),
                Look::Noise(reason) => {
                    runs.count(reason, 1);
                    validated += 1;
                }
            }
            candidates &= candidates - 1;
        }
        lengths += window.first(passed).bad_lengths.count_ones() as usize;
        at += passed;
    }
    runs.span(from, at);
    runs.count(Reason::BadLength, lengths);
    runs.count(Reason::NoHeader, at - from - validated - lengths);
    at
}

/// Return the first position after `from` at which a frame may start, or `end`; and the number of
/// headers before it with a LEN that no frame has.
#[inline(always)]
fn next(quick: Quick<'_>, data: &Block, from: usize, end: usize) -> (usize, usize) {
    let (mut at, mut lengths) = (from + 1, 0);
    while at < end {
        let window = quick.window(data, at);
        let skipped = (window.candidates.trailing_zeros() as usize).min(end - at);
        // Headers in noise are rare, and old processors have no instruction that counts bits.
        let bad_lengths = window.first(skipped).bad_lengths;
        if bad_lengths != 0 {
            lengths += bad_lengths.count_ones() as usize;
        }
        at += skipped;
        if skipped < WINDOW {
            break;
        }
    }
    (at, lengths)
}

/// Return the first position from `at` on where a frame starts, or `stop` if the search takes so
/// long that the lane would cost more than it saves.
fn guess(quick: Quick<'_>, data: &Block, mut at: usize, stop: usize) -> usize {
    let enough = stop.min(at + GUESSING);
    while at < enough {
        if let Look::Frame { .. } = quick.look(data, at) {
            return at;
        }
        (at, _) = next(quick, data, at, enough);
    }
    stop
}
