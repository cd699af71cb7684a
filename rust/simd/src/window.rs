//! Checks several positions together. Most bytes of noise do not start a header, or start one with
//! a LEN that no frame has, so they need no separate check.

/// The number of positions that are checked together.
pub const WINDOW: usize = 32;
/// The number of bytes that a check reads, including the header and LEN at the last position.
pub const SEEN: usize = WINDOW + 2;

/// The pattern to search for: two bytes, and a third one within bounds.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    header: [u8; 2],
    least: u8,
    /// The difference between the largest and the least LEN.
    span: u8,
}

/// Sets of positions; the lowest bit is the first position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// The positions at which a frame may start.
    pub candidates: u32,
    /// The positions of headers with a LEN that no frame has.
    pub bad_lengths: u32,
}

impl Pattern {
    /// Return the pattern of headers with a LEN from `least` to `most`.
    #[must_use]
    pub fn new(header: [u8; 2], least: u8, most: u8) -> Self {
        Self {
            header,
            least,
            span: most.saturating_sub(least),
        }
    }

    /// Check the positions of a window.
    #[inline(always)]
    #[must_use]
    pub fn look(self, seen: &[u8; SEEN]) -> Window {
        #[cfg(target_arch = "x86_64")]
        return self.look_sse2(seen);
        #[cfg(not(target_arch = "x86_64"))]
        self.look_portable(seen)
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn look_sse2(self, seen: &[u8; SEEN]) -> Window {
        use std::arch::x86_64::{
            __m128i, _mm_and_si128, _mm_cmpeq_epi8, _mm_loadu_si128, _mm_min_epu8,
            _mm_movemask_epi8, _mm_set1_epi8, _mm_sub_epi8,
        };
        let half = |start: usize| {
            // SAFETY: every x86-64 processor has SSE2. `start` is 0 or 16, and the last load reads
            // 16 bytes from `start + 2` on, which are within the 34 bytes.
            unsafe {
                let load = |at: usize| _mm_loadu_si128(seen.as_ptr().add(at).cast::<__m128i>());
                let all = |byte: u8| _mm_set1_epi8(byte.cast_signed());
                let [first, second] = self.header;
                let header = _mm_and_si128(
                    _mm_cmpeq_epi8(load(start), all(first)),
                    _mm_cmpeq_epi8(load(start + 1), all(second)),
                );
                let above = _mm_sub_epi8(load(start + 2), all(self.least));
                let possible = _mm_cmpeq_epi8(_mm_min_epu8(above, all(self.span)), above);
                let bits = |mask: __m128i| _mm_movemask_epi8(mask).cast_unsigned();
                (bits(header), bits(_mm_and_si128(header, possible)))
            }
        };
        let ((low, low_possible), (high, high_possible)) = (half(0), half(16));
        let (headers, candidates) = (low | high << 16, low_possible | high_possible << 16);
        Window {
            candidates,
            bad_lengths: headers & !candidates,
        }
    }

    #[cfg(any(test, not(target_arch = "x86_64")))]
    fn look_portable(self, seen: &[u8; SEEN]) -> Window {
        let mut found = Window {
            candidates: 0,
            bad_lengths: 0,
        };
        for (index, bytes) in seen.windows(3).enumerate() {
            let header = bytes.starts_with(&self.header);
            let length = bytes.last().copied().unwrap_or_default();
            let possible = length.wrapping_sub(self.least) <= self.span;
            found.candidates |= u32::from(header && possible) << index;
            found.bad_lengths |= u32::from(header && !possible) << index;
        }
        found
    }
}

impl Window {
    /// Keep only the first positions.
    #[inline(always)]
    #[must_use]
    pub fn first(self, count: usize) -> Self {
        let mask = if count < WINDOW {
            (1 << count) - 1
        } else {
            u32::MAX
        };
        Self {
            candidates: self.candidates & mask,
            bad_lengths: self.bad_lengths & mask,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Pattern, SEEN};

    #[test]
    fn both_versions_find_the_same_positions() {
        let mut state = 1_u32;
        let mut draw = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        for (least, most) in [(2, 16), (0, 255), (5, 5), (127, 129), (250, 255)] {
            let pattern = Pattern::new([0xFE, 0xFD], least, most);
            for _ in 0..20_000 {
                let seen: [u8; SEEN] = std::array::from_fn(|_| match draw() % 4 {
                    0 => 0xFE,
                    1 => 0xFD,
                    2 => draw() % 20,
                    _ => draw(),
                });
                #[cfg(target_arch = "x86_64")]
                assert_eq!(pattern.look_sse2(&seen), pattern.look_portable(&seen));
                let look = pattern.look_portable(&seen);
                assert_eq!(look.candidates & look.bad_lengths, 0);
            }
        }
    }
}
