//! A packet of a recording.

/// The direction of a packet, as the recording program saw it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PacketDirection {
    /// The file does not state the direction.
    Unknown,
    /// The program read the bytes.
    Received,
    /// The program wrote the bytes.
    Sent,
}

impl PacketDirection {
    /// Return the direction in a packet's flags; `flags` is their lowest byte.
    #[inline]
    pub(crate) fn of(flags: u8) -> Self {
        match flags & 3 {
            1 => Self::Received,
            2 => Self::Sent,
            _ => Self::Unknown,
        }
    }
}

/// A packet.
#[derive(Clone, Copy)]
pub(crate) struct Packet<'a> {
    /// The index of its interface in the file.
    pub(crate) interface: usize,
    pub(crate) direction: PacketDirection,
    /// When its first byte arrived, in nanoseconds since 1970.
    pub(crate) time: i64,
    pub(crate) data: &'a [u8],
    pub(crate) comment: &'a [u8],
}
