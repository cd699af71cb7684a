//! The fast path for messages that consist of plain numbers and arrays of plain numbers.
//!
//! Nearly all messages qualify: they have no selectors, texts, lists of arrays, bits or floats. A
//! template handles only values that are allowed. For everything else it returns `None`; then the
//! general encoder and decoder do the work, and report what is wrong.

use alloc::vec::Vec;

use crate::direction::Direction;
use crate::field::{Field, Shape};
use crate::frame::FrameFormat;
use crate::message::{Command, Variant};
use crate::number::{Number, Value};
use crate::step::Step;

/// The size of the longest frame that a template builds.
pub const LONGEST_PLAIN: usize = 64;

/// A number that the caller passed as an integer or a float, without conversion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exact {
    /// An integer.
    Integer(i64),
    /// A real number.
    Real(f64),
}

/// Which number of the values a template needs next. Arrays are read in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The value of the field with that index.
    Single(usize),
    /// The first number of a field's array: the index of the field, and the length of the array.
    First(usize, usize),
    /// The number with that index in the same array.
    Next(usize),
}

/// The templates of one command in one direction, by variant.
#[derive(Clone, Debug)]
pub(crate) struct Templates(Vec<Option<Template>>);

#[derive(Clone, Debug)]
pub(crate) struct Template {
    /// The number of fields.
    pub(crate) fields: usize,
    /// A whole frame with zeros as data and check.
    frame: Vec<u8>,
    data_at: usize,
    slots: Vec<Slot>,
    /// How to read the numbers of the slots.
    steps: Vec<Step>,
    /// The fields, in order.
    parts: Vec<Part>,
}

/// The numbers of one field.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// Whether the field's value is an array of numbers, rather than one number.
    many: bool,
    numbers: usize,
}

#[derive(Clone, Debug)]
struct Slot {
    place: Place,
    /// The offset of its first byte in the data.
    at: usize,
    number: Number,
    /// The legal raw values, if the field lists them.
    choices: Vec<i64>,
}

impl Templates {
    pub(crate) fn new(frame: &FrameFormat, command: &Command, direction: Direction) -> Self {
        let variants = command.variants(direction).iter();
        Self(
            variants
                .map(|variant| Template::new(frame, command, direction, variant))
                .collect(),
        )
    }

    /// Return the template of a variant; `None` if only the general encoder and decoder handle it.
    #[inline]
    pub(crate) fn get(&self, variant: usize) -> Option<&Template> {
        self.0.get(variant)?.as_ref()
    }
}

impl Template {
    /// Return the template of a variant; `None` if a field is not plain, or the frame is too long.
    fn new(
        format: &FrameFormat,
        command: &Command,
        direction: Direction,
        variant: &Variant,
    ) -> Option<Self> {
        let (mut slots, mut steps, mut parts) = (Vec::new(), Vec::new(), Vec::new());
        for (index, field) in variant.fields().iter().enumerate() {
            let numbers = plain_numbers(field)?;
            let mut at = variant.start(index);
            parts.push(Part {
                many: field.many,
                numbers: numbers.len(),
            });
            for (element, number) in numbers.iter().enumerate() {
                slots.push(Slot {
                    place: match (field.many, element) {
                        (false, _) => Place::Single(index),
                        (true, 0) => Place::First(index, numbers.len()),
                        (true, _) => Place::Next(element),
                    },
                    at,
                    number: number.clone(),
                    choices: field.choices.clone(),
                });
                let bounded = field.choices.is_empty() && number.choices.is_empty();
                steps.push(Step::new(number, at, bounded));
                at += number.step();
            }
        }
        let mut frame = Vec::new();
        let length = u16::try_from(format.length(variant.size(), direction)).ok()?;
        let address = format.addresses.first().copied();
        format.start(&mut frame, address, length, command.id, direction);
        let data_at = frame.len();
        frame.resize(data_at + variant.size() + format.check.size(), 0);
        (frame.len() <= LONGEST_PLAIN).then_some(Self {
            fields: variant.fields().len(),
            frame,
            data_at,
            slots,
            steps,
            parts,
        })
    }

    /// Write the frame, except its check.
    #[inline]
    pub(crate) fn write<'a>(
        &self,
        space: &'a mut [u8; LONGEST_PLAIN],
        mut number: impl FnMut(Place) -> Option<Exact>,
    ) -> Option<&'a mut [u8]> {
        let frame = space.get_mut(..self.frame.len())?;
        frame.copy_from_slice(&self.frame);
        let data = frame.get_mut(self.data_at..)?;
        for slot in &self.slots {
            let raw = slot.raw(number(slot.place)?)?;
            slot.number.put(raw, data, slot.at);
        }
        Some(frame)
    }

    /// Return a reader of the numbers in the data of a message.
    #[inline]
    pub(crate) fn read<'a>(&'a self, data: &'a [u8]) -> PlainNumbers<'a> {
        PlainNumbers {
            template: self,
            data,
        }
    }
}

/// The numbers of a message that a template reads.
#[derive(Clone, Copy, Debug)]
pub struct PlainNumbers<'a> {
    template: &'a Template,
    data: &'a [u8],
}

impl<'a> PlainNumbers<'a> {
    /// Return the fields in order: whether the value is an array, and its numbers. `None` stands
    /// for a number that is not allowed.
    #[inline]
    pub fn fields(
        self,
    ) -> impl ExactSizeIterator<Item = (bool, impl ExactSizeIterator<Item = Option<Value>> + 'a)>
    {
        let Self { template, data } = self;
        let (mut steps, mut slots) = (template.steps.as_slice(), template.slots.as_slice());
        template.parts.iter().map(move |part| {
            let (own, rest) = steps.split_at_checked(part.numbers).unwrap_or_default();
            let (places, others) = slots.split_at_checked(part.numbers).unwrap_or_default();
            (steps, slots) = (rest, others);
            let values = own.iter().zip(places);
            let values = values.map(|(step, slot)| match step.value(data) {
                Ok(value) => value,
                Err(at) => slot.value(data, at),
            });
            (part.many, values)
        })
    }
}

impl Slot {
    /// Return the physical value at an offset of the data; `None` if it is not allowed.
    #[cold]
    fn value(&self, data: &[u8], at: usize) -> Option<Value> {
        let raw = self.number.unpack(data, at);
        self.allows(raw).then(|| self.number.physical(raw))
    }

    #[inline]
    fn allows(&self, raw: i64) -> bool {
        if self.choices.is_empty() {
            self.number.allows(raw)
        } else {
            self.choices.contains(&raw)
        }
    }

    /// Return the raw value of an allowed number.
    #[inline]
    fn raw(&self, given: Exact) -> Option<i64> {
        let raw = match (given, self.number.scaled()) {
            // NaN and infinities are outside the bounds of every number.
            (Exact::Real(real), true) => self.number.raw(real)?,
            // The conversion rounds to even, as Python's does.
            (Exact::Integer(integer), true) => self.number.raw(integer as f64)?,
            (Exact::Integer(integer), false) => integer,
            (Exact::Real(_), false) => return None,
        };
        self.allows(raw).then_some(raw)
    }
}

/// Return the numbers of a field that consists of plain numbers only; `None` for other fields.
fn plain_numbers(field: &Field) -> Option<&[Number]> {
    let numbers = field.numbers(0);
    let plain = field.selector.is_none()
        && field.shape == Shape::Numbers
        && field.each == 0
        && !numbers.is_empty()
        && numbers.iter().all(Number::is_plain);
    plain.then_some(numbers)
}
