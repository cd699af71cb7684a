//! The blocking client: threads that share a port take turns in reading and writing for all.

use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use crate::connection::{Connection, LONGEST_STOP, Shared};
use crate::handle::{Handle, Outcome, Prepared, result};
use crate::options::nanos;
use crate::port::{self, Port};
use crate::session::Session;
use crate::streams::{Polling, Received, client_methods};
use crate::typed::{DeviceEvent, Request, Table};
use crate::{Error, Options, Sample, Value, lock};

/// The longest that a thread reads before it lets other threads use the connection; the more
/// threads wait, the shorter each reads. A shorter timer, due before the next tick of the system
/// (usually 4 ms), would cost a third of the time of a call.
const SLICE: Duration = Duration::from_millis(5);
/// How long a thread pauses to let others use the port.
const TURN: Duration = Duration::from_micros(500);

/// An arm at the other end of a port; clients of editions add a method for each command.
///
/// Every method may be called from any thread; a clone is a second handle of the same connection.
/// Requests without a reply are sent once and at once. Requests with a reply take turns.
#[derive(Clone)]
pub struct Client {
    handle: Handle,
    /// The connection, and the number of threads that wait for it.
    shared: Arc<Shared<AtomicU32>>,
}

client_methods!(Client Option std::thread::sleep, [] [] [] []);

impl Client {
    /// Open a serial port, or connect to `socket://host:port`.
    pub fn open(edition: Table, port: &str, mut options: Options) -> Result<Self, Error> {
        let opened = port::open(port, options.baudrate.unwrap_or(edition.baudrate))?;
        options.port_name = Some(port.to_owned());
        Self::over(edition, opened, options)
    }

    /// Drive an arm over an open port.
    pub fn over(
        edition: Table,
        port: impl Port + 'static,
        options: Options,
    ) -> Result<Self, Error> {
        let turns = (LONGEST_STOP, AtomicU32::new(0));
        let (handle, shared) = Connection::open(edition, Box::new(port), options, turns)?;
        Ok(Self { handle, shared })
    }

    /// Send what was written, and close the port. Nothing more is sent to the arm; calls of other
    /// threads end with a `LinkError`. Closing twice is harmless.
    pub fn close(&self) -> Result<(), Error> {
        self.connection().close()
    }

    /// Wait until no other thread holds the connection, and return it.
    fn connection(&self) -> MutexGuard<'_, Connection> {
        self.shared.turns.fetch_add(1, Ordering::SeqCst);
        let connection = lock(&self.shared.connection);
        self.shared.turns.fetch_sub(1, Ordering::SeqCst);
        connection
    }

    fn perform(&self, prepared: &Prepared) -> Outcome {
        // The time counts from here, since `connection()` may wait for another thread.
        let called = Instant::now();
        let id = self.connection().submit(prepared, &self.handle, called);
        self.until(None, |session, _| session.take(id))
    }

    /// Perform a request, and return that this thread waited for it all the time.
    fn attended(&self, prepared: &Prepared) -> (Outcome, Duration) {
        (self.perform(prepared), Duration::ZERO)
    }

    /// Read and write for all threads until `done` returns something. Its second argument is
    /// whether `longest` has passed.
    fn until<T>(
        &self,
        longest: Option<Duration>,
        mut done: impl FnMut(&mut Session, bool) -> Option<T>,
    ) -> T {
        let (began, mut connection) = (Instant::now(), self.connection());
        loop {
            let left = longest.map_or(SLICE, |longest| longest.saturating_sub(began.elapsed()));
            if let Some(found) = done(&mut connection.session, left.is_zero()) {
                return found;
            }
            let others = self.shared.turns.load(Ordering::SeqCst);
            connection.step(left.min(SLICE / others.saturating_add(1)));
            if let Some(found) = done(&mut connection.session, false) {
                return found;
            }
            connection = self.leave(connection);
        }
    }

    /// Release the connection for a moment if another thread waits for it.
    fn leave<'a>(&'a self, connection: MutexGuard<'a, Connection>) -> MutexGuard<'a, Connection> {
        if self.shared.turns.load(Ordering::SeqCst) == 0 {
            return connection;
        }
        drop(connection);
        std::thread::sleep(TURN);
        self.connection()
    }
}
