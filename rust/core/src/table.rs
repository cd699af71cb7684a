//! The protocol as data: the part of Python's `cobotwire.protocol.table` that the codecs interpret.
//!
//! Names, texts and units stay in Python. [`Table::new`] checks every property on which the codecs
//! rely.

use alloc::vec::Vec;
#[cfg(not(feature = "std"))]
use core::cell::OnceCell as OnceLock;
#[cfg(feature = "std")]
use std::sync::OnceLock;

use crate::direction::{Direction, Listening};
use crate::frame::FrameFormat;
use crate::message::{Command, Variant, VariantId};
use crate::number::Misfit;
use crate::rules::Rules;
use crate::template::Templates;

/// Why a table was rejected: a mistake in the table, not in any data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TableError {
    /// Index of the command.
    pub command: usize,
    /// What is wrong with it.
    pub misfit: Misfit,
}

/// One edition of the protocol, checked and with its legal frames indexed.
#[derive(Clone, Debug)]
pub struct Table {
    frame: FrameFormat,
    commands: Vec<Command>,
    request: Rules,
    reply: Rules,
    both: Rules,
    /// The templates of each command's request and reply; they are made on first use.
    templates: Vec<[OnceLock<Templates>; 2]>,
}

impl Table {
    /// Return a table that the codecs can interpret.
    ///
    /// # Errors
    /// A command has a part that they cannot interpret, which is a mistake in the table.
    pub fn new(frame: FrameFormat, commands: Vec<Command>) -> Result<Self, TableError> {
        for (index, command) in commands.iter().enumerate() {
            for direction in [Direction::Request, Direction::Reply] {
                for variant in command.variants(direction) {
                    let checked = variant.check(&frame, direction);
                    checked.map_err(|misfit| TableError {
                        command: index,
                        misfit,
                    })?;
                }
            }
        }
        let rules = |directions: &[Direction]| Rules::new(&frame, &commands, directions);
        Ok(Self {
            request: rules(&[Direction::Request]),
            reply: rules(&[Direction::Reply]),
            both: rules(&[Direction::Request, Direction::Reply]),
            templates: commands.iter().map(|_| Default::default()).collect(),
            frame,
            commands,
        })
    }

    /// Return the frame format.
    #[must_use]
    pub fn frame(&self) -> &FrameFormat {
        &self.frame
    }

    /// Return the commands, in the order given.
    #[must_use]
    pub fn commands(&self) -> &[Command] {
        &self.commands
    }

    /// Return the variant with this id.
    #[must_use]
    pub fn variant(&self, variant: VariantId) -> Option<&Variant> {
        let command = self.commands.get(variant.command)?;
        command.variants(variant.direction).get(variant.variant)
    }

    /// Return the index of a field's case that the data bytes of a message select; `None` if they
    /// select none.
    #[must_use]
    pub fn case(&self, id: VariantId, field: usize, data: &[u8]) -> Option<usize> {
        let variant = self.variant(id)?;
        let field = variant.fields().get(field)?;
        let Some((index, _, number)) = variant.selector(field) else {
            return Some(0);
        };
        field.case(number.unpack(data, variant.start(index)))
    }

    /// Return the templates of a command in one direction.
    #[inline]
    pub(crate) fn templates(&self, command: usize, direction: Direction) -> Option<&Templates> {
        let [request, reply] = self.templates.get(command)?;
        let place = match direction {
            Direction::Request => request,
            Direction::Reply => reply,
        };
        if let Some(templates) = place.get() {
            return Some(templates);
        }
        let record = self.commands.get(command)?;
        Some(place.get_or_init(|| Templates::new(&self.frame, record, direction)))
    }

    /// Return the rules for these directions.
    #[must_use]
    pub fn rules(&self, listening: Listening) -> &Rules {
        match listening {
            Listening::To(Direction::Request) => &self.request,
            Listening::To(Direction::Reply) => &self.reply,
            Listening::Both => &self.both,
        }
    }
}
