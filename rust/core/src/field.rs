//! Numbers and fields: what stands on the wire, and what it stands for.

use crate::error::Misfit;

/// Beyond this a double no longer holds every whole number.
const EXACT: u64 = 1 << 53;

/// Which byte of a word comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The most significant.
    Big,
    /// The least significant.
    Little,
}

/// One number on the wire.
///
/// The unsigned word `w` stands for `w - 256^width` if `w > signed_at`, else for `w`; that whole
/// number times `multiply / divide` is the physical value. The bounds are of the whole number.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the doc above says what each is
pub struct Number {
    pub width: usize,
    pub order: Order,
    pub signed_at: i64,
    pub multiply: i64,
    pub divide: i64,
    pub minimum: i64,
    pub maximum: i64,
}

impl Number {
    /// Whether the physical value is a real number, rather than the whole number itself.
    #[must_use]
    pub fn scaled(&self) -> bool {
        (self.multiply, self.divide) != (1, 1)
    }

    /// Whether whatever stands on the wire lies between the bounds.
    pub(crate) fn takes_every_word(&self) -> bool {
        let words = 1 << (8 * self.width);
        let signed_at = self.signed_at.clamp(-1, words - 1);
        let least = if signed_at < words - 1 {
            signed_at + 1 - words
        } else {
            0
        };
        self.minimum <= least && signed_at <= self.maximum
    }

    fn check(&self) -> Result<(), Misfit> {
        if !(1..=4).contains(&self.width) {
            return Err(Misfit::Width);
        }
        // So that whole * multiply and divide are exact, and one rounding is left: the division.
        let widest = EXACT >> (8 * self.width);
        let exact = self.multiply.unsigned_abs() <= widest && self.divide.unsigned_abs() <= EXACT;
        if self.multiply == 0 || self.divide == 0 || !exact {
            return Err(Misfit::Scale);
        }
        let bounded = |bound: i64| bound.unsigned_abs() < EXACT;
        if bounded(self.minimum) && bounded(self.maximum) {
            Ok(())
        } else {
            Err(Misfit::Bounds)
        }
    }
}

/// How a field reads while its selector holds one of `when`.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // as above
pub struct Case {
    pub when: Vec<i64>,
    pub numbers: Vec<Number>,
}

impl Case {
    fn size(&self) -> usize {
        // Saturating, because this also measures tables that are about to be refused.
        let widths = self.numbers.iter().map(|number| number.width);
        widths.fold(0, usize::saturating_add)
    }
}

/// One argument of a request or one part of a reply.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Whether it is a flag: then, and only then, a bool is a number.
    pub flag: bool,
    /// Whether its value is a row of numbers.
    pub many: bool,
    /// The legal whole numbers; empty: all between the bounds.
    pub choices: Vec<i64>,
    /// Index of the field in the same layout whose whole number picks the case.
    pub selector: Option<usize>,
    /// How it reads; only the first matters where there is no selector.
    pub cases: Vec<Case>,
}

impl Field {
    pub(crate) fn size(&self) -> usize {
        self.cases.first().map_or(0, Case::size)
    }

    /// The index of the case for what its selector holds.
    pub(crate) fn case(&self, picked: i64) -> Option<usize> {
        self.cases
            .iter()
            .position(|case| case.when.contains(&picked))
    }

    /// The numbers of a case.
    pub(crate) fn numbers(&self, case: usize) -> &[Number] {
        self.cases.get(case).map_or(&[], |case| &case.numbers)
    }

    /// Whether one of its numbers may hold that whole number.
    pub(crate) fn allows(&self, number: &Number, whole: i64) -> bool {
        if self.choices.is_empty() {
            (number.minimum..=number.maximum).contains(&whole)
        } else {
            self.choices.contains(&whole)
        }
    }

    /// The smallest and the largest whole number that it allows in any case.
    pub(crate) fn whole_range(&self) -> (i64, i64) {
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
