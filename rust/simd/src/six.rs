//! Reads rows of six big-endian numbers of two bytes, such as joint angles and coordinates.

/// The numbers in a row.
#[cfg(target_arch = "x86_64")]
const NUMBERS: usize = 6;

/// How the six numbers of a row are checked and converted. The last two of each array are unused.
#[derive(Clone, Copy, Debug)]
pub struct Six {
    /// Added to a number before its high bits are masked off, and subtracted after that: this
    /// applies the sign rule.
    pub bias: [i32; 8],
    /// The least raw value.
    pub least: [i32; 8],
    /// The difference between the largest and the least raw value.
    pub span: [u32; 8],
    /// The high part of the factor: a physical value is `raw * high + raw * low`.
    pub high: [f64; 8],
    /// The low part of the factor.
    pub low: [f64; 8],
}

impl Six {
    /// Append the physical values of rows, which start at `starts` in `block`. Return whether all
    /// raw values are within their bounds; if not, nothing is appended. `None`: this processor
    /// lacks the instructions.
    #[inline]
    pub fn append_physical(
        &self,
        out: &mut Vec<f64>,
        block: &[u8],
        starts: impl Iterator<Item = usize>,
    ) -> Option<bool> {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has the instructions, as was just checked.
            return Some(unsafe { avx2::append_physical(self, out, block, starts) });
        }
        let _ = (out, block, starts);
        None
    }

    /// Append the raw values of rows. Return the same as [`Self::append_physical`], but `None` also
    /// if two bytes cannot hold a bound. Raw values within such bounds fit the type.
    #[inline]
    pub fn append_raw(
        &self,
        out: &mut Vec<i16>,
        block: &[u8],
        starts: impl Iterator<Item = usize>,
    ) -> Option<bool> {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            let bounds = self.narrow()?;
            // SAFETY: the processor has the instructions, as was just checked.
            return Some(unsafe { avx2::append_raw(&bounds, out, block, starts) });
        }
        let _ = (out, block, starts);
        None
    }

    /// Return the bounds as 16-bit numbers; `None` if two bytes cannot hold them. 16 bits suffice:
    /// a raw value has the same bits as on the wire, and distances from the least raw value are
    /// unique modulo 2^16.
    #[cfg(target_arch = "x86_64")]
    fn narrow(&self) -> Option<Narrow> {
        let mut bounds = Narrow {
            least: [0; 8],
            span: [u16::MAX; 8],
        };
        let rules = self.bias.iter().zip(&self.least).zip(&self.span);
        let places = bounds.least.iter_mut().zip(&mut bounds.span);
        for (((bias, least), span), (narrow_least, narrow_span)) in rules.zip(places) {
            if *span >= u32::from(u16::MAX) {
                continue; // every raw value is allowed
            }
            let most = i64::from(*least) + i64::from(*span);
            if *least < -bias || most > i64::from(0xFFFF - bias) {
                return None;
            }
            *narrow_least = *least as u16;
            *narrow_span = *span as u16;
        }
        Some(bounds)
    }
}

/// The least raw value of each number, modulo 2^16, and how far the largest one is from it.
#[cfg(target_arch = "x86_64")]
struct Narrow {
    least: [u16; 8],
    span: [u16; 8],
}

#[cfg(target_arch = "x86_64")]
mod avx2 {
    use std::arch::x86_64::*;

    use super::{NUMBERS, Narrow, Six};

    /// The rules in registers.
    struct Rules {
        swap: __m128i,
        low_half: __m256i,
        bias: __m256i,
        least: __m256i,
        span: __m256i,
    }

    impl Rules {
        #[target_feature(enable = "avx2")]
        #[inline]
        fn new(six: &Six) -> Self {
            // SAFETY: each array has the 32 bytes that are loaded.
            let [bias, least, span] = unsafe {
                [
                    _mm256_loadu_si256(six.bias.as_ptr().cast()),
                    _mm256_loadu_si256(six.least.as_ptr().cast()),
                    _mm256_loadu_si256(six.span.as_ptr().cast()),
                ]
            };
            Self {
                swap: _mm_set_epi8(14, 15, 12, 13, 10, 11, 8, 9, 6, 7, 4, 5, 2, 3, 0, 1),
                low_half: _mm256_set1_epi32(0xFFFF),
                bias,
                least,
                span,
            }
        }

        /// Return the raw values of a row, after the sign rule.
        #[target_feature(enable = "avx2")]
        #[inline]
        fn raws(&self, bytes: &[u8; 16]) -> __m256i {
            // SAFETY: the array has the 16 bytes that are loaded.
            let bytes = unsafe { _mm_loadu_si128(bytes.as_ptr().cast()) };
            let words = _mm256_cvtepu16_epi32(_mm_shuffle_epi8(bytes, self.swap));
            let cut = _mm256_and_si256(_mm256_add_epi32(words, self.bias), self.low_half);
            _mm256_sub_epi32(cut, self.bias)
        }

        /// Return zero where a raw value is within its bounds.
        #[target_feature(enable = "avx2")]
        #[inline]
        fn outside(&self, raws: __m256i) -> __m256i {
            let above = _mm256_sub_epi32(raws, self.least);
            _mm256_xor_si256(_mm256_max_epu32(above, self.span), self.span)
        }
    }

    /// Append the physical values of rows; see [`Six::append_physical`].
    #[target_feature(enable = "avx2")]
    pub(super) fn append_physical(
        six: &Six,
        out: &mut Vec<f64>,
        block: &[u8],
        starts: impl Iterator<Item = usize>,
    ) -> bool {
        let (rules, factors) = (Rules::new(six), Factors::new(six));
        let mut outside = _mm256_setzero_si256();
        out.reserve(starts.size_hint().0 * NUMBERS);
        let room = (out.capacity() - out.len()) / NUMBERS;
        let mut done = 0;
        // SAFETY: the vector has at least this length.
        let first = unsafe { out.as_mut_ptr().add(out.len()) };
        for start in starts {
            let bytes = block.get(start..).and_then(<[u8]>::first_chunk);
            let (Some(bytes), true) = (bytes, done < room) else {
                return false;
            };
            let raws = rules.raws(bytes);
            outside = _mm256_or_si256(outside, rules.outside(raws));
            // SAFETY: there is room for more than `done` rows after the vector's end.
            unsafe { store_physical(raws, &factors, first.add(done * NUMBERS)) };
            done += 1;
        }
        if _mm256_testz_si256(outside, outside) == 0 {
            return false;
        }
        // SAFETY: there was room for `done` rows, and all of them were stored.
        unsafe { out.set_len(out.len() + done * NUMBERS) };
        true
    }

    /// Append the raw values of rows; see [`Six::append_raw`].
    #[target_feature(enable = "avx2")]
    pub(super) fn append_raw(
        bounds: &Narrow,
        out: &mut Vec<i16>,
        block: &[u8],
        starts: impl Iterator<Item = usize>,
    ) -> bool {
        // A row is stored with the two numbers after it, which the next row replaces.
        const AFTER: usize = 2;
        let swap = _mm_set_epi8(14, 15, 12, 13, 10, 11, 8, 9, 6, 7, 4, 5, 2, 3, 0, 1);
        // SAFETY: each array has the 16 bytes that are loaded.
        let [least, span] = [&bounds.least, &bounds.span]
            .map(|all| unsafe { _mm_loadu_si128(all.as_ptr().cast()) });
        let mut outside = _mm_setzero_si128();
        out.reserve(starts.size_hint().0 * NUMBERS + AFTER);
        let room = (out.capacity() - out.len()).saturating_sub(AFTER) / NUMBERS;
        let mut done = 0;
        // SAFETY: the vector has at least this length.
        let first = unsafe { out.as_mut_ptr().add(out.len()) };
        for start in starts {
            let bytes = block.get(start..).and_then(<[u8]>::first_chunk::<16>);
            let (Some(bytes), true) = (bytes, done < room) else {
                return false;
            };
            // SAFETY: the array has the 16 bytes that are loaded.
            let bytes = unsafe { _mm_loadu_si128(bytes.as_ptr().cast()) };
            let raws = _mm_shuffle_epi8(bytes, swap);
            let above = _mm_sub_epi16(raws, least);
            let beyond = _mm_xor_si128(_mm_max_epu16(above, span), span);
            outside = _mm_or_si128(outside, beyond);
            // SAFETY: there is room for more than `done` rows after the vector's end, and for two
            // numbers after them.
            unsafe { _mm_storeu_si128(first.add(done * NUMBERS).cast(), raws) };
            done += 1;
        }
        if _mm_testz_si128(outside, outside) == 0 {
            return false;
        }
        // SAFETY: there was room for `done` rows, and all of them were stored.
        unsafe { out.set_len(out.len() + done * NUMBERS) };
        true
    }

    /// The factors of the first four numbers, and of the last two.
    struct Factors {
        high: (__m256d, __m128d),
        low: (__m256d, __m128d),
    }

    impl Factors {
        #[target_feature(enable = "avx2")]
        #[inline]
        fn new(six: &Six) -> Self {
            // SAFETY: each array has eight numbers, of which the first six are loaded.
            unsafe {
                let parts = |all: &[f64; 8]| {
                    (
                        _mm256_loadu_pd(all.as_ptr()),
                        _mm_loadu_pd(all.as_ptr().add(4)),
                    )
                };
                Self {
                    high: parts(&six.high),
                    low: parts(&six.low),
                }
            }
        }
    }

    /// Store six physical values.
    ///
    /// # Safety
    /// `to` must be writable for six values.
    #[target_feature(enable = "avx2")]
    #[inline]
    unsafe fn store_physical(raws: __m256i, factors: &Factors, to: *mut f64) {
        // The products are not fused with the sum: the factors are proved for this arithmetic.
        let four = _mm256_cvtepi32_pd(_mm256_castsi256_si128(raws));
        let four = _mm256_add_pd(
            _mm256_mul_pd(four, factors.high.0),
            _mm256_mul_pd(four, factors.low.0),
        );
        let two = _mm_cvtepi32_pd(_mm256_extracti128_si256::<1>(raws));
        let two = _mm_add_pd(
            _mm_mul_pd(two, factors.high.1),
            _mm_mul_pd(two, factors.low.1),
        );
        // SAFETY: as the caller promises.
        unsafe {
            _mm256_storeu_pd(to, four);
            _mm_storeu_pd(to.add(4), two);
        }
    }
}
