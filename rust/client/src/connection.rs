//! A port with its session: what both clients share.

use std::io::ErrorKind;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use cobotwire_core::exchange::Nanos;

use crate::handle::{Handle, Prepared};
use crate::notes::Note;
use crate::options::nanos;
use crate::session::{CallId, Session};
use crate::typed::Table;
use crate::{Error, Options, Port};

/// How long a stop may take when a client is dropped and the line is full.
pub(crate) const LONGEST_STOP: Duration = Duration::from_secs(1);
/// The pause before the next attempt to write on a full line.
const PAUSE: Duration = Duration::from_micros(500);

/// A connection that several handles share, and what they need to take turns.
pub(crate) struct Shared<T> {
    pub connection: Mutex<Connection>,
    pub turns: T,
}

/// The port with its session; the thread or task that holds it reads and writes for all.
pub(crate) struct Connection {
    pub session: Session,
    /// `None`: it is closed.
    port: Option<Box<dyn Port>>,
    /// Whether reads and writes of the port return at once.
    is_instant: bool,
    /// How long a dropped client may wait until the line takes a stop.
    patience: Duration,
    began: Instant,
    note: Note,
}

impl Connection {
    /// Drive an arm over a port; return the first handle.
    pub fn open<T>(
        edition: Table,
        port: Box<dyn Port>,
        options: Options,
        (patience, turns): (Duration, T),
    ) -> Result<(Handle, Arc<Shared<T>>), Error> {
        let handle = Handle::new(edition, options)?;
        let (note, left) = Note::of(handle.options.port_name.as_deref());
        let connection = Mutex::new(Self {
            session: Session::new(&handle, &left),
            port: Some(port),
            is_instant: false,
            patience,
            began: Instant::now(),
            note,
        });
        Ok((handle, Arc::new(Shared { connection, turns })))
    }

    fn now(&self) -> Nanos {
        nanos(self.began.elapsed())
    }

    pub fn submit(&mut self, prepared: &Prepared, handle: &Handle, called: Instant) -> CallId {
        let called_at = nanos(called.saturating_duration_since(self.began));
        let now = self.now();
        self.session.submit(prepared, handle, called_at, now)
    }

    /// Return the time until the next deadline, at most `longest`; only received bytes need an
    /// earlier step.
    pub fn idle(&self, longest: Duration) -> Duration {
        let idle = self.session.idle(self.now());
        idle.map_or(longest, |idle| longest.min(Duration::from_nanos(idle)))
    }

    /// Read once, end requests whose deadline passed, and write what is due; return whether bytes
    /// were read.
    pub fn step(&mut self, longest: Duration) -> bool {
        let (idle, mut buffer) = (self.idle(longest), [0; 1024]);
        let read = self.port(idle).and_then(|port| port.read(&mut buffer));
        let lost = match &read {
            Ok(0) => Some("the peer has closed the connection".to_owned()),
            Err(error) if !is_wait(error) => Some(format!("cannot be read: {error}")),
            _ => None,
        };
        let now = self.now();
        match lost.filter(|_| self.session.fault.is_none()) {
            Some(detail) => drop(self.session.lose(&detail, now)),
            None => {
                let data = buffer.get(..*read.as_ref().unwrap_or(&0));
                self.session.receive(data.unwrap_or_default(), now);
                self.write(read.is_err(), now);
            }
        }
        read.is_ok()
    }

    /// Write until there is nothing left to send, or the line takes no more.
    fn write(&mut self, drained: bool, mut now: Nanos) {
        loop {
            let bytes = self.session.outgoing(now, drained).to_vec();
            if bytes.is_empty() {
                return;
            }
            let port = self.port(Duration::ZERO);
            let written = port.and_then(|port| port.write_some(&bytes));
            now = self.now();
            match written {
                Ok(size) if size > 0 => self.session.wrote(size, now),
                Err(error) if !is_wait(&error) => self.session.end_write(&error.to_string(), now),
                _ => return,
            }
        }
    }

    /// Return the port; its next read takes at most `longest`.
    fn port(&mut self, longest: Duration) -> std::io::Result<&mut dyn Port> {
        let port = self.port.as_mut().ok_or(ErrorKind::NotConnected)?;
        if !(self.is_instant && longest.is_zero()) {
            self.is_instant = false;
            port.wait_at_most(longest)?;
            self.is_instant = longest.is_zero();
        }
        Ok(&mut **port)
    }

    /// Send what was written, and close the port.
    pub fn close(&mut self) -> Result<(), Error> {
        let Some(mut port) = self.port.take() else {
            return Ok(());
        };
        let (flushed, now) = (port.finish(), self.now());
        self.note.leave(self.session.close(now));
        flushed.map_err(|error| {
            let detail = format!("cannot be written: {error}");
            self.session.lose(&detail, now)
        })
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
        let now = self.now();
        let mut rest = self.session.stops(now);
        self.note.leave(self.session.persist(now));
        let limited = self.port(Duration::ZERO).is_ok();
        let Some(mut port) = self.port.take().filter(|_| limited && !rest.is_empty()) else {
            return;
        };
        let mut stopped_by = move |until| {
            // No caller is left to handle an error.
            while !rest.is_empty() {
                let size = match port.write_some(&rest) {
                    Ok(size) => size.min(rest.len()),
                    Err(error) if is_wait(&error) => 0,
                    Err(_) => return true,
                };
                rest.drain(..size);
                if size == 0 && Instant::now() >= until {
                    return false;
                } else if size == 0 {
                    std::thread::sleep(PAUSE);
                }
            }
            true
        };
        let now = Instant::now();
        if !stopped_by(now + self.patience) {
            // The task that drops an asynchronous client must not block.
            std::thread::spawn(move || stopped_by(now + LONGEST_STOP));
        }
    }
}
