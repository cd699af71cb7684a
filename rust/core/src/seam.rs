//! What a stream keeps between two calls: the start of a frame that waits for its end.

use std::mem;

/// The bytes that wait, and where they stand. They are fewer than the longest frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seam {
    kept: Vec<u8>,
    offset: u64,
}

/// A call's way over the seam. Positions count from the first kept byte.
pub(crate) struct Crossing {
    /// What was kept, and so much of the new chunk as frames that start in it can need.
    pub(crate) data: Vec<u8>,
    /// How much of it was kept; the new chunk starts there.
    pub(crate) seam: usize,
    /// Where its first byte stands in the stream.
    pub(crate) offset: u64,
}

impl Seam {
    /// How many bytes wait.
    pub(crate) fn pending(&self) -> usize {
        self.kept.len()
    }

    /// Start a call with a new chunk. That itself is scanned in place, however large it is.
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

    /// End it: all before position `at` is done with.
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
