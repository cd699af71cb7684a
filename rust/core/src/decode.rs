//! Bytes to values. A frame that is not legal, or a number that the table rules out, is an error.

use crate::error::{DecodeError, Reason};
use crate::frame::{Frame, FrameFormat};
use crate::judge::{Rules, Verdict};
use crate::legal::Form;
use crate::read::{Reader, Value};
use crate::table::{Direction, Listening, Table};

/// A decoded frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Decoded {
    /// Which message it is.
    pub form: Form,
    /// Its values, one a field and those of rows.
    pub values: Vec<Value>,
    /// Its address byte, where the format has one.
    pub address: Option<u8>,
}

/// Read `data`, which must be one whole frame and nothing else; `of`: one of this command, by its
/// index. Where calls share an id and a size, it is the first of them that allows the values.
///
/// # Errors
/// It is not, or a number in it is not allowed: then it is the first one, but a selector goes
/// before the fields that it picks the case of. Where several forms refuse it, it is the first
/// one's error.
pub fn decode(
    table: &Table,
    direction: Direction,
    data: &[u8],
    of: Option<usize>,
) -> Result<Decoded, DecodeError> {
    let rules = table.rules(Listening::To(direction));
    let frame = whole_frame(table, rules, data, of)?;
    let forms = rules.forms(frame).iter();
    let named = forms.filter(|form| of.is_none_or(|of| of == form.command));
    read_as(table, frame, named)
}

/// Read a frame that a framer with these rules gave: the first form that allows the values.
///
/// # Errors
/// None does, or the table lacks the id and the rules believed it.
pub fn read(table: &Table, rules: &Rules, frame: Frame<'_>) -> Result<Decoded, DecodeError> {
    read_as(table, frame, rules.forms(frame).iter())
}

fn read_as<'a>(
    table: &Table,
    frame: Frame<'_>,
    forms: impl Iterator<Item = &'a Form>,
) -> Result<Decoded, DecodeError> {
    let mut refusal = None;
    for form in forms {
        let Some(layout) = table.layout(*form) else {
            continue;
        };
        let reader = Reader {
            form: *form,
            layout,
            data: table.frame().data(frame),
            offset: table.frame().overhead() + 1,
        };
        match reader.values() {
            Ok(values) => {
                return Ok(Decoded {
                    form: *form,
                    values,
                    address: table.frame().address(frame),
                });
            }
            Err(bad) => refusal = refusal.or(Some(DecodeError::Raw(bad))),
        }
    }
    // Only of an id that was believed there is no form.
    Err(refusal.unwrap_or_else(|| refuse(table.frame(), Reason::UnknownId, frame.bytes())))
}

fn whole_frame<'a>(
    table: &Table,
    rules: &Rules,
    data: &'a [u8],
    of: Option<usize>,
) -> Result<Frame<'a>, DecodeError> {
    let misnamed = of.and_then(|of| misnamed(table, rules, data, of));
    let reason = match misnamed.map_or_else(|| rules.judge(data), Verdict::Refuted) {
        Verdict::Stands(frame) if frame.bytes().len() == data.len() => return Ok(frame),
        Verdict::Stands(frame) => {
            let (reason, offset) = (Reason::Trailing, frame.bytes().len());
            return Err(DecodeError::Frame { reason, offset });
        }
        Verdict::Waits => Reason::Truncated,
        Verdict::Refuted(reason) => reason,
    };
    Err(refuse(table.frame(), reason, data))
}

/// Why `data` is no frame of that command, whatever follows its id and whatever others share it.
fn misnamed(table: &Table, rules: &Rules, data: &[u8], of: usize) -> Option<Reason> {
    let claim = rules.claim(data).ok().flatten()?;
    if rules.claimed(claim).iter().any(|form| form.command == of) {
        return None;
    }
    let command = table.commands().get(of);
    Some(if command.is_some_and(|command| command.id == claim.id) {
        Reason::BadLength
    } else {
        Reason::UnknownId
    })
}

/// The error, with the byte that refutes a frame at the start of `data`.
fn refuse(frame: &FrameFormat, reason: Reason, data: &[u8]) -> DecodeError {
    let at = frame.length_at();
    let offset = match reason {
        Reason::NoHeader => {
            let header = frame.header.iter().zip(data);
            header.take_while(|(byte, given)| byte == given).count()
        }
        Reason::BadAddress => at - 1,
        Reason::BadLength => at,
        Reason::UnknownId => at + 1,
        Reason::BadCheck => {
            let length = data.get(at).map_or(0, |length| usize::from(*length));
            (frame.overhead() + length).saturating_sub(frame.check.size())
        }
        Reason::Truncated | Reason::Trailing => data.len(),
    };
    DecodeError::Frame { reason, offset }
}
