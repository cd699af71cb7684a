//! The data bytes of one form, from values.
//!
//! A real value becomes the nearest whole number of the wire's steps, a tie the even one; the
//! arithmetic is IEEE double, step by step as in the reference, so that the bytes are the same.

use crate::error::{BadValue, EncodeError, ValueFault};
use crate::field::{Field, Number, Order};
use crate::given::{Given, Row, Unread};
use crate::table::Layout;

/// Appends the data bytes of one form to a frame.
pub(crate) struct Writer<'a, V: Given> {
    /// Index of the form.
    pub(crate) index: usize,
    pub(crate) layout: &'a Layout,
    pub(crate) values: &'a V::Row,
    pub(crate) bytes: &'a mut Vec<u8>,
}

/// Where in a layout a value goes.
#[derive(Clone, Copy)]
struct Place<'a> {
    index: usize,
    field: &'a Field,
    case: usize,
    element: Option<usize>,
}

impl<V: Given> Writer<'_, V> {
    /// All fields, or the leftmost mistake.
    pub(crate) fn fields(mut self) -> Result<(), EncodeError<V>> {
        for (index, field) in self.layout.fields().iter().enumerate() {
            let case = self.case(field)?;
            let value = self.values.at(index).ok_or(EncodeError::Form)?;
            self.field(
                Place {
                    index,
                    field,
                    case,
                    element: None,
                },
                value,
            )?;
        }
        Ok(())
    }

    /// The index of the case that the field's selector picks.
    fn case(&self, field: &Field) -> Result<usize, EncodeError<V>> {
        let Some((index, selector, number)) = self.layout.selector(field) else {
            return Ok(0);
        };
        let place = Place {
            index,
            field: selector,
            case: 0,
            element: None,
        };
        let value = || self.values.at(index).ok_or(EncodeError::Form);
        let picked = self.checked(place, number, value()?)?;
        match field.case(picked) {
            Some(case) => Ok(case),
            None => Err(EncodeError::Value(BadValue {
                picked: Some(picked),
                ..self.bad(place, ValueFault::Choice, value()?)
            })),
        }
    }

    fn field(&mut self, place: Place<'_>, value: V) -> Result<(), EncodeError<V>> {
        let numbers = place.field.numbers(place.case);
        match numbers {
            [number] if !place.field.many => self.number(place, number, value),
            _ => self.row(place, numbers, value),
        }
    }

    fn row(&mut self, place: Place<'_>, all: &[Number], value: V) -> Result<(), EncodeError<V>> {
        let row = match value.row() {
            Ok(row) => row,
            Err(unread) => return Err(self.unread(place, unread, value)),
        };
        if row.count() != all.len() {
            return Err(self.refuse(place, ValueFault::Count, row.into_value()));
        }
        for (element, number) in all.iter().enumerate() {
            let value = row.at(element).ok_or(EncodeError::Form)?;
            self.number(
                Place {
                    element: Some(element),
                    ..place
                },
                number,
                value,
            )?;
        }
        Ok(())
    }

    fn number(
        &mut self,
        place: Place<'_>,
        number: &Number,
        value: V,
    ) -> Result<(), EncodeError<V>> {
        let whole = self.checked(place, number, value)?;
        write(self.bytes, number, whole);
        Ok(())
    }

    /// The whole number on the wire for one value.
    fn checked(&self, place: Place<'_>, number: &Number, value: V) -> Result<i64, EncodeError<V>> {
        match read(place.field, number, &value) {
            Ok(whole) => Ok(whole),
            Err(unread) => Err(self.unread(place, unread, value)),
        }
    }

    fn unread(&self, place: Place<'_>, unread: Unread<V::Error>, value: V) -> EncodeError<V> {
        match unread {
            Unread::Fault(fault) => self.refuse(place, fault, value),
            Unread::Beyond => self.refuse(place, outside(place.field), value),
            Unread::Foreign(error) => EncodeError::Foreign(error),
        }
    }

    fn refuse(&self, place: Place<'_>, fault: ValueFault, value: V) -> EncodeError<V> {
        EncodeError::Value(self.bad(place, fault, value))
    }

    fn bad(&self, place: Place<'_>, fault: ValueFault, value: V) -> BadValue<V> {
        BadValue {
            layout: self.index,
            field: place.index,
            case: place.case,
            element: place.element,
            fault,
            value,
            picked: None,
        }
    }
}

fn read<V: Given>(field: &Field, number: &Number, value: &V) -> Result<i64, Unread<V::Error>> {
    let whole = if number.scaled() {
        steps(number, value.real()?)?
    } else {
        value.whole(field.flag)?
    };
    if field.allows(number, whole) {
        Ok(whole)
    } else {
        Err(Unread::Fault(outside(field)))
    }
}

/// What is wrong with a whole number that the field does not allow.
fn outside(field: &Field) -> ValueFault {
    if field.choices.is_empty() {
        ValueFault::Range
    } else {
        ValueFault::Choice
    }
}

/// The nearest whole number of the wire's steps. The casts to double are exact, as the table is
/// checked for.
fn steps<E>(number: &Number, real: f64) -> Result<i64, Unread<E>> {
    if !real.is_finite() {
        return Err(Unread::Fault(ValueFault::NotFinite));
    }
    let scaled = real * number.divide as f64;
    let steps = match number.multiply {
        1 => scaled, // the same, without the time that a division takes
        multiply => scaled / multiply as f64,
    };
    // Before rounding: a step count beyond the bounds by one or more has no whole number to be.
    let (below, above) = ((number.minimum - 1) as f64, (number.maximum + 1) as f64);
    if below < steps && steps < above {
        Ok(nearest(steps) as i64)
    } else {
        Err(Unread::Fault(ValueFault::Range))
    }
}

/// The nearest whole number, a tie the even one; for less than 2^51, as bounds of words are.
///
/// Where a double has no bits left for halves, adding rounds just so. The standard library's own
/// function is a call into the C library, where the processor is not known to do it.
fn nearest(real: f64) -> f64 {
    const NO_HALVES: f64 = (1_u64 << 52) as f64;
    let shift = NO_HALVES.copysign(real);
    if real.abs() < NO_HALVES / 2.0 {
        real + shift - shift
    } else {
        real.round_ties_even()
    }
}

/// The lowest bytes of a whole number; a negative one is its two's complement.
fn write(bytes: &mut Vec<u8>, number: &Number, whole: i64) {
    let word = match number.order {
        Order::Big => (whole << (64 - 8 * number.width)).to_be_bytes(),
        Order::Little => whole.to_le_bytes(),
    };
    bytes.extend(word.iter().take(number.width));
}
