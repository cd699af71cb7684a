//! A packet of a recording.

/// The direction of a packet, as the recording program saw it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PacketDirection {
    /// The file does not tell.
    Unknown,
    /// It read the bytes.
    Received,
    /// It wrote the bytes.
    Sent,
}

impl PacketDirection {
    /// Return the direction that a packet's flags tell, by their lowest byte.
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
    /// When its first byte came, in nanoseconds since 1970.
    pub(crate) time: i64,
    pub(crate) data: &'a [u8],
    pub(crate) comment: &'a [u8],
}
