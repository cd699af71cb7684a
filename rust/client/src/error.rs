//! The errors: one kind for each party that can be at fault.

use std::fmt::{Display, Formatter};
use std::time::Duration;

use cobotwire_core::exchange::WaitedFor;

/// Why a call failed. Its `message` says what happened, to what, and what to do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
#[allow(missing_docs)] // of the fields `message`
pub enum Error {
    /// An error of the caller, detected before a byte was sent.
    UsageError { message: String },
    /// An error of the peer: bytes that the protocol does not allow.
    ProtocolError {
        message: String,
        /// The rejected bytes.
        data: Vec<u8>,
    },
    /// The device replied that it does not carry out a request.
    RequestRefused { message: String },
    /// An error of the port: it could not be opened, or it disappeared.
    LinkError {
        message: String,
        /// How many bytes of the request were written; `None`: that is not known.
        written: Option<usize>,
    },
    /// The reply, or the requested acknowledgement, did not arrive in time.
    ReplyTimeout {
        message: String,
        /// The time since the request was sent, or since the call began if its deadline passed.
        waited: Duration,
        /// How often the request was sent; 0: it was not sent, and never will be.
        attempts: usize,
        /// What the call waited for when its deadline passed; `None`: the arm did not reply within
        /// its timeout.
        waited_for: Option<WaitedFor>,
    },
}

impl Error {
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        let message = message.into();
        Self::UsageError { message }
    }

    pub(crate) fn link(url: &str, detail: &str, written: Option<usize>) -> Self {
        let message = cobotwire_table::link_error(url, detail);
        Self::LinkError { message, written }
    }

    /// Return the name of its kind, for example `ReplyTimeout`.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.parts().0
    }

    fn parts(&self) -> (&'static str, &str) {
        match self {
            Self::UsageError { message } => ("UsageError", message),
            Self::ProtocolError { message, .. } => ("ProtocolError", message),
            Self::RequestRefused { message } => ("RequestRefused", message),
            Self::LinkError { message, .. } => ("LinkError", message),
            Self::ReplyTimeout { message, .. } => ("ReplyTimeout", message),
        }
    }
}

impl Display for Error {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.parts().1)
    }
}

impl std::error::Error for Error {}
