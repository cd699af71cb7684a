//! Values to bytes: which form takes the values, and the frame around them.

use crate::error::EncodeError;
use crate::frame::FrameFormat;
use crate::given::{Given, Row};
use crate::table::{Command, Direction, Layout};
use crate::write::Writer;

/// What a caller can settle besides the values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Only the form with this index; `None`: the first that takes the values.
    pub form: Option<usize>,
    /// The address byte; `None`: the format's first, if it has any.
    pub address: Option<u8>,
}

/// Build one whole frame, of the first form with that number of fields that takes the values.
///
/// # Errors
/// The format has no such address, there is no such form, or a value is not allowed: then it is
/// the leftmost one, of the first form with that number of fields.
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
    let mut refusal = None;
    for (index, layout) in command.layouts(direction).iter().enumerate() {
        if layout.fields().len() != count || choice.form.is_some_and(|form| form != index) {
            continue;
        }
        let mut bytes = start(frame, command, address, layout).ok_or(EncodeError::Form)?;
        let writer = Writer {
            index,
            layout,
            values,
            bytes: &mut bytes,
        };
        match writer.fields() {
            Ok(()) => {
                frame.check.end(&mut bytes, frame.overhead());
                return Ok(bytes);
            }
            Err(EncodeError::Value(bad)) => refusal = refusal.or(Some(bad)),
            Err(error) => return Err(error),
        }
    }
    Err(refusal.map_or(EncodeError::Form, EncodeError::Value))
}

/// A frame up to its id.
fn start(
    frame: &FrameFormat,
    command: &Command,
    address: Option<u8>,
    layout: &Layout,
) -> Option<Vec<u8>> {
    let length = frame.length(layout.size());
    let mut bytes = Vec::with_capacity(frame.overhead() + length);
    bytes.extend_from_slice(&frame.header);
    bytes.extend(address);
    // That LEN fits a byte is checked when the table is made.
    bytes.push(u8::try_from(length).ok()?);
    bytes.push(command.id);
    Some(bytes)
}
