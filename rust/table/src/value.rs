//! The values of callers and of replies, as the encoder reads them and as Python writes them.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::convert::Infallible;
use core::fmt::{self, Display, Formatter};

use cobotwire_core::{Encoding, Given, Unread, Value as Flat, ValueFault};

/// Below this number a double holds every integer exactly.
const EXACT: f64 = (1_u64 << 53) as f64;

/// The value of an argument or of a field of a reply.
#[derive(Clone, Debug, Default, PartialEq)]
#[allow(missing_docs)] // the names are those of JSON and Rust
pub enum Value {
    Flag(bool),
    /// An integer, or a member of an enum.
    Integer(i64),
    Real(f64),
    Text(String),
    Bytes(Vec<u8>),
    /// A row of numbers, or a list.
    Row(Vec<Value>),
    /// The number of elements of a list, which the encoder counts.
    Counted,
    /// An argument that is left out, or a field that a reply does not have.
    #[default]
    Absent,
}

type Read<T> = Result<T, Unread<Infallible>>;
const WRONG_TYPE: Unread<Infallible> = Unread::Fault(ValueFault::Type);

impl Given for Value {
    type Error = Infallible;
    type Row = Vec<Self>;

    fn integer(&self, flag: bool) -> Read<i64> {
        match self {
            Self::Integer(raw) => Ok(*raw),
            Self::Flag(set) if flag => Ok(i64::from(*set)),
            // An integer in an array of reals arrives as a real.
            Self::Real(real) if real.abs() < EXACT && (*real as i64) as f64 == *real => {
                Ok(*real as i64)
            }
            _ => Err(WRONG_TYPE),
        }
    }

    fn real(&self) -> Read<f64> {
        match self {
            Self::Integer(raw) => Ok(*raw as f64),
            Self::Real(real) => Ok(*real),
            _ => Err(WRONG_TYPE),
        }
    }

    fn row(&self) -> Read<Vec<Self>> {
        match self {
            Self::Row(row) => Ok(row.clone()),
            _ => Err(WRONG_TYPE),
        }
    }

    fn counted(&self) -> bool {
        *self == Self::Counted
    }

    fn bytes(&self) -> Read<Option<Vec<u8>>> {
        Ok(match self {
            Self::Bytes(bytes) => Some(bytes.clone()),
            _ => None,
        })
    }

    fn text(&self, encoding: Encoding) -> Read<Vec<u8>> {
        let encoded = match (self, encoding) {
            (Self::Text(text), Encoding::Latin1) => {
                text.chars().map(|c| c.try_into().ok()).collect()
            }
            (Self::Text(text), Encoding::Ascii) if !text.is_ascii() => None,
            (Self::Text(text), _) => Some(text.as_bytes().into()),
            _ => return Err(WRONG_TYPE),
        };
        encoded.ok_or(Unread::Fault(ValueFault::Text))
    }
}

impl From<Vec<Self>> for Value {
    fn from(row: Vec<Self>) -> Self {
        Self::Row(row)
    }
}

impl Value {
    /// Return the next value of a decoded message; a row also takes its elements, which follow it.
    pub(crate) fn nested(rest: &mut impl Iterator<Item = Flat>) -> Option<Self> {
        Some(match rest.next()? {
            Flat::Integer(raw) => Self::Integer(raw),
            Flat::Real(real) => Self::Real(real),
            Flat::Row(size) | Flat::Rows(size) => {
                Self::Row((0..size).map_while(|_| Self::nested(rest)).collect())
            }
            Flat::Bytes(size) => Self::Bytes(bytes(rest, size)),
            Flat::Text(size, encoding) => {
                let bytes = bytes(rest, size);
                Self::Text(match encoding {
                    Encoding::Latin1 => bytes.into_iter().map(char::from).collect(),
                    _ => String::from_utf8_lossy(&bytes).into(),
                })
            }
        })
    }

    /// Return the number of elements; for a text, the number of bytes in an encoding.
    pub(crate) fn length(&self, encoding: Option<Encoding>) -> usize {
        match self {
            Self::Bytes(bytes) => bytes.len(),
            Self::Text(text) if encoding == Some(Encoding::Utf8) => text.len(),
            Self::Text(text) => text.chars().count(),
            Self::Row(row) => row.len(),
            _ => 0,
        }
    }
}

impl Display for Value {
    fn fmt(&self, out: &mut Formatter<'_>) -> fmt::Result {
        let joined = |all: &[Self]| join(all.iter().map(Self::to_string), ", ");
        match self {
            Self::Flag(flag) => out.write_str(if *flag { "True" } else { "False" }),
            Self::Integer(integer) => integer.fmt(out),
            Self::Real(real) => out.write_str(&shortest(*real)),
            Self::Text(text) => out.write_str(&quoted(text, is_printable)),
            Self::Bytes(bytes) => {
                let text: String = bytes.iter().copied().map(char::from).collect();
                let shown = quoted(&text, |char| (' '..='~').contains(&char));
                write!(out, "b{shown}")
            }
            Self::Row(all) if all.len() == 1 => write!(out, "({},)", joined(all)),
            Self::Row(all) => write!(out, "({})", joined(all)),
            Self::Counted | Self::Absent => out.write_str("None"),
        }
    }
}

fn bytes(rest: &mut impl Iterator<Item = Flat>, size: usize) -> Vec<u8> {
    let byte = |value| match value {
        Flat::Integer(raw) => u8::try_from(raw).ok(),
        _ => None,
    };
    rest.take(size).filter_map(byte).collect()
}

pub(crate) fn join(all: impl Iterator<Item = String>, between: &str) -> String {
    all.collect::<Vec<_>>().join(between)
}

/// Return the shortest decimal that reads back as the same double.
pub(crate) fn shortest(real: f64) -> String {
    let text = format!("{real:?}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => with_exponent(mantissa, exponent),
        None if real.is_nan() => "nan".into(),
        None => text,
    }
}

/// Return a real number with that many digits, without trailing zeros: `{:g}` in Python.
pub(crate) fn general(real: f64, digits: usize) -> String {
    let text = format!("{real:.*e}", digits.saturating_sub(1));
    let Some((mantissa, exponent)) = text.split_once('e') else {
        return shortest(real);
    };
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => String::from(text),
    };
    let size: i64 = exponent.parse().unwrap_or_default();
    match usize::try_from(digits as i64 - 1 - size) {
        Ok(places) if size >= -4 => trimmed(&format!("{real:.places$}")),
        _ => with_exponent(&trimmed(mantissa), exponent),
    }
}

/// Return a number with an exponent that has a sign and at least two digits, as in Python.
fn with_exponent(mantissa: &str, exponent: &str) -> String {
    let digits = exponent.trim_start_matches('-');
    let sign = if digits == exponent { '+' } else { '-' };
    format!("{mantissa}e{sign}{digits:0>2}")
}

/// Return a text in quotes, with an escape for each character that is not `kept`.
pub(crate) fn quoted(text: &str, kept: impl Fn(char) -> bool) -> String {
    let double = text.contains('\'') && !text.contains('"');
    let quote = if double { '"' } else { '\'' };
    let inner = text.chars().map(|char| match char {
        '\\' => "\\\\".into(),
        _ if char == quote => format!("\\{char}"),
        _ => escaped(char, kept(char)),
    });
    format!("{quote}{}{quote}", inner.collect::<String>())
}

/// Return a text with an escape for each character that is not printable.
pub(crate) fn printable(text: &str) -> String {
    let all = text.chars();
    all.map(|char| escaped(char, is_printable(char))).collect()
}

/// Return whether a character is printable. `escape_debug` leaves printable characters unchanged,
/// except for some at the start of a text.
pub(crate) fn is_printable(char: char) -> bool {
    let text: String = ['a', char].iter().collect();
    matches!(char, '\'' | '"' | '\\') || text.escape_debug().nth(1) == Some(char)
}

fn escaped(char: char, kept: bool) -> String {
    match (char, u32::from(char)) {
        _ if kept => char.into(),
        ('\n' | '\r' | '\t', _) => char.escape_default().collect(),
        (_, code @ ..0x100) => format!("\\x{code:02x}"),
        (_, code @ ..0x1_0000) => format!("\\u{code:04x}"),
        (_, code) => format!("\\U{code:08x}"),
    }
}
