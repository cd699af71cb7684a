//! Turns raw values into physical values without a division.
//!
//! The physical value is the double nearest to `raw * multiply / divide`. A division computes it,
//! but takes longer than everything else. Multiplying by the double nearest to `multiply / divide`
//! is not exact: for hundredths, the last bit is wrong for 8,779 of 65,536 raw values. A factor in
//! two parts is exact: the product of the high part is exact, since it has few bits; the low part
//! adds the rest; only the sum is rounded. The constructor verifies this for every raw value.

use crate::number::Number;

/// How a raw value becomes a physical value.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    multiply: f64,
    divide: f64,
    pub(crate) high: f64,
    pub(crate) low: f64,
    /// Whether multiplying has the same result as dividing.
    pub(crate) exact: bool,
}

/// The low bits that are zero in the high part, so that its product with a two-byte number is
/// exact.
const SPARE: u64 = (1 << 17) - 1;

impl Scale {
    /// The scale of a number that has none.
    pub(crate) const ONE: Self = Self {
        multiply: 1.0,
        divide: 1.0,
        high: 1.0,
        low: 0.0,
        exact: true,
    };

    pub(crate) fn new(number: &Number) -> Self {
        // Both casts are exact: Table::new checks that.
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
    pub(crate) fn multiplied(self, raw: i32) -> f64 {
        let raw = f64::from(raw);
        raw * self.high + raw * self.low
    }

    #[inline(always)]
    pub(crate) fn divided(self, raw: i32) -> f64 {
        // Adding zero turns -0.0 into 0.0: the product of integers has no negative zero.
        (f64::from(raw) * self.multiply + 0.0) / self.divide
    }
}
