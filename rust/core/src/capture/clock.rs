//! Maps offsets of a stream to the times at which the bytes were received, until they are needed no
//! more.

/// How many pieces are searched one by one before a binary search begins.
const NEAR: usize = 8;

/// The pieces of a stream: where each starts, and when its bytes were received, all at once.
#[derive(Debug, Default)]
pub(crate) struct Clock {
    starts: Vec<u64>,
    times: Vec<i64>,
}

impl Clock {
    /// Add the piece that starts at the end of the stream.
    #[inline]
    pub(crate) fn add(&mut self, start: u64, time: i64) {
        // The last piece is empty if the next one starts at the same offset; it is replaced.
        match (self.starts.last(), self.times.last_mut()) {
            (Some(last), Some(last_time)) if *last == start => *last_time = time,
            _ => {
                self.starts.push(start);
                self.times.push(time);
            }
        }
    }

    /// Append the times of the bytes at `offsets`, which ascend.
    pub(crate) fn stamp(&self, offsets: &[u64], times: &mut Vec<i64>) {
        let mut at = 0;
        times.reserve(offsets.len());
        times.extend(offsets.iter().map(|offset| {
            at = self.piece(at, *offset);
            self.times.get(at).copied().unwrap_or_default()
        }));
    }

    /// Return the time of a byte.
    pub(crate) fn time_of(&self, offset: u64) -> i64 {
        let at = self.piece(0, offset);
        self.times.get(at).copied().unwrap_or_default()
    }

    /// Forget the pieces before the one with the byte at `offset`, which may lie beyond the
    /// received bytes.
    pub(crate) fn forget_before(&mut self, offset: u64) {
        let at = self.piece(0, offset);
        self.starts.drain(..at);
        self.times.drain(..at);
    }

    /// Return the index of the last piece that starts at or before `offset`; piece `at` does.
    #[inline]
    fn piece(&self, at: usize, offset: u64) -> usize {
        let later = self.starts.get(at + 1..).unwrap_or_default();
        let near = later.iter().take(NEAR);
        let passed = near.take_while(|start| **start <= offset).count();
        if passed < NEAR {
            return at + passed;
        }
        at + later.partition_point(|start| *start <= offset)
    }
}
