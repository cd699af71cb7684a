//! Counts of what a framer has received.

use crate::reason::Reason;

/// Counts from the start of a stream. They depend on its bytes alone, not on its chunks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tally {
    /// Bytes fed.
    pub bytes: u64,
    /// Frames, by id.
    pub frames: [u64; 256],
    /// Bytes of noise, by reason; in the order of [`Reason::ALL`].
    pub noise: [u64; Reason::ALL.len()],
    /// The number of frames directly after noise.
    pub resyncs: u64,
}

impl Default for Tally {
    fn default() -> Self {
        Self {
            bytes: 0,
            frames: [0; 256],
            noise: [0; Reason::ALL.len()],
            resyncs: 0,
        }
    }
}

impl Tally {
    /// Count frames of that id.
    #[inline]
    pub(crate) fn add_frames(&mut self, id: u8, count: u64) {
        if let Some(frames) = self.frames.get_mut(usize::from(id)) {
            *frames += count;
        }
    }

    /// Count bytes of noise.
    #[inline]
    pub(crate) fn add_noise(&mut self, reason: Reason, count: usize) {
        if let Some(noise) = self.noise.get_mut(reason as usize) {
            *noise += count as u64;
        }
    }
}
