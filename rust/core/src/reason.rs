//! Why bytes are not a frame.

/// Why bytes are not a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Reason {
    /// The header is missing.
    NoHeader,
    /// The format does not have that address byte.
    BadAddress,
    /// LEN is not legal, or not with that id.
    BadLength,
    /// The table lacks the id.
    UnknownId,
    /// The footer, CRC or sum at the end is wrong.
    BadCheck,
    /// The bytes end before the frame does.
    Truncated,
    /// Bytes follow the frame; only [`crate::decode`] reports this.
    Trailing,
}

impl Reason {
    /// Every reason; `reason as usize` is its index here.
    pub const ALL: [Self; 7] = [
        Self::NoHeader,
        Self::BadAddress,
        Self::BadLength,
        Self::UnknownId,
        Self::BadCheck,
        Self::Truncated,
        Self::Trailing,
    ];

    /// Return the reason's name in the API.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::NoHeader => "no-header",
            Self::BadAddress => "bad-address",
            Self::BadLength => "bad-length",
            Self::UnknownId => "unknown-id",
            Self::BadCheck => "bad-check",
            Self::Truncated => "truncated",
            Self::Trailing => "trailing",
        }
    }
}
