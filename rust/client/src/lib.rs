//! Drive robot arms of Elephant Robotics over a serial port or TCP: typed calls, each sent once, and
//! never a wrong pairing of request and reply.
//!
//! ```no_run
//! # #[cfg(feature = "mycobot280")]
//! # fn main() -> Result<(), cobotwire::Error> {
//! use cobotwire::editions::mycobot280::MyCobot280;
//!
//! let arm = MyCobot280::open("socket://127.0.0.1:9000")?;
//! println!("{:?}", arm.get_angles()?);
//! arm.send_angles([0.0; 6], 30)?;
//! arm.close();
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "mycobot280"))]
//! # fn main() {}
//! ```
//!
//! Each edition of the protocol has a feature of its name. `serial` adds serial ports, `tokio` the
//! asynchronous client. `cobotwire-gen build mine.yaml --out PACKAGE --rust FOLDER` writes the
//! module of a protocol of your own.
//!
//! A client that is dropped without `close()` stops an arm that it has set in motion: see
//! [`OnDrop`].

// Generated modules name this crate, also those in it.
extern crate self as cobotwire;

#[cfg(feature = "tokio")]
mod asynchronous;
mod blocking;
mod encoder;
mod error;
mod limits;
mod notes;
mod options;
mod port;
mod session;
pub mod typed;
mod value;

#[rustfmt::skip]
#[cfg(any(
    feature = "mecharm270", feature = "mercury_a1", feature = "mercury_b1", feature = "mercury_x1",
    feature = "myarm300", feature = "myarm_c650", feature = "myarm_m750", feature = "mybuddy",
    feature = "mycobot", feature = "mycobot280", feature = "mycobot280_rdkx5",
    feature = "mycobot320", feature = "mypalletizer260", feature = "pro400", feature = "pro450",
    feature = "pro630",
))]
pub mod editions;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use cobotwire_table::Edition;

#[cfg(feature = "tokio")]
pub use asynchronous::{AsyncClient, AsyncEvents, AsyncPolls, ByteStream};
pub use blocking::{Client, Events, Polls};
pub use cobotwire_core::exchange::WaitedFor;
pub use error::Error;
pub use limits::{Limits, Range};
pub use options::{Address, OnDrop, Options, RetryPolicy};
pub use port::Port;
pub use value::Value;

/// The result of a query at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample<T> {
    /// The result.
    pub value: T,
    /// When its request was made.
    pub requested_at: Instant,
    /// When its reply was read.
    pub replied_at: Instant,
}

/// Read the table of a protocol: the text of an `edition.json`, which may come from a stranger.
///
/// # Errors
/// The text is not such a table.
pub fn read_table(json: &[u8]) -> Result<typed::Table, Error> {
    let read = Edition::read(json).map_err(|error| Error::usage(error.to_string()));
    read.map(Arc::new)
}

/// Lock, also after a thread has panicked: each step leaves the state consistent.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
