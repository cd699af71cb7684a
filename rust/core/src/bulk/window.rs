//! Several positions looked at together: most bytes of noise are no header, or one with a LEN that no
//! frame has, and that shows without a look at each of them.
//!
//! The bytes of a word stand for positions, the lowest for the first; its highest bit says yes.

/// How many positions.
pub(crate) const WINDOW: usize = 8;
/// The bytes that decide them.
pub(crate) const SEEN: usize = WINDOW + 2;

const HIGH: u64 = 0x8080_8080_8080_8080;
const ONES: u64 = 0x0101_0101_0101_0101;

/// What to look for.
#[derive(Clone, Copy)]
pub(crate) struct Pattern {
    first: u64,
    second: u64,
    /// The smallest and the largest LEN, as far as seven bits can say.
    least: u64,
    most: u64,
    /// Whether a LEN of 128 and more is possible.
    long: u64,
}

/// What the positions are.
#[derive(Clone, Copy)]
pub(crate) struct Window {
    /// Where a frame may stand.
    candidates: u64,
    /// Where there is a header, but with a LEN that no frame has.
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

    /// Look at a window.
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
    /// Only its first positions.
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

    /// Take out the next position where a frame may stand.
    #[inline(always)]
    pub(crate) fn next(&mut self) -> Option<usize> {
        if self.candidates == 0 {
            return None;
        }
        let index = self.candidates.trailing_zeros() / 8;
        self.candidates &= self.candidates - 1;
        Some(index as usize)
    }

    /// How many headers have a LEN that no frame has.
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
