//! How the frames of one group are read, settled once for each table.

use super::words::Words;
use crate::field::{Field, Number};
use crate::legal::Form;
use crate::table::{Layout, Listening, Table};

/// How all frames are read that one who listens to some directions takes.
#[derive(Clone, Debug)]
pub struct Plans {
    pub(crate) listening: Listening,
    pub(crate) groups: Vec<Plan>,
}

impl Plans {
    /// The plans for a table. They take a while to make, and serve any number of readers.
    #[must_use]
    pub fn new(table: &Table, listening: Listening) -> Self {
        let groups = table.rules(listening).legal().groups().iter();
        Self {
            listening,
            groups: groups.map(|forms| Plan::new(table, forms)).collect(),
        }
    }
}

/// A group of frames that share id and LEN.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    /// The id of its frames.
    pub(crate) id: u8,
    /// The forms that a frame can be, in the order in which they are tried.
    pub(crate) forms: Vec<Form>,
    /// How the first form is read column by column, where that can be done.
    pub(crate) fields: Option<Vec<FieldPlan>>,
}

/// How one field is read.
#[derive(Clone, Debug)]
pub(crate) struct FieldPlan {
    /// Where it starts in a frame.
    pub(crate) start: u16,
    /// Its numbers.
    pub(crate) numbers: Vec<Number>,
    /// Whether some words are not allowed.
    pub(crate) picky: bool,
    /// The field, to ask it.
    pub(crate) field: Field,
    /// Its fast reader, where the numbers are alike enough.
    pub(crate) words: Option<Words>,
}

impl Plan {
    pub(crate) fn new(table: &Table, forms: &[Form]) -> Self {
        let first = forms.first();
        let id = first.and_then(|form| table.commands().get(form.command));
        let layout = first.and_then(|form| table.layout(*form));
        Self {
            id: id.map_or(0, |command| command.id),
            forms: forms.to_vec(),
            fields: layout.and_then(|layout| plain_fields(table, layout)),
        }
    }
}

/// The fields of a form, if no value decides how another is read.
fn plain_fields(table: &Table, layout: &Layout) -> Option<Vec<FieldPlan>> {
    let data = table.frame().overhead() + 1;
    let plan = |(index, field): (usize, &Field)| {
        let start = u16::try_from(data + layout.start(index)).ok()?;
        field
            .selector
            .is_none()
            .then(|| FieldPlan::new(start, field))
    };
    layout.fields().iter().enumerate().map(plan).collect()
}

impl FieldPlan {
    fn new(start: u16, field: &Field) -> Self {
        let numbers = field.numbers(0).to_vec();
        Self {
            start,
            picky: !field.choices.is_empty() || !numbers.iter().all(Number::takes_every_word),
            words: Words::new(&numbers),
            numbers,
            field: field.clone(),
        }
    }
}
