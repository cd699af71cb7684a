//! What both clients do with the exchange: begin requests, write them, sort what is received.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

use cobotwire_core::exchange::{Answer, Event, Exchange, Failure, Nanos, Safety, Ticket};

use crate::encoder::{Encoder, Named, Prepared};
use crate::notes::PortNames;
use crate::options::Settings;
use crate::{Error, OnDrop};

/// The least time that a write has, if a deadline limits it.
const SHORTEST_WRITE: Nanos = 20_000_000;
/// What a write has without a deadline: the line takes nothing for so long only if it is stuck.
const LONGEST_WRITE: Nanos = 1_000_000_000;
/// A write that takes longer than this was held up by a full line.
const SLOW_WRITE: Nanos = 5_000_000;

/// How many events wait for their consumer; if more come, the oldest is dropped.
const CAPACITY: usize = 1000;

/// Events of one command that wait for their consumer.
#[derive(Debug)]
pub(crate) struct Queue {
    pub command: usize,
    pub events: VecDeque<Named>,
    pub lost: u64,
}

/// Bytes that are to be written now.
#[derive(Debug)]
pub(crate) struct Outgoing {
    /// What ends an earlier request that was cut.
    align: Vec<u8>,
    data: Vec<u8>,
    /// The request whose caller waits; `None`: it is a one-way request.
    ticket: Option<Ticket>,
    /// The device that it stops, if it does.
    stops: Option<Option<u8>>,
    at: Nanos,
    /// Until when the write may take.
    pub until: Instant,
}

impl Outgoing {
    pub fn bytes(&self) -> Vec<u8> {
        [&*self.align, &*self.data].concat()
    }
}

/// The exchange over one transport, with its clock.
pub(crate) struct Session {
    pub encoder: Arc<Encoder>,
    pub exchange: Exchange,
    pub url: String,
    /// What happened to the transport last.
    pub fault: Error,
    /// Why writing a request has failed, by its ticket.
    faults: HashMap<Ticket, Error>,
    pub begun: Instant,
    queues: Vec<Weak<Mutex<Queue>>>,
    /// Until when the callers wait, by their tickets.
    ends: HashMap<Ticket, Nanos>,
    /// The ticket that was written last.
    written: Option<Ticket>,
    /// The devices that were set in motion, and not stopped since.
    moved: Vec<Option<u8>>,
    on_drop: OnDrop,
    names: PortNames,
}

impl Session {
    /// Begin with what an earlier session left; `None`: nothing says which port it is.
    pub fn new(encoder: Arc<Encoder>, url: Option<&str>, on_drop: OnDrop) -> Self {
        let (names, begun) = (url.map(PortNames::of).unwrap_or_default(), Instant::now());
        let mut exchange = Exchange::new(Arc::new(encoder.edition.protocol.clone()));
        exchange.restore(&names.recall(begun));
        let url = url.unwrap_or("port");
        Self {
            exchange,
            encoder,
            url: url.to_owned(),
            fault: Error::link(url, "is lost", None),
            faults: HashMap::new(),
            begun,
            names,
            queues: Vec::new(),
            ends: HashMap::new(),
            written: None,
            moved: Vec::new(),
            on_drop,
        }
    }

    pub fn now(&self) -> Nanos {
        crate::options::nanos(self.begun.elapsed())
    }

    fn instant(&self, at: Nanos) -> Instant {
        self.begun + Duration::from_nanos(at)
    }

    /// Return for how long nothing is to be done unless bytes come.
    pub fn idle(&self) -> Option<Duration> {
        self.exchange.idle(self.now()).map(Duration::from_nanos)
    }

    /// Keep events of a command for a consumer.
    pub fn subscribe(&mut self, queue: &Arc<Mutex<Queue>>) {
        self.queues.retain(|queue| queue.strong_count() > 0);
        self.queues.push(Arc::downgrade(queue));
    }

    /// Take received bytes and let time pass; return whether a request is to be sent.
    pub fn advance(&mut self, data: &[u8]) -> bool {
        let now = self.now();
        let events = self.exchange.advance(data, now);
        self.dispatch(events);
        self.exchange.has_next(now)
    }

    fn dispatch(&mut self, events: Vec<Event>) {
        for event in events {
            let Event::DeviceEvent {
                command, decoded, ..
            } = event
            else {
                continue;
            };
            for queue in self.queues.iter().filter_map(Weak::upgrade) {
                let mut queue = crate::lock(&queue);
                if queue.command != command {
                    continue;
                }
                if queue.events.len() >= CAPACITY {
                    queue.events.pop_front();
                    queue.lost += 1;
                }
                queue.events.push_back(self.encoder.named(decoded.clone()));
            }
        }
    }

    /// Queue a request whose caller waits for its reply. The call began at `called_at`.
    pub fn enqueue(
        &mut self,
        prepared: &Prepared,
        settings: &Settings,
        called_at: Nanos,
    ) -> Ticket {
        let now = self.now();
        self.note_motion(prepared);
        let ends_by = settings
            .deadline
            .map(|longest| called_at.saturating_add(longest));
        let request = prepared.request.clone();
        let ticket = self
            .exchange
            .enqueue(request, settings.timeout, settings.retry, now, ends_by);
        self.ends.extend(ends_by.map(|ends_by| (ticket, ends_by)));
        ticket
    }

    /// Return whether a request may be late if the line takes no bytes.
    pub fn has_deadline(&self) -> bool {
        !self.ends.is_empty()
    }

    /// Return whether a call may still wait for the line to take its request.
    pub fn has_time(&self, settings: &Settings, called_at: Nanos) -> bool {
        settings
            .deadline
            .is_some_and(|longest| self.now() - called_at < longest)
    }

    /// Return the bytes of a one-way request, and its ticket if its caller waits for the
    /// acknowledgement. The call began at `called_at`.
    pub fn one_way(
        &mut self,
        prepared: &Prepared,
        settings: &Settings,
        called_at: Nanos,
    ) -> Result<(Outgoing, Option<Ticket>), Error> {
        let now = self.now();
        let ends_by = settings
            .deadline
            .map(|longest| called_at.saturating_add(longest));
        if ends_by.is_some_and(|ends_by| ends_by <= now) {
            let unsent = Failure::unsent(now - called_at);
            return Err(self
                .encoder
                .failure(&prepared.request, &unsent, &self.fault));
        }
        self.note_motion(prepared);
        let request = prepared.request.clone();
        let (data, ticket) = self
            .exchange
            .send_one_way(request, now, settings.ack_within, ends_by);
        let until = ends_by.unwrap_or(now + LONGEST_WRITE);
        let mut outgoing = self.outgoing(data, None, now, until);
        outgoing.stops = self.is_stop(prepared).then_some(prepared.address);
        Ok((outgoing, ticket))
    }

    /// Return the request that is to be sent now; `drained`: nothing that has come is unread.
    pub fn next(&mut self, drained: bool) -> Option<Outgoing> {
        let now = self.now();
        let data = self.exchange.outgoing(now, drained);
        let ticket = self.exchange.sent_last().filter(|_| !data.is_empty())?;
        let longest = self
            .ends
            .get(&ticket)
            .map_or(LONGEST_WRITE, |ends_by| ends_by.saturating_sub(now));
        // A repeated query is written only if the line takes it at once.
        let longest = if self.written == Some(ticket) {
            0
        } else {
            longest.max(SHORTEST_WRITE)
        };
        self.written = Some(ticket);
        Some(self.outgoing(data, Some(ticket), now, now + longest))
    }

    fn outgoing(&self, data: Vec<u8>, ticket: Option<Ticket>, at: Nanos, until: Nanos) -> Outgoing {
        let (align, until) = (self.exchange.align().to_vec(), self.instant(until));
        Outgoing {
            align,
            data,
            ticket,
            stops: None,
            at,
            until,
        }
    }

    /// Note how writing has ended: all bytes were taken, or `taken` of them, for a reason.
    pub fn wrote(
        &mut self,
        outgoing: &Outgoing,
        taken: usize,
        error: Option<&std::io::Error>,
    ) -> Result<(), Error> {
        let (now, all) = (self.now(), outgoing.align.len() + outgoing.data.len());
        let mut written = None;
        if taken < all {
            written = self
                .exchange
                .cut(&outgoing.align, &outgoing.data, Some(taken));
        } else if !outgoing.align.is_empty() {
            self.exchange.aligned();
        }
        if let Some(ticket) = outgoing.ticket.filter(|_| now - outgoing.at > SLOW_WRITE) {
            self.exchange.written(ticket, now);
        }
        let seconds = Duration::from_nanos(now - outgoing.at).as_secs_f64();
        let detail = match error {
            Some(error) => format!("cannot be written: {error}"),
            None if taken < all => format!(
                "cannot be written: only {taken} of {all} bytes were taken in {seconds:.3} s"
            ),
            None => {
                if let Some(stopped) = outgoing.stops {
                    self.moved.retain(|address| *address != stopped);
                }
                return Ok(());
            }
        };
        let fault = Error::link(&self.url, &detail, written);
        if outgoing.ticket.is_none() {
            return Err(fault);
        }
        // The line is only full if a repeated query is not taken; its first attempt was.
        if error.is_some() || outgoing.until > self.instant(outgoing.at) {
            self.faults
                .extend(outgoing.ticket.map(|ticket| (ticket, fault)));
            self.exchange.fail_waiting();
        }
        Ok(())
    }

    /// End every request: the transport is gone.
    pub fn lose(&mut self, detail: &str) -> Error {
        self.fault = Error::link(&self.url, detail, None);
        let now = self.now();
        let events = self.exchange.fail(now);
        self.dispatch(events);
        self.fault.clone()
    }

    /// Return how a request has ended; `None`: it has not.
    pub fn take(&mut self, ticket: Ticket, prepared: &Prepared) -> Option<Result<Answer, Error>> {
        let outcome = self.exchange.take(ticket)?;
        self.ends.remove(&ticket);
        let fault = self.faults.remove(&ticket);
        Some(outcome.map_err(|failure| {
            let fault = fault.as_ref().unwrap_or(&self.fault);
            self.encoder.failure(&prepared.request, &failure, fault)
        }))
    }

    /// End a request whose caller waits no longer.
    pub fn give_up(&mut self, ticket: Ticket) {
        self.ends.remove(&ticket);
        self.faults.remove(&ticket);
        self.exchange.give_up(ticket);
    }

    /// Note that a motion may begin; only a stop that was written whole ends it for sure.
    fn note_motion(&mut self, prepared: &Prepared) {
        let command = self.encoder.edition.commands.get(prepared.request.command);
        let moves = command.is_some_and(|command| command.safety == Safety::Motion);
        if moves && !self.is_stop(prepared) && !self.moved.contains(&prepared.address) {
            self.moved.push(prepared.address);
        }
    }

    fn is_stop(&self, prepared: &Prepared) -> bool {
        let command = self.encoder.edition.commands.get(prepared.request.command);
        command.is_some_and(|command| command.role == "stop")
    }

    /// End every request: the client was closed, and sends nothing to the arm any more.
    pub fn close(&mut self) {
        self.moved.clear();
        // The transport is whole until now, so no request is cut.
        self.leave();
        self.lose("is closed");
    }

    /// Leave what the next session on this port must know.
    fn leave(&mut self) {
        let names = std::mem::take(&mut self.names);
        names.leave(self.exchange.persist(self.now()), self.begun);
    }

    /// Return the bytes that stop every device in motion, as the policy says. They are empty
    /// if nothing moves.
    pub fn stops(&mut self) -> Vec<u8> {
        let moved = std::mem::take(&mut self.moved);
        let edition = &self.encoder.edition;
        let Some(stop) = edition
            .commands
            .iter()
            .find(|command| command.role == "stop")
        else {
            return Vec::new();
        };
        if self.on_drop == OnDrop::Leave || moved.is_empty() {
            return Vec::new();
        }
        let mut bytes = self.exchange.align().to_vec();
        for address in moved {
            if let Ok(prepared) = self.encoder.prepare(&stop.name, &[], address) {
                bytes.extend(&prepared.request.frame);
            }
        }
        bytes
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.leave();
    }
}

impl Queue {
    pub fn new(command: usize) -> Arc<Mutex<Self>> {
        Arc::new(Mutex::new(Self {
            command,
            events: VecDeque::new(),
            lost: 0,
        }))
    }
}
