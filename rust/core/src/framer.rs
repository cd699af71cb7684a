//! Cuts frames out of a byte stream, and reports every other byte as noise.
//!
//! Either a frame starts at position i, or the byte at i is noise. The first byte that contradicts
//! a candidate rejects it. The scan then continues at i + 1: it never skips the bytes that a false
//! header claims. A candidate that more bytes could complete waits. Validating a candidate reads at
//! most as many bytes as the longest frame has; a CRC or sum is computed only when all its bytes
//! have come. No position is rejected twice. So the work is linear in the size of any input.

use core::mem;

use crate::frame::Frame;
use crate::reason::Reason;
use crate::rules::{Rules, Verdict};
use crate::scan::{Sink, scan};
use crate::seam::Seam;
use crate::tally::Tally;

/// A segment of the stream; `offset` counts from its start, over all calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// A whole, legal frame.
    Frame {
        /// The position of its first byte in the stream.
        offset: u64,
        /// The frame.
        frame: Frame<'a>,
    },
    /// Bytes that belong to no frame.
    Noise {
        /// The position of the first of them in the stream.
        offset: u64,
        /// Why each of them was rejected.
        reason: Reason,
        /// The bytes, in two pieces: the first may come from earlier calls.
        data: [&'a [u8]; 2],
    },
}

/// Turns bytes into events. Between calls it keeps fewer bytes than the longest frame has.
#[derive(Clone, Debug)]
pub struct Framer {
    rules: Rules,
    seam: Seam,
    tally: Tally,
    /// Whether the last event was noise.
    in_noise: bool,
}

impl Framer {
    /// Return a framer at the start of a stream.
    #[must_use]
    pub fn new(rules: Rules) -> Self {
        Self {
            rules,
            seam: Seam::default(),
            tally: Tally::default(),
            in_noise: false,
        }
    }

    /// Return the number of bytes fed that no event covers yet.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.seam.pending()
    }

    /// Return the counts since the framer was made.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        &self.tally
    }

    /// Feed bytes that are exactly one frame while none are pending; return it and its position.
    /// `None`: nothing was fed, and [`Framer::feed`] must take the bytes.
    #[inline]
    pub fn feed_frame<'a>(&mut self, chunk: &'a [u8]) -> Option<(u64, Frame<'a>)> {
        let Verdict::Frame(frame) = self.rules.validate(chunk) else {
            return None;
        };
        if frame.bytes().len() != chunk.len() {
            return None;
        }
        let offset = self.seam.pass(chunk.len())?;
        self.tally.bytes += chunk.len() as u64;
        self.tally.add_frames(frame.id(), 1);
        self.tally.resyncs += u64::from(mem::take(&mut self.in_noise));
        Some((offset, frame))
    }

    /// Feed bytes; pass the events that more bytes cannot change to `sink`.
    pub fn feed(&mut self, chunk: &[u8], sink: impl FnMut(Event<'_>)) {
        self.cut(chunk, false, sink);
    }

    /// Reject the pending candidate; pass the events of all remaining bytes to `sink`.
    pub fn flush(&mut self, sink: impl FnMut(Event<'_>)) {
        self.cut(&[], true, sink);
    }

    fn cut(&mut self, chunk: &[u8], at_end: bool, sink: impl FnMut(Event<'_>)) {
        self.tally.bytes += chunk.len() as u64;
        let crossing = self.seam.cross(chunk, self.rules.longest());
        let seam = crossing.seam;
        let mut pass = Pass {
            pieces: [crossing.data.get(..seam).unwrap_or_default(), chunk],
            offset: crossing.offset,
            base: 0,
            run: None,
            tally: &mut self.tally,
            in_noise: &mut self.in_noise,
            sink,
        };
        let mut at = scan(&self.rules, &crossing.data, 0, seam, at_end, &mut pass);
        if at >= seam {
            pass.base = seam;
            let stop = chunk.len();
            at = seam + scan(&self.rules, chunk, at - seam, stop, at_end, &mut pass);
        }
        pass.close();
        self.seam.keep(crossing, chunk, at);
    }
}

/// The state of one call. Positions in `run` count from the first kept byte; those that a scan
/// reports count from `base`.
struct Pass<'a, S> {
    pieces: [&'a [u8]; 2],
    offset: u64,
    base: usize,
    /// The current run of noise: start, end and reason.
    run: Option<(usize, usize, Reason)>,
    tally: &'a mut Tally,
    in_noise: &'a mut bool,
    sink: S,
}

impl<'a, S: FnMut(Event<'_>)> Sink<'a> for Pass<'_, S> {
    #[inline]
    fn frame(&mut self, at: usize, frame: Frame<'a>) {
        self.close();
        self.tally.add_frames(frame.id(), 1);
        self.tally.resyncs += u64::from(*self.in_noise);
        *self.in_noise = false;
        (self.sink)(Event::Frame {
            offset: self.offset + (self.base + at) as u64,
            frame,
        });
    }

    #[inline]
    fn noise(&mut self, from: usize, to: usize, reason: Reason) {
        let (from, to) = (self.base + from, self.base + to);
        match &mut self.run {
            // Two scans can report parts of one run of noise, but only where old and new bytes
            // meet.
            Some((_, end, current)) if *current == reason => *end = to,
            _ => {
                self.close();
                self.run = Some((from, to, reason));
            }
        }
    }
}

impl<S: FnMut(Event<'_>)> Pass<'_, S> {
    /// End the current run of noise, if there is one.
    #[inline]
    fn close(&mut self) {
        let Some((from, to, reason)) = self.run.take() else {
            return;
        };
        self.tally.add_noise(reason, to - from);
        *self.in_noise = true;
        let [kept, chunk] = self.pieces;
        let seam = kept.len();
        let before = kept.get(from.min(seam)..to.min(seam));
        let after = chunk.get(from.saturating_sub(seam)..to.saturating_sub(seam));
        (self.sink)(Event::Noise {
            offset: self.offset + from as u64,
            reason,
            data: [before.unwrap_or_default(), after.unwrap_or_default()],
        });
    }
}
