//! Checks several positions together. Most bytes of noise do not start a header, or start one with
//! a LEN that no frame has, so they need no separate check.
//!
//! Each byte of a 64-bit word represents a position, the lowest byte the first; its highest bit
//! means yes.

/// The number of positions.
pub(crate) const WINDOW: usize = 8;
/// The bytes that decide them.
pub(crate) const SEEN: usize = WINDOW + 2;

const HIGH: u64 = 0x8080_8080_8080_8080;
const ONES: u64 = 0x0101_0101_0101_0101;

/// The pattern to search for.
#[derive(Clone, Copy)]
pub(crate) struct Pattern {
    first: u64,
    second: u64,
    /// The smallest and the largest LEN, limited to seven bits.
    least: u64,
    most: u64,
    /// Whether a LEN of 128 and more is possible.
    long: u64,
}

/// What the positions are.
#[derive(Clone, Copy)]
pub(crate) struct Window {
    /// The positions at which a frame may start.
    candidates: u64,
    /// The positions of headers with a LEN that no frame has.
    bad_lengths: u64,
}

impl Pattern {
    pub(crate) fn new(header: [u8; 2], least: u8, most: u8) -> Self {
        let [first, second] = header.map(|byte| u64::from(byte) * ONES);
        Self {
            first,
            second,
            least: u64::from(least.min(0x7F)) * ONES,
            most: (u64::from(most.min(0x7F)) * ONES) | HIGH,
            long: if most > 0x7F { HIGH } else { 0 },
        }
    }

    /// Check a window.
    #[inline(always)]
    pub(crate) fn look(self, seen: &[u8; SEEN]) -> Window {
        let [first, second, length] = [0, 1, 2].map(|start| word(seen, start));
        let differ = (first ^ self.first) | (second ^ self.second);
        let headers = !(((differ & !HIGH) + !HIGH) | differ) & HIGH;
        // Neither subtraction borrows from the next byte.
        let enough = (length | HIGH) - self.least;
        let few = self.most - (length & !HIGH);
        let possible = (enough & few & !length) | (length & self.long);
        Window {
            candidates: headers & possible,
            bad_lengths: headers & !possible,
        }
    }
}

impl Window {
    /// Keep only the first positions.
    #[inline(always)]
    pub(crate) fn first(self, count: usize) -> Self {
        let mask = if count < WINDOW {
            (1 << (8 * count)) - 1
        } else {
            u64::MAX
        };
        Self {
            candidates: self.candidates & mask,
            bad_lengths: self.bad_lengths & mask,
        }
    }

    /// Remove and return the next position at which a frame may start.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<usize> {
        if self.candidates == 0 {
            return None;
        }
        let index = self.candidates.trailing_zeros() / 8;
        self.candidates &= self.candidates - 1;
        Some(index as usize)
    }

    /// Return the number of headers with a LEN that no frame has.
    #[inline(always)]
    pub(crate) fn bad_lengths(self) -> usize {
        ((self.bad_lengths >> 7).wrapping_mul(ONES) >> 56) as usize
    }
}

#[inline(always)]
fn word(seen: &[u8; SEEN], start: usize) -> u64 {
    let bytes = seen.get(start..).and_then(<[u8]>::first_chunk);
    bytes.map_or(0, |bytes| u64::from_le_bytes(*bytes))
}
