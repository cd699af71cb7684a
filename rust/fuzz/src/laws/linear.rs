//! Checks that the work is linear in the size of every input.

use std::time::Duration;

use cobotwire_core::OffsetReader;
use rustix::time::{ClockId, clock_gettime};

use crate::input::{Chunk, Input};

/// The size of the short stream: for the framer, and for bulk reading, which reads longer blocks.
const SHORT: [usize; 2] = [8 << 10, 128 << 10];
const TIMES: usize = 8;
/// Quadratic work would take `TIMES` times as long.
const MOST: u32 = 3;
/// Other processes use the same caches and so slow down some measurements, but not all.
const ATTEMPTS: usize = 12;

/// Check that a byte takes at most three times as long in a stream of eight times the length; both
/// streams repeat the stream of the fuzz bytes.
pub fn work_grows_with_the_input(data: &[u8]) {
    let input = Input::read(data);
    if input.stream.is_empty() {
        return;
    }
    let size = SHORT[usize::from(input.long)];
    let short = repeated(&input.stream, size);
    let long = repeated(&input.stream, size * TIMES);
    let (mut least_short, mut least_long) = (Duration::MAX, Duration::MAX);
    for _ in 0..ATTEMPTS {
        // Read the short stream eight times, so that both read the same number of bytes.
        least_short = least_short.min(time(&input, &short, TIMES));
        least_long = least_long.min(time(&input, &long, 1));
        if least_long <= least_short * MOST {
            return;
        }
    }
    panic!("one long stream took {least_long:?}, {TIMES} short ones {least_short:?}");
}

fn repeated(pattern: &[u8], size: usize) -> Vec<u8> {
    pattern.iter().copied().cycle().take(size).collect()
}

fn time(input: &Input, stream: &[u8], times: usize) -> Duration {
    let chunks = input.cutting.cut(stream);
    let started = own_time();
    for _ in 0..times {
        if input.long {
            read(input, &chunks);
        } else {
            cut(input, &chunks);
        }
    }
    own_time() - started
}

fn cut(input: &Input, chunks: &[Chunk<'_>]) {
    let mut framer = input.framer();
    for chunk in chunks {
        framer.feed(chunk.bytes, |_| ());
        if chunk.flush {
            framer.flush(|_| ());
        }
    }
    framer.flush(|_| ());
}

fn read(input: &Input, chunks: &[Chunk<'_>]) {
    let mut reader = OffsetReader::new(input.rules().clone(), None);
    for chunk in chunks {
        reader.expect(chunk.bytes, |_, _| ());
        reader.feed(chunk.bytes);
        reader.take();
    }
    reader.flush();
}

/// Return the processor time of this thread.
fn own_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}
