//! The values of a whole stream, in a column for each field of each message.

use std::sync::Arc;

use super::block::{Block, Found, LANES};
use super::buckets::Buckets;
use super::cells::{Advise, Cells, Numbers, reserve};
use super::decode::Job;
use super::plan::Plans;
use super::sample::expected;
use super::spans::Spans;
use super::stream::{Collect, Stream};
use crate::legal::Form;
use crate::table::Table;
use crate::tally::Tally;

/// All frames of one form, in the order of the stream.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// Which form.
    pub form: Form,
    /// Where each frame starts.
    pub offsets: Vec<u64>,
    /// A column for each field. One of a row of numbers has as many a frame.
    pub fields: Vec<Cells>,
}

/// The messages of a stretch of a stream.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// One for each form of the table that is listened to.
    pub rows: Vec<Rows>,
    /// Where frames start that are legal but hold a number that their form does not allow.
    pub refused: Vec<u64>,
    /// The noise between the frames.
    pub noise: Spans,
}

/// Decodes a stream into columns.
pub struct ColumnReader {
    stream: Stream,
    sorter: Sorter,
}

struct Sorter {
    table: Arc<Table>,
    plans: Arc<Plans>,
    buckets: Buckets,
    rows: Vec<Rows>,
    refused: Vec<u64>,
}

impl ColumnReader {
    /// A reader at the start of a stream, with the memory of what an earlier one found, if any.
    #[must_use]
    pub fn new(
        table: Arc<Table>,
        plans: Arc<Plans>,
        numbers: Numbers,
        old: Option<Columns>,
    ) -> Self {
        let forms = plans.groups.iter().flat_map(|plan| &plan.forms);
        let mut rows: Vec<Rows> = forms
            .map(|form| Rows::new(&table, *form, numbers))
            .collect();
        let mut refused = Vec::new();
        if let Some(mut old) = old {
            for old in old.rows {
                if let Some(new) = rows.iter_mut().find(|new| new.form == old.form) {
                    new.reuse(old);
                }
            }
            old.refused.clear();
            refused = old.refused;
        }
        Self {
            stream: Stream::new(table.rules(plans.listening).clone()),
            sorter: Sorter {
                table,
                buckets: Buckets::new(plans.groups.len()),
                plans,
                rows,
                refused,
            },
        }
    }

    /// Ask for the memory that the values of `data` will need, as far as a look at parts of it tells.
    pub fn expect(&mut self, data: &[u8], advise: Advise) {
        let Sorter { plans, rows, .. } = &mut self.sorter;
        let counts = expected(self.stream.rules(), plans.groups.len(), data);
        for (plan, count) in plans.groups.iter().zip(counts) {
            let first = plan.forms.first();
            let Some(rows) = rows.iter_mut().find(|rows| Some(&rows.form) == first) else {
                continue;
            };
            reserve(&mut rows.offsets, count, advise);
            for (field, cells) in plan.fields.iter().flatten().zip(&mut rows.fields) {
                cells.reserve(count * field.numbers.len(), advise);
            }
        }
    }

    /// Take bytes; the frames that are certain are kept for [`ColumnReader::take`].
    pub fn feed(&mut self, chunk: &[u8]) {
        self.stream.feed(chunk, &mut self.sorter);
    }

    /// Refute what still waits.
    pub fn flush(&mut self) {
        self.stream.flush(&mut self.sorter);
    }

    /// What was found since the last time.
    pub fn take(&mut self) -> Columns {
        Columns {
            rows: self.sorter.rows.iter_mut().map(Rows::take).collect(),
            refused: std::mem::take(&mut self.sorter.refused),
            noise: self.stream.take_noise(),
        }
    }

    /// What came so far.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        self.stream.tally()
    }

    /// Bytes fed that are not accounted for yet.
    #[must_use]
    pub fn pending(&self) -> usize {
        self.stream.pending()
    }
}

impl Rows {
    fn new(table: &Table, form: Form, numbers: Numbers) -> Self {
        let fields = table.layout(form).map_or(&[][..], |layout| layout.fields());
        Self {
            form,
            offsets: Vec::new(),
            fields: fields
                .iter()
                .map(|field| Cells::new(field, numbers))
                .collect(),
        }
    }

    /// Take over the memory of columns of the same types.
    fn reuse(&mut self, old: Self) {
        let alike = |(new, old): (&Cells, &Cells)| {
            std::mem::discriminant(new) == std::mem::discriminant(old)
        };
        let columns = self.fields.len() == old.fields.len();
        if columns && self.fields.iter().zip(&old.fields).all(alike) {
            *self = old;
            self.offsets.clear();
            self.fields.iter_mut().for_each(Cells::clear);
        }
    }

    /// What is in it; what stays is empty and of the same types.
    fn take(&mut self) -> Self {
        let empty = Self {
            form: self.form,
            offsets: Vec::new(),
            fields: self.fields.iter().map(Cells::like).collect(),
        };
        std::mem::replace(self, empty)
    }
}

impl Collect for Sorter {
    fn take(&mut self, offset: u64, block: &Block, found: [&[Found]; LANES], tally: &mut Tally) {
        self.buckets.fill(found);
        self.buckets.drain(|group, frames| {
            let Some(plan) = self.plans.groups.get(group) else {
                return;
            };
            tally.add_frames(plan.id, frames.len() as u64);
            let job = Job {
                table: &self.table,
                block,
                offset,
                frames,
            };
            job.run(plan, &mut self.rows, &mut self.refused);
        });
    }
}
