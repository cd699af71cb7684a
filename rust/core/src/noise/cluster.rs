//! A run of noise, interrupted by at most a few frames, with no other noise near it.

use crate::reason::Reason;
use crate::rules::{Rules, Verdict};

/// Bytes of noise, without the frames that interrupt them.
pub(crate) struct Cluster<'a> {
    /// The bytes.
    pub(crate) data: &'a [u8],
    /// The offsets in `data` that directly follow a frame, and the end of `data`.
    pub(crate) marks: &'a [usize],
    /// The spans of the stream that `data` consists of: start and end.
    pub(crate) spans: &'a [(u64, u64)],
    /// The stream from `base` on.
    pub(crate) stream: &'a [u8],
    /// The position of the first byte of `stream`.
    pub(crate) base: u64,
}

impl Cluster<'_> {
    /// Return the end of the bytes from `at` up to the next frame.
    pub(crate) fn segment_end(&self, at: usize) -> usize {
        let later = self.marks.iter().find(|mark| **mark > at);
        later.copied().unwrap_or(self.data.len())
    }

    /// Return whether the byte at `at` directly follows a frame.
    pub(crate) fn is_mark(&self, at: usize) -> bool {
        self.marks.contains(&at)
    }

    /// Return the bytes from `at` up to the next frame.
    pub(crate) fn rest(&self, at: usize) -> &[u8] {
        self.data.get(at..self.segment_end(at)).unwrap_or_default()
    }

    /// Return the offset after the line end at `at`; `at` itself if there is no line end.
    pub(crate) fn line_end(&self, at: usize) -> usize {
        match self.rest(at) {
            [b'\r', b'\n', ..] => at + 2,
            [b'\r' | b'\n', ..] => at + 1,
            _ => at,
        }
    }

    /// Return the position of a byte in the stream.
    pub(crate) fn place(&self, at: usize) -> u64 {
        let mut before = 0;
        for ((from, _), mark) in self.spans.iter().zip(self.marks) {
            if at < *mark {
                return from + (at - before) as u64;
            }
            before = *mark;
        }
        self.spans.last().map_or(0, |(_, to)| *to)
    }

    /// Return the spans of the stream that the bytes from `start` to before `end` come from.
    pub(crate) fn spans_of(&self, start: usize, end: usize) -> Vec<(u64, u64)> {
        let mut all = Vec::with_capacity(1);
        let mut at = start;
        while at < end {
            let to = self.segment_end(at).min(end);
            let place = self.place(at);
            all.push((place, place + (to - at) as u64));
            at = to;
        }
        all
    }

    /// Return why the byte at `at` is noise.
    pub(crate) fn reason(&self, rules: &Rules, at: usize) -> Reason {
        let at = usize::try_from(self.place(at).saturating_sub(self.base)).unwrap_or(usize::MAX);
        reason(rules, self.stream.get(at..).unwrap_or_default())
    }
}

/// Return why the first byte of the rest of a stream is noise.
pub(crate) fn reason(rules: &Rules, rest: &[u8]) -> Reason {
    match rules.validate(rest) {
        Verdict::Rejected(reason) => reason,
        // The stream ended, or was flushed.
        Verdict::Waits | Verdict::Frame(_) => Reason::Truncated,
    }
}
