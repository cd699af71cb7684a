//! Encodes values as the data bytes of one variant.

use alloc::vec::Vec;

use crate::field::{Field, Shape};
use crate::given::{Given, Row, Unread, ValueFault};
use crate::message::Variant;
use crate::number::{Encoding, Number};

/// A value that its field does not allow.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadValue<V> {
    /// Index of the variant among the command's variants in that direction.
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
    /// Whether the next number is a bit field in the bytes of the last one.
    pub(crate) shared: bool,
}

/// The position of a value in a variant.
#[derive(Clone, Copy)]
struct Place<'a> {
    index: usize,
    field: &'a Field,
    case: usize,
    element: Option<usize>,
}

impl Place<'_> {
    fn number(&self) -> Option<&Number> {
        let numbers = self.field.numbers(self.case);
        numbers.get(self.element.unwrap_or_default())
    }
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
        if place.field.each > 0 || place.field.shape != Shape::Numbers {
            return self.shaped(place, numbers, value);
        }
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
        self.elements(place, all, 0, &row)
    }

    /// Write the values of a row as numbers; `first` is the index of the first one in the field.
    fn elements(
        &mut self,
        place: Place<'_>,
        all: &[Number],
        first: usize,
        row: &V::Row,
    ) -> Result<(), EncodeError<V>> {
        for (at, number) in all.iter().enumerate() {
            let value = row.at(at).ok_or(EncodeError::VariantId)?;
            let element = Some(first + at);
            self.number(Place { element, ..place }, number, value)?;
        }
        Ok(())
    }

    /// Write bytes, text, or a list of rows or texts.
    fn shaped(&mut self, place: Place<'_>, all: &[Number], value: V) -> Result<(), EncodeError<V>> {
        if let Shape::Text(encoding, padding) = place.field.shape
            && place.field.each == 0
        {
            return self.text(place, (encoding, padding), all.len(), value);
        }
        if place.field.shape == Shape::Bytes {
            match value.bytes() {
                Ok(Some(bytes)) if bytes.len() == all.len() => {
                    self.bytes.extend(bytes);
                    return Ok(());
                }
                Ok(Some(_)) => return Err(self.reject(place, ValueFault::Count, value)),
                Ok(None) => return self.row(place, all, value),
                Err(unread) => return Err(self.unread(place, unread, value)),
            }
        }
        let rows = match value.row() {
            Ok(rows) => rows,
            Err(unread) => return Err(self.unread(place, unread, value)),
        };
        let each = place.field.each.max(1);
        if rows.count() * each != all.len() {
            return Err(self.reject(place, ValueFault::Count, rows.into_value()));
        }
        if let Shape::Text(encoding, padding) = place.field.shape {
            for (index, _) in all.chunks(each).enumerate() {
                let value = rows.at(index).ok_or(EncodeError::VariantId)?;
                let element = Some(index * each);
                self.text(Place { element, ..place }, (encoding, padding), each, value)?;
            }
            return Ok(());
        }
        let mut held = Vec::with_capacity(rows.count());
        for index in 0..rows.count() {
            let value = rows.at(index).ok_or(EncodeError::VariantId)?;
            let element = Some(index * each);
            held.push(self.group(Place { element, ..place }, each, value)?);
        }
        for (index, (numbers, row)) in all.chunks(each).zip(held).enumerate() {
            self.elements(place, numbers, index * each, &row)?;
        }
        Ok(())
    }

    /// Return one element of a list of rows.
    fn group(&self, place: Place<'_>, each: usize, value: V) -> Result<V::Row, EncodeError<V>> {
        match value.row() {
            Ok(row) if row.count() == each => Ok(row),
            Ok(row) => Err(self.reject(place, ValueFault::ElementCount, row.into_value())),
            Err(Unread::Fault(_)) => Err(self.reject(place, ValueFault::ElementType, value)),
            Err(unread) => Err(self.unread(place, unread, value)),
        }
    }

    /// Write a text of `size` bytes.
    fn text(
        &mut self,
        place: Place<'_>,
        (encoding, padding): (Encoding, Option<u8>),
        size: usize,
        value: V,
    ) -> Result<(), EncodeError<V>> {
        let mut bytes = match value.text(encoding) {
            Ok(bytes) => bytes,
            Err(unread) => return Err(self.unread(place, unread, value)),
        };
        if bytes.len() > size || (bytes.len() < size && padding.is_none()) {
            return Err(self.reject(place, ValueFault::Count, value));
        }
        if padding.is_some() && bytes.last().copied() == padding {
            return Err(self.reject(place, ValueFault::Text, value));
        }
        bytes.resize(size, padding.unwrap_or_default());
        self.bytes.extend(bytes);
        Ok(())
    }

    fn number(
        &mut self,
        place: Place<'_>,
        number: &Number,
        value: V,
    ) -> Result<(), EncodeError<V>> {
        let raw = self.checked(place, number, value)?;
        let start = self.bytes.len();
        number.pack(raw, self.bytes);
        // Bit fields that share bytes follow each other: their bits are combined in these bytes.
        if number.bits.is_some() {
            if self.shared {
                let whole = start - number.width;
                for at in 0..number.width {
                    let own = self.bytes.get(start + at).copied().unwrap_or_default();
                    if let Some(byte) = self.bytes.get_mut(whole + at) {
                        *byte |= own;
                    }
                }
                self.bytes.truncate(start);
            }
            self.shared = number.step() == 0;
        }
        Ok(())
    }

    /// Return the raw value of a caller's value.
    fn checked(&self, place: Place<'_>, number: &Number, value: V) -> Result<i64, EncodeError<V>> {
        if place.field.varies
            && !place.field.many
            && value.counted()
            && let [count] = place.field.choices.as_slice()
        {
            return Ok(*count);
        }
        match read(place.field, number, &value) {
            Ok(raw) => Ok(raw),
            Err(unread) => Err(self.unread(place, unread, value)),
        }
    }

    fn unread(&self, place: Place<'_>, unread: Unread<V::Error>, value: V) -> EncodeError<V> {
        match unread {
            Unread::Fault(fault) => self.reject(place, fault, value),
            Unread::Beyond => {
                let fault = outside(place.field, place.number());
                self.reject(place, fault, value)
            }
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
        value.integer(field.flag || number.flag)?
    };
    if field.allows(number, raw) {
        Ok(raw)
    } else {
        Err(Unread::Fault(outside(field, Some(number))))
    }
}

/// Return the fault of a raw value that the field does not allow.
fn outside(field: &Field, number: Option<&Number>) -> ValueFault {
    if field.choices.is_empty() && number.is_none_or(|number| number.choices.is_empty()) {
        ValueFault::Range
    } else {
        ValueFault::Choice
    }
}
