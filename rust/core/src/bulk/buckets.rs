//! Frames sorted by group, so that each group is decoded at once.

use super::block::{Found, LANES};

/// The frames of some lanes, by group and lane.
///
/// A counting sort: the frames of each group are counted first, and then stored at their indices.
/// If two consecutive frames increment the same counter, the processor waits for the first
/// increment. Therefore the lanes alternate, and each has its own counters.
#[derive(Default)]
pub(crate) struct Buckets {
    /// For each group, the number of frames in each lane; later the index of the next one.
    next: Vec<[u32; LANES]>,
    /// The positions of all frames.
    sorted: Vec<u32>,
}

impl Buckets {
    /// Sort the frames of all lanes by group. Pass each group that has frames to `take`; its frames
    /// are in the order of the lanes.
    pub(crate) fn sort(
        &mut self,
        groups: usize,
        lanes: [&[Found]; LANES],
        mut take: impl FnMut(usize, &[u32]),
    ) {
        self.next.clear();
        self.next.resize(groups, [0; LANES]);
        let next = &mut self.next;
        each(lanes, |lane, found| {
            // A frame without a group has an unknown id.
            if let Some(count) = next
                .get_mut(found.group())
                .and_then(|all| all.get_mut(lane))
            {
                *count += 1;
            }
        });
        let mut end = 0;
        for count in next.iter_mut().flatten() {
            end += std::mem::replace(count, end);
        }
        let most = end as usize;
        if self.sorted.len() < most {
            self.sorted.resize(most, 0);
        }
        let sorted = self.sorted.as_mut_slice();
        each(lanes, |lane, found| {
            if let Some(place) = next
                .get_mut(found.group())
                .and_then(|all| all.get_mut(lane))
                && let Some(entry) = sorted.get_mut(*place as usize)
            {
                *entry = found.at();
                *place += 1;
            }
        });
        let mut from = 0;
        for (group, [.., end]) in next.iter().enumerate() {
            let end = *end as usize;
            match sorted.get(from..end) {
                Some(frames) if !frames.is_empty() => take(group, frames),
                _ => {}
            }
            from = end;
        }
    }
}

/// Call `add` with each frame and the index of its lane; the lanes alternate.
#[inline(always)]
fn each(lanes: [&[Found]; LANES], mut add: impl FnMut(usize, Found)) {
    let [first, second, third] = lanes;
    for ((first, second), third) in first.iter().zip(second).zip(third) {
        add(0, *first);
        add(1, *second);
        add(2, *third);
    }
    let common = lanes.map(<[Found]>::len).into_iter().min();
    for (index, lane) in lanes.into_iter().enumerate() {
        for found in lane.iter().skip(common.unwrap_or_default()) {
            add(index, *found);
        }
    }
}
