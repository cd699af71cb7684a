//! Encodes and decodes plain messages by their templates.

use crate::direction::Direction;
use crate::frame::Frame;
use crate::message::VariantId;
use crate::rules::Rules;
use crate::table::Table;
use crate::template::{Exact, LONGEST_PLAIN, Place, PlainNumbers};

/// A message that a template read.
#[derive(Clone, Copy, Debug)]
pub struct PlainMessage<'a> {
    /// Which message it is.
    pub variant: VariantId,
    /// Its values.
    pub numbers: PlainNumbers<'a>,
    /// Its address byte, if the format has one.
    pub address: Option<u8>,
}

/// Build one frame, as [`crate::encode`] does, from exact numbers. Return `None` unless the first
/// variant with that many fields, or the chosen one, is plain and allows them.
pub fn encode_plain<'a>(
    table: &Table,
    command: usize,
    direction: Direction,
    (fields, variant): (usize, Option<usize>),
    space: &'a mut [u8; LONGEST_PLAIN],
    number: impl FnMut(Place) -> Option<Exact>,
) -> Option<&'a [u8]> {
    let templates = table.templates(command, direction)?;
    let variants = table.commands().get(command)?.variants(direction);
    let index = match variant {
        Some(index) => index,
        None => variants
            .iter()
            .position(|variant| variant.fields().len() == fields)?,
    };
    let template = templates.get(index)?;
    (template.fields == fields).then_some(())?;
    let frame = template.write(space, number)?;
    table.frame().check.fill(frame);
    Some(frame)
}

/// Decode a legal frame, as [`crate::read`] does. Return `None` unless the first message of these
/// rules is plain. If one of its numbers is not allowed, another message may allow them.
#[inline(always)]
pub fn read_plain<'a>(
    table: &'a Table,
    rules: &Rules,
    frame: Frame<'a>,
    of: Option<usize>,
) -> Option<PlainMessage<'a>> {
    let variants = rules.variants(frame).iter();
    let mut variants = variants.filter(|id| of.is_none_or(|of| of == id.command));
    let variant = *variants.next()?;
    let templates = table.templates(variant.command, variant.direction)?;
    let template = templates.get(variant.variant)?;
    Some(PlainMessage {
        variant,
        numbers: template.read(table.frame().data(frame, variant.direction)),
        address: table.frame().address(frame),
    })
}
