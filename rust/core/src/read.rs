//! Reads the values of a frame as one variant.

use alloc::vec::Vec;

use crate::field::{Field, Shape};
use crate::message::{Variant, VariantId};
use crate::number::{Number, Value};

/// A number on the wire that the table does not allow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BadRaw {
    /// The variant that does not allow it.
    pub variant: VariantId,
    /// Index of the field.
    pub field: usize,
    /// Index of the field's case.
    pub case: usize,
    /// Index of the number in the case.
    pub element: usize,
    /// Its raw value, after the sign rule.
    pub raw: i64,
    /// The index of its first byte in the frame.
    pub offset: usize,
}

/// Reads the values of one variant.
pub(crate) struct Reader<'a> {
    pub(crate) id: VariantId,
    pub(crate) variant: &'a Variant,
    /// The data bytes.
    pub(crate) data: &'a [u8],
    /// Where they start in the frame.
    pub(crate) offset: usize,
}

impl Reader<'_> {
    /// Return all values, or the first number that is not allowed.
    pub(crate) fn values(&self) -> Result<Vec<Value>, BadRaw> {
        let mut values = Vec::with_capacity(self.variant.values());
        for (index, field) in self.variant.fields().iter().enumerate() {
            let case = self.case(field)?;
            if field.each > 0 || field.shape != Shape::Numbers {
                self.shaped(index, field, case, &mut values)?;
                continue;
            }
            if field.many {
                values.push(Value::Row(field.numbers(case).len()));
            }
            self.field(index, field, case, |number, raw| {
                values.push(number.physical(raw));
            })?;
        }
        Ok(values)
    }

    /// Append the values of bytes, texts or a list of rows.
    fn shaped(
        &self,
        index: usize,
        field: &Field,
        case: usize,
        values: &mut Vec<Value>,
    ) -> Result<(), BadRaw> {
        let mut own = Vec::with_capacity(field.numbers(case).len());
        self.field(index, field, case, |number, raw| {
            own.push(number.physical(raw));
        })?;
        let all = own.len();
        let each = if field.each == 0 { all } else { field.each };
        match field.shape {
            Shape::Bytes => values.push(Value::Bytes(all)),
            _ if field.each > 0 => values.push(Value::Rows(all / each)),
            _ => {}
        }
        match field.shape {
            Shape::Bytes => values.extend(own),
            Shape::Numbers => {
                for row in own.chunks(each.max(1)) {
                    values.push(Value::Row(row.len()));
                    values.extend(row);
                }
            }
            Shape::Text(encoding, padding) => {
                if all == 0 && field.each == 0 {
                    values.push(Value::Text(0, encoding));
                }
                for text in own.chunks(each.max(1)) {
                    let pad = |value: &Value| {
                        padding.is_some_and(|pad| *value == Value::Integer(i64::from(pad)))
                    };
                    let kept = text.iter().rposition(|value| !pad(value));
                    let text = text.get(..kept.map_or(0, |at| at + 1)).unwrap_or_default();
                    values.push(Value::Text(text.len(), encoding));
                    values.extend(text);
                }
            }
        }
        Ok(())
    }

    /// Return the index of the field, the raw and the physical value of each number; or the first
    /// number that is not allowed.
    pub(crate) fn numbers(&self) -> Result<Vec<(usize, i64, Value)>, BadRaw> {
        let mut values = Vec::with_capacity(self.variant.size());
        for (index, field) in self.variant.fields().iter().enumerate() {
            self.field(index, field, self.case(field)?, |number, raw| {
                values.push((index, raw, number.physical(raw)));
            })?;
        }
        Ok(values)
    }

    fn field(
        &self,
        index: usize,
        field: &Field,
        case: usize,
        mut take: impl FnMut(&Number, i64),
    ) -> Result<(), BadRaw> {
        let mut start = self.variant.start(index);
        for (element, number) in field.numbers(case).iter().enumerate() {
            let raw = number.unpack(self.data, start);
            if !field.allows(number, raw) {
                return Err(self.reject((index, case, element), raw, start));
            }
            take(number, raw);
            start += number.step();
        }
        self.text(index, field, case)
    }

    /// Return an error if a text has a byte that its encoding does not allow.
    fn text(&self, index: usize, field: &Field, case: usize) -> Result<(), BadRaw> {
        if !matches!(field.shape, Shape::Text(..)) {
            return Ok(());
        }
        let start = self.variant.start(index);
        let bytes = self.data.get(start..).unwrap_or_default();
        let bytes = bytes.get(..field.numbers(case).len()).unwrap_or_default();
        match field.bad_text_at(bytes) {
            None => Ok(()),
            Some(at) => {
                let raw = bytes.get(at).copied().unwrap_or_default();
                Err(self.reject((index, case, at), i64::from(raw), start + at))
            }
        }
    }

    /// Return the index of the case that the field's selector picks.
    fn case(&self, field: &Field) -> Result<usize, BadRaw> {
        let Some((index, _, number)) = self.variant.selector(field) else {
            return Ok(0);
        };
        let start = self.variant.start(index);
        let picked = number.unpack(self.data, start);
        field
            .case(picked)
            .ok_or_else(|| self.reject((index, 0, 0), picked, start))
    }

    fn reject(&self, place: (usize, usize, usize), raw: i64, start: usize) -> BadRaw {
        let (field, case, element) = place;
        let offset = self.offset + start;
        BadRaw {
            variant: self.id,
            field,
            case,
            element,
            raw,
            offset,
        }
    }
}
