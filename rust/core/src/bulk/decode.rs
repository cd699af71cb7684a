//! The frames of one group into the columns of their forms.

use super::block::Block;
use super::cells::Cells;
use super::columns::Rows;
use super::plan::{Allowed, FieldPlan, Plan};
use crate::field::Number;
use crate::read::{Reader, Value, physical, whole};
use crate::table::Table;

/// What the frames of a group are read from and into.
pub(crate) struct Job<'a> {
    pub(crate) table: &'a Table,
    pub(crate) block: &'a Block,
    /// Where the block stands in the stream.
    pub(crate) offset: u64,
    /// Where the frames start in the block.
    pub(crate) frames: &'a [u16],
}

impl Job<'_> {
    /// Append the frames to the rows of their forms; those that no form allows to `refused`.
    pub(crate) fn run(&self, plan: &Plan, rows: &mut [Rows], refused: &mut Vec<u64>) {
        if let (Some(fields), Some(rows)) = (&plan.fields, rows.get_mut(plan.rows))
            && fields.iter().all(|field| self.all_allowed(field))
        {
            rows.offsets
                .extend(self.frames.iter().map(|at| self.place(*at)));
            for (field, cells) in fields.iter().zip(&mut rows.fields) {
                self.column(field, cells);
            }
            return;
        }
        for at in self.frames {
            if !self.row(plan, *at, rows) {
                refused.push(self.place(*at));
            }
        }
    }

    fn place(&self, at: u16) -> u64 {
        self.offset + u64::from(at)
    }

    #[allow(clippy::indexing_slicing)] // in bounds: a frame that starts in the block ends in it
    fn all_allowed(&self, plan: &FieldPlan) -> bool {
        match &plan.allowed {
            Allowed::All => true,
            Allowed::Bytes(bytes) => self.frames.iter().all(|at| {
                let byte = self.block[usize::from(*at) + usize::from(plan.start)];
                bytes[usize::from(byte)]
            }),
            Allowed::Some(field) => self.numbers(plan, |number, whole| field.allows(number, whole)),
        }
    }

    /// Ask of each number of a field, until one says no.
    fn numbers(&self, plan: &FieldPlan, mut ask: impl FnMut(&Number, i64) -> bool) -> bool {
        self.frames.iter().all(|at| {
            let mut start = usize::from(*at) + usize::from(plan.start);
            plan.numbers.iter().all(|number| {
                let read = whole(number, self.block, start);
                start += number.width;
                ask(number, read)
            })
        })
    }

    fn column(&self, plan: &FieldPlan, cells: &mut Cells) {
        let (frames, start) = (self.frames, plan.start);
        let block = self.block;
        match (&plan.words, cells) {
            (Some(words), Cells::F64(out)) => words.physical(block, frames, start, out),
            (Some(words), Cells::U8(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::I8(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::U16(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::I16(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::I32(out)) => words.raw(block, frames, start, out),
            (_, cells) => {
                self.numbers(plan, |number, whole| {
                    cells.push(whole, physical(number, whole));
                    true
                });
            }
        }
    }

    /// One frame, by the first form that allows its values; whether there is one.
    fn row(&self, plan: &Plan, at: u16, all: &mut [Rows]) -> bool {
        let data = self.table.frame().overhead() + 1;
        for (form, rows) in plan.forms.iter().zip(all.iter_mut().skip(plan.rows)) {
            let Some(layout) = self.table.layout(*form) else {
                continue;
            };
            let start = usize::from(at) + data;
            let reader = Reader {
                form: *form,
                layout,
                data: self
                    .block
                    .get(start..start + layout.size())
                    .unwrap_or_default(),
                offset: data,
            };
            let Ok(values) = reader.numbers() else {
                continue;
            };
            rows.offsets.push(self.place(at));
            push(values, &mut rows.fields);
            return true;
        }
        false
    }
}

/// Each field's numbers to its column.
fn push(values: Vec<(usize, i64, Value)>, fields: &mut [Cells]) {
    for (field, whole, physical) in values {
        if let Some(cells) = fields.get_mut(field) {
            cells.push(whole, physical);
        }
    }
}
