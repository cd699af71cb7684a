//! The blocking client: threads that share a port take turns in reading for all.

use std::io::ErrorKind;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use cobotwire_core::exchange::{Answer, Ticket};

use crate::encoder::{Handle, Named, Outcome, Polling, Prepared, client_methods, result};
use crate::port::{self, Port};
use crate::session::{Outgoing, Queue, Session};
use crate::typed::{DeviceEvent, Request, Table};
use crate::{Error, Options, Sample, Value, lock};

/// The longest that a thread reads before it checks whether others have something to do.
const SLICE: Duration = Duration::from_millis(20);
/// How long a thread leaves the port to others.
const TURN: Duration = Duration::from_micros(500);
/// For how long received bytes are read after a one-way request, if they do not end.
const DRAIN: Duration = Duration::from_millis(50);

/// An arm at the other end of a port; clients of editions add a method for each command.
///
/// Every method may be called from any thread; a clone is a second handle of the same connection.
/// Requests without a reply are sent once and at once. Requests with a reply take turns.
#[derive(Clone)]
pub struct Client {
    handle: Handle,
    shared: Arc<Shared>,
}

struct Shared {
    connection: Mutex<Connection>,
    /// How many threads want the connection.
    waiting: AtomicUsize,
}

client_methods!(Client [] []);

impl Client {
    /// Open a port: that of a serial line, or `socket://host:port`.
    pub fn open(edition: Table, port: &str, options: Options) -> Result<Self, Error> {
        let opened = port::open(port, options.baudrate.unwrap_or(edition.baudrate))?;
        Self::with(edition, opened, Some(port), options)
    }

    /// Drive an arm over an open port.
    pub fn over(
        edition: Table,
        port: impl Port + 'static,
        options: Options,
    ) -> Result<Self, Error> {
        let name = options.port_name.clone();
        Self::with(edition, Box::new(port), name.as_deref(), options)
    }

    fn with(
        edition: Table,
        port: Box<dyn Port>,
        url: Option<&str>,
        options: Options,
    ) -> Result<Self, Error> {
        let handle = Handle::new(edition, &options)?;
        let connection = Mutex::new(Connection {
            session: Session::new(handle.encoder.clone(), url, options.on_drop),
            port: Some(port),
            limit: None,
            writing: false,
            buffer: vec![0; 4096],
        });
        let waiting = AtomicUsize::new(0);
        Ok(Self {
            handle,
            shared: Arc::new(Shared {
                connection,
                waiting,
            }),
        })
    }

    /// Close the port when what was written is sent. Nothing more is sent to the arm; calls of other
    /// threads end with a `LinkError`. Closing twice is harmless.
    pub fn close(&self) -> Result<(), Error> {
        let mut connection = self.connection();
        let flushed = connection
            .port
            .take()
            .map_or(Ok(()), |mut port| port.flush());
        while connection.writing {
            connection = self.leave(connection);
        }
        connection.session.close();
        flushed.map_err(|error| {
            connection
                .session
                .lose(&format!("cannot be written: {error}"))
        })
    }

    fn subscribe(&self, queue: &Arc<Mutex<Queue>>) {
        self.connection().session.subscribe(queue);
    }

    /// Return the connection as soon as no other thread has it.
    fn connection(&self) -> MutexGuard<'_, Connection> {
        self.shared.waiting.fetch_add(1, Ordering::SeqCst);
        let connection = lock(&self.shared.connection);
        self.shared.waiting.fetch_sub(1, Ordering::SeqCst);
        connection
    }

    fn perform(&self, prepared: &Prepared) -> Outcome {
        // Another thread may have the connection for as long as a full line takes no bytes.
        let called = Instant::now();
        let (settings, mut connection) = (&self.handle.settings, self.connection());
        let called_at =
            crate::options::nanos(called.saturating_duration_since(connection.session.begun));
        if prepared.awaits_reply {
            let ticket = connection.session.enqueue(prepared, settings, called_at);
            let (connection, sent) = self.turn(connection, Duration::ZERO);
            return self.wait(connection, ticket, prepared, sent).map(Some);
        }
        loop {
            let has_time = connection.session.has_time(settings, called_at);
            let waits_for_writer = connection.writing && (has_time || settings.deadline.is_none());
            if !waits_for_writer && (!has_time || connection.has_room()) {
                break;
            }
            connection = self.leave(connection);
        }
        let (outgoing, ticket) = connection.session.one_way(prepared, settings, called_at)?;
        let (mut connection, written) = self.write(connection, &outgoing);
        if let Some(ticket) = ticket {
            return self.wait(connection, ticket, prepared, written).map(Some);
        }
        written?;
        connection.drain()?;
        Ok(None)
    }

    /// Read for all until a request has ended.
    fn wait<'a>(
        &'a self,
        mut connection: MutexGuard<'a, Connection>,
        ticket: Ticket,
        prepared: &Prepared,
        mut last: Result<(), Error>,
    ) -> Result<Answer, Error> {
        loop {
            if let Some(outcome) = connection.session.take(ticket, prepared) {
                return outcome;
            }
            if let Err(error) = last {
                connection.session.give_up(ticket);
                return Err(error);
            }
            if self.shared.waiting.load(Ordering::SeqCst) > 0 {
                // A turn nevertheless, or threads could leave it to each other for ever.
                connection = self.leave(connection);
                (connection, last) = self.turn(connection, Duration::ZERO);
                continue;
            }
            (connection, last) = self.turn(connection, SLICE);
        }
    }

    /// Leave the connection to other threads for a moment.
    fn leave<'a>(&'a self, connection: MutexGuard<'a, Connection>) -> MutexGuard<'a, Connection> {
        drop(connection);
        std::thread::sleep(TURN);
        self.connection()
    }

    /// Read once, let time pass, and send the request that is next.
    fn turn<'a>(
        &'a self,
        mut connection: MutexGuard<'a, Connection>,
        longest: Duration,
    ) -> (MutexGuard<'a, Connection>, Result<(), Error>) {
        match connection.turn(longest) {
            Ok(Some(outgoing)) => self.write(connection, &outgoing),
            Ok(None) => (connection, Ok(())),
            Err(error) => (connection, Err(error)),
        }
    }

    /// Write a request whole, within its time. Other threads read while the line takes no bytes.
    fn write<'a>(
        &'a self,
        mut connection: MutexGuard<'a, Connection>,
        outgoing: &Outgoing,
    ) -> (MutexGuard<'a, Connection>, Result<(), Error>) {
        let bytes = outgoing.bytes();
        let (mut taken, mut fault) = (0, None);
        connection.writing = true;
        while let Some(rest) = bytes.get(taken..).filter(|rest| !rest.is_empty()) {
            let port = connection.port(Duration::ZERO);
            match port.and_then(|port| port.write(rest)) {
                Ok(size) if size > 0 => taken += size,
                Err(error) if !is_wait(&error) => {
                    fault = Some(error);
                    break;
                }
                _ if Instant::now() >= outgoing.until => break,
                _ => connection = self.leave(connection),
            }
        }
        connection.writing = false;
        let written = connection.session.wrote(outgoing, taken, fault.as_ref());
        (connection, written)
    }

    /// Read what comes without a request for some time, or until `done`.
    fn listen(&self, longest: Duration, done: impl Fn() -> bool) -> Result<(), Error> {
        let begun = Instant::now();
        while !done() && begun.elapsed() < longest {
            let left = longest.saturating_sub(begun.elapsed());
            self.turn(self.connection(), left.min(SLICE)).1?;
            if self.shared.waiting.load(Ordering::SeqCst) > 0 {
                std::thread::sleep(TURN);
            }
        }
        Ok(())
    }
}

/// The samples of a query; see [`Client::poll`].
pub struct Polls<R, C = Client> {
    pub(crate) client: C,
    pub(crate) polling: Polling,
    pub(crate) reply: PhantomData<fn() -> R>,
}

impl<R, C> Polls<R, C> {
    /// Return how many periods have had no sample.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.polling.missed
    }
}

impl<R: Request> Iterator for Polls<R> {
    type Item = Result<Sample<R::Reply>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        while !self.polling.ended {
            let at = self.polling.tick();
            std::thread::sleep(at.saturating_duration_since(Instant::now()));
            let answer = self.client.perform(&self.polling.prepared);
            let sample = self.polling.sample::<R>(&self.client.handle, answer);
            if sample.is_some() {
                return sample;
            }
        }
        None
    }
}

/// Events of one type; see [`Client::events`].
pub struct Events<E, C = Client> {
    pub(crate) client: C,
    pub(crate) queue: Arc<Mutex<Queue>>,
    pub(crate) timeout: Option<Duration>,
    pub(crate) event: PhantomData<fn() -> E>,
}

impl<E, C> Events<E, C> {
    /// Return how many events were dropped because too many waited: always the oldest.
    #[must_use]
    pub fn lost(&self) -> u64 {
        lock(&self.queue).lost
    }
}

impl<E: DeviceEvent> Iterator for Events<E> {
    type Item = Result<E, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let longest = self.timeout.unwrap_or(crate::FOREVER);
        let waits = || !lock(&self.queue).events.is_empty();
        let listened = self.client.listen(longest, waits);
        let event = lock(&self.queue).events.pop_front();
        let event = event.map(|fields| result(fields, (E::FIELDS, false), &[]));
        event.or_else(|| listened.err().map(Err))
    }
}

/// The port with its exchange; the thread that holds it reads and writes.
struct Connection {
    session: Session,
    /// `None`: it is closed.
    port: Option<Box<dyn Port>>,
    /// The limit that the port has.
    limit: Option<Duration>,
    /// Whether a thread is writing; it leaves the connection to others while the line is full.
    writing: bool,
    buffer: Vec<u8>,
}

impl Connection {
    /// Read once, and let time pass; return the request that is to be sent.
    fn turn(&mut self, longest: Duration) -> Result<Option<Outgoing>, Error> {
        let idle = self.session.idle().unwrap_or(longest);
        let size = self.read(longest.min(idle))?;
        let data = self.buffer.get(..size).unwrap_or_default();
        if self.session.advance(data) {
            let full = self.writing || self.session.has_deadline() && !self.has_room();
            self.session.exchange.note_full(full);
            if !full {
                return Ok(self.session.next(size == 0));
            }
            std::thread::sleep(TURN);
        }
        Ok(None)
    }

    /// Read received bytes, so that no buffer overflows while only one-way requests are sent.
    fn drain(&mut self) -> Result<(), Error> {
        let until = Instant::now() + DRAIN;
        while Instant::now() < until {
            let size = self.read(Duration::ZERO)?;
            if size == 0 {
                break;
            }
            let data = self.buffer.get(..size).unwrap_or_default();
            self.session.advance(data);
        }
        Ok(())
    }

    fn has_room(&mut self) -> bool {
        self.port.as_mut().is_none_or(|port| port.has_room())
    }

    /// Return the port, so that it waits for some time at most.
    fn port(&mut self, longest: Duration) -> std::io::Result<&mut dyn Port> {
        let port = self.port.as_mut().ok_or(ErrorKind::NotConnected)?;
        if self.limit != Some(longest) {
            port.wait_at_most(longest)?;
            self.limit = Some(longest);
        }
        Ok(port)
    }

    /// Read what has come into the buffer, and return its size.
    fn read(&mut self, longest: Duration) -> Result<usize, Error> {
        if self.port.is_none() {
            return Err(self.session.lose("is closed"));
        }
        let mut buffer = std::mem::take(&mut self.buffer);
        let outcome = self.port(longest).and_then(|port| port.read(&mut buffer));
        self.buffer = buffer;
        match outcome {
            Ok(0) => Err(self.session.lose("the peer has closed the connection")),
            Ok(size) => Ok(size),
            Err(error) if is_wait(&error) => Ok(0),
            Err(error) => Err(self.session.lose(&format!("cannot be read: {error}"))),
        }
    }
}

fn is_wait(error: &std::io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
    )
}

impl Drop for Connection {
    fn drop(&mut self) {
        let bytes = self.session.stops();
        if let Some(port) = self.port.as_mut().filter(|_| !bytes.is_empty()) {
            // Nobody is left who could handle an error.
            let _ = port.wait_at_most(Duration::from_secs(1));
            // No flush: it would wait for a stuck line without limit.
            let _ = port.write_all(&bytes);
        }
    }
}
