//! How the frames of one group are read, settled once for each table.

use super::words::Words;
use crate::field::{Field, Number};
use crate::legal::Form;
use crate::read::whole;
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
        let mut rows = 0;
        let plan = |forms: &Vec<Form>| {
            let plan = Plan::new(table, forms, rows);
            rows += forms.len();
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
    pub(crate) id: u8,
    /// The forms that a frame can be, in the order in which they are tried.
    pub(crate) forms: Vec<Form>,
    /// Where the rows of the first one stand among those of all forms.
    pub(crate) rows: usize,
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
    /// Which words are allowed.
    pub(crate) allowed: Allowed,
    /// Its fast reader, where the numbers are alike enough.
    pub(crate) words: Option<Words>,
}

impl Plan {
    fn new(table: &Table, forms: &[Form], rows: usize) -> Self {
        let first = forms.first();
        let id = first.and_then(|form| table.commands().get(form.command));
        let layout = first.and_then(|form| table.layout(*form));
        Self {
            id: id.map_or(0, |command| command.id),
            forms: forms.to_vec(),
            rows,
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
            allowed: Allowed::new(field, &numbers),
            words: Words::new(&numbers),
            numbers,
        }
    }
}

/// Which words a field allows.
#[derive(Clone, Debug)]
pub(crate) enum Allowed {
    /// All that its bytes can be.
    All,
    /// It is one byte, and these are.
    Bytes(Box<[bool; 256]>),
    /// Those that the field says.
    Some(Box<Field>),
}

impl Allowed {
    fn new(field: &Field, numbers: &[Number]) -> Self {
        if field.choices.is_empty() && numbers.iter().all(Number::takes_every_word) {
            return Self::All;
        }
        if let [number] = numbers
            && number.width == 1
        {
            let allows = |byte| field.allows(number, whole(number, &[byte], 0));
            let mut bytes = [false; 256];
            for (byte, allowed) in (0..=u8::MAX).zip(&mut bytes) {
                *allowed = allows(byte);
            }
            return Self::Bytes(Box::new(bytes));
        }
        Self::Some(Box::new(field.clone()))
    }
}
