//! The scan of contiguous bytes: each position is judged once, and a frame is passed over whole.

use crate::error::Reason;
use crate::frame::Frame;
use crate::judge::{Rules, Verdict};

/// Takes what a scan finds, in the order of the stream; positions count from the start of its data.
pub(crate) trait Sink<'a> {
    /// A frame stands at `at`.
    fn frame(&mut self, at: usize, frame: Frame<'a>);

    /// The bytes from `from` to before `to` are noise, each for this reason.
    fn noise(&mut self, from: usize, to: usize, reason: Reason);
}

/// So many bytes of noise without a header make it likely that the next ones are none either.
const LONG_RUN: usize = 8;
/// How many are then looked at together.
const STEP: usize = 16;

/// Judge the positions from `at` to `stop`. Gives the first that waits for more bytes (at the end
/// of the stream none does), else where the last frame ends, which may be behind `stop`.
#[inline]
pub(crate) fn scan<'a>(
    rules: &Rules,
    data: &'a [u8],
    mut at: usize,
    stop: usize,
    at_end: bool,
    sink: &mut impl Sink<'a>,
) -> usize {
    let [header, _] = rules.frame().header;
    let mut run = (at, Reason::NoHeader);
    while at < stop {
        let reason = match rules.judge(data.get(at..).unwrap_or_default()) {
            Verdict::Stands(frame) => {
                close(run, at, sink);
                sink.frame(at, frame);
                at += frame.bytes().len();
                run.0 = at;
                continue;
            }
            Verdict::Refuted(reason) => reason,
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

/// How many bytes at the start surely are not `byte`; a multiple of the step.
#[inline]
fn without(bytes: &[u8], byte: u8) -> usize {
    let clear = |chunk: &&[u8; STEP]| !chunk.iter().fold(false, |any, each| any | (*each == byte));
    bytes.as_chunks().0.iter().take_while(clear).count() * STEP
}
