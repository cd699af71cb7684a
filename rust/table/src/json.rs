//! Reads values of a JSON file and checks their types.

use alloc::vec::Vec;
use core::fmt::Display;
use core::ops::RangeInclusive;

use serde::Deserialize;
use serde_json::Value;

use crate::{BadEdition, Outcome, Within};

/// A type with a few values; a file names each of them by a word.
pub(crate) trait Word: Copy + 'static {
    /// Each word, and the value that it names.
    const WORDS: &'static [(&'static str, Self)];
}

static NULL: Value = Value::Null;

/// An object of the file.
#[derive(Clone, Copy)]
pub(crate) struct Record<'a>(pub(crate) &'a Value);

impl<'a> Record<'a> {
    /// Return the value of a key; null if it is missing.
    pub(crate) fn at(self, key: &str) -> Self {
        Self(self.0.get(key).unwrap_or(&NULL))
    }

    /// Return the value of a key, unless it is missing or null.
    pub(crate) fn some(self, key: &str) -> Option<Self> {
        Some(self.at(key)).filter(|value| !value.0.is_null())
    }

    /// Return the value of a key; a missing key is an error unless `T` is an option.
    pub(crate) fn get<T: Deserialize<'a>>(self, key: &str) -> Outcome<T> {
        let read = T::deserialize(self.at(key).0);
        read.or_else(BadEdition::because).within(key, "")
    }

    /// Return the value of a key; the default if the key is missing.
    pub(crate) fn or<T: Deserialize<'a>>(self, key: &str, usual: T) -> Outcome<T> {
        Ok(self.get::<Option<T>>(key)?.unwrap_or(usual))
    }

    /// Return the value of a key; an empty one if the key is missing.
    pub(crate) fn any<T: Deserialize<'a> + Default>(self, key: &str) -> Outcome<T> {
        self.or(key, T::default())
    }

    /// Return the value that a word names.
    pub(crate) fn word<T: Word>(self, key: &str) -> Outcome<T> {
        self.at(key).as_word().within(key, "")
    }

    /// Return the value that a word names; the default if the key is missing.
    pub(crate) fn word_or<T: Word>(self, key: &str, usual: T) -> Outcome<T> {
        self.some(key).map_or(Ok(usual), |_| self.word(key))
    }

    /// Return the values that a list of words names; the default if the key is missing.
    pub(crate) fn words_or<T: Word>(self, key: &str, usual: &[T]) -> Outcome<Vec<T>> {
        let read = |list: Self| list.items()?.into_iter().map(Self::as_word).collect();
        let words = self.some(key).map(read);
        words.unwrap_or_else(|| Ok(usual.to_vec())).within(key, "")
    }

    fn as_word<T: Word>(self) -> Outcome<T> {
        let found = T::WORDS.iter().find(|(word, _)| self.0 == word);
        let unknown = || {
            let words: Vec<&str> = T::WORDS.iter().map(|(word, _)| *word).collect();
            BadEdition::because(format_args!(
                "{} is not one of {}",
                self.0,
                words.join(", ")
            ))
        };
        found.map_or_else(unknown, |(_, value)| Ok(*value))
    }

    /// Return a number in a range.
    pub(crate) fn within<T>(self, key: &str, range: RangeInclusive<T>) -> Outcome<T>
    where
        T: Deserialize<'a> + PartialOrd + Display,
    {
        let found = self.get(key)?;
        if range.contains(&found) {
            return Ok(found);
        }
        let (low, high) = range.into_inner();
        BadEdition::because(format_args!("{key} is {found}; allowed: {low}..{high}"))
    }

    /// Return a number in a range; the default if the key is missing.
    pub(crate) fn within_or<T>(self, key: &str, range: RangeInclusive<T>, usual: T) -> Outcome<T>
    where
        T: Deserialize<'a> + PartialOrd + Display,
    {
        let found = self.some(key);
        found.map_or(Ok(usual), |_| self.within(key, range))
    }

    /// Return the items of a list; there are none if it is missing.
    pub(crate) fn items(self) -> Outcome<Vec<Self>> {
        match self.0 {
            Value::Null => Ok(Vec::new()),
            Value::Array(items) => Ok(items.iter().map(Self).collect()),
            other => BadEdition::because(format_args!("{other} is not a list")),
        }
    }

    /// Return the objects of a list; there are none if the key is missing.
    pub(crate) fn records(self, key: &str) -> Outcome<Vec<Self>> {
        self.at(key).items().within(key, "")
    }

    /// Return a fraction, such as `-552/5`: its numerator and its denominator, which is not 0. A
    /// missing key means 1.
    pub(crate) fn rational(self, key: &str) -> Outcome<(i64, i64)> {
        let Some(text) = self.at(key).0.as_str() else {
            return Ok((self.or(key, 1)?, 1));
        };
        let (above, below) = text.split_once('/').unwrap_or((text, "1"));
        match (above.parse(), below.parse()) {
            (Ok(above), Ok(below)) if below != 0 => Ok((above, below)),
            _ => BadEdition::because("expected an integer, or a text such as 1/2").within(key, ""),
        }
    }

    /// Return the value of the key `name`.
    pub(crate) fn name(self) -> Outcome<&'a str> {
        self.get("name")
    }
}
