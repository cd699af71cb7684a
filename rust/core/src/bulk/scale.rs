//! A scale without a division.
//!
//! The physical value is the double nearest to `whole * multiply / divide`. Dividing gives it, and
//! costs more than all the rest; multiplying by the nearest double to `multiply / divide` does not:
//! for 8,779 words of 65,536 the last bit of a hundredth is wrong. But that factor in two parts
//! does: the high one has so few bits that its product is exact, the low one makes up for the
//! rest, and one rounding is left, that of the sum. Whether it holds is tried for every word.

use crate::field::Number;

/// How a whole number becomes a physical value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    multiply: f64,
    divide: f64,
    high: f64,
    low: f64,
    /// Whether multiplying gives what dividing does.
    pub(crate) exact: bool,
}

/// The bits of the high part that are not used: those of a word of two bytes with its sign.
const SPARE: u64 = (1 << 17) - 1;

impl Scale {
    /// No scale.
    pub(crate) const ONE: Self = Self {
        multiply: 1.0,
        divide: 1.0,
        high: 1.0,
        low: 0.0,
        exact: true,
    };

    pub(crate) fn new(number: &Number) -> Self {
        // Both casts are exact: the table is checked for it.
        let (multiply, divide) = (number.multiply as f64, number.divide as f64);
        if divide == 1.0 {
            return Self {
                multiply,
                high: multiply,
                ..Self::ONE
            };
        }
        let high = f64::from_bits((multiply / divide).to_bits() & !SPARE);
        let mut scale = Self {
            multiply,
            divide,
            high,
            low: (multiply - high * divide) / divide,
            exact: true,
        };
        let mut words = -(1 << 16)..1 << 16;
        scale.exact =
            words.all(|word| scale.multiplied(word).to_bits() == scale.divided(word).to_bits());
        scale
    }

    #[inline(always)]
    pub(crate) fn multiplied(self, whole: i32) -> f64 {
        let whole = f64::from(whole);
        whole * self.high + whole * self.low
    }

    #[inline(always)]
    pub(crate) fn divided(self, whole: i32) -> f64 {
        f64::from(whole) * self.multiply / self.divide
    }
}
