//! Work grows with the input and not faster, whatever the input.

use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

use crate::input::Input;

const SHORT: usize = 8 << 10;
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
    let short = repeated(&input.stream, SHORT);
    let long = repeated(&input.stream, SHORT * TIMES);
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
        let mut framer = input.framer();
        for chunk in &chunks {
            framer.feed(chunk.bytes, |_| ());
            if chunk.flush {
                framer.flush(|_| ());
            }
        }
        framer.flush(|_| ());
    }
    own_time() - started
}

/// What this thread has computed so far.
fn own_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::new(time.tv_sec as u64, time.tv_nsec as u32)
}
