//! Fuzz bytes as a source of numbers.

/// Fuzz bytes, consumed from the front; after their end every byte is zero.
#[derive(Clone, Debug)]
pub struct Bytes<'a>(pub &'a [u8]);

impl<'a> Bytes<'a> {
    pub fn byte(&mut self) -> u8 {
        self.take(1).first().copied().unwrap_or_default()
    }

    pub fn word(&mut self) -> usize {
        usize::from(self.byte()) << 8 | usize::from(self.byte())
    }

    /// Return a number below `count`, zero if `count` is zero; read one byte, or two if necessary.
    pub fn pick(&mut self, count: usize) -> usize {
        let picked = if count <= 256 {
            usize::from(self.byte())
        } else {
            self.word()
        };
        picked.checked_rem(count).unwrap_or_default()
    }

    /// Return the next `count` bytes, or all that are left.
    pub fn take(&mut self, count: usize) -> &'a [u8] {
        let (taken, rest) = self.0.split_at(count.min(self.0.len()));
        self.0 = rest;
        taken
    }

    pub fn is_done(&self) -> bool {
        self.0.is_empty()
    }
}
