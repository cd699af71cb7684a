//! A borrowed view of one valid frame.

/// Bytes of a frame that LEN does not count: the header and LEN itself.
pub const OVERHEAD: usize = 3;

/// Bytes of a frame before its data: header, LEN and id.
pub(crate) const PREFIX: usize = OVERHEAD + 1;

/// One whole frame. Only [`crate::Rules::judge`] makes them, so having one means that it is legal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    bytes: &'a [u8],
    id: u8,
}

impl<'a> Frame<'a> {
    pub(crate) fn new(bytes: &'a [u8], id: u8) -> Self {
        Self { bytes, id }
    }

    /// All of it, from header to footer.
    #[must_use]
    pub fn bytes(self) -> &'a [u8] {
        self.bytes
    }

    /// The command id.
    #[must_use]
    pub fn id(self) -> u8 {
        self.id
    }

    /// LEN: the bytes from the id to the footer.
    #[must_use]
    pub fn length(self) -> u8 {
        self.bytes.get(2).copied().unwrap_or_default()
    }

    /// The data bytes, between id and footer.
    #[must_use]
    pub fn data(self) -> &'a [u8] {
        let end = self.bytes.len().saturating_sub(1);
        self.bytes.get(PREFIX..end).unwrap_or_default()
    }
}
