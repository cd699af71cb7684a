//! The rows of columns, in a shape that does not tell batches or types apart.

use std::collections::BTreeMap;

use cobotwire_core::{Cells, Columns, Direction, Form, Layout, Spans, Table};

/// The rows of each form: where they start, and its fields' numbers.
pub type Rows = BTreeMap<(bool, usize, usize), (Vec<u64>, Vec<Vec<i64>>)>;

/// The layout of a form.
pub fn layout(table: &Table, form: Form) -> &Layout {
    &table.commands()[form.command].layouts(form.direction)[form.layout]
}

/// A form's place among the rows.
pub fn key(form: Form) -> (bool, usize, usize) {
    (
        form.direction == Direction::Reply,
        form.command,
        form.layout,
    )
}

/// What a reader found, batch after batch.
#[derive(Debug, Default)]
pub struct Found {
    pub rows: Rows,
    pub refused: Vec<u64>,
    pub noise: Spans,
}

impl Found {
    pub fn add(&mut self, table: &Table, columns: Columns) {
        for rows in columns.rows {
            let fields = layout(table, rows.form).fields().len();
            assert_eq!(rows.fields.len(), fields, "a column for each field");
            if rows.offsets.is_empty() {
                assert!(rows.fields.iter().all(Cells::is_empty));
                continue;
            }
            let (offsets, all) = self.rows.entry(key(rows.form)).or_default();
            offsets.extend(rows.offsets);
            all.resize(fields, vec![]);
            for (all, cells) in all.iter_mut().zip(&rows.fields) {
                all.extend(wholes(cells));
            }
        }
        self.refused.extend(columns.refused);
        extend(&mut self.noise, columns.noise);
    }
}

/// Floats as their bits, so that a zero's sign counts.
fn wholes(cells: &Cells) -> Vec<i64> {
    fn cast<T: Copy + Into<i64>>(all: &[T]) -> Vec<i64> {
        all.iter().map(|value| (*value).into()).collect()
    }
    match cells {
        Cells::F64(all) => all.iter().map(|real| real.to_bits() as i64).collect(),
        Cells::U8(all) => cast(all),
        Cells::I8(all) => cast(all),
        Cells::U16(all) => cast(all),
        Cells::I16(all) => cast(all),
        Cells::U32(all) => cast(all),
        Cells::I32(all) => cast(all),
        Cells::I64(all) => cast(all),
    }
}

/// One behind the other.
pub fn extend(all: &mut Spans, more: Spans) {
    all.offsets.extend(more.offsets);
    all.sizes.extend(more.sizes);
}
