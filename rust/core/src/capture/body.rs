//! Reads the body of a block: numbers in the section's byte order, data with padding, options.

use super::damage::Fault;

/// The byte order of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Order {
    Little,
    Big,
}

impl Order {
    pub(crate) fn half(self, bytes: [u8; 2]) -> u16 {
        match self {
            Self::Little => u16::from_le_bytes(bytes),
            Self::Big => u16::from_be_bytes(bytes),
        }
    }

    #[inline]
    pub(crate) fn word(self, bytes: [u8; 4]) -> u32 {
        match self {
            Self::Little => u32::from_le_bytes(bytes),
            Self::Big => u32::from_be_bytes(bytes),
        }
    }

    /// Return the number that up to eight bytes hold.
    pub(crate) fn number(self, bytes: &[u8]) -> Result<u64, Fault> {
        if bytes.len() > 8 {
            return Err(Fault::LongNumber);
        }
        let add = |number: u64, byte: &u8| number << 8 | u64::from(*byte);
        Ok(match self {
            Self::Little => bytes.iter().rev().fold(0, add),
            Self::Big => bytes.iter().fold(0, add),
        })
    }

    /// Return the signed number that up to eight bytes hold.
    pub(crate) fn signed(self, bytes: &[u8]) -> Result<i64, Fault> {
        let number = self.number(bytes)?;
        let unused = 64 - 8 * bytes.len() as u32;
        // All 64 bits are unused if there are no bytes.
        Ok((number.checked_shl(unused).unwrap_or_default() as i64) >> unused.min(63))
    }

    /// Return the lowest byte of a number of any size; zero if it has no bytes.
    #[inline]
    pub(crate) fn lowest(self, bytes: &[u8]) -> u8 {
        let byte = match self {
            Self::Little => bytes.first(),
            Self::Big => bytes.last(),
        };
        byte.copied().unwrap_or_default()
    }
}

/// The unread rest of a body.
#[derive(Clone, Copy)]
pub(crate) struct Body<'a> {
    rest: &'a [u8],
    order: Order,
}

impl<'a> Body<'a> {
    pub(crate) fn new(rest: &'a [u8], order: Order) -> Self {
        Self { rest, order }
    }

    pub(crate) fn order(&self) -> Order {
        self.order
    }

    #[inline]
    pub(crate) fn word(&mut self) -> Result<u32, Fault> {
        let (bytes, rest) = self.rest.split_first_chunk().ok_or(Fault::TooShort)?;
        self.rest = rest;
        Ok(self.order.word(*bytes))
    }

    #[inline]
    pub(crate) fn half(&mut self) -> Result<u16, Fault> {
        let (bytes, rest) = self.rest.split_first_chunk().ok_or(Fault::TooShort)?;
        self.rest = rest;
        Ok(self.order.half(*bytes))
    }

    /// Return `size` bytes and skip the padding after them.
    #[inline]
    pub(crate) fn data(&mut self, size: usize) -> Result<&'a [u8], Fault> {
        let (data, rest) = self.rest.split_at_checked(size).ok_or(Fault::TooShort)?;
        let padding = size.wrapping_neg() % 4;
        self.rest = rest.get(padding..).unwrap_or_default();
        Ok(data)
    }

    /// Return the next option, a code with a value; `None` after the last one.
    #[inline]
    pub(crate) fn option(&mut self) -> Result<Option<(u16, &'a [u8])>, Fault> {
        if self.rest.is_empty() {
            return Ok(None);
        }
        let (code, size) = (self.half()?, self.half()?);
        if code == END {
            return Ok(None);
        }
        Ok(Some((code, self.data(usize::from(size))?)))
    }
}

/// The code of the option that ends the options.
const END: u16 = 0;
