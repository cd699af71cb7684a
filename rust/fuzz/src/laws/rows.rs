//! The rows of columns, in a shape that does not tell batches or types apart.

use std::collections::BTreeMap;

use cobotwire_core::{Cells, Columns, Direction, Field, Form, Layout, Number, Spans, Table};

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
            let fields = layout(table, rows.form).fields();
            assert_eq!(rows.fields.len(), fields.len(), "a column for each field");
            for (cells, field) in rows.fields.iter().zip(fields) {
                assert!(fits(cells, field), "{cells:?} holds {field:?}");
            }
            if rows.offsets.is_empty() {
                assert!(rows.fields.iter().all(Cells::is_empty));
                continue;
            }
            let (offsets, all) = self.rows.entry(key(rows.form)).or_default();
            offsets.extend(rows.offsets);
            all.resize(fields.len(), vec![]);
            for (all, cells) in all.iter_mut().zip(&rows.fields) {
                all.extend(wholes(cells));
            }
        }
        self.refused.extend(columns.refused);
        extend(&mut self.noise, columns.noise);
    }
}

/// Whether a column's type holds all that its field allows.
fn fits(cells: &Cells, field: &Field) -> bool {
    let (least, most) = match cells {
        Cells::F64(_) | Cells::I64(_) => (i64::MIN, i64::MAX),
        Cells::U8(_) => (0, u8::MAX.into()),
        Cells::I8(_) => (i8::MIN.into(), i8::MAX.into()),
        Cells::U16(_) => (0, u16::MAX.into()),
        Cells::I16(_) => (i16::MIN.into(), i16::MAX.into()),
        Cells::U32(_) => (0, u32::MAX.into()),
        Cells::I32(_) => (i32::MIN.into(), i32::MAX.into()),
    };
    let holds = |whole: &i64| (least..=most).contains(whole);
    let mut numbers = field.cases.iter().flat_map(|case| &case.numbers);
    let nothing = |number: &Number| number.minimum > number.maximum;
    if field.choices.is_empty() {
        numbers.all(|number| nothing(number) || holds(&number.minimum) && holds(&number.maximum))
    } else {
        field.choices.iter().all(holds)
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
