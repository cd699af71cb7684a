//! Scans contiguous bytes: validates each position once and skips the bytes of a frame.

use crate::frame::Frame;
use crate::reason::Reason;
use crate::rules::{Rules, Verdict};

/// Receives the results of a scan in stream order; positions count from the start of its data.
pub(crate) trait Sink<'a> {
    /// Receive the frame at `at`.
    fn frame(&mut self, at: usize, frame: Frame<'a>);

    /// Receive noise: the bytes from `from` up to, not including, `to`; `reason` applies to each.
    fn noise(&mut self, from: usize, to: usize, reason: Reason);
}

/// After this many bytes of noise without a header, the next bytes probably have no header either.
const LONG_RUN: usize = 8;
/// After a long run of noise, this number of bytes is examined together.
const STEP: usize = 16;

/// Validate the positions from `at` to `stop`. Return the first position that cannot be decided
/// without more bytes, or the end of the scan, which is after `stop` if a frame ends there. At the
/// end of the stream (`at_end`) every position can be decided.
#[inline]
pub(crate) fn scan<'a>(
    rules: &Rules,
    data: &'a [u8],
    mut at: usize,
    stop: usize,
    at_end: bool,
    sink: &mut impl Sink<'a>,
) -> usize {
    let header = rules.frame().header.first().copied().unwrap_or_default();
    let mut run = (at, Reason::NoHeader);
    while at < stop {
        let reason = match rules.validate(data.get(at..).unwrap_or_default()) {
            Verdict::Frame(frame) => {
                close(run, at, sink);
                sink.frame(at, frame);
                at += frame.bytes().len();
                run.0 = at;
                continue;
            }
            Verdict::Rejected(reason) => reason,
            Verdict::Waits if at_end => Reason::Truncated,
            Verdict::Waits => break,
        };
        if reason != run.1 {
            close(run, at, sink);
            run = (at, reason);
        }
        at += 1;
        if reason == Reason::NoHeader && at - run.0 >= LONG_RUN {
            let rest = data.get(at..stop).unwrap_or_default();
            at += without(rest, header);
        }
    }
    close(run, at, sink);
    at
}

#[inline]
fn close<'a>(run: (usize, Reason), end: usize, sink: &mut impl Sink<'a>) {
    let (from, reason) = run;
    if from < end {
        sink.noise(from, end, reason);
    }
}

/// Return a number of leading bytes, a multiple of the step, that do not contain `byte`.
#[inline]
fn without(bytes: &[u8], byte: u8) -> usize {
    let clear = |chunk: &&[u8; STEP]| !chunk.iter().fold(false, |any, each| any | (*each == byte));
    bytes.as_chunks().0.iter().take_while(clear).count() * STEP
}
