//! Plans how to read the frames of each group, once for each table.

use super::words::{Bounds, Words};
use crate::direction::Listening;
use crate::field::{Field, Shape};
use crate::message::{Variant, VariantId};
use crate::number::Number;
use crate::table::Table;
use cobotwire_simd::Six;

/// The plans for every frame in the directions of a reader.
#[derive(Clone, Debug)]
pub struct Plans {
    pub(crate) listening: Listening,
    pub(crate) groups: Vec<Plan>,
}

impl Plans {
    /// Return the plans for a table. Making them is expensive; any number of readers can share
    /// them.
    #[must_use]
    pub fn new(table: &Table, listening: Listening) -> Self {
        let mut rows = 0;
        let plan = |variants: &Vec<VariantId>| {
            let plan = Plan::new(table, variants, rows);
            rows += variants.len();
            plan
        };
        let groups = table.rules(listening).legal().groups().iter();
        Self {
            listening,
            groups: groups.map(plan).collect(),
        }
    }
}

/// A group of frames that share id and LEN.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The id of its frames.
    pub(crate) id: u16,
    /// The variants that a frame can be, in order of precedence.
    pub(crate) variants: Vec<VariantId>,
    /// The index of the first variant's rows in the rows of all variants.
    pub(crate) rows: usize,
    /// How to read the first variant column by column; `None`: it has a selector or a text.
    pub(crate) fields: Option<Vec<FieldPlan>>,
}

/// How to read one field.
#[derive(Clone, Debug)]
pub(crate) struct FieldPlan {
    /// Where it starts in a frame.
    pub(crate) start: u16,
    /// Its numbers.
    pub(crate) numbers: Vec<Number>,
    /// Which raw values are allowed.
    pub(crate) allowed: Allowed,
    /// Its fast reader, if that can handle its numbers.
    pub(crate) words: Option<Words>,
    /// Its reader for rows of six pairs of bytes.
    pub(crate) six: Option<Six>,
}

impl Plan {
    fn new(table: &Table, variants: &[VariantId], rows: usize) -> Self {
        let first = variants.first();
        let id = first.and_then(|variant| table.commands().get(variant.command));
        let variant = first.and_then(|id| Some((*id, table.variant(*id)?)));
        Self {
            id: id.map_or(0, |command| command.id),
            variants: variants.to_vec(),
            rows,
            fields: variant.and_then(|(id, variant)| plain_fields(table, id, variant)),
        }
    }
}

/// Return how to read the fields of a variant, if it has no selector and no text.
fn plain_fields(table: &Table, id: VariantId, variant: &Variant) -> Option<Vec<FieldPlan>> {
    let data = table.frame().data_start(id.direction);
    let plan = |(index, field): (usize, &Field)| {
        let start = u16::try_from(data + variant.start(index)).ok()?;
        (field.selector.is_none() && !matches!(field.shape, Shape::Text(..)))
            .then(|| FieldPlan::new(start, field))
    };
    variant.fields().iter().enumerate().map(plan).collect()
}

impl FieldPlan {
    fn new(start: u16, field: &Field) -> Self {
        let numbers = field.numbers(0).to_vec();
        let words = Words::new(&numbers);
        let allowed = Allowed::new(field, &numbers, words.is_some());
        let bounds = match &allowed {
            Allowed::All => Some(Bounds::NONE),
            Allowed::Within(bounds) => Some(*bounds),
            _ => None,
        };
        Self {
            start,
            six: words
                .as_ref()
                .zip(bounds)
                .and_then(|(words, bounds)| words.six(&bounds)),
            allowed,
            words,
            numbers,
        }
    }
}

/// Which raw values a field allows.
#[derive(Clone, Debug)]
pub(crate) enum Allowed {
    /// Every combination of its bytes.
    All,
    /// The field is one byte; these are allowed.
    Bytes(Box<[bool; 256]>),
    /// The raw values within these bounds.
    Within(Bounds),
    /// The raw values that this field allows.
    Some(Box<Field>),
}

impl Allowed {
    fn new(field: &Field, numbers: &[Number], words: bool) -> Self {
        if field.choices.is_empty() && numbers.iter().all(Number::takes_all_bytes) {
            return Self::All;
        }
        if let [number] = numbers
            && number.width == 1
        {
            let allows = |byte| field.allows(number, number.unpack(&[byte], 0));
            let mut bytes = [false; 256];
            for (byte, allowed) in (0..=u8::MAX).zip(&mut bytes) {
                *allowed = allows(byte);
            }
            return Self::Bytes(Box::new(bytes));
        }
        match Bounds::new(numbers).filter(|_| words && field.choices.is_empty()) {
            Some(bounds) => Self::Within(bounds),
            None => Self::Some(Box::new(field.clone())),
        }
    }
}
