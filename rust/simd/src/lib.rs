//! Instructions that plain Rust cannot express: the only unsafe code outside the Python binding.
//!
//! Each function has the same result as a plain version. The plain version runs on processors
//! without the instructions, and the tests compare the two.

mod six;
mod window;

pub use six::Six;
pub use window::{Pattern, SEEN, WINDOW, Window};

/// Load the memory `ahead` bytes after the start of `bytes` into the cache, also if `bytes` is
/// shorter.
#[inline(always)]
pub fn prefetch(bytes: &[u8], ahead: usize) {
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a prefetch has no effect on the program, whatever the address is.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(bytes.as_ptr().wrapping_add(ahead).cast());
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (bytes, ahead);
}
