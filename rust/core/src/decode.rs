//! Bytes to values. A frame that is not legal, or a number that the table rules out, is an error.

use crate::error::{BadRaw, DecodeError, Reason};
use crate::field::{Field, Number, Order};
use crate::frame::{Frame, OVERHEAD, PREFIX};
use crate::judge::{Rules, Verdict};
use crate::legal::Form;
use crate::table::{Direction, Layout, Listening, Table};

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

/// A decoded frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Which message it is.
    pub form: Form,
    /// Its values, one a field and those of rows.
    pub values: Vec<Value>,
}

/// Read `data`, which must be one whole frame and nothing else.
///
/// # Errors
/// It is not, or a number in it is not allowed: then it is the first one, but a selector goes
/// before the fields that it picks the case of.
pub fn decode(table: &Table, direction: Direction, data: &[u8]) -> Result<Decoded, DecodeError> {
    let rules = table.rules(Listening::To(direction));
    let frame = whole_frame(table, rules, data)?;
    // These rules believe no unknown id, so the form and its layout are there.
    let unknown = DecodeError::Frame {
        reason: Reason::UnknownId,
        offset: OVERHEAD,
    };
    let form = rules.form(frame).ok_or(unknown)?;
    let layouts = table
        .commands()
        .get(form.command)
        .map(|command| command.layouts(direction));
    let layout = layouts
        .and_then(|all| all.get(form.layout))
        .ok_or(unknown)?;
    let values = Decoder {
        form,
        layout,
        data: frame.data(),
    }
    .fields()?;
    Ok(Decoded { form, values })
}

fn whole_frame<'a>(table: &Table, rules: &Rules, data: &'a [u8]) -> Result<Frame<'a>, DecodeError> {
    let (reason, offset) = match rules.judge(data) {
        Verdict::Stands(frame) if frame.bytes().len() == data.len() => return Ok(frame),
        Verdict::Stands(frame) => (Reason::Trailing, frame.bytes().len()),
        Verdict::Waits => (Reason::Truncated, data.len()),
        Verdict::Refuted(reason) => (reason, place(table, reason, data)),
    };
    Err(DecodeError::Frame { reason, offset })
}

/// The byte that refutes a frame at the start of `data`.
fn place(table: &Table, reason: Reason, data: &[u8]) -> usize {
    match reason {
        Reason::NoHeader => {
            let header = table.frame().header.iter();
            header
                .zip(data)
                .take_while(|(expected, byte)| expected == byte)
                .count()
        }
        Reason::BadLength => 2,
        Reason::UnknownId => OVERHEAD,
        Reason::BadFooter => data.get(2).map_or(0, |length| usize::from(*length)) + OVERHEAD - 1,
        Reason::Truncated | Reason::Trailing => data.len(),
    }
}

struct Decoder<'a> {
    form: Form,
    layout: &'a Layout,
    data: &'a [u8],
}

impl Decoder<'_> {
    fn fields(&self) -> Result<Vec<Value>, DecodeError> {
        let mut values = Vec::with_capacity(self.layout.size() + self.layout.fields().len());
        for (index, field) in self.layout.fields().iter().enumerate() {
            self.field(index, field, &mut values)?;
        }
        Ok(values)
    }

    fn field(
        &self,
        index: usize,
        field: &Field,
        values: &mut Vec<Value>,
    ) -> Result<(), DecodeError> {
        let case = self.case(field)?;
        let numbers = field.numbers(case);
        if field.many {
            values.push(Value::Row(numbers.len()));
        }
        let mut start = self.layout.start(index);
        for (element, number) in numbers.iter().enumerate() {
            let whole = whole(number, self.data, start);
            if !field.allows(number, whole) {
                return Err(self.refuse((index, case, element), whole, start));
            }
            values.push(physical(number, whole));
            start += number.width;
        }
        Ok(())
    }

    /// The index of the case that the field's selector picks.
    fn case(&self, field: &Field) -> Result<usize, DecodeError> {
        let Some((index, _, number)) = self.layout.selector(field) else {
            return Ok(0);
        };
        let start = self.layout.start(index);
        let picked = whole(number, self.data, start);
        field
            .case(picked)
            .ok_or_else(|| self.refuse((index, 0, 0), picked, start))
    }

    fn refuse(&self, place: (usize, usize, usize), whole: i64, start: usize) -> DecodeError {
        let (field, case, element) = place;
        let Form {
            command, layout, ..
        } = self.form;
        let offset = PREFIX + start;
        DecodeError::Raw(BadRaw {
            command,
            layout,
            field,
            case,
            element,
            whole,
            offset,
        })
    }
}

/// The whole number that starts there, after the sign rule.
fn whole(number: &Number, data: &[u8], start: usize) -> i64 {
    let bytes = data
        .get(start..start + number.width)
        .unwrap_or_default()
        .iter();
    let join = |word: i64, byte: &u8| word << 8 | i64::from(*byte);
    let word = match number.order {
        Order::Big => bytes.fold(0, join),
        Order::Little => bytes.rev().fold(0, join),
    };
    if word > number.signed_at {
        word - (1 << (8 * number.width))
    } else {
        word
    }
}

/// One rounding, that of the division: both casts are exact, as the table is checked for.
fn physical(number: &Number, whole: i64) -> Value {
    if number.scaled() {
        Value::Real((whole * number.multiply) as f64 / number.divide as f64)
    } else {
        Value::Whole(whole)
    }
}
