//! Values as Python writes them, for the texts of errors.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::{Display, Formatter, Result};

use cobotwire_core::{Encoding, Value};

/// A longer value is cut.
const MOST: usize = 80;

/// A value as a text shows it.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// A truth value.
    Flag(bool),
    /// An integer.
    Integer(i64),
    /// A real number.
    Real(f64),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// Values in square brackets.
    List(Vec<Shown>),
    /// Values in parentheses.
    Tuple(Vec<Shown>),
    /// Anything else, as it is to be written.
    Other(String),
}

/// A value of a caller that an error can be about.
pub trait Quote {
    /// Return it as a text shows it.
    fn quote(&self) -> Shown;
}

impl Shown {
    /// Return the first of these values, which may be a row of others, and how many it takes.
    pub(crate) fn decoded(values: &[Value]) -> Option<(Self, usize)> {
        let byte = |value: &Value| match value {
            Value::Integer(byte) => u8::try_from(*byte).unwrap_or_default(),
            _ => 0,
        };
        let (first, rest) = values.split_first()?;
        let many = |count: usize| rest.get(..count).unwrap_or(rest);
        let (mut all, mut taken) = (Vec::new(), 1);
        match *first {
            Value::Integer(raw) => return Some((Self::Integer(raw), 1)),
            Value::Real(real) => return Some((Self::Real(real), 1)),
            Value::Bytes(count) => {
                let bytes = many(count).iter().map(byte).collect();
                return Some((Self::Bytes(bytes), 1 + count));
            }
            Value::Text(count, encoding) => {
                let bytes: Vec<u8> = many(count).iter().map(byte).collect();
                let text = match encoding {
                    Encoding::Utf8 => String::from_utf8_lossy(&bytes).into_owned(),
                    _ => bytes.into_iter().map(char::from).collect(),
                };
                return Some((Self::Text(text), 1 + count));
            }
            Value::Row(count) | Value::Rows(count) => {
                for _ in 0..count {
                    let (value, size) = Self::decoded(values.get(taken..)?)?;
                    all.push(value);
                    taken += size;
                }
            }
        }
        Some((Self::Tuple(all), taken))
    }

    /// Return its length: of a text, in bytes of an encoding.
    pub(crate) fn count(&self, encoding: Option<Encoding>) -> usize {
        match self {
            Self::List(all) | Self::Tuple(all) => all.len(),
            Self::Bytes(bytes) => bytes.len(),
            Self::Text(text) if encoding == Some(Encoding::Utf8) => text.len(),
            Self::Text(text) => text.chars().count(),
            _ => 0,
        }
    }

    /// Return it as Python's `str` writes it: a text without quotes.
    pub(crate) fn plain(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            other => other.to_string(),
        }
    }

    /// Return it, cut if it is long.
    pub(crate) fn short(&self) -> String {
        let text = self.to_string();
        match text.char_indices().nth(MOST) {
            None => text,
            Some(_) => text.chars().take(MOST - 3).chain("...".chars()).collect(),
        }
    }
}

impl Display for Shown {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        match self {
            Self::Flag(flag) => out.write_str(if *flag { "True" } else { "False" }),
            Self::Integer(integer) => integer.fmt(out),
            Self::Real(real) => out.write_str(&shortest(*real)),
            Self::Text(text) => out.write_str(&quoted(text)),
            Self::Bytes(bytes) => {
                // Python escapes in bytes what it escapes in a text, and all above 7E.
                let text: String = bytes.iter().copied().map(char::from).collect();
                write!(out, "b{}", quoted_if(&text, |char| matches!(char, ' '..='~')))
            }
            Self::List(all) => write!(out, "[{}]", joined(all)),
            Self::Tuple(all) if all.len() == 1 => write!(out, "({},)", joined(all)),
            Self::Tuple(all) => write!(out, "({})", joined(all)),
            Self::Other(text) => out.write_str(text),
        }
    }
}

fn joined(all: &[Shown]) -> String {
    let all: Vec<String> = all.iter().map(Shown::to_string).collect();
    all.join(", ")
}

/// Return a real number: the shortest decimal that reads back as the same double.
pub(crate) fn shortest(real: f64) -> String {
    let text = format!("{real:?}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => with_exponent(mantissa, exponent),
        None if real.is_nan() => "nan".into(),
        None => text,
    }
}

/// Return a real number with that many digits, without trailing zeros: `{:g}` in Python.
#[must_use]
pub fn general(real: f64, digits: usize) -> String {
    if !real.is_finite() {
        return shortest(real);
    }
    let text = format!("{real:.*e}", digits - 1);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let trimmed = |text: &str| match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').to_string(),
        false => text.to_string(),
    };
    match exponent.parse::<i64>().map(|size| digits as i64 - 1 - size) {
        Ok(places @ 0..) if places <= digits as i64 + 3 => {
            trimmed(&format!("{real:.*}", places as usize))
        }
        _ => with_exponent(&trimmed(mantissa), exponent),
    }
}

/// Return an exponent with its sign and at least two digits.
fn with_exponent(mantissa: &str, exponent: &str) -> String {
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    format!("{mantissa}e{sign}{digits:0>2}")
}

/// Return a text in quotes.
pub(crate) fn quoted(text: &str) -> String {
    quoted_if(text, is_printable)
}

fn quoted_if(text: &str, kept: impl Fn(char) -> bool) -> String {
    let double = text.contains('\'') && !text.contains('"');
    let quote = if double { '"' } else { '\'' };
    let inner = text.chars().map(|char| match char {
        '\\' => "\\\\".into(),
        _ if char == quote => format!("\\{char}"),
        _ if kept(char) => char.to_string(),
        _ => escaped(char),
    });
    format!("{quote}{}{quote}", inner.collect::<String>())
}

/// Return a text with an escape for each character that is not printable.
pub(crate) fn printable(text: &str) -> String {
    text.chars()
        .map(|char| {
            if is_printable(char) {
                char.to_string()
            } else {
                escaped(char)
            }
        })
        .collect()
}

/// Return whether a character is printable. The standard library escapes the others where it shows
/// a text; of the first character it escapes more.
fn is_printable(char: char) -> bool {
    matches!(char, ' '..='~') || !char.is_ascii() && {
        let text = ['a', char].iter().collect::<String>();
        text.escape_debug().nth(1) == Some(char)
    }
}

fn escaped(char: char) -> String {
    match (char, u32::from(char)) {
        ('\n', _) => "\\n".into(),
        ('\r', _) => "\\r".into(),
        ('\t', _) => "\\t".into(),
        (_, code @ ..0x100) => format!("\\x{code:02x}"),
        (_, code @ ..0x1_0000) => format!("\\u{code:04x}"),
        (_, code) => format!("\\U{code:08x}"),
    }
}
