//! Frames sorted by group, so that each group is decoded in one go.

use super::block::{Found, MOST};

/// To add to a bucket is to read, and write, its count: the processor waits for that if the next
/// frame goes to the same one. So the frames are dealt out in as many parts.
const PARTS: usize = 4;
const SIZE: usize = MOST / PARTS;

/// The frames of one block or lane by part and group.
pub(crate) struct Buckets {
    parts: [Part; PARTS],
}

struct Part {
    frames: Vec<[u16; SIZE]>,
    counts: Vec<u16>,
}

impl Buckets {
    pub(crate) fn new(groups: usize) -> Self {
        Self {
            parts: std::array::from_fn(|_| Part {
                frames: vec![[0; SIZE]; groups],
                counts: vec![0; groups],
            }),
        }
    }

    /// Sort `found`, which are at most as many as a block can hold.
    pub(crate) fn fill(&mut self, found: &[Found]) {
        let each = found.len().div_ceil(PARTS);
        let [a, b, c, d] = &mut self.parts;
        let (first, rest) = found.split_at(each.min(found.len()));
        let (second, rest) = rest.split_at(each.min(rest.len()));
        let (third, fourth) = rest.split_at(each.min(rest.len()));
        let together = first.iter().zip(second).zip(third).zip(fourth);
        for (((first, second), third), fourth) in together {
            a.push(*first);
            b.push(*second);
            c.push(*third);
            d.push(*fourth);
        }
        for (part, all) in [(a, first), (b, second), (c, third)] {
            all.iter()
                .skip(fourth.len())
                .for_each(|found| part.push(*found));
        }
    }

    /// Empty them: each group with its frames, which come in order.
    pub(crate) fn drain(&mut self, mut take: impl FnMut(usize, &[u16])) {
        for part in &mut self.parts {
            let groups = part.frames.iter().zip(&mut part.counts).enumerate();
            for (group, (frames, count)) in groups.filter(|(_, (_, count))| **count > 0) {
                take(group, frames.get(..usize::from(*count)).unwrap_or_default());
                *count = 0;
            }
        }
    }
}

impl Part {
    #[inline(always)]
    #[allow(clippy::indexing_slicing)] // in bounds by the mask
    fn push(&mut self, found: Found) {
        let group = usize::from(found.group());
        // A frame of no group has an unknown id.
        if let (Some(frames), Some(count)) =
            (self.frames.get_mut(group), self.counts.get_mut(group))
        {
            frames[usize::from(*count) % SIZE] = found.at();
            *count += 1;
        }
    }
}
