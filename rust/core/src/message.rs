//! Messages: their directions, their variants, and the commands that they belong to.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::direction::Direction;
use crate::field::Field;
use crate::frame::FrameFormat;
use crate::number::{Misfit, Number};

/// The highest LEN of two bytes that is supported.
const LONGEST: usize = 0x4000;

/// The data bytes of one variant of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variant {
    fields: Vec<Field>,
    starts: Vec<usize>,
    size: usize,
    /// The largest number of values in a message, including rows and their elements.
    values: usize,
}

impl Variant {
    /// Return a variant with these fields, in wire order.
    #[must_use]
    pub fn new(fields: Vec<Field>) -> Self {
        let (mut size, mut values) = (0, 0);
        let mut starts = Vec::with_capacity(fields.len());
        for field in &fields {
            starts.push(size);
            size = usize::saturating_add(size, field.size());
            let counts = field.cases.iter().map(|case| case.numbers.len());
            values += 1 + counts.max().unwrap_or_default();
        }
        Self {
            fields,
            starts,
            size,
            values,
        }
    }

    /// Return its fields, in wire order.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Return the number of its data bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Return the field that selects the case of `field`, with its index and its number.
    pub(crate) fn selector(&self, field: &Field) -> Option<(usize, &Field, &Number)> {
        let index = field.selector?;
        let selector = self.fields.get(index)?;
        Some((index, selector, selector.numbers(0).first()?))
    }

    /// Return the largest number of values in a message, including rows and their elements.
    pub(crate) fn values(&self) -> usize {
        self.values
    }

    /// Return the index of a field's first data byte.
    pub(crate) fn start(&self, field: usize) -> usize {
        self.starts.get(field).copied().unwrap_or_default()
    }

    /// Return whether data bytes can be this variant, as far as its constants show.
    pub(crate) fn has_constants(&self, data: &[u8]) -> bool {
        let mut places = self.places().into_iter();
        self.size == data.len()
            && places.all(|(at, (field, number))| {
                field.choices.len() != 1 || field.allows(number, number.unpack(data, at))
            })
    }

    /// Return whether no data bytes are legal in both variants. That is known if their sizes
    /// differ, or if two numbers at the same offset have no raw value in common, such as two
    /// constants.
    pub(crate) fn excludes(&self, other: &Self) -> bool {
        let there = other.places();
        let differs = |(at, one): (usize, (&Field, &Number))| {
            let other = there.get(&at);
            other.is_some_and(|other| one.1.is_alike(other.1) && !meet(one, *other))
        };
        self.size != other.size || self.places().into_iter().any(differs)
    }

    /// Return the fields and numbers that no selector decides, by their offset.
    fn places(&self) -> BTreeMap<usize, (&Field, &Number)> {
        let mut found = BTreeMap::new();
        for (field, start) in self.fields.iter().zip(&self.starts) {
            let mut at = *start;
            for number in field.numbers(0).iter().filter(|_| field.selector.is_none()) {
                found.insert(at, (field, number));
                at += number.step();
            }
        }
        found
    }

    pub(crate) fn check(&self, frame: &FrameFormat, direction: Direction) -> Result<(), Misfit> {
        self.fields
            .iter()
            .try_for_each(|field| field.check(&self.fields))?;
        let length = frame.length(self.size, direction);
        let most = if frame.layout.length.wide {
            LONGEST
        } else {
            255
        };
        let id = frame.layout.id;
        let holds_id = frame.has_id(direction) || self.size >= id.end() - id.at;
        if length > most || !holds_id {
            return Err(Misfit::Length);
        }
        Ok(())
    }
}

/// Return whether a raw value is legal in both numbers of fields.
fn meet(one: (&Field, &Number), other: (&Field, &Number)) -> bool {
    for ((field, number), (two, there)) in [(one, other), (other, one)] {
        let own = [&field.choices, &number.choices];
        if let Some(choices) = own.into_iter().find(|choices| !choices.is_empty()) {
            return choices.iter().any(|raw| two.allows(there, *raw));
        }
    }
    one.1.minimum.max(other.1.minimum) <= one.1.maximum.min(other.1.maximum)
}

/// One command: its id, its request and its reply.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Command {
    /// The id on the wire.
    pub id: u16,
    /// The variants of the request.
    pub request: Vec<Variant>,
    /// The variants of the reply.
    pub reply: Vec<Variant>,
}

impl Command {
    /// Return the variants in one direction.
    #[must_use]
    pub fn variants(&self, direction: Direction) -> &[Variant] {
        match direction {
            Direction::Request => &self.request,
            Direction::Reply => &self.reply,
        }
    }
}

/// One variant of one command's message in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VariantId {
    /// The direction.
    pub direction: Direction,
    /// Index of the command in the table.
    pub command: usize,
    /// Index of the variant among the command's in that direction.
    pub variant: usize,
}
