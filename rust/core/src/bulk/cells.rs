//! One column of numbers, of the type that fits them.

use crate::field::{Field, Shape};
use crate::number::Value;

/// Which numbers a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Numbers {
    /// Physical values: 64-bit floats; bytes and texts are bytes.
    Physical,
    /// The raw values of the wire, after the sign rule: the smallest integer type that holds
    /// all that the field allows.
    Raw,
}

/// A number in a column of integers.
pub(crate) trait Cell: Copy + Default {
    /// Convert a raw value. It fits, since the column's field allows it.
    fn of(raw: i32) -> Self;
}

macro_rules! cell {
    ($($type:ty),+) => {
        $(impl Cell for $type {
            #[inline(always)]
            fn of(raw: i32) -> Self {
                raw as Self
            }
        })+
    };
}

cell!(u8, i8, u16, i16, u32, i32, i64);

/// A column, row after row.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the variants are named after their types
pub enum Cells {
    F64(Vec<f64>),
    U8(Vec<u8>),
    I8(Vec<i8>),
    U16(Vec<u16>),
    I16(Vec<i16>),
    U32(Vec<u32>),
    I32(Vec<i32>),
    I64(Vec<i64>),
}

/// Called with the start and the size of memory that is about to be filled.
pub type Advise = fn(*const u8, usize);

/// Reserve memory for `more` elements.
pub(crate) fn reserve<T>(all: &mut Vec<T>, more: usize, advise: Advise) {
    if all.capacity() - all.len() < more {
        all.reserve_exact(more);
        let spare = all.spare_capacity_mut();
        advise(spare.as_ptr().cast(), size_of_val(spare));
    }
}

/// Apply the same expression to the vector of any type.
macro_rules! each {
    ($cells:expr, $vector:ident => $what:expr) => {
        match $cells {
            Cells::F64($vector) => $what,
            Cells::U8($vector) => $what,
            Cells::I8($vector) => $what,
            Cells::U16($vector) => $what,
            Cells::I16($vector) => $what,
            Cells::U32($vector) => $what,
            Cells::I32($vector) => $what,
            Cells::I64($vector) => $what,
        }
    };
}

impl Cells {
    /// Return an empty column for a field.
    pub(crate) fn new(field: &Field, numbers: Numbers) -> Self {
        if numbers == Numbers::Physical {
            return match field.shape {
                Shape::Numbers => Self::F64(Vec::new()),
                Shape::Bytes | Shape::Text(..) => Self::U8(Vec::new()),
            };
        }
        let (least, most) = field.raw_range();
        let holds = |from: i64, to: i64| from <= least && most <= to;
        match () {
            () if holds(0, u8::MAX.into()) => Self::U8(Vec::new()),
            () if holds(i8::MIN.into(), i8::MAX.into()) => Self::I8(Vec::new()),
            () if holds(0, u16::MAX.into()) => Self::U16(Vec::new()),
            () if holds(i16::MIN.into(), i16::MAX.into()) => Self::I16(Vec::new()),
            () if holds(0, u32::MAX.into()) => Self::U32(Vec::new()),
            () if holds(i32::MIN.into(), i32::MAX.into()) => Self::I32(Vec::new()),
            () => Self::I64(Vec::new()),
        }
    }

    /// Return how many numbers it has.
    #[must_use]
    pub fn len(&self) -> usize {
        each!(self, all => all.len())
    }

    /// Return whether it is empty.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Reserve memory for `more` numbers.
    pub(crate) fn reserve(&mut self, more: usize, advise: Advise) {
        each!(self, all => reserve(all, more, advise));
    }

    /// Remove the numbers, but keep their memory.
    pub(crate) fn clear(&mut self) {
        each!(self, all => all.clear());
    }

    /// Remove the last numbers.
    pub(crate) fn remove_last(&mut self, count: usize) {
        let left = self.len().saturating_sub(count);
        each!(self, all => all.truncate(left));
    }

    /// Append the numbers of a column of the same type, and leave it empty, with its memory.
    pub(crate) fn append(&mut self, other: &mut Self) {
        match (self, other) {
            (Self::F64(all), Self::F64(more)) => all.append(more),
            (Self::U8(all), Self::U8(more)) => all.append(more),
            (Self::I8(all), Self::I8(more)) => all.append(more),
            (Self::U16(all), Self::U16(more)) => all.append(more),
            (Self::I16(all), Self::I16(more)) => all.append(more),
            (Self::U32(all), Self::U32(more)) => all.append(more),
            (Self::I32(all), Self::I32(more)) => all.append(more),
            (Self::I64(all), Self::I64(more)) => all.append(more),
            _ => {}
        }
    }

    /// Return an empty column of the same type.
    pub(crate) fn like(&self) -> Self {
        match self {
            Self::F64(_) => Self::F64(Vec::new()),
            Self::U8(_) => Self::U8(Vec::new()),
            Self::I8(_) => Self::I8(Vec::new()),
            Self::U16(_) => Self::U16(Vec::new()),
            Self::I16(_) => Self::I16(Vec::new()),
            Self::U32(_) => Self::U32(Vec::new()),
            Self::I32(_) => Self::I32(Vec::new()),
            Self::I64(_) => Self::I64(Vec::new()),
        }
    }

    /// Append a number, given as raw and physical value. The type of the column can hold every
    /// value that the field allows.
    pub(crate) fn push(&mut self, raw: i64, physical: Value) {
        match self {
            Self::F64(all) => all.push(match physical {
                Value::Real(real) => real,
                _ => raw as f64,
            }),
            Self::U8(all) => all.push(raw as u8),
            Self::I8(all) => all.push(raw as i8),
            Self::U16(all) => all.push(raw as u16),
            Self::I16(all) => all.push(raw as i16),
            Self::U32(all) => all.push(raw as u32),
            Self::I32(all) => all.push(raw as i32),
            Self::I64(all) => all.push(raw),
        }
    }
}
