//! The fast path for reading one number.
//!
//! A [`Number`] describes every number that a table can have, but most are plain integers of one or
//! two bytes. A [`Step`] has only what reading one of these needs, in less than a cache line.

use crate::number::{Number, Order, Value};

/// How to read one number.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// The offset of its first byte in the data.
    at: usize,
    form: Form,
    /// The raw value is negative above this number.
    signed_at: i32,
    /// The least and the largest legal raw value.
    least: i32,
    most: i32,
    scaled: bool,
    multiply: i64,
    divide: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Byte,
    Big,
    Little,
    /// [`Number`] reads it.
    Other,
}

impl Step {
    /// Return the step of a number that starts at `at`; `bounded`: its bounds alone decide which
    /// raw values are legal.
    pub(crate) fn new(number: &Number, at: usize, bounded: bool) -> Self {
        let form = match (number.width, number.order) {
            _ if !bounded || !number.is_plain() => Form::Other,
            (1, _) => Form::Byte,
            (2, Order::Big) => Form::Big,
            (2, Order::Little) => Form::Little,
            _ => Form::Other,
        };
        Self {
            at,
            form,
            signed_at: cut(number.signed_at),
            least: cut(number.minimum),
            most: cut(number.maximum),
            scaled: number.scaled(),
            multiply: number.multiply,
            divide: number.divide as f64,
        }
    }

    /// Return the physical value in the data; `None` and `Err` mean the same as for [`Step::raw`].
    #[inline(always)]
    pub(crate) fn value(&self, data: &[u8]) -> Result<Option<Value>, usize> {
        Ok(self.raw(data)?.map(|raw| self.physical(raw)))
    }

    /// Return the raw value in the data; `None` if it is not legal. `Err`: [`Number`] must read it,
    /// at this offset.
    #[inline(always)]
    fn raw(&self, data: &[u8]) -> Result<Option<i64>, usize> {
        let rest = data.get(self.at..).unwrap_or_default();
        let (unsigned, modulus) = match (self.form, rest) {
            (Form::Byte, &[byte, ..]) => (i32::from(byte), 1 << 8),
            (Form::Big, &[first, second, ..]) => {
                (i32::from(u16::from_be_bytes([first, second])), 1 << 16)
            }
            (Form::Little, &[first, second, ..]) => {
                (i32::from(u16::from_le_bytes([first, second])), 1 << 16)
            }
            (Form::Other, _) => return Err(self.at),
            _ => return Ok(None),
        };
        let negative = if unsigned > self.signed_at {
            modulus
        } else {
            0
        };
        let raw = unsigned - negative;
        let legal = self.least <= raw && raw <= self.most;
        Ok(legal.then_some(i64::from(raw)))
    }

    /// Return the physical value of a raw value, as [`Number::physical`] does.
    #[inline(always)]
    fn physical(&self, raw: i64) -> Value {
        if self.scaled {
            Value::Real((raw * self.multiply) as f64 / self.divide)
        } else {
            Value::Integer(raw)
        }
    }
}

/// Return the nearest 32-bit number; numbers of two bytes compare the same with it.
fn cut(number: i64) -> i32 {
    number.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32
}
