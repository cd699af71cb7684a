//! Reads values of JSON whose types are not known, and says which of them is wrong.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;
use core::ops::RangeInclusive;

use serde_json::{Map, Value};

/// Why a file is not the table of a protocol, as a sentence that says where it is wrong.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadEdition {
    message: String,
}

impl BadEdition {
    pub(crate) fn new(message: impl Into<String>) -> Self {
        let message = message.into();
        Self { message }
    }
}

impl fmt::Display for BadEdition {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl core::error::Error for BadEdition {}

/// What was read, or why it could not be.
pub(crate) type Outcome<T> = Result<T, BadEdition>;

/// Says in an error where the mistake is.
pub(crate) trait Within<T> {
    /// Put the name of a place before the sentence of an error.
    fn within(self, what: &str, name: &str) -> Outcome<T>;
}

impl<T> Within<T> for Outcome<T> {
    fn within(self, what: &str, name: &str) -> Outcome<T> {
        self.map_err(|error| {
            let space = if name.is_empty() { "" } else { " " };
            BadEdition::new(format!("{what}{space}{}: {error}", shown(name)))
        })
    }
}

/// Return a text of the file for an error: no longer than a line, and without control characters.
pub(crate) fn shown(text: &str) -> String {
    let text = text.chars().filter(|char| !char.is_control());
    text.take(60).collect()
}

/// An object of the file.
#[derive(Clone, Copy)]
pub(crate) struct Record<'a>(&'a Map<String, Value>);

/// A value of the file, and what to call it in an error.
#[derive(Clone, Copy)]
pub(crate) struct Node<'a> {
    value: &'a Value,
    name: &'a str,
}

impl<'a> Record<'a> {
    /// Return the value of a key; `None` if the object lacks it, or has null.
    pub(crate) fn get(self, name: &'a str) -> Option<Node<'a>> {
        let value = self.0.get(name).filter(|value| !value.is_null())?;
        Some(Node { value, name })
    }

    /// Return the value of a key that must be there.
    pub(crate) fn need(self, name: &'a str) -> Outcome<Node<'a>> {
        self.get(name)
            .ok_or_else(|| BadEdition::new(format!("{name} is missing")))
    }

    /// Return the items of a list; none if the key is missing.
    pub(crate) fn list(self, name: &'a str) -> Outcome<impl ExactSizeIterator<Item = Node<'a>>> {
        let found = self.get(name).map(Node::list).transpose()?;
        let items: &[Value] = found.unwrap_or_default();
        Ok(items.iter().map(move |value| Node { value, name }))
    }

    /// Return the objects of a list; none if the key is missing.
    pub(crate) fn records(self, name: &'a str) -> Outcome<Vec<Record<'a>>> {
        self.list(name)?.map(Node::record).collect()
    }

    /// Return the texts of a list; none if the key is missing.
    pub(crate) fn texts(self, name: &'a str) -> Outcome<Vec<String>> {
        self.list(name)?.map(Node::string).collect()
    }

    /// Return the integers of a list; none if the key is missing.
    pub(crate) fn integers(self, name: &'a str) -> Outcome<Vec<i64>> {
        self.list(name)?.map(Node::integer).collect()
    }

    /// Return a text; empty if the key is missing.
    pub(crate) fn text(self, name: &'a str) -> Outcome<&'a str> {
        self.get(name).map_or(Ok(""), Node::text)
    }

    /// Return the values of an object that maps names to texts.
    pub(crate) fn values(self) -> Outcome<Vec<String>> {
        let nodes = self.0.iter().map(|(name, value)| Node { value, name });
        nodes.map(Node::string).collect()
    }

    /// Return the name of what the object describes.
    pub(crate) fn name(self) -> Outcome<&'a str> {
        self.need("name")?.text()
    }

    /// Return an integer; `default` if the key is missing.
    pub(crate) fn integer(self, name: &'a str, default: i64) -> Outcome<i64> {
        self.get(name).map_or(Ok(default), Node::integer)
    }

    /// Return an integer that must be there and lie in a range.
    pub(crate) fn within(self, name: &'a str, range: RangeInclusive<i64>) -> Outcome<i64> {
        self.need(name)?.within(range)
    }

    /// Return a size that must be there.
    pub(crate) fn size(self, name: &'a str, most: i64) -> Outcome<usize> {
        let size = self.within(name, 0..=most)?;
        Ok(usize::try_from(size).unwrap_or_default())
    }

    /// Return whether a key is true; a missing one is not.
    pub(crate) fn is(self, name: &'a str) -> Outcome<bool> {
        self.get(name).map_or(Ok(false), |node| {
            node.value
                .as_bool()
                .ok_or_else(|| node.expected("true or false"))
        })
    }
}

impl<'a> Node<'a> {
    /// Return the root of a file.
    pub(crate) fn root(value: &'a Value) -> Self {
        let name = "the file";
        Self { value, name }
    }

    fn expected(self, allowed: &str) -> BadEdition {
        let found = match self.value {
            Value::Null => "null".to_string(),
            Value::Bool(_) => "true or false".to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(text) => format!("{:?}", shown(text)),
            Value::Array(_) => "a list".to_string(),
            Value::Object(_) => "an object".to_string(),
        };
        BadEdition::new(format!("{} is {found}; allowed: {allowed}", self.name))
    }

    /// Return the error of a word that is not one of those allowed.
    pub(crate) fn unknown(self, allowed: &str) -> BadEdition {
        self.expected(allowed)
    }

    pub(crate) fn record(self) -> Outcome<Record<'a>> {
        let object = self.value.as_object();
        Ok(Record(object.ok_or_else(|| self.expected("an object"))?))
    }

    pub(crate) fn list(self) -> Outcome<&'a [Value]> {
        let list = self.value.as_array();
        Ok(list.ok_or_else(|| self.expected("a list"))?)
    }

    /// Return the objects of a list that is an item of another one.
    pub(crate) fn records(self) -> Outcome<Vec<Record<'a>>> {
        let (items, name) = (self.list()?, self.name);
        let nodes = items.iter().map(|value| Node { value, name });
        nodes.map(Node::record).collect()
    }

    pub(crate) fn text(self) -> Outcome<&'a str> {
        self.if_text().ok_or_else(|| self.expected("a text"))
    }

    /// Return the text; `None` if it is something else.
    pub(crate) fn if_text(self) -> Option<&'a str> {
        self.value.as_str()
    }

    pub(crate) fn string(self) -> Outcome<String> {
        self.text().map(String::from)
    }

    pub(crate) fn integer(self) -> Outcome<i64> {
        self.value
            .as_i64()
            .ok_or_else(|| self.expected("an integer"))
    }

    pub(crate) fn within(self, range: RangeInclusive<i64>) -> Outcome<i64> {
        let found = self.integer()?;
        if range.contains(&found) {
            return Ok(found);
        }
        let (low, high) = range.into_inner();
        Err(self.expected(&format!("{low}..{high}")))
    }

    pub(crate) fn byte(self) -> Outcome<u8> {
        let byte = self.within(0..=255)?;
        Ok(u8::try_from(byte).unwrap_or_default())
    }

    /// Return an exact number, such as `-552/5`: its numerator and its denominator, which is not 0.
    pub(crate) fn rational(self) -> Outcome<(i64, i64)> {
        let Some(text) = self.if_text() else {
            return Ok((self.integer()?, 1));
        };
        let (above, below) = text.split_once('/').unwrap_or((text, "1"));
        match (above.parse(), below.parse()) {
            (Ok(above), Ok(below)) if below != 0 => Ok((above, below)),
            _ => Err(self.expected("an integer, or a text such as \"1/100\"")),
        }
    }

    /// Return the nearest float to an exact number.
    pub(crate) fn real(self) -> Outcome<f64> {
        let (above, below) = self.rational()?;
        Ok(above as f64 / below as f64)
    }

    /// Return bytes, which are pairs of hexadecimal digits.
    pub(crate) fn bytes(self, most: usize) -> Outcome<Vec<u8>> {
        let digits: Vec<char> = self.text()?.chars().filter(|char| *char != ' ').collect();
        let bytes = digits.chunks(2).map(|pair| match pair {
            [high, low] => Some(high.to_digit(16)? << 4 | low.to_digit(16)?),
            _ => None,
        });
        let bytes: Option<Vec<u8>> = bytes.map(|byte| u8::try_from(byte?).ok()).collect();
        bytes
            .filter(|bytes| bytes.len() <= most)
            .ok_or_else(|| self.expected(&format!("hexadecimal digits of at most {most} bytes")))
    }
}
