//! The protocol as data: the part of Python's `cobotwire.table` that the codecs interpret.
//!
//! Names, texts and units stay in Python. [`Table::new`] checks once what the codecs then rely on.

use crate::error::{Misfit, TableError};
use crate::field::{Field, Number};
use crate::frame::FrameFormat;
use crate::judge::Rules;
use crate::legal::Form;

/// Which way a message goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// To the arm.
    Request,
    /// From the arm.
    Reply,
}

/// Which directions a framer takes frames of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Listening {
    /// Only one.
    To(Direction),
    /// Both, as on a line that is being sniffed.
    Both,
}

/// The data bytes of one form of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    fields: Vec<Field>,
    starts: Vec<usize>,
    size: usize,
    /// How many values a message of this form has at most, rows and their elements counted.
    values: usize,
}

impl Layout {
    /// A layout of these fields, in the order of the wire.
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

    /// Its fields, in the order of the wire.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        &self.fields
    }

    /// Its data bytes.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// The field that picks another's case, with its index and its one number.
    pub(crate) fn selector(&self, field: &Field) -> Option<(usize, &Field, &Number)> {
        let index = field.selector?;
        let selector = self.fields.get(index)?;
        Some((index, selector, selector.numbers(0).first()?))
    }

    /// How many values a message of this form has at most, rows and their elements counted.
    pub(crate) fn values(&self) -> usize {
        self.values
    }

    /// Where a field starts among the data bytes.
    pub(crate) fn start(&self, field: usize) -> usize {
        self.starts.get(field).copied().unwrap_or_default()
    }

    fn check(&self, frame: &FrameFormat) -> Result<(), Misfit> {
        self.fields
            .iter()
            .try_for_each(|field| field.check(&self.fields))?;
        u8::try_from(frame.length(self.size))
            .map(|_| ())
            .map_err(|_| Misfit::Length)
    }
}

/// One call: its id, how it is asked and how it is answered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Command {
    /// The id on the wire.
    pub id: u8,
    /// The forms of the question.
    pub request: Vec<Layout>,
    /// The forms of the answer.
    pub reply: Vec<Layout>,
}

impl Command {
    /// The forms in one direction.
    #[must_use]
    pub fn layouts(&self, direction: Direction) -> &[Layout] {
        match direction {
            Direction::Request => &self.request,
            Direction::Reply => &self.reply,
        }
    }
}

/// One edition of the protocol, checked and with its legal frames indexed.
#[derive(Clone, Debug)]
pub struct Table {
    frame: FrameFormat,
    commands: Vec<Command>,
    request: Rules,
    reply: Rules,
    both: Rules,
}

impl Table {
    /// A table that the codecs can interpret.
    ///
    /// # Errors
    /// A command that they cannot, which is a mistake in the table.
    pub fn new(frame: FrameFormat, commands: Vec<Command>) -> Result<Self, TableError> {
        for (index, command) in commands.iter().enumerate() {
            let layouts = command.request.iter().chain(&command.reply);
            for layout in layouts {
                layout.check(&frame).map_err(|misfit| TableError {
                    command: index,
                    misfit,
                })?;
            }
        }
        let rules = |directions: &[Direction]| Rules::new(&frame, &commands, directions);
        Ok(Self {
            request: rules(&[Direction::Request]),
            reply: rules(&[Direction::Reply]),
            both: rules(&[Direction::Request, Direction::Reply]),
            frame,
            commands,
        })
    }

    /// How a frame is built.
    #[must_use]
    pub fn frame(&self) -> &FrameFormat {
        &self.frame
    }

    /// The commands, in the order given.
    #[must_use]
    pub fn commands(&self) -> &[Command] {
        &self.commands
    }

    /// The layout of a form.
    #[must_use]
    pub fn layout(&self, form: Form) -> Option<&Layout> {
        let command = self.commands.get(form.command)?;
        command.layouts(form.direction).get(form.layout)
    }

    /// What a listener takes for a frame.
    #[must_use]
    pub fn rules(&self, listening: Listening) -> &Rules {
        match listening {
            Listening::To(Direction::Request) => &self.request,
            Listening::To(Direction::Reply) => &self.reply,
            Listening::Both => &self.both,
        }
    }
}
