//! Counts the messages of a stream, without their values.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::block::{Block, Found, LANES};
use super::buckets::Buckets;
use super::decode::Job;
use super::plan::{Plan, Plans};
use super::search::Collect;
use crate::frame::Part;
use crate::table::Table;

/// How often a message occurred.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counted {
    /// The id of its frames.
    pub id: u16,
    /// The index of its command; `None`: no message has that id, or none allows the values.
    pub command: Option<usize>,
    /// How many frames there are.
    pub count: u64,
    /// The position of the first one.
    pub first: u64,
}

/// Counts the messages of a stream, and optionally keeps the positions of their frames.
pub(crate) struct Counts {
    table: Arc<Table>,
    plans: Arc<Plans>,
    buckets: Buckets,
    id: Part,
    counted: BTreeMap<(u16, Option<usize>), Counted>,
    /// The positions of the frames, if they are kept.
    pub(crate) frames: Option<Vec<u64>>,
}

impl Counts {
    pub(crate) fn new(table: Arc<Table>, plans: Arc<Plans>, keep: bool) -> Self {
        Self {
            buckets: Buckets::default(),
            id: table.frame().layout.id,
            table,
            plans,
            counted: BTreeMap::new(),
            frames: keep.then(Vec::new),
        }
    }

    /// Return the counts, in the order of the first frames.
    pub(crate) fn counted(&self) -> Vec<Counted> {
        let mut all: Vec<Counted> = self.counted.values().copied().collect();
        all.sort_unstable_by_key(|counted| counted.first);
        all
    }
}

impl Collect for Counts {
    fn take(&mut self, offset: u64, block: &Block, found: [&[Found]; LANES]) {
        if let Some(frames) = &mut self.frames {
            let all = found.into_iter().flatten();
            frames.extend(all.map(|frame| offset + u64::from(frame.at())));
        }
        let counted = &mut self.counted;
        let mut add = |id, command, count, first| {
            let key = (id, command);
            let entry = counted.entry(key).or_insert_with(|| Counted {
                id,
                command,
                count: 0,
                first,
            });
            entry.count += count;
            entry.first = entry.first.min(first);
        };
        let groups = self.plans.groups.len();
        self.buckets.sort(groups, found, |group, frames| {
            let Some(plan) = self.plans.groups.get(group) else {
                return;
            };
            let job = Job {
                table: &self.table,
                block,
                offset,
                frames,
            };
            job.count(plan, |index, count, first| {
                add(
                    plan.id,
                    index.and_then(|index| command(plan, index)),
                    count,
                    first,
                );
            });
        });
        let unknown = found.into_iter().flatten();
        for frame in unknown.filter(|frame| frame.is_unknown()) {
            let bytes = block.get(frame.at() as usize..).unwrap_or_default();
            let id = self.id.read(bytes).unwrap_or_default();
            add(id, None, 1, offset + u64::from(frame.at()));
        }
    }
}

fn command(plan: &Plan, index: usize) -> Option<usize> {
    plan.variants.get(index).map(|variant| variant.command)
}
