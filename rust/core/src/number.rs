//! Numbers on the wire: their bytes, raw values and physical values.

use alloc::vec::Vec;
use core::fmt;

/// Up to this number a double holds every integer.
const EXACT: u64 = 1 << 53;

/// Which byte of a number comes first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Order {
    /// The most significant.
    #[default]
    Big,
    /// The least significant.
    Little,
}

/// How bytes become the raw value of a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NumberEncoding {
    /// An integer with the sign rule of `signed_at`.
    #[default]
    Integer,
    /// An IEEE float.
    Float,
}

impl NumberEncoding {
    /// All encodings, with their names.
    pub const ALL: [(&'static str, Self); 2] = [("integer", Self::Integer), ("float", Self::Float)];

    /// Return the encoding with a name, or `None`.
    #[must_use]
    pub fn named(word: &str) -> Option<Self> {
        let known = Self::ALL.into_iter().find(|(known, _)| *known == word);
        known.map(|(_, encoding)| encoding)
    }
}

/// The bits of an integer of one or more bytes that a number uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bits {
    /// The number of bits below them.
    pub shift: u32,
    /// The number of bits that are used.
    pub count: u32,
    /// Whether the next number uses other bits of the same bytes.
    pub more: bool,
}

/// One number on the wire.
///
/// The bytes are an unsigned integer `u`. The raw value is `u - 256^width` if `u > signed_at`, else
/// `u`. The physical value is `raw * multiply / divide`. The bounds are those of the raw value.
///
/// A [`NumberEncoding::Float`] is an IEEE float of 4 or 8 bytes, without a scale or a sign rule.
/// Its raw value is the integer of its bits, with the bits after a set sign inverted, so that raw
/// values have the order of the floats.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs)] // the doc above explains each field
pub struct Number {
    pub width: usize,
    pub order: Order,
    pub signed_at: i64,
    pub multiply: i64,
    pub divide: i64,
    pub minimum: i64,
    pub maximum: i64,
    pub encoding: NumberEncoding,
    /// The legal raw values, where they differ from those of the field's other numbers.
    pub choices: Vec<i64>,
    /// Whether it is a flag in a field that also has other numbers.
    pub flag: bool,
    /// Which bits of its bytes it uses; `None`: all.
    pub bits: Option<Bits>,
}

/// A decoded value. A row is followed by its elements, so that a message is one flat buffer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// A number without a scale: its raw value.
    Integer(i64),
    /// A number with a scale.
    Real(f64),
    /// This many of the following values are the elements of one field.
    Row(usize),
    /// This many of the following rows are the elements of one field.
    Rows(usize),
    /// This many of the following values are bytes.
    Bytes(usize),
    /// This many of the following values are the bytes of a text in this encoding.
    Text(usize, Encoding),
}

/// How a text is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Bytes below 128.
    Ascii,
    /// UTF-8.
    Utf8,
    /// Each byte is the Unicode character of that number.
    Latin1,
}

/// A part of a table that cannot be interpreted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Misfit {
    /// An integer is not one to four bytes wide, a float not four or eight, or its bits are not
    /// within its bytes.
    Width,
    /// A scale is zero, or too fine for an exact double.
    Scale,
    /// A bound is beyond the integers that a double holds exactly.
    Bounds,
    /// A field has no case, cases of different sizes, or several numbers although it takes only
    /// one.
    Cases,
    /// A selector is not the index of a field of one number.
    Selector,
    /// A variant is longer than LEN can express. Or, in a format whose replies carry no id, a reply
    /// has fewer bytes than the id of a request.
    Length,
}

impl fmt::Display for Misfit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Width => {
                "an integer must have one to four bytes, a float four or eight; bits must fit"
            }
            Self::Scale => "a scale is zero, or too fine for an exact double",
            Self::Bounds => "a bound is an integer that a double cannot represent exactly",
            Self::Cases => {
                "all cases of a field must have the same size; a field that is not a row must have one number"
            }
            Self::Selector => "a selector must be a field of the message with one number",
            Self::Length => {
                "a variant is longer than LEN can express, or replies carry no id and one has fewer bytes than an id"
            }
        })
    }
}

impl Number {
    /// Return whether the physical value differs from the raw value by a factor.
    #[must_use]
    pub fn scaled(&self) -> bool {
        (self.multiply, self.divide) != (1, 1)
    }

    /// Return whether it is an IEEE float.
    #[must_use]
    pub fn is_float(&self) -> bool {
        self.encoding == NumberEncoding::Float
    }

    /// Return whether it is an integer that takes all bits of its bytes.
    pub(crate) fn is_plain(&self) -> bool {
        self.encoding == NumberEncoding::Integer && self.bits.is_none()
    }

    /// Return whether the physical value is a real number, rather than the raw value itself.
    pub(crate) fn real(&self) -> bool {
        self.is_float() || self.scaled()
    }

    /// Return whether the same bytes hold the same raw value in both numbers.
    pub(crate) fn is_alike(&self, other: &Self) -> bool {
        let bits = |number: &Self| number.bits.map(|bits| (bits.shift, bits.count));
        let sign = |number: &Self| (number.signed_at, number.encoding);
        (self.width, self.order) == (other.width, other.order)
            && (sign(self), bits(self)) == (sign(other), bits(other))
    }

    /// Return the number of bytes from the start of this number to the next number of the field.
    #[inline]
    #[must_use]
    pub fn step(&self) -> usize {
        match self.bits {
            Some(Bits { more: true, .. }) => 0,
            _ => self.width,
        }
    }

    /// Return whether the number may hold a raw value.
    #[inline]
    pub(crate) fn allows(&self, raw: i64) -> bool {
        if self.choices.is_empty() {
            (self.minimum..=self.maximum).contains(&raw)
        } else {
            self.choices.contains(&raw)
        }
    }

    /// Return whether the bounds allow a float that is infinite or not a number.
    pub(crate) fn takes_not_finite(&self) -> bool {
        self.is_float() && self.maximum >= raw_of_float(f64::INFINITY, self.width)
    }

    /// Return the raw value of the bytes at `start`.
    #[inline]
    #[must_use]
    pub fn unpack(&self, data: &[u8], start: usize) -> i64 {
        let bytes = data.get(start..start + self.width).unwrap_or_default();
        let unsigned = match (bytes, self.order) {
            ([byte], _) => i64::from(*byte),
            (&[high, low], Order::Big) => i64::from(u16::from_be_bytes([high, low])),
            (_, Order::Big) => bytes.iter().fold(0, join),
            (_, Order::Little) => bytes.iter().rev().fold(0, join),
        };
        let signed = |unsigned: i64, count: u32| {
            if unsigned > self.signed_at {
                unsigned - (1_i64 << count)
            } else {
                unsigned
            }
        };
        match (self.encoding, self.bits) {
            (NumberEncoding::Float, _) => ordered(unsigned, self.width),
            (NumberEncoding::Integer, None) => signed(unsigned, 8 * self.width as u32),
            (NumberEncoding::Integer, Some(Bits { shift, count, .. })) => {
                signed((unsigned >> shift) & ((1 << count) - 1), count)
            }
        }
    }

    /// Append the lowest bytes of a raw value; negative values are in two's complement.
    pub(crate) fn pack(&self, raw: i64, bytes: &mut Vec<u8>) {
        bytes.extend(self.ordered_bytes(raw).iter().take(self.width));
    }

    /// Overwrite the bytes at `start` with the lowest bytes of a raw value.
    #[inline]
    pub(crate) fn put(&self, raw: i64, bytes: &mut [u8], start: usize) {
        let all = self.ordered_bytes(raw);
        let [first, second, ..] = all;
        match bytes.get_mut(start..start + self.width) {
            // Most numbers have one or two bytes, which are written without a function call.
            Some([one]) => *one = first,
            Some([one, two]) => (*one, *two) = (first, second),
            Some(places) => {
                for (place, byte) in places.iter_mut().zip(all) {
                    *place = byte;
                }
            }
            None => {}
        }
    }

    /// Return the bytes of a raw value; only the first ones are used.
    #[inline]
    fn ordered_bytes(&self, raw: i64) -> [u8; 8] {
        let raw = match self.bits {
            Some(bits) => (raw & ((1 << bits.count) - 1)) << bits.shift,
            None if self.is_float() && raw < 0 => raw ^ magnitude(self.width),
            None => raw,
        };
        match self.order {
            Order::Big => (raw << (64 - 8 * self.width)).to_be_bytes(),
            Order::Little => raw.to_le_bytes(),
        }
    }

    /// Return the physical value of a raw value. Only the division rounds: both casts are exact,
    /// which [`Number::check`] ensures.
    #[inline]
    #[must_use]
    pub fn physical(&self, raw: i64) -> Value {
        if self.is_float() {
            Value::Real(float_of_raw(raw, self.width))
        } else if self.scaled() {
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
    #[inline]
    #[must_use]
    pub fn raw(&self, physical: f64) -> Option<i64> {
        if self.is_float() {
            return Some(raw_of_float(physical, self.width));
        }
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
        if !self.is_plain() || !self.choices.is_empty() {
            return false; // each raw value has to be compared
        }
        let (least, most) = self.natural_range();
        self.minimum <= least && most <= self.maximum
    }

    /// Return the lowest and the highest raw value that its bytes can hold; for floats, the finite
    /// ones.
    #[must_use]
    pub fn natural_range(&self) -> (i64, i64) {
        if self.is_float() {
            let infinite = raw_of_float(f64::INFINITY, self.width);
            return (-infinite, infinite - 1);
        }
        let top = (1 << (8 * self.width.min(7))) - 1;
        let signed_at = self.signed_at.clamp(-1, top);
        (if signed_at < top { signed_at - top } else { 0 }, signed_at)
    }

    /// Check that the codecs can interpret the number, and compute without overflow.
    ///
    /// # Errors
    /// Its width, scale or bounds are not supported.
    pub fn check(&self) -> Result<(), Misfit> {
        if self.is_float() {
            return match (self.width, self.multiply, self.divide) {
                (4 | 8, 1, 1) => Ok(()),
                (4 | 8, ..) => Err(Misfit::Scale),
                _ => Err(Misfit::Width),
            };
        }
        if !(1..=4).contains(&self.width) {
            return Err(Misfit::Width);
        }
        if let Some(bits) = self.bits
            && (bits.count == 0 || bits.shift.saturating_add(bits.count) as usize > 8 * self.width)
        {
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

/// Return a mask of all bits of a float except its sign.
fn magnitude(width: usize) -> i64 {
    if width == 4 {
        i64::from(i32::MAX)
    } else {
        i64::MAX
    }
}

/// Return the raw value of a float, given its bits as an integer.
fn ordered(unsigned: i64, width: usize) -> i64 {
    // The cast to 32 bits and back extends the sign.
    let signed = if width == 4 {
        i64::from(unsigned as i32)
    } else {
        unsigned
    };
    if signed < 0 {
        signed ^ magnitude(width)
    } else {
        signed
    }
}

/// Return the raw value of the float nearest to `real`; a value that is too large becomes infinite.
fn raw_of_float(real: f64, width: usize) -> i64 {
    if real.is_nan() {
        // All NaNs become the same one, since the payload does not survive every conversion.
        return if width == 4 {
            0x7FC0_0000
        } else {
            0x7FF8_0000_0000_0000
        };
    }
    let bits = if width == 4 {
        i64::from((real as f32).to_bits())
    } else {
        real.to_bits() as i64
    };
    ordered(bits, width)
}

/// Return the float of a raw value.
fn float_of_raw(raw: i64, width: usize) -> f64 {
    let bits = if raw < 0 { raw ^ magnitude(width) } else { raw };
    if width == 4 {
        f64::from(f32::from_bits(bits as u32))
    } else {
        f64::from_bits(bits as u64)
    }
}

fn join(unsigned: i64, byte: &u8) -> i64 {
    unsigned << 8 | i64::from(*byte)
}

/// Return the nearest integer, ties to even.
///
/// The sum of a double below 2^52 and 2^52 has no bits for fractions, so the addition rounds; a
/// larger double is an integer. The standard library's function calls the C library, unless the
/// compiler knows that the processor has an instruction for it.
fn nearest(real: f64) -> f64 {
    const NO_HALVES: f64 = (1_u64 << 52) as f64;
    let shift = NO_HALVES.copysign(real);
    if real.abs() < NO_HALVES {
        real + shift - shift
    } else {
        real
    }
}
