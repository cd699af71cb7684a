//! Encodes values: chooses the first variant that allows them, and builds the frame.

use alloc::vec::Vec;

use crate::direction::Direction;
use crate::frame::FrameFormat;
use crate::given::{Given, Row, ValueFault};
use crate::message::{Command, Variant};
use crate::write::{BadValue, EncodeError, Writer};

/// What a caller chooses besides the values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// The index of the variant; `None`: the first one that allows the values.
    pub variant: Option<usize>,
    /// The address byte; `None`: the format's first, if it has any.
    pub address: Option<u8>,
}

/// Build one frame: the first variant that has as many fields as there are values and allows them.
///
/// # Errors
/// The format has no such address, the command has no such variant, or a value is not allowed. The
/// error names the first value that is not allowed, in the first variant with that number of
/// fields.
pub fn encode<V: Given>(
    frame: &FrameFormat,
    command: &Command,
    direction: Direction,
    values: &V::Row,
    choice: Choice,
) -> Result<Vec<u8>, EncodeError<V>> {
    let address = choice.address.or(frame.addresses.first().copied());
    if address.is_some_and(|address| !frame.addresses.contains(&address)) {
        return Err(EncodeError::Address);
    }
    let count = values.count();
    let (mut rejection, mut other_size) = (None, None);
    for (index, variant) in command.variants(direction).iter().enumerate() {
        if variant.fields().len() != count || choice.variant.is_some_and(|variant| variant != index)
        {
            continue;
        }
        let mut bytes =
            start(frame, command, address, direction, variant).ok_or(EncodeError::VariantId)?;
        let writer = Writer {
            index,
            variant,
            values,
            bytes: &mut bytes,
            shared: false,
        };
        match writer.fields() {
            Ok(()) => {
                frame.check.end(&mut bytes);
                return Ok(bytes);
            }
            // The error of a variant of the right size is more informative.
            Err(EncodeError::Value(bad)) if of_other_size(variant, &bad) => {
                other_size = other_size.or(Some(bad));
            }
            Err(EncodeError::Value(bad)) => rejection = rejection.or(Some(bad)),
            Err(error) => return Err(error),
        }
    }
    Err(rejection
        .or(other_size)
        .map_or(EncodeError::VariantId, EncodeError::Value))
}

/// Return whether a list has a number of elements that another variant may have.
fn of_other_size<V>(variant: &Variant, bad: &BadValue<V>) -> bool {
    let varies = variant
        .fields()
        .get(bad.field)
        .is_some_and(|field| field.varies);
    varies && bad.element.is_none() && matches!(bad.fault, ValueFault::Count | ValueFault::Choice)
}

/// Return the start of a frame, up to its data.
fn start(
    frame: &FrameFormat,
    command: &Command,
    address: Option<u8>,
    direction: Direction,
    variant: &Variant,
) -> Option<Vec<u8>> {
    let length = frame.length(variant.size(), direction);
    let mut bytes = Vec::with_capacity(frame.layout.overhead + length);
    // LEN fits: Table::new checked that.
    let length = u16::try_from(length).ok()?;
    frame.start(&mut bytes, address, length, command.id, direction);
    Some(bytes)
}
