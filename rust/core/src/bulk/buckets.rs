//! Frames sorted by group, so that each group is decoded at once.

use super::block::{Found, LANES};

/// The frames of some lanes, by lane and group.
///
/// Adding to a bucket reads and writes its size, and the processor waits for that if the next frame
/// goes to the same bucket. Therefore the lanes alternate, and each has its own buckets.
#[derive(Default)]
pub(crate) struct Buckets {
    parts: [Vec<Vec<u16>>; LANES],
}

impl Buckets {
    /// Have buckets for that number of groups; they are empty.
    pub(crate) fn fit(&mut self, groups: usize) {
        for part in &mut self.parts {
            part.resize(groups, Vec::new());
        }
    }

    /// Sort the frames of all lanes.
    pub(crate) fn fill(&mut self, lanes: [&[Found]; LANES]) {
        let [a, b, c] = &mut self.parts;
        let [first, second, third] = lanes;
        for ((first, second), third) in first.iter().zip(second).zip(third) {
            push(a, *first);
            push(b, *second);
            push(c, *third);
        }
        let common = lanes
            .map(<[Found]>::len)
            .into_iter()
            .min()
            .unwrap_or_default();
        for (part, lane) in self.parts.iter_mut().zip(lanes) {
            lane.iter()
                .skip(common)
                .for_each(|found| push(part, *found));
        }
    }

    /// Pass on each group with its frames, in the order of the lanes, and empty the buckets.
    pub(crate) fn drain(&mut self, mut take: impl FnMut(usize, &[u16])) {
        let [first, second, third] = &mut self.parts;
        let groups = first.iter_mut().zip(second).zip(third).enumerate();
        for (group, ((frames, more), rest)) in groups {
            frames.append(more);
            frames.append(rest);
            if !frames.is_empty() {
                take(group, frames);
                frames.clear();
            }
        }
    }
}

#[inline(always)]
fn push(part: &mut [Vec<u16>], found: Found) {
    // A frame without a group has an unknown id.
    if let Some(frames) = part.get_mut(usize::from(found.group())) {
        frames.push(found.at());
    }
}
