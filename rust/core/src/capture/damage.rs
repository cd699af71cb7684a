//! Why a file cannot be read to its end.

/// What is wrong with a block of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The file does not begin with a section, or a section has no byte order.
    NotPcapng,
    /// The length of a block, and the smallest that its kind can have.
    BadLength(u32, u32),
    /// The two lengths of a block differ.
    LengthsDiffer,
    /// A block ends before its content does.
    TooShort,
    /// A section has this major version, which is not supported.
    Version(u16),
    /// An interface has a number of more than eight bytes.
    LongNumber,
    /// A packet belongs to an interface of this link type, which is not one for private use.
    LinkType(u16),
    /// A block belongs to an interface of this index, which the file does not describe.
    NoInterface(u32),
    /// A packet has neither a time nor a direction.
    NoTime,
    /// The file describes more interfaces than a reader accepts.
    TooManyInterfaces,
    /// A time in nanoseconds since 1970 is beyond 64 bits.
    TimeRange,
}

/// What is wrong, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Damage {
    /// The position of the faulty block in the file.
    pub offset: u64,
    /// What is wrong with it.
    pub fault: Fault,
}
