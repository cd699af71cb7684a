//! Encodes values as the data bytes of one variant.

use crate::field::Field;
use crate::given::{Given, Row, Unread, ValueFault};
use crate::message::Variant;
use crate::number::Number;

/// A value that its field does not allow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadValue<V> {
    /// Index of the variant among the command's in that direction.
    pub variant: usize,
    /// Index of the field.
    pub field: usize,
    /// Index of the field's case.
    pub case: usize,
    /// Index of the number in a row; `None`: the field as a whole.
    pub element: Option<usize>,
    /// What is wrong.
    pub fault: ValueFault,
    /// The value, as the caller passed it.
    pub value: V,
    /// The raw value of a selector that picks no case.
    pub picked: Option<i64>,
}

/// Why nothing was encoded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EncodeError<V: Given> {
    /// The frame format has no such address.
    Address,
    /// The command has no variant with that many fields in that direction, or the chosen variant
    /// has another number of fields.
    VariantId,
    /// A value is not allowed.
    Value(BadValue<V>),
    /// Converting a value raised an error of its own, which is passed on.
    Foreign(V::Error),
}

/// Appends the data bytes of one variant to a frame.
pub(crate) struct Writer<'a, V: Given> {
    /// Index of the variant.
    pub(crate) index: usize,
    pub(crate) variant: &'a Variant,
    pub(crate) values: &'a V::Row,
    pub(crate) bytes: &'a mut Vec<u8>,
}

/// The place of a value in a variant.
#[derive(Clone, Copy)]
struct Place<'a> {
    index: usize,
    field: &'a Field,
    case: usize,
    element: Option<usize>,
}

impl<V: Given> Writer<'_, V> {
    /// Write all fields, or return the leftmost mistake.
    pub(crate) fn fields(mut self) -> Result<(), EncodeError<V>> {
        for (index, field) in self.variant.fields().iter().enumerate() {
            let case = self.case(field)?;
            let value = self.values.at(index).ok_or(EncodeError::VariantId)?;
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

    /// Return the index of the case that the field's selector picks.
    fn case(&self, field: &Field) -> Result<usize, EncodeError<V>> {
        let Some((index, selector, number)) = self.variant.selector(field) else {
            return Ok(0);
        };
        let place = Place {
            index,
            field: selector,
            case: 0,
            element: None,
        };
        let value = || self.values.at(index).ok_or(EncodeError::VariantId);
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
            return Err(self.reject(place, ValueFault::Count, row.into_value()));
        }
        for (element, number) in all.iter().enumerate() {
            let value = row.at(element).ok_or(EncodeError::VariantId)?;
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
        let raw = self.checked(place, number, value)?;
        number.pack(raw, self.bytes);
        Ok(())
    }

    /// Return the raw value of one value.
    fn checked(&self, place: Place<'_>, number: &Number, value: V) -> Result<i64, EncodeError<V>> {
        match read(place.field, number, &value) {
            Ok(raw) => Ok(raw),
            Err(unread) => Err(self.unread(place, unread, value)),
        }
    }

    fn unread(&self, place: Place<'_>, unread: Unread<V::Error>, value: V) -> EncodeError<V> {
        match unread {
            Unread::Fault(fault) => self.reject(place, fault, value),
            Unread::Beyond => self.reject(place, outside(place.field), value),
            Unread::Foreign(error) => EncodeError::Foreign(error),
        }
    }

    fn reject(&self, place: Place<'_>, fault: ValueFault, value: V) -> EncodeError<V> {
        EncodeError::Value(self.bad(place, fault, value))
    }

    fn bad(&self, place: Place<'_>, fault: ValueFault, value: V) -> BadValue<V> {
        BadValue {
            variant: self.index,
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
    let raw = if number.real() {
        let real = value.real()?;
        if !real.is_finite() && !number.takes_not_finite() {
            return Err(Unread::Fault(ValueFault::NotFinite));
        }
        let raw = number.raw(real);
        raw.ok_or(Unread::Fault(ValueFault::Range))?
    } else {
        value.integer(field.flag)?
    };
    if field.allows(number, raw) {
        Ok(raw)
    } else {
        Err(Unread::Fault(outside(field)))
    }
}

/// Return the fault of a raw value that the field does not allow.
fn outside(field: &Field) -> ValueFault {
    if field.choices.is_empty() {
        ValueFault::Range
    } else {
        ValueFault::Choice
    }
}
