//! The values of a frame, once it is known which message it is.

use crate::error::BadRaw;
use crate::field::{Field, Number, Order};
use crate::legal::Form;
use crate::table::Layout;

/// A decoded value. A row is followed by its elements, so that a message is one flat buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number without a scale.
    Whole(i64),
    /// A number with one.
    Real(f64),
    /// That many of the values that follow are the elements of one field.
    Row(usize),
}

/// Reads the values of one form.
pub(crate) struct Reader<'a> {
    pub(crate) form: Form,
    pub(crate) layout: &'a Layout,
    /// The data bytes.
    pub(crate) data: &'a [u8],
    /// Where they start in the frame.
    pub(crate) offset: usize,
}

impl Reader<'_> {
    /// All of them, or the first number that is not allowed.
    pub(crate) fn values(&self) -> Result<Vec<Value>, BadRaw> {
        let mut values = Vec::with_capacity(self.layout.values());
        for (index, field) in self.layout.fields().iter().enumerate() {
            let case = self.case(field)?;
            if field.many {
                values.push(Value::Row(field.numbers(case).len()));
            }
            self.field(index, field, case, |number, whole| {
                values.push(physical(number, whole));
            })?;
        }
        Ok(values)
    }

    /// Each number with the index of its field, whole and physical; or the first not allowed.
    pub(crate) fn numbers(&self) -> Result<Vec<(usize, i64, Value)>, BadRaw> {
        let mut values = Vec::with_capacity(self.layout.size());
        for (index, field) in self.layout.fields().iter().enumerate() {
            self.field(index, field, self.case(field)?, |number, whole| {
                values.push((index, whole, physical(number, whole)));
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
        let mut start = self.layout.start(index);
        for (element, number) in field.numbers(case).iter().enumerate() {
            let whole = whole(number, self.data, start);
            if !field.allows(number, whole) {
                return Err(self.refuse((index, case, element), whole, start));
            }
            take(number, whole);
            start += number.width;
        }
        Ok(())
    }

    /// The index of the case that the field's selector picks.
    fn case(&self, field: &Field) -> Result<usize, BadRaw> {
        let Some((index, _, number)) = self.layout.selector(field) else {
            return Ok(0);
        };
        let start = self.layout.start(index);
        let picked = whole(number, self.data, start);
        field
            .case(picked)
            .ok_or_else(|| self.refuse((index, 0, 0), picked, start))
    }

    fn refuse(&self, place: (usize, usize, usize), whole: i64, start: usize) -> BadRaw {
        let (field, case, element) = place;
        let offset = self.offset + start;
        BadRaw {
            form: self.form,
            field,
            case,
            element,
            whole,
            offset,
        }
    }
}

/// The whole number that starts there, after the sign rule.
#[inline]
pub(crate) fn whole(number: &Number, data: &[u8], start: usize) -> i64 {
    let bytes = data.get(start..start + number.width).unwrap_or_default();
    let word = match (bytes, number.order) {
        ([byte], _) => i64::from(*byte),
        (&[high, low], Order::Big) => i64::from(u16::from_be_bytes([high, low])),
        (_, Order::Big) => bytes.iter().fold(0, join),
        (_, Order::Little) => bytes.iter().rev().fold(0, join),
    };
    if word > number.signed_at {
        word - (1 << (8 * number.width))
    } else {
        word
    }
}

fn join(word: i64, byte: &u8) -> i64 {
    word << 8 | i64::from(*byte)
}

/// One rounding, that of the division: both casts are exact, as the table is checked for.
#[inline]
pub(crate) fn physical(number: &Number, whole: i64) -> Value {
    if number.scaled() {
        Value::Real((whole * number.multiply) as f64 / number.divide as f64)
    } else {
        Value::Whole(whole)
    }
}
