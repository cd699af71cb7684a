//! The blocking client: threads that share a port take turns in reading for all.

use std::io::ErrorKind;
use std::marker::PhantomData;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

use cobotwire_core::exchange::{Answer, Ticket};

use crate::encoder::{Handle, Named, Outcome, Polling, Prepared, handle_methods, result};
use crate::port::{self, Port};
use crate::session::{Outgoing, Queue, Session};
use crate::typed::{DeviceEvent, Request, Table};
use crate::{Address, Error, Options, Sample, Value, lock};

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

handle_methods!(Client);

impl Client {
    /// Open a port: that of a serial line, or `socket://host:port`.
    ///
    /// # Errors
    /// The port or an option is not allowed, or the port cannot be opened.
    pub fn open(edition: Table, port: &str, options: Options) -> Result<Self, Error> {
        let opened = port::open(port, options.baudrate.unwrap_or(edition.baudrate))?;
        Self::with(edition, opened, Some(port), options)
    }

    /// Drive an arm over an open port.
    ///
    /// # Errors
    /// An option is not allowed.
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

    /// Close the port. Nothing is sent to the arm; calls of other threads end with a `LinkError`.
    pub fn close(&self) {
        let mut connection = self.connection();
        connection.port = None;
        connection.session.close();
    }

    /// Send a request; return the result of its reply, if it has one.
    ///
    /// # Errors
    /// An argument is not allowed, the port is lost, or the reply is illegal or missing.
    pub fn call<R: Request>(&self, request: R) -> Result<R::Reply, Error> {
        let prepared = self.handle.prepare(request)?;
        self.handle.result::<R>(&prepared, self.perform(&prepared)?)
    }

    /// Send a request by the name of its command; return the fields of its reply.
    ///
    /// # Errors
    /// As [`Self::call`].
    pub fn call_named(&self, command: &str, arguments: &[(&str, Value)]) -> Result<Named, Error> {
        let prepared = self.handle.prepare_named(command, arguments)?;
        Ok(self
            .handle
            .encoder
            .fields(&prepared, self.perform(&prepared)?))
    }

    /// Return an iterator that samples a query `rate` times a second.
    ///
    /// A request is sent only when the loop wants a sample, and not again within its period. A
    /// period without a reply has no sample; [`Polls::missed`] counts such periods, and those for
    /// which the loop came too late.
    ///
    /// # Errors
    /// The request is no query, an argument is not allowed, or the rate is not above 0 and up to
    /// 1000.
    pub fn poll<R: Request>(&self, request: R, rate: f64) -> Result<Polls<R>, Error> {
        let polling = self.handle.polling(request, rate)?;
        let mut client = self.clone();
        client.handle.settings.retry.attempts = 1;
        Ok(Polls {
            client,
            polling,
            ended: false,
            reply: PhantomData,
        })
    }

    /// Return an iterator over the events of a type that come from now on. It ends if none comes
    /// within `timeout`.
    ///
    /// # Errors
    /// The edition has no such event.
    pub fn events<E: DeviceEvent>(&self, timeout: Option<Duration>) -> Result<Events<E>, Error> {
        let queue = Queue::new(self.handle.encoder.command(E::COMMAND)?);
        self.connection().session.subscribe(&queue);
        Ok(Events {
            client: self.clone(),
            queue,
            timeout,
            event: PhantomData,
        })
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
            let sent = connection.turn(Duration::ZERO);
            return self.wait(connection, ticket, prepared, sent).map(Some);
        }
        while connection.session.has_time(settings, called_at) && !connection.has_room() {
            drop(connection);
            std::thread::sleep(TURN);
            connection = self.connection();
        }
        let (outgoing, ticket) = connection.session.one_way(prepared, settings, called_at)?;
        let written = connection.write(&outgoing);
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
                drop(connection);
                std::thread::sleep(TURN);
                connection = self.connection();
                last = Ok(());
                continue;
            }
            last = connection.turn(SLICE);
        }
    }

    /// Read what comes without a request for some time, or until `done`.
    fn listen(&self, longest: Duration, done: impl Fn() -> bool) -> Result<(), Error> {
        let until = Instant::now() + longest;
        while !done() && Instant::now() < until {
            let left = until.saturating_duration_since(Instant::now());
            let outcome = self.connection().turn(left.min(SLICE));
            outcome?;
            if self.shared.waiting.load(Ordering::SeqCst) > 0 {
                std::thread::sleep(TURN);
            }
        }
        Ok(())
    }
}

/// The samples of a query; see [`Client::poll`].
pub struct Polls<R> {
    client: Client,
    polling: Polling,
    ended: bool,
    reply: PhantomData<fn() -> R>,
}

impl<R> Polls<R> {
    /// Return how many periods have had no sample.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.polling.missed
    }
}

impl<R: Request> Iterator for Polls<R> {
    type Item = Result<Sample<R::Reply>, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        while !self.ended {
            let at = self.polling.tick();
            std::thread::sleep(at.saturating_duration_since(Instant::now()));
            let requested_at = Instant::now();
            let prepared = &self.polling.prepared;
            let answer = self.client.perform(prepared);
            let value = answer.and_then(|each| self.client.handle.result::<R>(prepared, each));
            match value {
                Ok(value) => {
                    return Some(Ok(Sample {
                        value,
                        requested_at,
                        replied_at: Instant::now(),
                    }));
                }
                Err(error @ Error::LinkError { .. }) => {
                    self.ended = true;
                    return Some(Err(error));
                }
                Err(_) => self.polling.missed += 1,
            }
        }
        None
    }
}

/// Events of one type; see [`Client::events`].
pub struct Events<E> {
    client: Client,
    queue: Arc<Mutex<Queue>>,
    timeout: Option<Duration>,
    event: PhantomData<fn() -> E>,
}

impl<E> Events<E> {
    /// Return how many events were dropped because too many waited: always the oldest.
    #[must_use]
    pub fn lost(&self) -> u64 {
        lock(&self.queue).lost
    }
}

impl<E: DeviceEvent> Iterator for Events<E> {
    type Item = Result<E, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let longest = self.timeout.unwrap_or(Duration::from_secs(3600));
        loop {
            let listened = self
                .client
                .listen(longest, || !lock(&self.queue).events.is_empty());
            let event = lock(&self.queue).events.pop_front();
            match (event, listened) {
                (Some(fields), _) => return Some(result(fields, (E::FIELDS, false), &[])),
                (None, Err(error)) => return Some(Err(error)),
                (None, Ok(())) if self.timeout.is_some() => return None,
                (None, Ok(())) => {}
            }
        }
    }
}

/// The port with its exchange; the thread that holds it reads and writes.
struct Connection {
    session: Session,
    /// `None`: it is closed.
    port: Option<Box<dyn Port>>,
    /// The limit that the port has.
    limit: Option<Duration>,
    buffer: Vec<u8>,
}

impl Connection {
    /// Read once, let time pass, and send the request that is next.
    fn turn(&mut self, longest: Duration) -> Result<(), Error> {
        let idle = self.session.idle().unwrap_or(longest);
        let size = self.read(longest.min(idle))?;
        let data = self.buffer.get(..size).unwrap_or_default();
        if self.session.advance(data) {
            let full = self.session.has_deadline() && !self.has_room();
            self.session.exchange.note_full(full);
            if full {
                std::thread::sleep(TURN);
            } else if let Some(outgoing) = self.session.next(size == 0) {
                self.write(&outgoing)?;
            }
        }
        Ok(())
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

    /// Write a request whole, within its time.
    fn write(&mut self, outgoing: &Outgoing) -> Result<(), Error> {
        let bytes = outgoing.bytes();
        let (mut taken, mut fault) = (0, None);
        while let Some(rest) = bytes.get(taken..).filter(|rest| !rest.is_empty()) {
            match self.port(Duration::ZERO).and_then(|port| port.write(rest)) {
                Ok(size) if size > 0 => taken += size,
                Err(error) if !is_wait(&error) => {
                    fault = Some(error);
                    break;
                }
                _ if Instant::now() >= outgoing.until => break,
                _ => std::thread::sleep(TURN),
            }
        }
        self.session.wrote(outgoing, taken, fault.as_ref())
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
            let _ = port.write_all(&bytes).and_then(|()| port.flush());
        }
    }
}
