//! Cuts frames out of a byte stream and accounts for every other byte.
//!
//! The law: at position i a frame stands or the byte at i is noise; a candidate is refuted by the
//! first byte that refutes it, and the scan goes on at i + 1, never skipping what a false header
//! claimed; a candidate that more bytes could complete waits. Judging a position takes at
//! most one look at the longest frame (for its CRC or sum, once all its bytes are there) and no
//! position is refuted twice, so the work is linear whatever the input.

use std::mem;

use crate::error::Reason;
use crate::frame::Frame;
use crate::judge::{Rules, Verdict};

/// A stretch of the stream; `offset` counts from its start, over all calls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event<'a> {
    /// A whole, legal frame.
    Frame {
        /// Where its first byte stands in the stream.
        offset: u64,
        /// The frame.
        frame: Frame<'a>,
    },
    /// Bytes that belong to no frame.
    Noise {
        /// Where the first of them stands in the stream.
        offset: u64,
        /// Why: each of them was refuted for this.
        reason: Reason,
        /// The bytes, in two pieces: the first may lie in what earlier calls kept.
        data: [&'a [u8]; 2],
    },
}

/// Takes bytes, gives events. What it keeps between calls is less than the longest frame.
#[derive(Clone, Debug)]
pub struct Framer {
    rules: Rules,
    /// What still waits; its first byte stands at `offset` in the stream.
    kept: Vec<u8>,
    offset: u64,
}

impl Framer {
    /// A framer at the start of a stream.
    #[must_use]
    pub fn new(rules: Rules) -> Self {
        Self {
            rules,
            kept: Vec::new(),
            offset: 0,
        }
    }

    /// Bytes fed that no event covers yet.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.kept.len()
    }

    /// Take bytes; give what is certain by now.
    pub fn feed(&mut self, chunk: &[u8], sink: impl FnMut(Event<'_>)) {
        self.cut(chunk, false, sink);
    }

    /// Refute what still waits: a true frame behind it comes now.
    pub fn flush(&mut self, sink: impl FnMut(Event<'_>)) {
        self.cut(&[], true, sink);
    }

    /// Positions are counted from the first kept byte, over the seam between `kept` and `chunk`.
    fn cut(&mut self, chunk: &[u8], at_end: bool, sink: impl FnMut(Event<'_>)) {
        let mut kept = mem::take(&mut self.kept);
        let seam = kept.len();
        // Only what candidates that start before the seam can need; the chunk itself is scanned in
        // place, however large it is.
        let need = if seam == 0 {
            0
        } else {
            self.rules.longest() - 1
        };
        kept.extend_from_slice(chunk.get(..need).unwrap_or(chunk));

        let pieces = [kept.get(..seam).unwrap_or_default(), chunk];
        let mut pass = Pass {
            rules: &self.rules,
            at_end,
            pieces,
            offset: self.offset,
            run: None,
            sink,
        };
        let mut at = pass.scan(&kept, 0, 0, seam);
        if at >= seam {
            at = pass.scan(chunk, seam, at, seam + chunk.len());
        }
        pass.close(at);

        if at < seam {
            kept.drain(..at);
        } else {
            kept.clear();
            kept.extend_from_slice(chunk.get(at - seam..).unwrap_or_default());
        }
        self.kept = kept;
        self.offset += at as u64;
    }
}

/// One call's way through its bytes.
struct Pass<'a, S> {
    rules: &'a Rules,
    at_end: bool,
    pieces: [&'a [u8]; 2],
    offset: u64,
    /// Where the current run of noise started, and its reason.
    run: Option<(usize, Reason)>,
    sink: S,
}

impl<S: FnMut(Event<'_>)> Pass<'_, S> {
    /// Judge the positions from `at` to `stop`; gives the first that waits, else where it ended.
    /// The first byte of `data` is at position `base`.
    fn scan(&mut self, data: &[u8], base: usize, mut at: usize, stop: usize) -> usize {
        while at < stop {
            let rest = data.get(at - base..).unwrap_or_default();
            match self.rules.judge(rest) {
                Verdict::Stands(frame) => {
                    self.close(at);
                    (self.sink)(Event::Frame {
                        offset: self.offset + at as u64,
                        frame,
                    });
                    at += frame.bytes().len();
                }
                Verdict::Refuted(reason) => {
                    self.refute(at, reason);
                    at += 1;
                }
                Verdict::Waits if self.at_end => {
                    self.refute(at, Reason::Truncated);
                    at += 1;
                }
                Verdict::Waits => break,
            }
        }
        at
    }

    /// The byte at `at` is noise.
    #[inline]
    fn refute(&mut self, at: usize, reason: Reason) {
        if self.run.is_none_or(|(_, current)| current != reason) {
            self.close(at);
            self.run = Some((at, reason));
        }
    }

    /// The current run of noise, if there is one, ends before `end`.
    #[inline]
    fn close(&mut self, end: usize) {
        let Some((start, reason)) = self.run.take() else {
            return;
        };
        let [kept, chunk] = self.pieces;
        let seam = kept.len();
        let before = kept.get(start.min(seam)..end.min(seam));
        let after = chunk.get(start.saturating_sub(seam)..end.saturating_sub(seam));
        (self.sink)(Event::Noise {
            offset: self.offset + start as u64,
            reason,
            data: [before.unwrap_or_default(), after.unwrap_or_default()],
        });
    }
}
