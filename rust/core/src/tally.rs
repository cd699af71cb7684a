//! Counts the bytes, frames and noise that a framer has received.

use alloc::collections::BTreeMap;

use crate::reason::Reason;

/// Counts from the start of a stream. They depend on its bytes alone, not on its chunks.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tally {
    /// Bytes fed.
    pub bytes: u64,
    /// The number of frames with each id of one byte.
    pub frames: [u64; 256],
    /// The number of frames with each larger id.
    pub wide: BTreeMap<u16, u64>,
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
            wide: BTreeMap::new(),
            noise: [0; Reason::ALL.len()],
            resyncs: 0,
        }
    }
}

impl Tally {
    /// Count frames of that id.
    #[inline]
    pub(crate) fn add_frames(&mut self, id: u16, count: u64) {
        match self.frames.get_mut(usize::from(id)) {
            Some(frames) => *frames += count,
            None => self.add_wide(id, count),
        }
    }

    #[cold]
    fn add_wide(&mut self, id: u16, count: u64) {
        *self.wide.entry(id).or_default() += count;
    }

    /// Count bytes of noise.
    #[inline]
    pub(crate) fn add_noise(&mut self, reason: Reason, count: usize) {
        if let Some(noise) = self.noise.get_mut(reason as usize) {
            *noise += count as u64;
        }
    }

    /// Add the counts of another tally, and clear it.
    pub(crate) fn append(&mut self, other: &mut Self) {
        self.bytes += other.bytes;
        self.resyncs += other.resyncs;
        let counts = self.frames.iter_mut().zip(&other.frames);
        for (total, count) in counts.chain(self.noise.iter_mut().zip(&other.noise)) {
            *total += count;
        }
        for (id, count) in &other.wide {
            *self.wide.entry(*id).or_default() += count;
        }
        *other = Self::default();
    }
}
