//! How frames are built, and a borrowed view of one valid frame.

use alloc::vec::Vec;

use crate::check::Check;
use crate::direction::Direction;
use crate::number::Order;

/// Where the fixed parts of a frame are, between its header and its data. The last is LEN or id.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// The offset of the address byte, if frames have one.
    pub address_at: Option<usize>,
    /// LEN.
    pub length: Part,
    /// The command id.
    pub id: Part,
    /// The offset of the data after a command id.
    pub data_at: usize,
    /// The number of bytes that LEN does not count.
    pub overhead: usize,
    /// Whether replies carry a command id. If not, their data starts at the offset of the id.
    pub reply_has_id: bool,
}

/// An unsigned number among the fixed parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its offset.
    pub at: usize,
    /// Whether it has two bytes instead of one.
    pub wide: bool,
    /// The order of two bytes.
    pub order: Order,
}

impl Part {
    /// Return a part of one byte.
    #[must_use]
    pub const fn byte(at: usize) -> Self {
        let (wide, order) = (false, Order::Big);
        Self { at, wide, order }
    }

    /// Return the offset of the byte after it.
    #[must_use]
    pub fn end(self) -> usize {
        self.at + if self.wide { 2 } else { 1 }
    }

    /// Return its number in a frame; `None` if the frame is too short.
    #[inline]
    #[must_use]
    pub fn read(self, frame: &[u8]) -> Option<u16> {
        let rest = frame.get(self.at..)?;
        match (self.wide, self.order) {
            (false, _) => rest.first().map(|byte| u16::from(*byte)),
            (true, Order::Big) => rest.first_chunk().copied().map(u16::from_be_bytes),
            (true, Order::Little) => rest.first_chunk().copied().map(u16::from_le_bytes),
        }
    }

    #[inline]
    pub(crate) fn write(self, frame: &mut [u8], number: u16) {
        let [low, high] = number.to_le_bytes();
        match (self.wide, self.order, frame.get_mut(self.at..)) {
            (false, _, Some([first, ..])) => *first = low,
            (true, Order::Big, Some([first, second, ..])) => (*first, *second) = (high, low),
            (true, Order::Little, Some([first, second, ..])) => (*first, *second) = (low, high),
            _ => {}
        }
    }
}

impl Layout {
    /// Return the usual layout after a header of that size: LEN and id, with an address before
    /// them if `address`; LEN counts the bytes after itself.
    #[must_use]
    pub fn usual(header: usize, address: bool) -> Self {
        let at = header + usize::from(address);
        Self {
            address_at: address.then_some(header),
            length: Part::byte(at),
            id: Part::byte(at + 1),
            data_at: at + 2,
            overhead: at + 1,
            reply_has_id: true,
        }
    }
}

/// A header, fixed parts, data and a check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FrameFormat {
    /// How a frame starts.
    pub header: Vec<u8>,
    /// The legal address bytes; the first one is sent unless the caller chooses another. Empty: a
    /// frame has none.
    pub addresses: Vec<u8>,
    /// How it ends.
    pub check: Check,
    /// The largest LEN that is accepted with an id that the table lacks.
    pub maximum_length: i64,
    /// Where the parts are.
    pub layout: Layout,
}

impl FrameFormat {
    /// Return LEN of a frame with that many data bytes.
    #[must_use]
    pub fn length(&self, data_size: usize, direction: Direction) -> usize {
        let size = (self.data_start(direction) + self.check.size()).saturating_add(data_size);
        size.saturating_sub(self.layout.overhead)
    }

    /// Return the offset of the data in a frame of that direction.
    #[inline]
    #[must_use]
    pub fn data_start(&self, direction: Direction) -> usize {
        if self.has_id(direction) {
            self.layout.data_at
        } else {
            self.layout.id.at
        }
    }

    /// Return whether frames of that direction carry a command id.
    #[inline]
    #[must_use]
    pub fn has_id(&self, direction: Direction) -> bool {
        self.layout.reply_has_id || direction == Direction::Request
    }

    /// Return whether header, LEN and id are `h h LEN id`, and LEN counts all after itself.
    #[must_use]
    pub fn plain(&self) -> bool {
        self.header.len() == 2
            && self.addresses.is_empty()
            && self.layout == Layout::usual(2, false)
    }

    /// Return the address byte of a frame.
    #[must_use]
    pub fn address(&self, frame: Frame<'_>) -> Option<u8> {
        frame.bytes.get(self.layout.address_at?).copied()
    }

    /// Return the data bytes of a frame, before the check.
    #[must_use]
    pub fn data<'a>(&self, frame: Frame<'a>, direction: Direction) -> &'a [u8] {
        let end = frame.bytes.len().saturating_sub(self.check.size());
        let data = frame.bytes.get(self.data_start(direction)..end);
        data.unwrap_or_default()
    }

    /// Append the start of a frame, up to its data, to an empty buffer.
    #[inline]
    pub(crate) fn start(
        &self,
        frame: &mut Vec<u8>,
        address: Option<u8>,
        length: u16,
        id: u16,
        direction: Direction,
    ) {
        frame.extend_from_slice(&self.header);
        frame.resize(self.data_start(direction), 0);
        self.layout.length.write(frame, length);
        if self.has_id(direction) {
            self.layout.id.write(frame, id);
        }
        let place = self.layout.address_at.and_then(|at| frame.get_mut(at));
        if let (Some(place), Some(address)) = (place, address) {
            *place = address;
        }
    }
}

/// A legal frame: only [`crate::Rules::validate`] makes these.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    bytes: &'a [u8],
    length: u16,
    id: u16,
}

impl<'a> Frame<'a> {
    pub(crate) fn new(bytes: &'a [u8], length: u16, id: u16) -> Self {
        Self { bytes, length, id }
    }

    /// Return all of it, from header to check.
    #[must_use]
    pub fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    /// Return the number at the offset of the command id.
    #[must_use]
    pub fn id(self) -> u16 {
        self.id
    }

    /// Return LEN.
    #[must_use]
    pub fn length(self) -> u16 {
        self.length
    }
}
