//! Decodes the frames of one group into the columns of their variants.

use super::block::{BLOCK, Block, MARGIN};
use super::cells::Cells;
use super::plan::{Allowed, FieldPlan, Plan};
use super::rows::Rows;
use crate::number::{Number, Value};
use crate::read::Reader;
use crate::table::Table;

/// The numbers of a frame: the index of the field, the raw and the physical value of each.
type Numbers = Vec<(usize, i64, Value)>;

/// A group of at most this many frames is read one by one if one of them is not allowed.
const FEW: usize = 8;

/// The frames of a group in a block.
pub(crate) struct Job<'a> {
    pub(crate) table: &'a Table,
    pub(crate) block: &'a Block,
    /// The position of the block in the stream.
    pub(crate) offset: u64,
    /// The positions of the frames in the block.
    pub(crate) frames: &'a [u32],
}

impl Job<'_> {
    /// Append the frames to the rows of their variants, or to `rejected` if no variant allows them.
    pub(crate) fn run(&self, plan: &Plan, rows: &mut [Rows], rejected: &mut Vec<u64>) {
        if let (Some(fields), Some(rows)) = (&plan.fields, rows.get_mut(plan.rows))
            && self.columns(fields, rows)
        {
            return;
        }
        // Split the group, so that most frames are still read together if one is not allowed.
        if plan.fields.is_some() && self.frames.len() > FEW {
            let (first, second) = self.frames.split_at(self.frames.len() / 2);
            for frames in [first, second] {
                Job { frames, ..*self }.run(plan, rows, rejected);
            }
            return;
        }
        for at in self.frames {
            if !self.row(plan, *at, rows) {
                rejected.push(self.place(*at));
            }
        }
    }

    /// Append the frames to the rows of their first variant, column by column. If the variant does
    /// not allow all frames, append nothing and return false.
    fn columns(&self, fields: &[FieldPlan], rows: &mut Rows) -> bool {
        let mut all = fields.iter().zip(&mut rows.fields);
        if let Some(failed) = all.position(|(field, cells)| !self.column(field, cells)) {
            for (field, cells) in fields.iter().zip(&mut rows.fields).take(failed) {
                cells.remove_last(self.frames.len() * field.numbers.len());
            }
            return false;
        }
        rows.offsets
            .extend(self.frames.iter().map(|at| self.place(*at)));
        if let Some(place) = self.table.frame().layout.address_at {
            let addresses = self.frames.iter().filter_map(|at| self.address(*at, place));
            rows.addresses.extend(addresses);
        }
        true
    }

    fn place(&self, at: u32) -> u64 {
        self.offset + u64::from(at)
    }

    /// Return the address byte of a frame. It is never `None`, since a frame ends in its block.
    fn address(&self, at: u32, place: usize) -> Option<u8> {
        self.block.get(at as usize + place).copied()
    }

    #[allow(clippy::indexing_slicing)] // in bounds: a frame that starts in the block ends in it
    fn all_allowed(&self, plan: &FieldPlan) -> bool {
        match &plan.allowed {
            Allowed::All => true,
            Allowed::Bytes(bytes) => self.frames.iter().all(|at| {
                let byte = self.block[*at as usize % BLOCK + usize::from(plan.start) % MARGIN];
                bytes[usize::from(byte)]
            }),
            Allowed::Within(bounds) => plan
                .words
                .as_ref()
                .is_some_and(|words| words.within(self.block, self.frames, plan.start, bounds)),
            Allowed::Some(field) => self.numbers(plan, |number, raw| field.allows(number, raw)),
        }
    }

    /// Call `check` with each number of a field, until it returns false.
    fn numbers(&self, plan: &FieldPlan, mut check: impl FnMut(&Number, i64) -> bool) -> bool {
        self.frames.iter().all(|at| {
            let mut start = (*at as usize) + usize::from(plan.start);
            plan.numbers.iter().all(|number| {
                let read = number.unpack(self.block, start);
                start += number.step();
                check(number, read)
            })
        })
    }

    /// Append the numbers of a field, if all are allowed; return whether they are.
    fn column(&self, plan: &FieldPlan, cells: &mut Cells) -> bool {
        let (block, frames, start) = (self.block, self.frames, plan.start);
        if let Some(six) = &plan.six {
            let starts = frames.iter().map(|at| *at as usize + usize::from(start));
            let appended = match cells {
                Cells::F64(out) => six.append_physical(out, block, starts),
                Cells::I16(out) => six.append_raw(out, block, starts),
                _ => None,
            };
            if let Some(appended) = appended {
                return appended;
            }
        }
        if !self.all_allowed(plan) {
            return false;
        }
        match (&plan.words, cells) {
            (Some(words), Cells::F64(out)) => words.physical(block, frames, start, out),
            (Some(words), Cells::U8(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::I8(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::U16(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::I16(out)) => words.raw(block, frames, start, out),
            (Some(words), Cells::I32(out)) => words.raw(block, frames, start, out),
            (_, cells) => {
                self.numbers(plan, |number, raw| {
                    cells.push(raw, number.physical(raw));
                    true
                });
            }
        }
        true
    }

    /// Append one frame to the first variant that allows its values; return whether there is one.
    // Inlined, it would make the loops over columns an eighth slower.
    #[inline(never)]
    fn row(&self, plan: &Plan, at: u32, all: &mut [Rows]) -> bool {
        let Some((index, values)) = self.first_allowed(plan, at) else {
            return false;
        };
        if let Some(rows) = all.get_mut(plan.rows + index) {
            rows.offsets.push(self.place(at));
            let place = self.table.frame().layout.address_at;
            let address = place.and_then(|place| self.address(at, place));
            rows.addresses.extend(address);
            push(values, &mut rows.fields);
        }
        true
    }

    /// Return the index of the first variant that allows the values of a frame, and the values.
    fn first_allowed(&self, plan: &Plan, at: u32) -> Option<(usize, Numbers)> {
        plan.variants.iter().enumerate().find_map(|(index, id)| {
            let variant = self.table.variant(*id)?;
            let data = self.table.frame().data_start(id.direction);
            let start = at as usize + data;
            let reader = Reader {
                id: *id,
                variant,
                data: self
                    .block
                    .get(start..start + variant.size())
                    .unwrap_or_default(),
                offset: data,
            };
            Some((index, reader.numbers().ok()?))
        })
    }

    /// Call `count` with an index of a variant, a number of frames and the position of the first of
    /// them. The index is `None` for frames that no variant allows.
    pub(crate) fn count(&self, plan: &Plan, mut count: impl FnMut(Option<usize>, u64, u64)) {
        let fields = plan.fields.as_ref();
        if fields.is_some_and(|fields| fields.iter().all(|field| self.all_allowed(field))) {
            if let Some(first) = self.frames.first() {
                count(Some(0), self.frames.len() as u64, self.place(*first));
            }
            return;
        }
        for at in self.frames {
            let found = self.first_allowed(plan, *at);
            count(found.map(|(index, _)| index), 1, self.place(*at));
        }
    }
}

/// Append each field's numbers to its column.
fn push(values: Numbers, fields: &mut [Cells]) {
    for (field, raw, physical) in values {
        if let Some(cells) = fields.get_mut(field) {
            cells.push(raw, physical);
        }
    }
}
