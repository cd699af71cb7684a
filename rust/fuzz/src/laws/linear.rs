//! Work grows with the input and not faster, whatever the input.

use std::time::Duration;

use cobotwire_core::OffsetReader;
use rustix::time::{ClockId, clock_gettime};

use crate::input::{Chunk, Input};

/// For the framer, and for bulk reading, whose blocks are longer than the other.
const SHORT: [usize; 2] = [8 << 10, 128 << 10];
const TIMES: usize = 8;
/// Quadratic work would take `TIMES` times as long.
const MOST: u32 = 3;
/// Others' use of the caches makes one measurement slow, but not all of them.
const TRIES: usize = 12;

/// A byte of a stream takes at most three times as long in one of eight times the length; the
/// fuzz bytes are the pattern that is repeated.
pub fn work_grows_with_the_input(data: &[u8]) {
    let input = Input::read(data);
    if input.stream.is_empty() {
        return;
    }
    let size = SHORT[usize::from(input.long)];
    let short = repeated(&input.stream, size);
    let long = repeated(&input.stream, size * TIMES);
    let (mut least_short, mut least_long) = (Duration::MAX, Duration::MAX);
    for _ in 0..TRIES {
        // The short one as often as to read as many bytes.
        least_short = least_short.min(time(&input, &short, TIMES));
        least_long = least_long.min(time(&input, &long, 1));
        if least_long <= least_short * MOST {
            return;
        }
    }
    panic!("{least_long:?} for what takes {least_short:?} in {TIMES} pieces");
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

/// What this thread has computed so far.
fn own_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}
