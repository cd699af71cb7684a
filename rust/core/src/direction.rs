//! The directions of messages.

/// The direction of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Direction {
    /// To the arm.
    Request,
    /// From the arm.
    Reply,
}

impl Direction {
    /// Return its name in the API.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Request => "request",
            Self::Reply => "reply",
        }
    }
}

/// The directions whose frames a framer accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Listening {
    /// Only one direction.
    To(Direction),
    /// Both directions, as when sniffing a transport.
    Both,
}
