//! How frames are built, and a borrowed view of one valid frame.

use crate::check::Check;

/// `header [address] LEN CMD DATA check`; LEN counts CMD, DATA and check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameFormat {
    /// How a frame starts.
    pub header: [u8; 2],
    /// The legal address bytes; the first one is sent unless the caller chooses another. Empty: a
    /// frame has none.
    pub addresses: Vec<u8>,
    /// How it ends.
    pub check: Check,
    /// The largest LEN that is accepted with an id that the table lacks.
    pub maximum_length: i64,
}

impl FrameFormat {
    /// Return LEN of a frame with that many data bytes.
    #[must_use]
    pub fn length(&self, data_size: usize) -> usize {
        data_size.saturating_add(1 + self.check.size())
    }

    /// Return the index of LEN in a frame. CMD follows it.
    #[inline]
    #[must_use]
    pub fn length_at(&self) -> usize {
        self.header.len() + usize::from(!self.addresses.is_empty())
    }

    /// Return the number of bytes that LEN does not count: header, address and LEN itself.
    #[inline]
    #[must_use]
    pub fn overhead(&self) -> usize {
        self.length_at() + 1
    }

    /// Return the address byte of a frame.
    #[must_use]
    pub fn address(&self, frame: Frame<'_>) -> Option<u8> {
        let [_, _, address, ..] = *frame.bytes else {
            return None;
        };
        (!self.addresses.is_empty()).then_some(address)
    }

    /// Return the data bytes of a frame, between id and check.
    #[must_use]
    pub fn data<'a>(&self, frame: Frame<'a>) -> &'a [u8] {
        let end = frame.bytes.len().saturating_sub(self.check.size());
        let data = frame.bytes.get(self.overhead() + 1..end);
        data.unwrap_or_default()
    }
}

/// A legal frame: only [`crate::Rules::judge`] makes these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    bytes: &'a [u8],
    length: u8,
    id: u8,
}

impl<'a> Frame<'a> {
    pub(crate) fn new(bytes: &'a [u8], length: u8, id: u8) -> Self {
        Self { bytes, length, id }
    }

    /// Return all of it, from header to check.
    #[must_use]
    pub fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    /// Return the command id.
    #[must_use]
    pub fn id(self) -> u8 {
        self.id
    }

    /// LEN: the bytes from the id to the end.
    #[must_use]
    pub fn length(self) -> u8 {
        self.length
    }
}

/// A frame that owns its bytes. A short frame stores them in place, without an allocation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OwnedFrame(Bytes);

/// The number of bytes stored in place: more than the longest frame of the arms known today.
const IN_PLACE: usize = 30;

#[derive(Clone, Debug, PartialEq, Eq)]
enum Bytes {
    InPlace(u8, [u8; IN_PLACE]),
    Apart(Box<[u8]>),
}

impl From<Frame<'_>> for OwnedFrame {
    #[inline]
    fn from(frame: Frame<'_>) -> Self {
        let mut place = [0; IN_PLACE];
        let size = u8::try_from(frame.bytes.len()).unwrap_or(u8::MAX);
        Self(match place.get_mut(..frame.bytes.len()) {
            Some(start) => {
                start.copy_from_slice(frame.bytes);
                Bytes::InPlace(size, place)
            }
            None => Bytes::Apart(frame.bytes.into()),
        })
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
        let bytes = self.bytes();
        let byte = |at: usize| bytes.get(at).copied().unwrap_or_default();
        Frame {
            bytes,
            length: byte(format.length_at()),
            id: byte(format.overhead()),
        }
    }
}
