//! The bytes that end a frame.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::crc::Crc;
use crate::number::Order;

/// How a frame ends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Check {
    /// It always ends with this byte.
    Footer(u8),
    /// It ends with a number computed from the frame, and then a footer.
    Computed(Box<Computed>),
}

/// A check that is computed from a frame, and the footer after it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Computed {
    /// The number; `None`: there is only a footer.
    pub algorithm: Option<Algorithm>,
    /// The width of the number in bytes: at most 16.
    pub width: usize,
    /// The order of its bytes.
    pub order: Order,
    /// The offset of the first byte that the number covers; it covers all bytes from there to
    /// itself.
    pub from: usize,
    /// The bytes after the number.
    pub footer: Vec<u8>,
}

/// How the number is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Algorithm {
    /// The sum of the bytes.
    Sum,
    /// The sum with all bits inverted.
    InvertedSum,
    /// The number that gives zero when it is added to the sum.
    NegatedSum,
    /// The exclusive or of the bytes.
    Xor,
    /// Two running sums of bytes by this modulus, the second in the high byte.
    Fletcher(u32),
    /// A CRC.
    Crc(Crc),
}

impl Check {
    /// Return the number of bytes that end a frame.
    #[must_use]
    pub fn size(&self) -> usize {
        match self {
            Self::Footer(_) => 1,
            Self::Computed(computed) => computed.size(),
        }
    }

    /// Return whether a frame ends with the right bytes.
    #[inline]
    pub(crate) fn holds(&self, frame: &[u8]) -> bool {
        match self {
            Self::Footer(footer) => frame.last() == Some(footer),
            Self::Computed(computed) => computed.holds(frame),
        }
    }

    /// Append the bytes that end the frame.
    pub fn end(&self, frame: &mut Vec<u8>) {
        frame.resize(frame.len() + self.size(), 0);
        self.fill(frame);
    }

    /// Overwrite the last bytes of a complete frame with those that must end it.
    #[inline]
    pub(crate) fn fill(&self, frame: &mut [u8]) {
        match self {
            Self::Footer(footer) => {
                if let Some(last) = frame.last_mut() {
                    *last = *footer;
                }
            }
            Self::Computed(computed) => computed.fill(frame),
        }
    }
}

impl Computed {
    fn size(&self) -> usize {
        let number = if self.algorithm.is_some() {
            self.width
        } else {
            0
        };
        number + self.footer.len()
    }

    #[inline(never)]
    fn holds(&self, frame: &[u8]) -> bool {
        let Some(body) = frame
            .strip_suffix(self.footer.as_slice())
            .and_then(|rest| rest.get(..frame.len().checked_sub(self.size())?))
        else {
            return false;
        };
        let given = frame.get(body.len()..frame.len() - self.footer.len());
        self.number(body, |bytes| Some(bytes) == given)
    }

    fn fill(&self, frame: &mut [u8]) {
        let size = frame.len().saturating_sub(self.size());
        let (body, end) = frame.split_at_mut(size);
        self.number(body, |bytes| {
            for (place, byte) in end.iter_mut().zip(bytes.iter().chain(&self.footer)) {
                *place = *byte;
            }
        });
    }

    /// Call `with` with the bytes of the number that must follow `body`.
    fn number<R>(&self, body: &[u8], with: impl FnOnce(&[u8]) -> R) -> R {
        let Some(algorithm) = &self.algorithm else {
            return with(&[]);
        };
        let number = algorithm.of(body.get(self.from..).unwrap_or_default());
        let width = self.width.min(16);
        match self.order {
            Order::Little => with(number.to_le_bytes().get(..width).unwrap_or_default()),
            Order::Big => with(number.to_be_bytes().get(16 - width..).unwrap_or_default()),
        }
    }
}

impl Algorithm {
    /// Return the number for some bytes; only as many of its low bytes as the check is wide are
    /// used.
    #[must_use]
    pub fn of(&self, data: &[u8]) -> u128 {
        let sum = || data.iter().map(|byte| u128::from(*byte)).sum::<u128>();
        match self {
            Self::Sum => sum(),
            Self::InvertedSum => !sum(),
            Self::NegatedSum => sum().wrapping_neg(),
            Self::Xor => u128::from(data.iter().fold(0, |all, byte| all ^ byte)),
            Self::Fletcher(modulus) => fletcher(data, *modulus),
            Self::Crc(crc) => crc.of(data),
        }
    }
}

fn fletcher(data: &[u8], modulus: u32) -> u128 {
    let rest = |sum: u32| sum.checked_rem(modulus).unwrap_or_default();
    let (first, second) = data.iter().fold((0, 0), |(first, second), byte| {
        let first = rest(first + u32::from(*byte));
        (first, rest(second + first))
    });
    u128::from(second << 8 | first)
}
