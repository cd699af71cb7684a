//! Keeps the start of an incomplete frame between two calls.

use alloc::vec::Vec;
use core::mem;

/// The bytes that wait, and their position. They are fewer than the longest frame has.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seam {
    kept: Vec<u8>,
    offset: u64,
}

/// The bytes around the seam between two calls. Positions count from the first kept byte.
pub(crate) struct Crossing {
    /// The kept bytes, and the bytes of the new chunk that frames starting in them can cover.
    pub(crate) data: Vec<u8>,
    /// The number of kept bytes; the new chunk starts there.
    pub(crate) seam: usize,
    /// The position of the first kept byte in the stream.
    pub(crate) offset: u64,
}

impl Seam {
    /// Return a seam before the first byte, which is at `offset` in the stream.
    pub(crate) fn at(offset: u64) -> Self {
        Self {
            kept: Vec::new(),
            offset,
        }
    }

    /// Return the number of bytes that wait.
    pub(crate) fn pending(&self) -> usize {
        self.kept.len()
    }

    /// Skip `count` bytes; return the position of the first one in the stream. `None`: earlier
    /// bytes wait, and nothing changed.
    #[inline]
    pub(crate) fn pass(&mut self, count: usize) -> Option<u64> {
        if !self.kept.is_empty() {
            return None;
        }
        let first = self.offset;
        self.offset += count as u64;
        Some(first)
    }

    /// Start a call with a new chunk. The rest of the chunk is scanned in place, without a copy.
    pub(crate) fn cross(&mut self, chunk: &[u8], longest: usize) -> Crossing {
        let mut data = mem::take(&mut self.kept);
        let seam = data.len();
        let need = if seam == 0 {
            0
        } else {
            longest.saturating_sub(1)
        };
        data.extend_from_slice(chunk.get(..need).unwrap_or(chunk));
        Crossing {
            data,
            seam,
            offset: self.offset,
        }
    }

    /// End a call: every byte before position `at` belongs to a frame or to noise; keep the rest.
    pub(crate) fn keep(&mut self, crossing: Crossing, chunk: &[u8], at: usize) {
        let Crossing {
            mut data,
            seam,
            offset,
        } = crossing;
        if at < seam {
            data.drain(..at);
        } else {
            data.clear();
            data.extend_from_slice(chunk.get(at - seam..).unwrap_or_default());
        }
        self.kept = data;
        self.offset = offset + at as u64;
    }
}
