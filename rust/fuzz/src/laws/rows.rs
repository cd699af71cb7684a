//! The rows of columns, in a representation that is independent of batches and types.

use std::collections::BTreeMap;

use cobotwire_core::{Cells, Columns, Direction, Field, Number, Spans, Table, Variant, VariantId};

/// The rows of each variant: their offsets, their addresses, and the numbers of each field.
pub type Rows = BTreeMap<(bool, usize, usize), (Vec<u64>, Vec<u8>, Vec<Vec<i64>>)>;

/// Return the variant with this id.
pub fn variant_at(table: &Table, variant: VariantId) -> &Variant {
    &table.commands()[variant.command].variants(variant.direction)[variant.variant]
}

/// Return the key of a variant in [`Rows`].
pub fn key(variant: VariantId) -> (bool, usize, usize) {
    (
        variant.direction == Direction::Reply,
        variant.command,
        variant.variant,
    )
}

/// The results of a reader, collected over its batches.
#[derive(Debug, Default)]
pub struct Found {
    pub rows: Rows,
    pub rejected: Vec<u64>,
    pub noise: Spans,
}

impl Found {
    pub fn add(&mut self, table: &Table, columns: Columns) {
        for rows in columns.rows {
            let fields = variant_at(table, rows.variant).fields();
            assert_eq!(rows.fields.len(), fields.len(), "a column for each field");
            for (cells, field) in rows.fields.iter().zip(fields) {
                assert!(fits(cells, field), "{cells:?} holds {field:?}");
            }
            if rows.offsets.is_empty() {
                assert!(rows.addresses.is_empty());
                assert!(rows.fields.iter().all(Cells::is_empty));
                continue;
            }
            let (offsets, addresses, all) = self.rows.entry(key(rows.variant)).or_default();
            offsets.extend(rows.offsets);
            addresses.extend(rows.addresses);
            all.resize(fields.len(), vec![]);
            for (all, cells) in all.iter_mut().zip(&rows.fields) {
                all.extend(raw_values(cells));
            }
        }
        self.rejected.extend(columns.rejected);
        extend(&mut self.noise, columns.noise);
    }
}

/// Return whether a column's type holds all that its field allows.
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
    let holds = |raw: &i64| (least..=most).contains(raw);
    let mut numbers = field.cases.iter().flat_map(|case| &case.numbers);
    let nothing = |number: &Number| number.minimum > number.maximum;
    if field.choices.is_empty() {
        numbers.all(|number| nothing(number) || holds(&number.minimum) && holds(&number.maximum))
    } else {
        field.choices.iter().all(holds)
    }
}

/// Return numbers as integers; floats as their bits, so that the sign of zero counts.
fn raw_values(cells: &Cells) -> Vec<i64> {
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

/// Append spans.
pub fn extend(all: &mut Spans, more: Spans) {
    all.offsets.extend(more.offsets);
    all.sizes.extend(more.sizes);
}
