//! The values of a whole stream, in a column for each field of each message.

use std::sync::Arc;

use super::block::{Block, Found, LANES};
use super::buckets::Buckets;
use super::cells::{Advise, Numbers, reserve};
use super::decode::Job;
use super::plan::Plans;
use super::rows::Rows;
use super::sample::expected;
use super::search::{Collect, Space};
use super::spans::Spans;
use super::speculative::{Share, Workers};
use super::stream::Stream;
use crate::table::Table;
use crate::tally::Tally;

/// The messages of a segment of a stream.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// One entry for each variant of the table in the reader's directions.
    pub rows: Vec<Rows>,
    /// The positions of legal frames with a number that no variant allows, in the order of the
    /// stream.
    pub rejected: Vec<u64>,
    /// The noise between the frames.
    pub noise: Spans,
}

/// What a reader found since the last [`ColumnReader::take`].
pub(crate) struct Progress<'a> {
    pub(crate) rows: &'a [Rows],
    pub(crate) rejected: &'a [u64],
    /// The positions of the spans of noise that a frame or a flush has ended.
    pub(crate) noise: &'a [u64],
    /// The position of the noise that may continue.
    pub(crate) open_noise: Option<u64>,
}

/// Memory for reading. Readers share it, since only one of them runs at a time.
#[derive(Default)]
pub(crate) struct Workspace {
    space: Space,
    buckets: Buckets,
}

/// Decodes a stream into columns.
pub struct ColumnReader {
    stream: Stream,
    workers: Workers,
    sorter: Sorter,
}

struct Sorter {
    table: Arc<Table>,
    plans: Arc<Plans>,
    buckets: Buckets,
    rows: Vec<Rows>,
    rejected: Vec<u64>,
}

impl ColumnReader {
    /// Return a reader for a new stream; it reuses the memory of `old` columns.
    #[must_use]
    pub fn new(
        table: Arc<Table>,
        plans: Arc<Plans>,
        numbers: Numbers,
        old: Option<Columns>,
    ) -> Self {
        let variants = plans.groups.iter().flat_map(|plan| &plan.variants);
        let mut rows: Vec<Rows> = variants
            .map(|variant| Rows::new(&table, *variant, numbers))
            .collect();
        let mut old = old.unwrap_or_default();
        for old in old.rows {
            if let Some(new) = rows.iter_mut().find(|new| new.variant == old.variant) {
                new.reuse(old);
            }
        }
        old.rejected.clear();
        Self {
            stream: Stream::new(table.rules(plans.listening).clone()).reusing(old.noise),
            workers: Workers::ONE,
            sorter: Sorter {
                table,
                buckets: Buckets::default(),
                plans,
                rows,
                rejected: old.rejected,
            },
        }
    }

    /// Return this reader, for a segment that begins at `offset` of its stream.
    #[must_use]
    pub fn starting_at(mut self, offset: u64) -> Self {
        self.stream.start_at(offset);
        self
    }

    /// Read large chunks with several threads; the results stay the same.
    pub fn set_workers(&mut self, workers: Workers) {
        self.workers = workers;
    }

    /// Return the number of threads that read large chunks.
    #[must_use]
    pub fn workers(&self) -> Workers {
        self.workers
    }

    /// Reserve memory for the values of `data`; their number is estimated from samples of it.
    pub fn expect(&mut self, data: &[u8], advise: Advise) {
        let Sorter {
            table, plans, rows, ..
        } = &mut self.sorter;
        let has_address = table.frame().layout.address_at.is_some();
        let counts = expected(self.stream.rules(), plans.groups.len(), data);
        for (plan, count) in plans.groups.iter().zip(counts) {
            let first = plan.variants.first();
            let Some(rows) = rows.iter_mut().find(|rows| Some(&rows.variant) == first) else {
                continue;
            };
            reserve(&mut rows.offsets, count, advise);
            if has_address {
                reserve(&mut rows.addresses, count, advise);
            }
            for (field, cells) in plan.fields.iter().flatten().zip(&mut rows.fields) {
                cells.reserve(count * field.numbers.len(), advise);
            }
        }
    }

    /// Feed bytes; [`ColumnReader::take`] returns the frames that more bytes cannot change.
    pub fn feed(&mut self, chunk: &[u8]) {
        self.stream.feed_with(self.workers, chunk, &mut self.sorter);
    }

    /// Reject the pending candidate.
    pub fn flush(&mut self) {
        self.stream.flush(&mut self.sorter);
    }

    /// Swap the memory for reading with `work`; call this before and after feeding or flushing.
    pub(crate) fn exchange(&mut self, work: &mut Workspace) {
        self.stream.exchange(&mut work.space);
        std::mem::swap(&mut self.sorter.buckets, &mut work.buckets);
    }

    /// Return what was found since the last [`ColumnReader::take`], in the order of the stream.
    pub(crate) fn found(&mut self) -> Progress<'_> {
        // Within a block, rejected frames are found group by group.
        self.sorter.rejected.sort_unstable();
        let noise = self.stream.noise();
        Progress {
            rows: &self.sorter.rows,
            rejected: &self.sorter.rejected,
            noise: noise.closed(),
            open_noise: noise.open().map(|(from, _)| from),
        }
    }

    /// Return everything found since the last call.
    pub fn take(&mut self) -> Columns {
        let mut rejected = std::mem::take(&mut self.sorter.rejected);
        // Within a block, rejected frames are found group by group.
        rejected.sort_unstable();
        Columns {
            rows: self.sorter.rows.iter_mut().map(Rows::take).collect(),
            rejected,
            noise: self.stream.take_noise(),
        }
    }

    /// Return the counts since the start of the stream.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        self.stream.tally()
    }

    /// Return the number of bytes that may still become part of a frame.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.stream.pending()
    }
}

impl Collect for Sorter {
    fn take(&mut self, offset: u64, block: &Block, found: [&[Found]; LANES]) {
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
            job.run(plan, &mut self.rows, &mut self.rejected);
        });
    }
}

impl Share for Sorter {
    fn part(&self) -> Self {
        Self {
            table: Arc::clone(&self.table),
            plans: Arc::clone(&self.plans),
            buckets: Buckets::default(),
            rows: self.rows.iter().map(Rows::like).collect(),
            rejected: Vec::new(),
        }
    }

    fn append(&mut self, part: &mut Self) {
        for (rows, part) in self.rows.iter_mut().zip(&mut part.rows) {
            rows.append(part);
        }
        self.rejected.append(&mut part.rejected);
    }

    fn clear(&mut self) {
        self.rows.iter_mut().for_each(Rows::clear);
        self.rejected.clear();
    }
}
