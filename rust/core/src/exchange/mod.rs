//! The exchange of requests and replies over one transport: bytes and times go in, bytes, finished
//! requests and events come out.
//!
//! This file makes every decision that depends on the state. It has no thread, clock or port.
//! `python/cobotwire/session` is its specification: both make the same decisions for the same bytes
//! and times. `docs/contribute/exchange.md` shows its states and what it promises.
//!
//! Only one request waits at a time, since the protocol has no sequence numbers. The others queue
//! in the order of submission; later ones may overtake one that is held for an outstanding reply.
//! One-way requests are sent at once, and only once, also while another request waits. Times are
//! nanoseconds of a clock that never goes back. Sums of times saturate; a saturated time
//! never comes.

mod acks;
mod alignment;
mod echo;
mod events;
mod facts;
mod matching;
mod outcome;
mod outstanding;
mod pending;
mod request;
mod text;

use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;

pub use self::alignment::Part;
pub use self::events::{Event, ReplyError, SeenFrame};
pub use self::facts::{Addressee, Facts, Named, Nanos, Protocol, Replier, Safety, TextForm};
pub use self::outcome::{Answer, Failure, Received, WaitedFor};
pub use self::outstanding::{OutstandingReply, PersistedState};
pub use self::pending::{RetryPolicy, Ticket};
pub use self::request::{Request, RequestError};
pub use self::text::{TextError, TextFault, TextMistake};

use self::acks::Acks;
use self::alignment::Alignment;
use self::echo::{EchoDetector, since};
use self::outcome::Got;
use self::outstanding::OutstandingReplies;
use self::pending::{NEVER, Pending};
use self::text::TextCollector;
use crate::decode::DecodeError;
use crate::direction::{Direction, Listening};
use crate::framer::Framer;

/// If received bytes come without a pause for this long, a request is sent nevertheless.
const DRAIN: Nanos = 50_000_000;

/// Matches requests and the received frames; requests with a reply take turns.
#[derive(Clone)]
pub struct Exchange {
    protocol: Arc<Protocol>,
    framer: Framer,
    alignment: Alignment,
    outstanding: OutstandingReplies,
    acks: Acks,
    echo: EchoDetector,
    /// The requests that wait for their turn.
    queue: Vec<Pending>,
    /// The request that was sent last; it waits for its reply unless it is done.
    last: Option<Pending>,
    /// Whether the transport took no bytes when the next request was due.
    line_is_full: bool,
    /// The outcomes that callers have not taken yet.
    finished: BTreeMap<Ticket, Result<Answer, Failure>>,
    tickets: u64,
}

impl Exchange {
    /// Return an exchange for a new transport: the peer holds no part of a request, and no reply is
    /// outstanding.
    #[must_use]
    pub fn new(protocol: Arc<Protocol>) -> Self {
        let rules = protocol.table.rules(Listening::To(Direction::Reply));
        Self {
            framer: Framer::new(rules.clone()),
            alignment: Alignment::default(),
            outstanding: OutstandingReplies::default(),
            acks: Acks::default(),
            echo: EchoDetector::default(),
            queue: Vec::new(),
            last: None,
            line_is_full: false,
            finished: BTreeMap::new(),
            tickets: 0,
            protocol,
        }
    }

    // What callers want.

    /// Queue a request that has a reply. The arm has the time `wait` to reply; `None`: the time
    /// that the protocol states. The caller waits at most until `ends_by`, including the wait for
    /// the request's turn.
    pub fn enqueue(
        &mut self,
        request: Request,
        wait: Option<Nanos>,
        policy: RetryPolicy,
        now: Nanos,
        ends_by: Option<Nanos>,
    ) -> Ticket {
        let pending = self.pending(&Arc::new(request), wait, policy, now, ends_by);
        let ticket = pending.ticket;
        self.queue.push(pending);
        ticket
    }

    /// Return the bytes of a one-way request, to be written now; and a ticket for the wait for its
    /// acknowledgement, if `ack_within` is given and the request has an acknowledgement.
    pub fn send_one_way(
        &mut self,
        request: Request,
        now: Nanos,
        ack_within: Option<Nanos>,
        ends_by: Option<Nanos>,
    ) -> (Vec<u8>, Option<Ticket>) {
        let offset = self.fed();
        self.echo.sent(&request, offset, true);
        self.alignment.last_request.clone_from(&request.frame);
        let data = [request.frame.as_slice(), &request.text].concat();
        let (request, protocol) = (Arc::new(request), Arc::clone(&self.protocol));
        if !protocol.is(request.command, |facts| facts.ack) || request.replier == Replier::Nobody {
            return (data, None);
        }
        let policy = RetryPolicy::default();
        let pending = |within| self.pending(&request, Some(within), policy, now, ends_by);
        let pending = ack_within.map(pending);
        let ticket = pending.as_ref().map(|pending| pending.ticket);
        let acks = &mut self.acks;
        let until = acks.expect(&protocol, &request, now, offset, pending);
        if protocol.has_query(protocol.id(request.command)) {
            self.outstanding.drop_expired(now);
            self.outstanding.expect(request, until);
        }
        (data, ticket)
    }

    /// End a request whose caller no longer waits. A reply that still comes is late.
    pub fn give_up(&mut self, ticket: Ticket) {
        self.queue.retain(|pending| pending.ticket != ticket);
        self.acks.waiting.retain(|pending| pending.ticket != ticket);
        if self.waiting().is_some_and(|own| own.ticket == ticket) {
            self.fail_waiting();
        }
        self.finished.remove(&ticket);
    }

    /// Return the outcome of a request, once; `None`: it has not ended, or was given up.
    pub fn take(&mut self, ticket: Ticket) -> Option<Result<Answer, Failure>> {
        self.finished.remove(&ticket)
    }

    /// End every request, since the transport is lost. Return the events of bytes that waited in
    /// the framer; bytes of a new connection cannot complete them.
    pub fn fail(&mut self, now: Nanos) -> Vec<Event> {
        let events = self.flush(now);
        self.alignment.lose(&self.protocol);
        self.fail_waiting();
        let waiting = self.queue.drain(..).chain(self.acks.waiting.drain(..));
        let failed = waiting.map(|pending| (pending.ticket, Err(Failure::Link)));
        self.finished.extend(failed);
        events
    }

    /// End the request that waits: its bytes were not written, or not all of them.
    pub fn fail_waiting(&mut self) {
        self.end_waiting(0, |_| Err(Failure::Link));
    }

    // What one session passes to the next one on its port.

    /// Return the state for the next session on this port.
    #[must_use]
    pub fn persist(&self, now: Nanos) -> PersistedState {
        let mut outstanding = self.outstanding.clone();
        outstanding.drop_expired(now);
        if let Some(waiting) = self.waiting() {
            outstanding.expect_late(waiting, 0);
        }
        let (late, parts) = (outstanding.0, self.alignment.held.clone());
        PersistedState { late, parts }
    }

    /// Take over the state that an earlier session on this port persisted.
    pub fn restore(&mut self, state: &PersistedState) {
        for late in &state.late {
            if let Some(request) = Request::from_frame(&self.protocol, &late.request.frame) {
                self.outstanding.expect(Arc::new(request), late.until);
            }
        }
        if !state.parts.is_empty() {
            self.alignment.hold(&self.protocol, state.parts.clone());
        }
    }

    // What the client's loop does.

    /// Call [`Self::receive`], then [`Self::wake`]. In the other order, the received frames could
    /// count as late.
    pub fn advance(&mut self, data: &[u8], now: Nanos) -> Vec<Event> {
        let mut events = self.receive(data, now);
        events.extend(self.wake(now));
        events
    }

    /// Take received bytes; return what they are.
    pub fn receive(&mut self, data: &[u8], now: Nanos) -> Vec<Event> {
        let (mut received, chunk_at) = (Vec::new(), self.fed());
        self.framer.feed(data, |event| received.push(event.into()));
        self.sort(received, now, chunk_at)
    }

    /// End the waits whose time is over; return the events. Pass received bytes to
    /// [`Self::receive`] first.
    pub fn wake(&mut self, now: Nanos) -> Vec<Event> {
        let waiting = self.waiting();
        let over = waiting.is_some_and(|waiting| waiting.ends_at() <= now);
        let mut events = if over { self.end_wait(now) } else { Vec::new() };
        events.extend(self.end_overdue(now));
        events
    }

    /// End the requests whose callers no longer wait; return the event of the one that was sent.
    pub fn end_overdue(&mut self, now: Nanos) -> Vec<Event> {
        let ended = self.acks.wake(&self.protocol, now, self.echo.proven);
        self.finished.extend(ended);
        let over = |pending: &mut Pending| pending.ends_by <= now;
        let ended: Vec<Pending> = self.queue.extract_if(.., over).collect();
        for mut pending in ended {
            let waited_for = match (self.free_at(&pending, now) > now, self.line_is_full) {
                (true, _) => WaitedFor::Hold,
                (false, true) => WaitedFor::Line,
                (false, false) => WaitedFor::Turn,
            };
            let failure = pending.expire(now, Some(waited_for));
            self.finished.insert(pending.ticket, Err(failure));
        }
        // The caller stops waiting before the arm's deadline, so a received copy of the request is
        // not taken as its reply.
        let over = self.waiting().is_some_and(|waiting| waiting.ends_by <= now);
        let expired = over.then(|| self.expire(now, Some(WaitedFor::Reply)));
        expired.flatten().into_iter().collect()
    }

    /// Note whether the transport took no bytes when a request was due.
    pub fn note_full(&mut self, full: bool) {
        self.line_is_full = full;
    }

    /// Return the bytes of the request to send now, for the first time or again. `drained`: whether
    /// all bytes that have arrived were received; unread ones would seem to be its reply.
    pub fn outgoing(&mut self, now: Nanos, drained: bool) -> Vec<u8> {
        if self.waiting().is_some() {
            return self.next_attempt(now).unwrap_or_default();
        }
        let free = |pending: &Pending| pending.ends_by > now && self.free_at(pending, now) <= now;
        match self.queue.iter().position(free) {
            Some(index) if drained || self.sends_undrained(index, now) => {
                self.outstanding.drop_expired(now);
                self.begin(index, now)
            }
            _ => Vec::new(),
        }
    }

    /// Return the request that [`Self::outgoing`] returned last; it may have ended by now.
    #[must_use]
    pub fn sent_last(&self) -> Option<Ticket> {
        self.last.as_ref().map(|last| last.ticket)
    }

    /// Note that the request that was sent last was completely written only now.
    pub fn written(&mut self, ticket: Ticket, now: Nanos) {
        let Some(last) = self.last.as_mut().filter(|last| last.ticket == ticket) else {
            return;
        };
        if last.done {
            let until = now.saturating_add(last.policy.grace);
            self.outstanding.expect(Arc::clone(&last.request), until);
        } else {
            last.written(now);
        }
    }

    /// Return the time until the next deadline if no bytes come earlier; `None`: no deadline.
    #[must_use]
    pub fn idle(&self, now: Nanos) -> Option<Nanos> {
        let waiting = self.waiting();
        let own = waiting.map_or(NEVER, |waiting| {
            waiting.ends_first().min(self.repeat_at(waiting))
        });
        let queued = self.queue.iter().map(|pending| match waiting {
            None => self.free_at(pending, now).min(pending.ends_by),
            Some(_) => pending.ends_by,
        });
        let acks = self.acks.waiting.iter().map(Pending::ends_first);
        let soonest = queued.chain(acks).fold(own, Nanos::min);
        (soonest != NEVER).then(|| soonest.saturating_sub(now))
    }

    // Whose turn it is.

    fn pending(
        &mut self,
        request: &Arc<Request>,
        wait: Option<Nanos>,
        policy: RetryPolicy,
        now: Nanos,
        ends_by: Option<Nanos>,
    ) -> Pending {
        self.tickets += 1;
        let facts = self.protocol.facts.get(request.command);
        let wait = wait.unwrap_or(facts.map_or(0, |facts| facts.deadline));
        let form = facts.and_then(|facts| facts.text.clone());
        Pending {
            ticket: Ticket(self.tickets),
            request: Arc::clone(request),
            ends_by: ends_by.unwrap_or(NEVER),
            done: false,
            received: Vec::new(),
            policy,
            queued_at: now,
            undrained_since: NEVER,
            attempt_times: Vec::new(),
            requested_at: now,
            offset: 0,
            candidate: None,
            text: form.map(TextCollector::new),
            wait,
            attempts: facts.map_or(1, |facts| policy.attempts_of(facts, wait)),
            deadline: NEVER,
        }
    }

    fn fed(&self) -> u64 {
        self.framer.tally().bytes
    }

    fn waiting(&self) -> Option<&Pending> {
        self.last.as_ref().filter(|last| !last.done)
    }

    /// Return the time from which no late reply can be mistaken for the reply to a queued request.
    fn free_at(&self, pending: &Pending, now: Nanos) -> Nanos {
        let held = (self.outstanding).held_until(&self.protocol, &pending.request);
        held.unwrap_or(now)
    }

    /// Make a queued request the one that waits; return its bytes.
    fn begin(&mut self, index: usize, now: Nanos) -> Vec<u8> {
        let (offset, mut pending) = (self.fed(), self.queue.remove(index));
        self.echo.sent(&pending.request, offset, false);
        (self.alignment.last_request).clone_from(&pending.request.frame);
        pending.begin(now, offset);
        self.last.insert(pending).request.frame.clone()
    }

    /// Return whether a queued request is sent although unread bytes remain, because they come
    /// faster than they can be read. End the request if the late reply for which it was held may be
    /// among the unread bytes.
    fn sends_undrained(&mut self, index: usize, now: Nanos) -> bool {
        let Some(pending) = self.queue.get_mut(index) else {
            return false;
        };
        let (outstanding, protocol) = (&self.outstanding, &*self.protocol);
        let held = outstanding.held_until(protocol, &pending.request).is_some();
        pending.undrained_since = pending.undrained_since.min(now);
        if now.saturating_sub(pending.undrained_since) < DRAIN {
            return false;
        }
        if held {
            let mut ended = self.queue.remove(index);
            let failure = ended.expire(now, None);
            self.finished.insert(ended.ticket, Err(failure));
        }
        !held
    }

    /// Return the time to send the request again: never while a received copy may be its reply.
    fn repeat_at(&self, waiting: &Pending) -> Nanos {
        if waiting.candidate.is_some() && !self.echo.proven {
            return NEVER;
        }
        waiting.repeat_at()
    }

    fn next_attempt(&mut self, now: Nanos) -> Option<Vec<u8>> {
        let at = self.repeat_at(self.waiting()?);
        let waiting = waiting(&mut self.last)?;
        if at > now || now >= waiting.ends_by {
            return None;
        }
        self.echo.sent_again();
        waiting.attempt_times.push(now);
        Some(waiting.request.frame.clone())
    }

    // What received bytes are, and how the request that waits ends by them or by silence.

    /// Flush the framer, so that a frame inside the incomplete one is found; return the events.
    fn flush(&mut self, now: Nanos) -> Vec<Event> {
        let (mut received, fed) = (Vec::new(), self.fed());
        self.framer.flush(|event| received.push(event.into()));
        self.sort(received, now, fed)
    }

    /// Turn the framer's events into those of the exchange; the bytes received last begin at
    /// `chunk_at`.
    fn sort(&mut self, received: Vec<Event>, now: Nanos, chunk_at: u64) -> Vec<Event> {
        let sorted = received.into_iter().map(|event| match event {
            Event::Unexpected { frame } => {
                let began_at = if frame.offset >= chunk_at { now } else { 0 };
                self.match_frame(frame, now, began_at)
            }
            noise => self.take_noise(noise, now),
        });
        sorted.collect()
    }

    /// Take noise, which may be the text that a request waits for.
    fn take_noise(&mut self, noise: Event, now: Nanos) -> Event {
        if let Event::Noise { offset, data, .. } = &noise {
            self.echo.add_noise(*offset, data);
            if let Some(waiting) = waiting(&mut self.last)
                && let Some(text) = &mut waiting.text
            {
                // A text that began before the request was sent does not belong to it.
                text.add(since(waiting.offset, *offset, data), now);
            }
        }
        self.note(noise)
    }

    /// Find out what a frame is. `began_at`: when its first byte came, or 0 if that is unknown.
    fn match_frame(&mut self, frame: SeenFrame, now: Nanos, began_at: Nanos) -> Event {
        let is_copy = self.echo.take_copy(&frame);
        let waits = waiting(&mut self.last).filter(|waiting| frame.offset >= waiting.offset);
        let request = waits.as_ref().map(|waiting| &waiting.request);
        let reply = request.and_then(|request| self.protocol.as_reply(&frame, request));
        let reply = match reply {
            None => return self.match_other(frame, now, began_at, is_copy),
            Some(Err(error)) => return self.reject(frame, error, is_copy),
            Some(Ok(reply)) => reply,
        };
        let repeats = request.is_some_and(|own| own.repeated_by(&self.protocol, &reply));
        match (is_copy, repeats, waits) {
            (false, true, _) => return self.end((Some(reply), Vec::new()), Some(frame), now),
            (false, false, _) => return self.match_other(frame, now, began_at, is_copy),
            // A copy that can be the reply is kept; one that cannot proves that the transport
            // echoes.
            (true, true, Some(waiting)) => waiting.candidate = Some(reply),
            (true, ..) => self.echo.proven = true,
        }
        self.note(Event::Echo { frame })
    }

    /// Find out what a frame is that does not reply to the request that waits.
    fn match_other(
        &mut self,
        frame: SeenFrame,
        now: Nanos,
        began_at: Nanos,
        is_copy: bool,
    ) -> Event {
        if let Some((index, command)) = self.outstanding.find(&self.protocol, &frame, now) {
            if self.protocol.is(command, Facts::requires_reply) {
                // The reply stays outstanding: this may be a copy, with the reply still to come.
                return self.note(Event::Late { command, frame });
            }
            self.outstanding.0.remove(index);
        }
        if is_copy {
            self.acks.note_copy(&self.protocol, &frame);
            return self.note(Event::Echo { frame });
        }
        let event = match self.acks.take(&self.protocol, &frame, now, began_at) {
            None => self.protocol.as_event(frame),
            Some((command, decoded, ended)) => {
                self.finished.extend(ended);
                Event::Ack {
                    command,
                    decoded,
                    frame,
                }
            }
        };
        self.note(event)
    }

    /// End the request that waits with a reply of illegal values, unless the frame is an echo or
    /// may be an outstanding reply.
    fn reject(&mut self, frame: SeenFrame, error: DecodeError, is_copy: bool) -> Event {
        if is_copy {
            self.echo.proven = true;
            return self.note(Event::Echo { frame });
        }
        if self.outstanding.has_command(&self.protocol, &frame) {
            return self.note(Event::Unexpected { frame });
        }
        let data = frame.bytes().into();
        self.fail_reply(ReplyError::Frame(error), data, Some(frame))
    }

    /// End the request that waits with an illegal reply.
    fn fail_reply(&mut self, error: ReplyError, data: Vec<u8>, frame: Option<SeenFrame>) -> Event {
        let command = self.end_waiting(1, |_| Err(Failure::Reply { error, data }));
        Event::Rejected {
            command,
            error,
            frame,
        }
    }

    /// End the request that waits with its reply or text.
    fn end(&mut self, got: Got, frame: Option<SeenFrame>, now: Nanos) -> Event {
        let waiting = self.waiting();
        // Other devices may reply to a broadcast too.
        let anybody = waiting.is_some_and(|own| own.request.replier == Replier::Anybody);
        let received = usize::from(!anybody || got.0.is_none());
        let answer = |own: &mut Pending| Ok(own.answer(got.clone(), now));
        let command = self.end_waiting(received, answer);
        let (decoded, texts) = got;
        Event::Matched {
            command,
            decoded,
            texts,
            frame,
        }
    }

    /// End the request that waits; return its command. The replies to all but its first `received`
    /// attempts may still come.
    fn end_waiting(
        &mut self,
        received: usize,
        outcome: impl FnOnce(&mut Pending) -> Result<Answer, Failure>,
    ) -> usize {
        waiting(&mut self.last).map_or(0, |waiting| {
            self.outstanding.expect_late(waiting, received);
            waiting.done = true;
            self.finished.insert(waiting.ticket, outcome(waiting));
            waiting.request.command
        })
    }

    /// End the wait: silence ends a text, a copy of the request becomes its reply, or it times out.
    fn end_wait(&mut self, now: Nanos) -> Vec<Event> {
        if let Some(event) = self.end_text(now) {
            // Bytes that wait in the framer came after the text, and do not belong to it.
            return [event].into();
        }
        // The reply may be inside an incomplete frame that waits in the framer.
        let mut events = self.flush(now);
        let Some(waiting) = self.waiting().filter(|waiting| waiting.ends_at() <= now) else {
            return events;
        };
        match waiting.candidate.clone().filter(|_| !self.echo.proven) {
            None => events.extend(self.expire(now, None)),
            reply => events.push(self.end((reply, Vec::new()), None, now)),
        }
        events
    }

    /// End the wait for a text that has begun, if the silence after it was long enough.
    fn end_text(&mut self, now: Nanos) -> Option<Event> {
        let text = self.waiting()?.text.as_ref()?;
        if text.ends_at()? > now {
            return None;
        }
        Some(match text.decode() {
            Ok(texts) => self.end((None, texts), None, now),
            Err((error, data)) => self.fail_reply(ReplyError::Text(error), data, None),
        })
    }

    /// End the request that waits with a timeout; its reply may still come.
    fn expire(&mut self, now: Nanos, waited_for: Option<WaitedFor>) -> Option<Event> {
        let waiting = self.waiting()?;
        let (requested_at, attempts) = (waiting.requested_at, waiting.attempt_times.len());
        let command = self.end_waiting(0, |own| Err(own.expire(now, waited_for)));
        Some(Event::Expired {
            command,
            requested_at,
            attempts,
        })
    }

    /// Add an event to each waiting request.
    fn note(&mut self, event: Event) -> Event {
        let waiting = waiting(&mut self.last).into_iter();
        for waiting in waiting.chain(&mut self.acks.waiting) {
            waiting.note(&event);
        }
        event
    }
}

/// Return the request that waits for its reply.
fn waiting(last: &mut Option<Pending>) -> Option<&mut Pending> {
    last.as_mut().filter(|last| !last.done)
}

impl fmt::Debug for Exchange {
    /// Write the state on which later decisions depend.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Exchange")
            .field("fed", &self.fed())
            .field("unparsed", &self.framer.pending())
            .field("alignment", &self.alignment)
            .field("outstanding", &self.outstanding)
            .field("acks", &self.acks)
            .field("echo", &self.echo)
            .field("queue", &self.queue)
            .field("waiting", &self.waiting())
            .field("line_is_full", &self.line_is_full)
            .finish_non_exhaustive()
    }
}
