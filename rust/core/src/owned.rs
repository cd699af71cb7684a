//! A frame that owns its bytes.

use alloc::boxed::Box;

use crate::frame::{Frame, FrameFormat};

/// A frame that owns its bytes. A short frame stores them in place, without an allocation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnedFrame(Bytes);

/// The number of bytes stored in place: enough for nearly all messages, and so few that a Python
/// object of a frame takes 72 bytes.
const IN_PLACE: usize = 22;
/// The bytes in place do not start at an address that is a multiple of eight; the next such address
/// is this many bytes later.
const BEFORE_WORDS: usize = 6;

#[derive(Clone, Debug, PartialEq, Eq)]
enum Bytes {
    InPlace(u8, [u8; IN_PLACE]),
    Apart(Box<[u8]>),
}

impl From<Frame<'_>> for OwnedFrame {
    #[inline]
    fn from(frame: Frame<'_>) -> Self {
        let bytes = frame.bytes();
        Self(match (in_place(bytes), u8::try_from(bytes.len())) {
            (Some(place), Ok(size)) => Bytes::InPlace(size, place),
            _ => Bytes::Apart(bytes.into()),
        })
    }
}

/// Return the bytes, and zeros after them; `None` if they are too many.
///
/// They are copied eight at a time, as they were written. If a read had another size than the write
/// before it, the processor would wait until the write is in the cache.
#[inline(always)]
fn in_place(bytes: &[u8]) -> Option<[u8; IN_PLACE]> {
    let mut place = [0; IN_PLACE];
    let (start, words) = place.split_at_mut(BEFORE_WORDS);
    start.copy_from_slice(word(bytes, 0).to_le_bytes().get(..BEFORE_WORDS)?);
    for (at, piece) in (BEFORE_WORDS..).step_by(8).zip(words.as_chunks_mut().0) {
        *piece = word(bytes, at).to_le_bytes();
    }
    (bytes.len() <= IN_PLACE).then_some(place)
}

/// Return the eight bytes at an offset as a number; zeros stand for missing bytes.
#[inline(always)]
fn word(bytes: &[u8], at: usize) -> u64 {
    let rest = bytes.get(at..).unwrap_or_default();
    match (rest.first_chunk(), bytes.last_chunk(), rest) {
        (Some(word), ..) => u64::from_le_bytes(*word),
        (None, Some(last), _) => {
            let missing = (8 - rest.len()) as u32;
            let shifted = u64::from_le_bytes(*last).checked_shr(8 * missing);
            shifted.unwrap_or_default()
        }
        (None, None, rest) => {
            let bytes = rest.iter().rev();
            bytes.fold(0, |word, byte| word << 8 | u64::from(*byte))
        }
    }
}

impl OwnedFrame {
    /// Return all of it, from header to check.
    #[inline]
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        match &self.0 {
            Bytes::InPlace(size, place) => place.get(..usize::from(*size)).unwrap_or_default(),
            Bytes::Apart(bytes) => bytes,
        }
    }

    /// Return the frame, in the format in which it was found.
    #[inline]
    #[must_use]
    pub fn get(&self, format: &FrameFormat) -> Frame<'_> {
        let (bytes, layout) = (self.bytes(), format.layout);
        let [length, id] =
            [layout.length, layout.id].map(|part| part.read(bytes).unwrap_or_default());
        Frame::new(bytes, length, id)
    }
}
