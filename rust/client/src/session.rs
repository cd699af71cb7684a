//! The client without its transport and clock: requests, received bytes and times go in; bytes to
//! write and outcomes come out. Times are nanoseconds of a clock that never goes back.

use std::collections::{HashMap, VecDeque};
use std::sync::{Arc, Mutex, Weak};

use cobotwire_core::exchange::{
    Event, Exchange, Failure, Nanos, PersistedState, Safety, Ticket, WaitedFor,
};

use crate::handle::{Handle, Named, Outcome, Prepared};
use crate::options::nanos;
use crate::{Error, OnDrop};

/// The longest time for a write without a deadline: a transport that takes nothing for longer is
/// stuck.
const LONGEST_WRITE: Nanos = 1_000_000_000;
/// A write that takes longer than this was delayed by a full transport.
const SLOW_WRITE: Nanos = 5_000_000;
/// The pause before the next attempt to write on a full line.
const FULL: Nanos = 1_000_000;

/// The most events that wait for a consumer; if another comes, the oldest is dropped.
const CAPACITY: usize = 1000;

/// Events of one command that wait for their consumer.
#[derive(Debug, Default)]
pub struct Queue {
    pub events: VecDeque<Named>,
    pub lost: u64,
}

/// Identifies a request that was submitted.
pub type CallId = u64;

/// A submitted request.
struct Call {
    prepared: Prepared,
    called_at: Nanos,
    ends_by: Nanos,
    ack_within: Option<Nanos>,
    /// Its ticket in the exchange; `None`: it has none, or none yet.
    ticket: Option<Ticket>,
    /// How many of its bytes were written.
    written: usize,
    /// Why writing it has failed.
    fault: Option<Error>,
    /// Whether it is a one-way request that was written, or has failed.
    done: bool,
}

/// A request that is being written.
struct Writing {
    id: CallId,
    /// `None`: it is a one-way request.
    ticket: Option<Ticket>,
    bytes: Vec<u8>,
    /// How many of the bytes end an earlier request that was cut.
    align: usize,
    taken: usize,
    at: Nanos,
    until: Nanos,
    /// The address that it stops, if it is a stop.
    stops: Option<Option<u8>>,
}

/// The requests and replies of one transport.
pub struct Session {
    handle: Handle,
    exchange: Exchange,
    /// What happened to the transport; `None`: it is open.
    pub fault: Option<Error>,
    calls: HashMap<CallId, Call>,
    submitted: u64,
    /// The one-way requests that wait until they can be written.
    one_ways: VecDeque<CallId>,
    writing: Option<Writing>,
    /// For each consumer of events, the command of the events and the queue.
    queues: Vec<(usize, Weak<Mutex<Queue>>)>,
    /// The devices that were set in motion, and not stopped since.
    moved: Vec<Option<u8>>,
}

impl Session {
    /// Start a session. `left` is the state that the previous session on its port persisted.
    pub fn new(handle: &Handle, left: &PersistedState) -> Self {
        let mut exchange = Exchange::new(Arc::new(handle.edition.protocol.clone()));
        exchange.restore(left);
        Self {
            handle: handle.clone(),
            exchange,
            fault: None,
            calls: HashMap::new(),
            submitted: 0,
            one_ways: VecDeque::new(),
            writing: None,
            queues: Vec::new(),
            moved: Vec::new(),
        }
    }

    /// Return the time until the next step is due, unless bytes are received earlier; `None`: no
    /// step is due.
    pub fn idle(&self, now: Nanos) -> Option<Nanos> {
        match &self.writing {
            Some(_) => Some(FULL),
            None if !self.one_ways.is_empty() => Some(0),
            None => self.exchange.idle(now),
        }
    }

    /// Return a queue that receives the events of a command from now on.
    pub fn subscribe(&mut self, command: usize) -> Arc<Mutex<Queue>> {
        let queue = Arc::<Mutex<Queue>>::default();
        self.queues.retain(|(_, queue)| queue.strong_count() > 0);
        self.queues.push((command, Arc::downgrade(&queue)));
        queue
    }

    /// Take a request, which is sent when it is its turn; the call began at `called_at`.
    pub fn submit(
        &mut self,
        prepared: &Prepared,
        handle: &Handle,
        called_at: Nanos,
        now: Nanos,
    ) -> CallId {
        self.submitted += 1;
        let id = self.submitted;
        let longest = handle.options.deadline.map_or(Nanos::MAX, nanos);
        let mut call = Call {
            prepared: prepared.clone(),
            called_at,
            ends_by: called_at.saturating_add(longest),
            ack_within: handle.ack_within,
            ticket: None,
            written: 0,
            fault: None,
            done: false,
        };
        if self.fault.is_none() && prepared.awaits_reply {
            let (request, ends_by) = (prepared.request.clone(), Some(call.ends_by));
            let (wait, retry) = (handle.options.timeout.map(nanos), handle.options.retry);
            call.ticket = Some(self.exchange.enqueue(request, wait, retry, now, ends_by));
        } else if self.fault.is_none() {
            self.one_ways.push_back(id);
        }
        self.calls.insert(id, call);
        id
    }

    /// Return the outcome of a request, once; `None`: it has not ended.
    pub fn take(&mut self, id: CallId) -> Option<Outcome> {
        let call = self.calls.get(&id)?;
        let mut fault = call.fault.as_ref().or(self.fault.as_ref()).cloned();
        if let Some(Error::LinkError { written, .. }) = &mut fault {
            *written = Some(call.written);
        }
        let outcome = match (call.ticket, fault) {
            (Some(ticket), fault) if !call.done => {
                self.exchange.take(ticket)?.map(Some).map_err(|failure| {
                    let error = self.handle.failure(&call.prepared.request, &failure);
                    let lost = || self.handle.link("is lost", None);
                    error.or(fault).unwrap_or_else(lost)
                })
            }
            (_, Some(fault)) => Err(fault),
            (_, None) if call.done => Ok(None),
            (_, None) => return None,
        };
        self.calls.remove(&id);
        Some(outcome)
    }

    /// End a request whose caller no longer waits. It is not sent, unless its first bytes have been
    /// written.
    pub fn give_up(&mut self, id: CallId) {
        self.one_ways.retain(|other| *other != id);
        let has_begun = |writing: &mut Writing| writing.id != id || writing.taken > 0;
        self.writing.take_if(|writing| !has_begun(writing));
        if let Some(ticket) = self.calls.remove(&id).and_then(|call| call.ticket) {
            self.exchange.give_up(ticket);
        }
    }

    /// Take received bytes, if any, and end what is overdue at `now`.
    pub fn receive(&mut self, data: &[u8], now: Nanos) {
        let mut writing = self.writing.iter();
        if writing.any(|writing| writing.until <= now) {
            self.end_write("", now);
        }
        self.one_ways.retain(|id| {
            let over = self.calls.get_mut(id).filter(|call| call.ends_by <= now);
            over.map(|call| call.unsent(&self.handle, now)).is_none()
        });
        self.exchange.note_full(self.writing.is_some());
        let events = self.exchange.advance(data, now);
        self.dispatch(events);
    }

    /// Return the bytes to write now; none if no request may be sent. `drained`: whether all bytes
    /// that have arrived were read.
    pub fn outgoing(&mut self, now: Nanos, drained: bool) -> &[u8] {
        if self.writing.is_none() && self.fault.is_none() {
            self.writing = self.next_write(now, drained);
        }
        let writing = self.writing.as_ref();
        let rest = writing.and_then(|writing| writing.bytes.get(writing.taken..));
        rest.unwrap_or_default()
    }

    /// Begin a one-way request, or else the query that is next.
    fn next_write(&mut self, now: Nanos, drained: bool) -> Option<Writing> {
        let (id, ticket, data) = if let Some(id) = self.one_ways.pop_front() {
            let call = self.calls.get_mut(&id)?;
            let (request, ends_by) = (call.prepared.request.clone(), Some(call.ends_by));
            let (exchange, within) = (&mut self.exchange, call.ack_within);
            let data;
            (data, call.ticket) = exchange.send_one_way(request, now, within, ends_by);
            (id, None, data)
        } else {
            let data = self.exchange.outgoing(now, drained);
            let ticket = self.exchange.sent_last().filter(|_| !data.is_empty())?;
            let mut calls = self.calls.iter();
            let (id, _) = calls.find(|(_, call)| call.ticket == Some(ticket))?;
            (*id, Some(ticket), data)
        };
        let (call, align) = (self.calls.get(&id)?, self.exchange.align());
        let command = call.prepared.request.command;
        let command = self.handle.edition.commands.get(command)?;
        let (address, stops) = (call.prepared.address, command.role == "stop");
        // Only a stop that was written completely is certain to end a motion.
        if command.safety == Safety::Motion && !stops && !self.moved.contains(&address) {
            self.moved.push(address);
        }
        Some(Writing {
            id,
            ticket,
            bytes: [align, &data].concat(),
            align: align.len(),
            taken: 0,
            at: now,
            until: match call.ends_by {
                // A repeated query is written only if the line takes it at once.
                _ if call.written > 0 => now,
                Nanos::MAX => now.saturating_add(LONGEST_WRITE),
                ends_by => ends_by,
            },
            stops: stops.then_some(address),
        })
    }

    /// Note that the line has taken more bytes.
    pub fn wrote(&mut self, size: usize, now: Nanos) {
        if let Some(writing) = &mut self.writing {
            writing.taken += size;
            if writing.taken >= writing.bytes.len() {
                self.end_write("", now);
            }
        }
    }

    /// End a write. If it is incomplete, `why` is the reason; empty: its deadline passed.
    pub fn end_write(&mut self, why: &str, now: Nanos) {
        let Some(writing) = self.writing.take() else {
            return;
        };
        let (taken, all) = (writing.taken, writing.bytes.len());
        let (align, data) = writing.bytes.split_at(writing.align);
        let mut written = data.len();
        if taken < all {
            let own = self.exchange.cut(align, data, Some(taken));
            written = own.unwrap_or_default();
        } else if !align.is_empty() {
            self.exchange.aligned();
        }
        if let Some(ticket) = writing.ticket.filter(|_| now - writing.at > SLOW_WRITE) {
            self.exchange.written(ticket, now);
        }
        if let Some(stopped) = writing.stops.filter(|_| taken == all) {
            self.moved.retain(|address| *address != stopped);
        }
        // A request that was given up has no call. If the transport does not take a repeated query,
        // that is no error: its first attempt was written.
        let call = self.calls.get_mut(&writing.id);
        let Some(call) = call.filter(|call| taken == all || call.written == 0 || !why.is_empty())
        else {
            return;
        };
        (call.written, call.done) = (written, writing.ticket.is_none() && taken < all);
        if taken == all {
            call.done = call.ticket.is_none();
        } else if taken == 0 && call.ends_by <= now && why.is_empty() {
            call.unsent(&self.handle, now);
        } else {
            let seconds = (now - writing.at) as f64 / 1e9;
            let few = format!("only {taken} of {all} bytes were taken in {seconds:.3} s");
            let why = if why.is_empty() { &few } else { why };
            let detail = format!("cannot be written: {why}");
            call.fault = Some(self.handle.link(&detail, None));
        }
        match (writing.ticket, call.ticket) {
            (Some(_), _) if taken < all => self.exchange.fail_waiting(),
            (None, Some(ticket)) if taken < all => self.exchange.give_up(ticket),
            _ => {}
        }
    }

    /// End every request, since the transport is lost.
    pub fn lose(&mut self, detail: &str, now: Nanos) -> Error {
        if let Some(writing) = self.writing.take()
            && let Some(call) = self.calls.get_mut(&writing.id)
        {
            call.written = writing.taken.saturating_sub(writing.align);
        }
        self.one_ways.clear();
        let fault = self.handle.link(detail, Some(0));
        self.fault = Some(fault.clone());
        let events = self.exchange.fail(now);
        self.dispatch(events);
        fault
    }

    /// End every request, since the client was closed; return the state for the port's next
    /// session.
    pub fn close(&mut self, now: Nanos) -> PersistedState {
        let state = self.persist(now);
        self.moved.clear();
        self.lose("is closed", now);
        state
    }

    /// Return the state for the next session on this port. A request that is partly written counts
    /// as cut.
    pub fn persist(&mut self, now: Nanos) -> PersistedState {
        self.end_write("the client was closed", now);
        self.exchange.persist(now)
    }

    /// Return the bytes that stop every device in motion. They are empty if none moves, or if
    /// `on_drop` is `Leave`.
    pub fn stops(&mut self, now: Nanos) -> Vec<u8> {
        self.end_write("", now);
        let moved = std::mem::take(&mut self.moved);
        let (mut handle, commands) = (self.handle.clone(), &self.handle.edition.commands);
        let stops = handle.options.on_drop == OnDrop::Stop;
        let stop = commands.iter().find(|command| command.role == "stop");
        let Some(stop) = stop.filter(|_| stops && !moved.is_empty()) else {
            return Vec::new();
        };
        let mut bytes = self.exchange.align().to_vec();
        for address in moved {
            handle.address = address;
            if let Ok(prepared) = handle.prepare_named(&stop.name, &[]) {
                bytes.extend(&prepared.request.frame);
            }
        }
        bytes
    }

    fn dispatch(&mut self, events: Vec<Event>) {
        for event in events {
            let Event::DeviceEvent {
                command, decoded, ..
            } = event
            else {
                continue;
            };
            let wanted = self.queues.iter().filter(|(wanted, _)| *wanted == command);
            for queue in wanted.filter_map(|(_, queue)| queue.upgrade()) {
                let mut queue = crate::lock(&queue);
                if queue.events.len() >= CAPACITY {
                    queue.events.pop_front();
                    queue.lost += 1;
                }
                queue.events.push_back(self.handle.edition.named(&decoded));
            }
        }
    }
}

impl Call {
    /// End a request whose deadline passed before any of its bytes was written.
    fn unsent(&mut self, handle: &Handle, now: Nanos) {
        let failure = Failure::Timeout {
            waited: now.saturating_sub(self.called_at),
            attempts: 0,
            waited_for: Some(WaitedFor::Line),
            received: Vec::new(),
        };
        self.fault = handle.failure(&self.prepared.request, &failure);
        self.done |= self.ticket.is_none();
    }
}
