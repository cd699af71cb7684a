//! Fields of messages: their numbers, and the raw values that these may hold.

use alloc::vec::Vec;

use crate::number::{Encoding, Misfit, Number};

/// The numbers of a field whose selector holds one of `when`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Case {
    pub when: Vec<i64>,
    pub numbers: Vec<Number>,
}

impl Case {
    fn size(&self) -> usize {
        // Saturating, because this also measures tables that are about to be rejected.
        let widths = self.numbers.iter().map(Number::step);
        widths.fold(0, usize::saturating_add)
    }
}

/// How the numbers of a field form one value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shape {
    /// A row of numbers.
    #[default]
    Numbers,
    /// Bytes.
    Bytes,
    /// Text, with the byte that pads it to the size of its field, if any.
    Text(Encoding, Option<u8>),
}

/// One argument of a request or one part of a reply.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Field {
    /// Whether it is a flag; only flags accept a bool as a number.
    pub flag: bool,
    /// Whether its value is a row of numbers.
    pub many: bool,
    /// The legal raw values; empty: all between the bounds.
    pub choices: Vec<i64>,
    /// Index of the field in the same variant whose raw value picks the case.
    pub selector: Option<usize>,
    /// Its cases; without a selector it has only the first one.
    pub cases: Vec<Case>,
    /// How its numbers form a value.
    pub shape: Shape,
    /// The count of numbers in each element of a list of rows or texts; 0 for other fields.
    pub each: usize,
    /// Whether its size differs between variants, or it counts the elements of another field.
    pub varies: bool,
}

impl Field {
    pub(crate) fn size(&self) -> usize {
        self.cases.first().map_or(0, Case::size)
    }

    /// Return the index of the case that the selector's raw value picks.
    pub(crate) fn case(&self, picked: i64) -> Option<usize> {
        self.cases
            .iter()
            .position(|case| case.when.contains(&picked))
    }

    /// Return the numbers of a case.
    #[must_use]
    pub fn numbers(&self, case: usize) -> &[Number] {
        self.cases.get(case).map_or(&[], |case| &case.numbers)
    }

    /// Return whether one of its numbers may hold that raw value.
    pub(crate) fn allows(&self, number: &Number, raw: i64) -> bool {
        if self.choices.is_empty() {
            number.allows(raw)
        } else {
            self.choices.contains(&raw)
        }
    }

    /// Return the smallest and the largest raw value that it allows in any case.
    pub(crate) fn raw_range(&self) -> (i64, i64) {
        let numbers = || self.cases.iter().flat_map(|case| &case.numbers);
        let all = if self.choices.is_empty() {
            (
                numbers().map(|number| number.minimum).min(),
                numbers().map(|number| number.maximum).max(),
            )
        } else {
            (
                self.choices.iter().min().copied(),
                self.choices.iter().max().copied(),
            )
        };
        (all.0.unwrap_or_default(), all.1.unwrap_or_default())
    }

    /// Return the index of the first byte that is not valid in the text's encoding, if there is
    /// one.
    pub(crate) fn bad_text_at(&self, bytes: &[u8]) -> Option<usize> {
        let Shape::Text(Encoding::Utf8, _) = self.shape else {
            return None;
        };
        let each = if self.each == 0 {
            bytes.len()
        } else {
            self.each
        };
        bytes
            .chunks(each.max(1))
            .enumerate()
            .find_map(|(index, text)| {
                let error = core::str::from_utf8(text).err()?;
                Some(index * each + error.valid_up_to())
            })
    }

    pub(crate) fn check(&self, fields: &[Self]) -> Result<(), Misfit> {
        for case in &self.cases {
            case.numbers.iter().try_for_each(Number::check)?;
            if case.size() != self.size() || !(self.many || case.numbers.len() == 1) {
                return Err(Misfit::Cases);
            }
        }
        if self.cases.is_empty() {
            return Err(Misfit::Cases);
        }
        match self.selector.map(|index| fields.get(index)) {
            Some(None) => Err(Misfit::Selector),
            Some(Some(selector)) if selector.many => Err(Misfit::Selector),
            _ => Ok(()),
        }
    }
}
