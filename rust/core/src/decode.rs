//! Decodes one frame to values. Bytes that are not a legal frame, and numbers that the table does
//! not allow, are errors.

use alloc::vec::Vec;

use crate::direction::{Direction, Listening};
use crate::frame::{Frame, FrameFormat, Layout};
use crate::message::VariantId;
use crate::number::Value;
use crate::read::{BadRaw, Reader};
use crate::reason::Reason;
use crate::rules::{Rules, Verdict};
use crate::table::Table;

/// Why nothing was decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DecodeError {
    /// The bytes are not one whole legal frame.
    Frame {
        /// The reason.
        reason: Reason,
        /// The index of the first byte that is not legal.
        offset: usize,
    },
    /// The frame is legal, but a number in it is not.
    Raw(BadRaw),
}

/// A decoded frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Which message it is.
    pub variant: VariantId,
    /// Its values: one for each field; each row is followed by its elements.
    pub values: Vec<Value>,
    /// Its address byte, if the format has one.
    pub address: Option<u8>,
}

impl Decoded {
    /// Return the values of each field; a row is followed by its elements.
    pub fn fields(&self) -> impl Iterator<Item = &[Value]> {
        let mut rest = self.values.as_slice();
        core::iter::from_fn(move || {
            let (field, after) = rest.split_at_checked(size(rest))?;
            rest = after;
            (!field.is_empty()).then_some(field)
        })
    }
}

/// Return how many of these values belong to the first field.
fn size(values: &[Value]) -> usize {
    match values.first() {
        None => 0,
        Some(Value::Integer(_) | Value::Real(_)) => 1,
        Some(Value::Row(count) | Value::Bytes(count) | Value::Text(count, _)) => 1 + count,
        Some(Value::Rows(count)) => {
            (0..*count).fold(1, |at, _| at + values.get(at..).map_or(0, size))
        }
    }
}

/// Decode `data`, which must be one frame and nothing else, as the first message that allows its
/// values. `of` restricts the search to messages of the command with that index.
///
/// # Errors
/// The bytes are not one legal frame, or a number in it is not allowed. The error names the first
/// such number; selectors are checked before the fields that depend on them. If several variants
/// reject the frame, the error is that of the first one.
pub fn decode(
    table: &Table,
    direction: Direction,
    data: &[u8],
    of: Option<usize>,
) -> Result<Decoded, DecodeError> {
    let rules = table.rules(Listening::To(direction));
    read(table, rules, validated(table, rules, data, of)?, of)
}

/// Decode a frame that was already validated, as the first message of these rules that allows its
/// values. `of` restricts the search to messages of the command with that index.
///
/// # Errors
/// No message allows the values, or these rules have no message with this id and LEN.
pub fn read(
    table: &Table,
    rules: &Rules,
    frame: Frame<'_>,
    of: Option<usize>,
) -> Result<Decoded, DecodeError> {
    let mut rejection = None;
    for id in rules.variants(frame) {
        if of.is_some_and(|of| of != id.command) {
            continue;
        }
        let Some(variant) = table.variant(*id) else {
            continue;
        };
        let reader = Reader {
            id: *id,
            variant,
            data: table.frame().data(frame, id.direction),
            offset: table.frame().data_start(id.direction),
        };
        match reader.values() {
            Ok(values) => {
                return Ok(Decoded {
                    variant: *id,
                    values,
                    address: table.frame().address(frame),
                });
            }
            Err(bad) => rejection = rejection.or(Some(DecodeError::Raw(bad))),
        }
    }
    Err(rejection.unwrap_or_else(|| no_message(table, rules, frame, of)))
}

fn validated<'a>(
    table: &Table,
    rules: &Rules,
    data: &'a [u8],
    of: Option<usize>,
) -> Result<Frame<'a>, DecodeError> {
    let misnamed = misnamed(table, rules, data, of);
    let reason = match misnamed.map_or_else(|| rules.validate(data), Verdict::Rejected) {
        Verdict::Frame(frame) if frame.bytes().len() == data.len() => return Ok(frame),
        Verdict::Frame(frame) => {
            let (reason, offset) = (Reason::Trailing, frame.bytes().len());
            return Err(DecodeError::Frame { reason, offset });
        }
        Verdict::Waits => Reason::Truncated,
        Verdict::Rejected(reason) => reason,
    };
    Err(reject(table.frame(), reason, data))
}

/// Return the error of a frame for which the rules have no message: it has another direction or
/// command, or an unknown id that its framer accepted.
#[cold]
fn no_message(table: &Table, rules: &Rules, frame: Frame<'_>, of: Option<usize>) -> DecodeError {
    let data = frame.bytes();
    let reason = misnamed(table, rules, data, of).unwrap_or_else(|| match rules.validate(data) {
        Verdict::Rejected(reason) => reason,
        _ => Reason::UnknownId,
    });
    reject(table.frame(), reason, data)
}

/// Return why `data` cannot be a frame of the command `of`, judged by its id and LEN only; `None`
/// if it may be one.
fn misnamed(table: &Table, rules: &Rules, data: &[u8], of: Option<usize>) -> Option<Reason> {
    let of = of?;
    let claim = rules.claim(data).ok().flatten()?;
    if rules
        .claimed(claim)
        .iter()
        .any(|variant| variant.command == of)
    {
        return None;
    }
    let command = table.commands().get(of);
    let is_id = command.is_some_and(|command| command.id == claim.id);
    Some(if is_id || rules.lacks_ids() {
        Reason::BadLength
    } else {
        Reason::UnknownId
    })
}

/// Return the error for a reason, with the index of the byte for which `data` is rejected.
fn reject(frame: &FrameFormat, reason: Reason, data: &[u8]) -> DecodeError {
    let Layout {
        length,
        id,
        address_at,
        overhead,
        ..
    } = frame.layout;
    let offset = match reason {
        Reason::NoHeader => {
            let header = frame.header.iter().zip(data);
            header.take_while(|(byte, given)| byte == given).count()
        }
        Reason::BadAddress => address_at.unwrap_or_default(),
        Reason::BadLength => length.at,
        Reason::UnknownId => id.at,
        Reason::BadCheck => {
            let length = usize::from(length.read(data).unwrap_or_default());
            (overhead + length).saturating_sub(frame.check.size())
        }
        Reason::Truncated | Reason::Trailing => data.len(),
    };
    DecodeError::Frame { reason, offset }
}
