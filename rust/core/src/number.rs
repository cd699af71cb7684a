//! Numbers on the wire: their bytes, raw values and physical values.

/// Up to this number a double holds every integer.
const EXACT: u64 = 1 << 53;

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The most significant.
    Big,
    /// The least significant.
    Little,
}

/// One number on the wire.
///
/// The bytes are an unsigned integer `u`. The raw value is `u - 256^width` if `u > signed_at`, else
/// `u`. The physical value is `raw * multiply / divide`. The bounds are those of the raw value.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the doc above explains each field
pub struct Number {
    pub width: usize,
    pub order: Order,
    pub signed_at: i64,
    pub multiply: i64,
    pub divide: i64,
    pub minimum: i64,
    pub maximum: i64,
}

/// A decoded value. A row is followed by its elements, so that a message is one flat buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number without a scale: its raw value.
    Integer(i64),
    /// A number with a scale.
    Real(f64),
    /// That many of the values that follow are the elements of one field.
    Row(usize),
}

/// A part of a table that cannot be interpreted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misfit {
    /// A number is not one to four bytes wide.
    Width,
    /// A scale is zero, or too fine for an exact double.
    Scale,
    /// A bound is beyond the integers that a double holds exactly.
    Bounds,
    /// A field has no case, cases of different sizes, or not one number where it takes one.
    Cases,
    /// A selector is not the index of a field of one number.
    Selector,
    /// A variant is longer than LEN can express.
    Length,
}

impl Number {
    /// Return whether the physical value is a real number, rather than the raw value itself.
    #[must_use]
    pub fn scaled(&self) -> bool {
        (self.multiply, self.divide) != (1, 1)
    }

    /// Return the raw value that starts there.
    #[inline]
    pub(crate) fn unpack(&self, data: &[u8], start: usize) -> i64 {
        let bytes = data.get(start..start + self.width).unwrap_or_default();
        let unsigned = match (bytes, self.order) {
            ([byte], _) => i64::from(*byte),
            (&[high, low], Order::Big) => i64::from(u16::from_be_bytes([high, low])),
            (_, Order::Big) => bytes.iter().fold(0, join),
            (_, Order::Little) => bytes.iter().rev().fold(0, join),
        };
        if unsigned > self.signed_at {
            unsigned - (1 << (8 * self.width))
        } else {
            unsigned
        }
    }

    /// Append the lowest bytes of a raw value; a negative one is its two's complement.
    pub(crate) fn pack(&self, raw: i64, bytes: &mut Vec<u8>) {
        let ordered = match self.order {
            Order::Big => (raw << (64 - 8 * self.width)).to_be_bytes(),
            Order::Little => raw.to_le_bytes(),
        };
        bytes.extend(ordered.iter().take(self.width));
    }

    /// Return the physical value of a raw value. Only the division rounds: both casts are exact,
    /// which [`Number::check`] ensures.
    #[inline]
    pub(crate) fn physical(&self, raw: i64) -> Value {
        if self.scaled() {
            Value::Real((raw * self.multiply) as f64 / self.divide as f64)
        } else {
            Value::Integer(raw)
        }
    }

    /// Return the raw value nearest to a physical value, ties to even; `None` if it is out of
    /// bounds.
    ///
    /// The arithmetic is IEEE double, step by step as in the reference, so that the bytes are the
    /// same.
    pub(crate) fn raw(&self, physical: f64) -> Option<i64> {
        let scaled = physical * self.divide as f64;
        let raw = match self.multiply {
            1 => scaled, // the same result without a slow division
            multiply => scaled / multiply as f64,
        };
        // Compare before rounding: a huge double would not fit the integer.
        let (below, above) = ((self.minimum - 1) as f64, (self.maximum + 1) as f64);
        (below < raw && raw < above).then(|| nearest(raw) as i64)
    }

    /// Return whether the bounds allow every raw value that the bytes can encode.
    pub(crate) fn takes_all_bytes(&self) -> bool {
        let values = 1 << (8 * self.width);
        let signed_at = self.signed_at.clamp(-1, values - 1);
        let least = if signed_at < values - 1 {
            signed_at + 1 - values
        } else {
            0
        };
        self.minimum <= least && signed_at <= self.maximum
    }

    pub(crate) fn check(&self) -> Result<(), Misfit> {
        if !(1..=4).contains(&self.width) {
            return Err(Misfit::Width);
        }
        // Within these limits raw * multiply and divide are exact, and only the division rounds.
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

fn join(unsigned: i64, byte: &u8) -> i64 {
    unsigned << 8 | i64::from(*byte)
}

/// Return the nearest integer, ties to even, for a magnitude below 2^51, as all bounds are.
///
/// The sum of such a double and 2^52 has no bits for fractions, so the addition rounds. The
/// standard library's function calls the C library, unless the compiler knows that the processor
/// has an instruction for it.
fn nearest(real: f64) -> f64 {
    const NO_HALVES: f64 = (1_u64 << 52) as f64;
    let shift = NO_HALVES.copysign(real);
    if real.abs() < NO_HALVES / 2.0 {
        real + shift - shift
    } else {
        real.round_ties_even()
    }
}
