//! Drive robot arms of Elephant Robotics over a serial port or TCP with typed calls. Only queries
//! are sent again, and no reply is matched to a wrong request.
//!
//! ```no_run
//! # #[cfg(feature = "mycobot280")]
//! # fn main() -> Result<(), cobotwire::Error> {
//! use cobotwire::editions::mycobot280::MyCobot280;
//!
//! let arm = MyCobot280::open("socket://127.0.0.1:9000")?;
//! println!("{:?}", arm.get_angles()?);
//! arm.send_angles([0.0; 6], 30)?;
//! arm.close()
//! # }
//! # #[cfg(not(feature = "mycobot280"))]
//! # fn main() {}
//! ```
//!
//! Each edition of the protocol has a feature of its name. `serial` adds serial ports, `tokio` the
//! asynchronous client. `cobotwire-gen build mine.yaml --out PACKAGE --rust FOLDER` writes the
//! module of a protocol of your own.
//!
//! Every method that sends a request fails with a [`Error::UsageError`] before a byte is sent if an
//! argument is not allowed, with a `LinkError` if the port is lost, and, if it waits for a reply,
//! with a `ReplyTimeout`, `ProtocolError` or `RequestRefused`.
//!
//! A client that is dropped without `close()` stops an arm that it has set in motion: see
//! [`OnDrop`].

// Generated modules refer to this crate by its name, and so do those inside it.
extern crate self as cobotwire;

#[cfg(feature = "tokio")]
mod asynchronous;
mod blocking;
mod connection;
mod error;
#[doc(hidden)]
mod handle;
mod limits;
mod notes;
mod options;
mod port;
#[doc(hidden)]
mod session;
mod streams;
pub mod typed;

#[rustfmt::skip]
#[cfg(feature = "editions")]
pub mod editions;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cobotwire_table::Edition;

#[cfg(feature = "tokio")]
pub use asynchronous::{AsyncClient, ByteStream};
pub use blocking::Client;
pub use cobotwire_core::exchange::{Nanos, RetryPolicy, WaitedFor};
pub use error::Error;
pub use limits::{Limits, Range};
pub use options::{OnDrop, Options};
pub use port::Port;
pub use streams::Received;
pub use typed::Value;

/// A client without a port and a clock, for transports of other kinds.
#[doc(hidden)]
pub mod machine {
    pub use crate::handle::{Handle, Named, Outcome, Prepared};
    pub use crate::session::{CallId, Queue, Session};
    pub use cobotwire_core::exchange::PersistedState;
}

/// The result of a query, with its times.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample<T> {
    /// The result.
    pub value: T,
    /// When its request was sent, in nanoseconds since the client was opened.
    pub requested_at: Nanos,
    /// When its reply was read, on the same clock.
    pub replied_at: Nanos,
}

/// Read the table of a protocol: the text of an `edition.json`, which may come from an untrusted
/// source.
pub fn read_table(json: &[u8]) -> Result<typed::Table, Error> {
    let read = Edition::read(json).map_err(|error| Error::usage(error.to_string()));
    read.map(Arc::new)
}

/// Lock a mutex, even if a thread panicked while it held it: each step leaves the state consistent.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
