//! Reads fields whose numbers are single bytes or big-endian pairs, as in nearly all fields.

use super::block::{BLOCK, Block, MARGIN};
use super::cells::Cell;
use super::scale::Scale;
use crate::number::{Number, Order};
use cobotwire_simd::Six;

/// The largest number of numbers in a field that this reader handles.
const MOST: usize = 6;

/// The rules of one field: up to six numbers of one width.
#[derive(Clone, Debug)]
pub(crate) struct Words {
    width: usize,
    count: usize,
    /// Added to a number before its high bits are masked off, and subtracted after that: this
    /// applies the sign rule.
    bias: [i32; MOST],
    scales: [Scale; MOST],
}

impl Words {
    /// Return the rules, if this reader can handle a field of these numbers.
    pub(crate) fn new(numbers: &[Number]) -> Option<Self> {
        let width = numbers.first()?.width;
        let alike = |number: &Number| {
            number.width == width
                && number.is_plain()
                && (width == 1 || width == 2 && number.order == Order::Big)
        };
        if !matches!(numbers.len(), 1 | 2 | 3 | MOST) || !numbers.iter().all(alike) {
            return None;
        }
        let most = (1 << (8 * width)) - 1;
        let mut words = Self {
            width,
            count: numbers.len(),
            bias: [0; MOST],
            scales: [Scale::ONE; MOST],
        };
        let places = words.bias.iter_mut().zip(&mut words.scales);
        for (number, (bias, scale)) in numbers.iter().zip(places) {
            // A threshold outside of the width is replaced by the nearest one with the same effect:
            // no raw value is negative, or all are.
            *bias = i32::try_from(most - number.signed_at.clamp(-1, most)).ok()?;
            *scale = Scale::new(number);
        }
        Some(words)
    }

    /// Return the reader of six pairs of bytes, if the field has these.
    pub(crate) fn six(&self, bounds: &Bounds) -> Option<Six> {
        let exact = self.scales.iter().all(|scale| scale.exact);
        (self.width == 2 && self.count == MOST && exact).then(|| Six {
            bias: padded(self.bias, 0),
            least: padded(bounds.0.map(|(least, _)| least), 0),
            span: padded(bounds.0.map(|(_, span)| span), u32::MAX),
            high: padded(self.scales.map(|scale| scale.high), 0.0),
            low: padded(self.scales.map(|scale| scale.low), 0.0),
        })
    }

    /// Return whether all raw values are between their bounds.
    pub(crate) fn within(&self, block: &Block, frames: &[u32], start: u16, all: &Bounds) -> bool {
        let task = Task {
            words: self,
            block,
            frames,
            start,
        };
        match (self.width, self.count) {
            (1, 1) => task.within::<1, 1>(all),
            (1, 2) => task.within::<1, 2>(all),
            (1, 3) => task.within::<1, 3>(all),
            (1, _) => task.within::<1, MOST>(all),
            (_, 1) => task.within::<2, 1>(all),
            (_, 2) => task.within::<2, 2>(all),
            (_, 3) => task.within::<2, 3>(all),
            (_, _) => task.within::<2, MOST>(all),
        }
    }

    /// Append a row of physical values for each frame.
    pub(crate) fn physical(&self, block: &Block, frames: &[u32], start: u16, out: &mut Vec<f64>) {
        let all = Task {
            words: self,
            block,
            frames,
            start,
        };
        match (self.width, self.count) {
            (1, 1) => all.physical::<1, 1>(out),
            (1, 2) => all.physical::<1, 2>(out),
            (1, 3) => all.physical::<1, 3>(out),
            (1, _) => all.physical::<1, MOST>(out),
            (_, 1) => all.physical::<2, 1>(out),
            (_, 2) => all.physical::<2, 2>(out),
            (_, 3) => all.physical::<2, 3>(out),
            (_, _) => all.physical::<2, MOST>(out),
        }
    }

    /// Append a row of raw values for each frame.
    pub(crate) fn raw<T: Cell>(&self, block: &Block, frames: &[u32], start: u16, out: &mut Vec<T>) {
        let all = Task {
            words: self,
            block,
            frames,
            start,
        };
        match (self.width, self.count) {
            (1, 1) => all.raw::<1, 1, T>(out),
            (1, 2) => all.raw::<1, 2, T>(out),
            (1, 3) => all.raw::<1, 3, T>(out),
            (1, _) => all.raw::<1, MOST, T>(out),
            (_, 1) => all.raw::<2, 1, T>(out),
            (_, 2) => all.raw::<2, 2, T>(out),
            (_, 3) => all.raw::<2, 3, T>(out),
            (_, _) => all.raw::<2, MOST, T>(out),
        }
    }
}

/// Return the six elements, followed by `rest` twice.
fn padded<T: Copy>([a, b, c, d, e, f]: [T; MOST], rest: T) -> [T; 8] {
    [a, b, c, d, e, f, rest, rest]
}

/// The least raw value of each number, and the difference between the largest and the least one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds([(i32, u32); MOST]);

impl Bounds {
    /// All raw values are allowed.
    pub(crate) const NONE: Self = Self([(i32::MIN, u32::MAX); MOST]);

    /// Return the bounds of a field whose numbers have no choices; `None` if a number has choices.
    pub(crate) fn new(numbers: &[Number]) -> Option<Self> {
        let mut all = [(0, u32::MAX); MOST];
        for (number, bounds) in numbers.iter().zip(&mut all) {
            if !number.choices.is_empty() {
                return None;
            }
            let least = i32::try_from(number.minimum).ok()?;
            let most = i32::try_from(number.maximum).ok()?;
            *bounds = (
                least,
                u32::try_from(i64::from(most) - i64::from(least)).ok()?,
            );
        }
        Some(Self(all))
    }
}

/// One field of some frames.
struct Task<'a> {
    words: &'a Words,
    block: &'a Block,
    frames: &'a [u32],
    start: u16,
}

impl Task<'_> {
    #[inline(never)]
    #[allow(clippy::indexing_slicing)] // in bounds: N is at most MOST
    fn physical<const WIDTH: usize, const N: usize>(&self, out: &mut Vec<f64>) {
        let scales: [Scale; N] = std::array::from_fn(|index| self.words.scales[index]);
        if scales.iter().all(|scale| scale.exact) {
            self.rows::<WIDTH, N, f64>(out, |index, raw| scales[index].multiplied(raw));
        } else {
            self.rows::<WIDTH, N, f64>(out, |index, raw| scales[index].divided(raw));
        }
    }

    #[inline(never)]
    fn raw<const WIDTH: usize, const N: usize, T: Cell>(&self, out: &mut Vec<T>) {
        self.rows::<WIDTH, N, T>(out, |_, raw| T::of(raw));
    }

    #[inline(never)]
    #[allow(clippy::indexing_slicing)] // in bounds: N is at most MOST
    fn within<const WIDTH: usize, const N: usize>(&self, all: &Bounds) -> bool {
        let bias: [i32; N] = std::array::from_fn(|index| self.words.bias[index]);
        let bounds: [(i32, u32); N] = std::array::from_fn(|index| all.0[index]);
        let mut outside = false;
        for at in self.frames {
            let words = read::<WIDTH, N>(self.block, *at, self.start);
            for index in 0..N {
                let cut = (words[index] + bias[index]) & ((1 << (8 * WIDTH)) - 1);
                let (least, span) = bounds[index];
                let above = (cut - bias[index]).wrapping_sub(least);
                outside |= above as u32 > span;
            }
        }
        !outside
    }

    #[inline(always)]
    #[allow(clippy::indexing_slicing)] // in bounds: N is at most MOST
    fn rows<const WIDTH: usize, const N: usize, T: Copy + Default>(
        &self,
        out: &mut Vec<T>,
        value: impl Fn(usize, i32) -> T,
    ) {
        let bias: [i32; N] = std::array::from_fn(|index| self.words.bias[index]);
        out.reserve(self.frames.len() * N);
        for at in self.frames {
            let words = read::<WIDTH, N>(self.block, *at, self.start);
            let row: [T; N] = std::array::from_fn(|index| {
                let cut = (words[index] + bias[index]) & ((1 << (8 * WIDTH)) - 1);
                value(index, cut - bias[index])
            });
            out.extend_from_slice(&row);
        }
    }
}

#[inline(always)]
#[allow(clippy::indexing_slicing)] // in bounds: a frame that starts in the block ends in its margin
fn read<const WIDTH: usize, const N: usize>(block: &Block, at: u32, start: u16) -> [i32; N] {
    let from = at as usize % BLOCK + usize::from(start) % (MARGIN / 2);
    let bytes = &block[from..from + WIDTH * N];
    std::array::from_fn(|index| {
        if WIDTH == 1 {
            i32::from(bytes[index])
        } else {
            i32::from(u16::from_be_bytes([bytes[2 * index], bytes[2 * index + 1]]))
        }
    })
}
