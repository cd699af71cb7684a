//! The expected counts of a stream.

use cobotwire_core::{Reason, Spans, Tally};

use crate::oracle::Oracle;

/// The counts of the oracle's events, and its noise spans, merged across reasons.
#[derive(Debug, Default)]
pub struct Count {
    tally: Tally,
    pub spans: Spans,
    in_noise: bool,
}

impl Count {
    /// Count the next event.
    pub fn add(&mut self, oracle: &Oracle, bytes: &[u8], reason: Option<Reason>) {
        let (offset, size) = (self.tally.bytes, bytes.len() as u64);
        self.tally.bytes += size;
        match reason {
            None => {
                let id = oracle.id(bytes);
                match self.tally.frames.get_mut(usize::from(id)) {
                    Some(count) => *count += 1,
                    None => *self.tally.wide.entry(id).or_default() += 1,
                }
                self.tally.resyncs += u64::from(self.in_noise);
            }
            Some(reason) => {
                self.tally.noise[reason as usize] += size;
                if self.in_noise {
                    *self.spans.sizes.last_mut().expect("there was noise") += size;
                } else {
                    self.spans.offsets.push(offset);
                    self.spans.sizes.push(size);
                }
            }
        }
        self.in_noise = reason.is_some();
    }

    /// Check a tally; all bytes that were fed must be in events by now.
    pub fn check(&self, tally: &Tally) {
        let numbers = |tally: &Tally| (tally.bytes, tally.noise, tally.resyncs);
        assert_eq!(numbers(tally), numbers(&self.tally), "the oracle's counts");
        assert_eq!(
            tally.wide, self.tally.wide,
            "the oracle's counts of wide ids"
        );
        for (id, counts) in tally.frames.iter().zip(self.tally.frames).enumerate() {
            assert_eq!(*counts.0, counts.1, "the oracle's count of frames {id:02X}");
        }
    }
}
