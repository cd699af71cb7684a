//! Estimates the number of frames in a capture from parts of it, to allocate memory once.

use super::block::{Block, Found, LANES};
use super::search::Collect;
use super::stream::Stream;
use crate::rules::Rules;

/// For smaller input, an estimate costs more than it saves.
const WORTH: usize = 1 << 20;
/// The number of parts that are read, and their size.
const PARTS: usize = 16;
const PART_SIZE: usize = 1 << 14;

/// Estimate the number of frames of each group in `data`; the estimate is rarely too low. It is
/// empty for small input.
pub(crate) fn expected(rules: &Rules, groups: usize, data: &[u8]) -> Vec<usize> {
    if data.len() < WORTH {
        return Vec::new();
    }
    let mut stream = Stream::new(rules.clone());
    let mut seen = Seen(vec![0; groups]);
    for part in data.chunks(data.len() / PARTS) {
        stream.feed(part.get(..PART_SIZE).unwrap_or(part), &mut seen);
        stream.flush(&mut seen);
    }
    let sampled = (PARTS * PART_SIZE) as u64;
    let estimate = |count: u64| {
        // The added sixteenth makes a low estimate rare.
        let all = (count + count / 16) * data.len() as u64 / sampled;
        usize::try_from(all).unwrap_or_default()
    };
    seen.0.into_iter().map(estimate).collect()
}

struct Seen(Vec<u64>);

impl Collect for Seen {
    fn take(&mut self, _: u64, _: &Block, found: [&[Found]; LANES]) {
        for frame in found.into_iter().flatten() {
            if let Some(count) = self.0.get_mut(frame.group()) {
                *count += 1;
            }
        }
    }
}
