//! The exchange of requests and replies over one transport: bytes and times go in, bytes, finished
//! requests and events come out.
//!
//! Everything that decides a state stands in this file. It has no thread, clock or port.
//! `python/cobotwire/session` is its specification: both decide alike on the same bytes and times.
//! `docs/contribute/exchange.md` shows its states and what it promises.
//!
//! Only one request waits at a time, since the protocol has no sequence numbers. The others queue in
//! the order of submission; one that is held for an outstanding reply is overtaken. One-way requests
//! are sent at once, and only once, also while another request waits. Times are nanoseconds of a
//! clock that never goes back; those that are too large saturate, and never come.

mod acks;
mod alignment;
mod echo;
mod events;
mod facts;
mod matching;
mod outcome;
mod outstanding;
mod pending;
mod received;
mod refusal;
mod request;
mod text;
mod values;

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;

pub use self::alignment::Part;
pub use self::events::{Event, ReplyError, SeenFrame};
pub use self::facts::{Addressee, Facts, Named, Nanos, Protocol, Replier, Safety, TextForm};
pub use self::outcome::{Answer, Failure, WaitedFor};
pub use self::outstanding::{LateFrame, PersistedState};
pub use self::pending::{RetryPolicy, Ticket};
pub use self::received::{Kind, Received};
pub use self::request::{Request, RequestError};
pub use self::text::{TextError, TextFault};

use self::acks::Acks;
use self::alignment::Alignment;
use self::echo::{EchoDetector, since};
use self::matching::{as_event, as_reply};
use self::outstanding::{OutstandingReplies, late_replies};
use self::pending::{NEVER, Pending, PendingRequest, not_drained};
use self::received::ReceivedMeanwhile;
use crate::decode::{DecodeError, Decoded};
use crate::direction::{Direction, Listening};
use crate::framer::{self, Framer};

/// For how long received bytes are read before a request is sent, if they do not end.
const DRAIN: Nanos = 50_000_000;

/// Requests that take turns, one-way requests, and the frames that come back.
#[derive(Clone)]
pub struct Exchange {
    protocol: Arc<Protocol>,
    framer: Framer,
    alignment: Alignment,
    outstanding: OutstandingReplies,
    acks: Acks,
    echo: EchoDetector,
    /// What waits for its turn, oldest first.
    queue: Vec<PendingRequest>,
    /// The request that was sent last; it waits for its reply unless it is done.
    last: Option<PendingRequest>,
    /// Whether the line took no bytes when the next request was to be sent.
    line_is_full: bool,
    /// How the requests have ended whose callers have not asked yet.
    finished: BTreeMap<Ticket, Result<Answer, Failure>>,
    /// How many tickets were given.
    tickets: u64,
}

impl Exchange {
    /// Return an exchange over a line that is aligned and silent.
    #[must_use]
    pub fn new(protocol: Arc<Protocol>) -> Self {
        let rules = protocol.table.rules(Listening::To(Direction::Reply));
        Self {
            framer: Framer::new(rules.clone()),
            alignment: Alignment::default(),
            outstanding: OutstandingReplies::default(),
            acks: Acks::new(protocol.reports_ends),
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

    /// Queue a request that has a reply. The arm has `wait` to reply, `None`: the time of the
    /// protocol. Its caller waits until `ends_by`, and gives it up in any case.
    pub fn enqueue(
        &mut self,
        request: Request,
        wait: Option<Nanos>,
        policy: RetryPolicy,
        now: Nanos,
        ends_by: Option<Nanos>,
    ) -> Ticket {
        let base = self.pending(Arc::new(request), ends_by);
        let (ticket, facts) = (base.ticket, self.protocol.facts.get(base.request.command));
        let pending = PendingRequest::new(base, facts, wait, policy, now);
        self.queue.push(pending);
        ticket
    }

    /// Return the bytes of a one-way request, to be written now. The ticket is there if `ack_within`
    /// says for how long its acknowledgement is waited for, and the protocol has one.
    pub fn send_one_way(
        &mut self,
        request: Request,
        now: Nanos,
        ack_within: Option<Nanos>,
        ends_by: Option<Nanos>,
    ) -> (Vec<u8>, Option<Ticket>) {
        let offset = self.fed();
        self.echo.sent_one_way(&request.frame, offset);
        self.alignment.sent(&request.frame);
        let data = [request.frame.as_slice(), &request.text].concat();
        let (request, protocol) = (Arc::new(request), Arc::clone(&self.protocol));
        let Some((command, facts)) = protocol.command(request.command) else {
            return (data, None);
        };
        if !facts.ack || request.replier == Replier::Nobody {
            return (data, None);
        }
        let pending = ack_within.map(|_| self.pending(Arc::clone(&request), ends_by));
        let ticket = pending.as_ref().map(|pending| pending.ticket);
        let until = (self.acks).expect(&protocol, &request, (now, offset), ack_within, pending);
        if protocol.has_query(command.id) {
            self.outstanding.expect(request, until);
        }
        (data, ticket)
    }

    /// End a request whose caller waits no longer. A reply that still comes is late.
    pub fn give_up(&mut self, ticket: Ticket) {
        self.queue.retain(|pending| pending.base.ticket != ticket);
        self.acks.give_up(ticket);
        if let Some(waiting) = waiting(&mut self.last)
            && waiting.base.ticket == ticket
        {
            self.outstanding.expect_late(waiting, 0);
            waiting.base.done = true;
        }
    }

    /// Return how a request has ended, once; `None`: it has not, or was given up.
    pub fn take(&mut self, ticket: Ticket) -> Option<Result<Answer, Failure>> {
        self.finished.remove(&ticket)
    }

    /// End every request: the transport is gone. Return what the bytes are that still waited: what
    /// comes after the transport is open again does not complete them.
    pub fn fail(&mut self, now: Nanos) -> Vec<Event> {
        let events = self.flush(now);
        self.alignment.lose(&self.protocol);
        self.fail_waiting();
        let queued = self.queue.drain(..).map(|pending| pending.base.ticket);
        self.finished
            .extend(queued.map(|ticket| (ticket, Err(Failure::Link))));
        self.finished.extend(self.acks.fail());
        events
    }

    /// End the request that waits: its bytes were not written, or not all of them.
    pub fn fail_waiting(&mut self) {
        if let Some(waiting) = waiting(&mut self.last) {
            self.outstanding.expect_late(waiting, 0);
            self.end_waiting(Err(Failure::Link));
        }
    }

    // Half a request on the line.

    /// Return what must be written before the next request; empty on an aligned line.
    #[must_use]
    pub fn align(&self) -> &[u8] {
        &self.alignment.align
    }

    /// Note that these bytes and a request after them were taken whole.
    pub fn aligned(&mut self) {
        self.alignment.end();
    }

    /// Note that of `align + request` only `written` bytes were taken; `None`: nobody knows. Return
    /// how many of these bytes belong to the request.
    pub fn cut(&mut self, align: &[u8], request: &[u8], written: Option<usize>) -> Option<usize> {
        self.alignment.cut(&self.protocol, align, request, written)
    }

    // What one session leaves to the next one on its port.

    /// Return what the next session on this port must respect.
    #[must_use]
    pub fn persist(&self, now: Nanos) -> PersistedState {
        let late = self.outstanding.0.iter().filter(|reply| reply.until > now);
        let own = self
            .waiting()
            .into_iter()
            .flat_map(|waiting| late_replies(waiting, 0));
        let late = late.cloned().chain(own).map(|reply| LateFrame {
            request: reply.request.frame.clone(),
            until: reply.until,
        });
        PersistedState {
            late: late.collect(),
            parts: self.alignment.held.clone(),
        }
    }

    /// Respect what an earlier session left on this port.
    pub fn restore(&mut self, state: &PersistedState) {
        for late in &state.late {
            if let Some(request) = Request::from_frame(&self.protocol, &late.request) {
                self.outstanding.expect(Arc::new(request), late.until);
            }
        }
        if !state.parts.is_empty() {
            self.alignment.hold(&self.protocol, state.parts.clone());
        }
    }

    // What the client's loop does.

    /// Take received bytes, then let time pass: [`Self::receive`] and [`Self::wake`]. Received bytes
    /// are taken before time passes, or their frames would count as late.
    pub fn advance(&mut self, data: &[u8], now: Nanos) -> Vec<Event> {
        let mut events = self.receive(data, now);
        events.extend(self.wake(now));
        events
    }

    /// Take received bytes; return what they are.
    pub fn receive(&mut self, data: &[u8], now: Nanos) -> Vec<Event> {
        let (mut received, chunk_at) = (Vec::new(), self.fed());
        self.framer.feed(data, |event| received.push(owned(event)));
        self.sort(received, now, chunk_at)
    }

    /// Let time pass; return what this ends. Pass received bytes to [`Self::receive`] first.
    pub fn wake(&mut self, now: Nanos) -> Vec<Event> {
        let over = self
            .waiting()
            .is_some_and(|waiting| waiting.ends_at() <= now);
        let mut events = if over { self.end_wait(now) } else { Vec::new() };
        events.extend(self.end_overdue(now));
        events
    }

    /// End the requests of callers that wait no longer; return what happened to a sent one.
    pub fn end_overdue(&mut self, now: Nanos) -> Vec<Event> {
        let ended = self.acks.wake(&self.protocol, now, self.echo.proven);
        self.finished.extend(ended);
        if self.queue.iter().any(|pending| pending.base.ends_by <= now) {
            self.end_overdue_queued(now);
        }
        // A copy of it does not count as its reply: that one still had time to come.
        let over = self.waiting().filter(|waiting| waiting.base.ends_by <= now);
        let waited = over.map(|waiting| now.saturating_sub(waiting.queued_at));
        let expired = waited.and_then(|waited| self.expire(waited, Some(WaitedFor::Reply)));
        expired.into_iter().collect()
    }

    /// Note whether the line took no bytes when a request was to be sent.
    pub fn note_full(&mut self, full: bool) {
        self.line_is_full = full;
    }

    /// Return whether [`Self::outgoing`] may have something to send.
    #[must_use]
    pub fn has_next(&self, now: Nanos) -> bool {
        match self.waiting() {
            None => !self.queue.is_empty(),
            Some(waiting) => self.repeat_at(waiting) <= now,
        }
    }

    /// Return the bytes of the request to be sent now, for the first time or again.
    ///
    /// `drained`: whether everything that has come by now was received. A request is sent on a
    /// drained line, so that earlier bytes cannot pass for its reply.
    pub fn outgoing(&mut self, now: Nanos, drained: bool) -> Vec<u8> {
        if self.waiting().is_some() {
            return self.next_attempt(now).unwrap_or_default();
        }
        let mut queue = self.queue.iter();
        let free = |pending: &PendingRequest| {
            pending.base.ends_by > now && self.free_at(pending, now) <= now
        };
        let Some(index) = queue.position(free) else {
            return Vec::new();
        };
        if !drained && !self.sends_undrained(index, now) {
            return Vec::new();
        }
        self.outstanding.drop_expired(now);
        self.begin(index, now)
    }

    /// Return the request that [`Self::outgoing`] gave last; it may have ended by now.
    #[must_use]
    pub fn sent_last(&self) -> Option<Ticket> {
        self.last.as_ref().map(|last| last.base.ticket)
    }

    /// Note that writing the request that was sent last ended only now: its reply may be late from
    /// now on.
    pub fn written(&mut self, ticket: Ticket, now: Nanos) {
        match &mut self.last {
            Some(last) if last.base.ticket == ticket && last.base.done => {
                let until = now.saturating_add(last.policy.grace);
                self.outstanding
                    .expect(Arc::clone(&last.base.request), until);
            }
            Some(last) if last.base.ticket == ticket => last.written(now),
            _ => {}
        }
    }

    /// Return for how long nothing is to be done unless bytes come; `None`: without end.
    #[must_use]
    pub fn idle(&self, now: Nanos) -> Option<Nanos> {
        let waiting = self.waiting();
        let own = waiting.map_or(NEVER, |waiting| {
            let ends = waiting.ends_at().min(waiting.base.ends_by);
            ends.min(self.repeat_at(waiting))
        });
        let queued = self.queue.iter().map(|pending| match waiting {
            None => self.free_at(pending, now).min(pending.base.ends_by),
            Some(_) => pending.base.ends_by,
        });
        let soonest = queued.fold(own.min(self.acks.next_end()), Nanos::min);
        (soonest != NEVER).then(|| soonest.saturating_sub(now))
    }

    /// Return whether a request waits for its turn or its reply, or for its acknowledgement.
    #[must_use]
    pub fn busy(&self) -> bool {
        !self.queue.is_empty() || !self.acks.waiting.is_empty() || self.waiting().is_some()
    }

    // Whose turn it is.

    fn pending(&mut self, request: Arc<Request>, ends_by: Option<Nanos>) -> Pending {
        self.tickets += 1;
        Pending {
            ticket: Ticket(self.tickets),
            request,
            ends_by: ends_by.unwrap_or(NEVER),
            done: false,
            received: ReceivedMeanwhile::default(),
        }
    }

    /// Return the number of bytes received so far.
    fn fed(&self) -> u64 {
        self.framer.tally().bytes
    }

    /// Return the request that waits for its reply.
    fn waiting(&self) -> Option<&PendingRequest> {
        self.last.as_ref().filter(|last| !last.base.done)
    }

    /// Return from when on no late reply can be mistaken for that of a queued request.
    fn free_at(&self, pending: &PendingRequest, now: Nanos) -> Nanos {
        let held = self
            .outstanding
            .held_until(&self.protocol, &pending.base.request);
        held.unwrap_or(now)
    }

    /// Make a queued request the one that waits; return its bytes.
    fn begin(&mut self, index: usize, now: Nanos) -> Vec<u8> {
        let (offset, mut pending) = (self.fed(), self.queue.remove(index));
        let frame = pending.base.request.frame.clone();
        self.echo.sent(&frame, offset);
        self.alignment.sent(&frame);
        pending.begin(now, offset);
        self.last = Some(pending);
        frame
    }

    /// Return whether a queued request is sent on a line that brings more than can be read, which is
    /// never drained. It ends if the late reply that has held it may be among the unread bytes.
    fn sends_undrained(&mut self, index: usize, now: Nanos) -> bool {
        let Some(pending) = self.queue.get_mut(index) else {
            return false;
        };
        pending.note_undrained(now);
        if now.saturating_sub(pending.undrained_since) < DRAIN {
            return false;
        }
        let base = &pending.base;
        if self
            .outstanding
            .held_until(&self.protocol, &base.request)
            .is_none()
        {
            return true;
        }
        let failure = not_drained(now.saturating_sub(pending.queued_at));
        self.finished.insert(base.ticket, Err(failure));
        self.queue.remove(index);
        false
    }

    /// Return when the request is to be sent again; not while its copy may be its reply.
    fn repeat_at(&self, waiting: &PendingRequest) -> Nanos {
        if waiting.candidate.is_some() && !self.echo.proven {
            return NEVER;
        }
        waiting.repeat_at()
    }

    fn next_attempt(&mut self, now: Nanos) -> Option<Vec<u8>> {
        let at = self
            .waiting()
            .map_or(NEVER, |waiting| self.repeat_at(waiting));
        let waiting = waiting(&mut self.last)?;
        if at > now || now >= waiting.base.ends_by {
            return None;
        }
        self.echo.sent_again();
        waiting.attempt_times.push(now);
        Some(waiting.base.request.frame.clone())
    }

    fn end_overdue_queued(&mut self, now: Nanos) {
        for pending in &self.queue {
            if pending.base.ends_by > now {
                continue;
            }
            let waited_for = match (self.free_at(pending, now) > now, self.line_is_full) {
                (true, _) => WaitedFor::Hold,
                (false, true) => WaitedFor::Line,
                (false, false) => WaitedFor::Turn,
            };
            let waited = now.saturating_sub(pending.queued_at);
            let mut base = pending.base.clone();
            let failure = base.expire(&self.protocol, waited, 0, Some(waited_for));
            self.finished.insert(base.ticket, Err(failure));
        }
        self.queue.retain(|pending| pending.base.ends_by > now);
    }

    // What received bytes are, and how the request that waits ends by them or by silence.

    /// Return what the framer gives up, so that a frame hidden in it still counts.
    fn flush(&mut self, now: Nanos) -> Vec<Event> {
        let (mut received, fed) = (Vec::new(), self.fed());
        self.framer.flush(|event| received.push(owned(event)));
        self.sort(received, now, fed)
    }

    /// Return what the framer's events are; the bytes received last began at `chunk_at`.
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
        let Event::Noise { offset, data, .. } = &noise else {
            return noise;
        };
        self.echo.add_noise(*offset, data);
        if let Some(waiting) = waiting(&mut self.last)
            && let Some((form, text)) = &mut waiting.text
        {
            // A text that began before the request was sent does not belong to it.
            text.add(since(waiting.offset, *offset, data), form, now);
        }
        self.note(noise)
    }

    /// Find out what a frame is; its first byte came at `began_at` or earlier.
    fn match_frame(&mut self, frame: SeenFrame, now: Nanos, began_at: Nanos) -> Event {
        let is_copy = self.echo.take_copy(&frame);
        let Some(request) = self.request_accepting(&frame) else {
            return self.match_other(frame, now, began_at, is_copy);
        };
        let reply = match as_reply(&self.protocol, &frame, &request) {
            Some(Err(error)) => return self.reject(request.command, frame, error, is_copy),
            Some(Ok(reply)) => reply,
            None => return self.match_other(frame, now, began_at, is_copy),
        };
        let repeats = request.repeated_by(&self.protocol, &reply);
        if !is_copy {
            if !repeats {
                return self.match_other(frame, now, began_at, is_copy);
            }
            return self.end(request.command, reply, Some(frame), now);
        }
        // A copy that can be the reply is kept; one that cannot proves that the line echoes.
        match waiting(&mut self.last) {
            Some(waiting) if repeats => waiting.candidate = Some(reply),
            _ => self.echo.proven = true,
        }
        self.note(Event::Echo { frame })
    }

    /// Return the request that waits, if a frame has its command id and began after it was sent.
    fn request_accepting(&self, frame: &SeenFrame) -> Option<Arc<Request>> {
        let waiting = self.waiting()?;
        let request = &waiting.base.request;
        let (_, facts) = self.protocol.command(request.command)?;
        let accepts = frame.offset >= waiting.offset
            && !facts.reply.is_empty()
            && request.can_have_reply(&self.protocol, frame);
        accepts.then(|| Arc::clone(request))
    }

    /// Find out what a frame is that does not reply to the request that waits.
    fn match_other(
        &mut self,
        frame: SeenFrame,
        now: Nanos,
        began_at: Nanos,
        is_copy: bool,
    ) -> Event {
        let protocol = Arc::clone(&self.protocol);
        if let Some((index, request)) = self.outstanding.find(&protocol, &frame, now) {
            let command = request.command;
            if protocol
                .command(command)
                .is_some_and(|(_, facts)| facts.requires_reply())
            {
                // It stays outstanding: this may be a copy, with the reply itself still to come.
                return self.note(Event::Late { command, frame });
            }
            self.outstanding.settle(index);
        }
        if is_copy {
            self.acks.note_copy(&protocol, &frame);
            return self.note(Event::Echo { frame });
        }
        let Some((command, decoded, ended)) = self.acks.take(&protocol, &frame, now, began_at)
        else {
            return self.note(as_event(&protocol, frame));
        };
        self.finished.extend(ended);
        self.note(Event::Ack {
            command,
            decoded,
            frame,
        })
    }

    /// End a request with a reply of illegal values, unless the frame is something else.
    fn reject(
        &mut self,
        command: usize,
        frame: SeenFrame,
        error: DecodeError,
        is_copy: bool,
    ) -> Event {
        if is_copy {
            self.echo.proven = true;
            return self.note(Event::Echo { frame });
        }
        if self.outstanding.has_command(&self.protocol, &frame) {
            return self.note(Event::Unexpected { frame });
        }
        if let Some(waiting) = waiting(&mut self.last).filter(|waiting| waiting.repeated()) {
            self.outstanding.expect_late(waiting, 1);
        }
        let (error, data) = (ReplyError::Frame(error), frame.bytes().into());
        self.end_waiting(Err(Failure::Reply { error, data }));
        let frame = Some(frame);
        Event::Rejected {
            command,
            error,
            frame,
        }
    }

    /// End the request that waits with its reply, of which other copies may come.
    fn end(
        &mut self,
        command: usize,
        reply: Decoded,
        frame: Option<SeenFrame>,
        now: Nanos,
    ) -> Event {
        if let Some(waiting) = waiting(&mut self.last) {
            if waiting.base.request.replier == Replier::Anybody {
                // Other devices may reply too.
                self.outstanding.expect_late(waiting, 0);
            } else if waiting.repeated() {
                self.outstanding.expect_late(waiting, 1);
            }
        }
        self.answer(command, Some(reply), Vec::new(), frame, now)
    }

    fn answer(
        &mut self,
        command: usize,
        decoded: Option<Decoded>,
        texts: Vec<String>,
        frame: Option<SeenFrame>,
        now: Nanos,
    ) -> Event {
        let requested_at = self.waiting().map(|waiting| waiting.requested_at);
        self.end_waiting(Ok(Answer {
            decoded: decoded.clone(),
            texts: texts.clone(),
            requested_at: requested_at.unwrap_or_default(),
            replied_at: now,
        }));
        Event::Matched {
            command,
            decoded,
            texts,
            frame,
        }
    }

    /// End the request that waits.
    fn end_waiting(&mut self, outcome: Result<Answer, Failure>) {
        if let Some(waiting) = waiting(&mut self.last) {
            waiting.base.done = true;
            self.finished.insert(waiting.base.ticket, outcome);
        }
    }

    /// End the wait by silence after a text, by a copy that counts as reply, or by timeout.
    fn end_wait(&mut self, now: Nanos) -> Vec<Event> {
        if let Some(event) = self.end_text(now) {
            // What waits in the framer came after the text, and does not belong to it.
            return [event].into();
        }
        // The framer gives up what waits in it, so that a frame hidden after it still counts.
        let mut events = self.flush(now);
        let Some(waiting) = self.waiting().filter(|waiting| waiting.ends_at() <= now) else {
            return events;
        };
        let waited = now.saturating_sub(waiting.requested_at);
        let command = waiting.base.request.command;
        match waiting.candidate.clone() {
            Some(reply) if !self.echo.proven => events.push(self.end(command, reply, None, now)),
            _ => events.extend(self.expire(waited, None)),
        }
        events
    }

    /// End the wait for a text that has begun, and has been silent for long enough.
    fn end_text(&mut self, now: Nanos) -> Option<Event> {
        let waiting = self.waiting()?;
        let command = waiting.base.request.command;
        let (form, text) = waiting.text.as_ref()?;
        if text.ends_at(form)? > now {
            return None;
        }
        let (error, data) = match text.decode(form) {
            Ok(texts) => return Some(self.answer(command, None, texts, None, now)),
            Err((error, data)) => (ReplyError::Text(error), data),
        };
        self.end_waiting(Err(Failure::Reply { error, data }));
        Some(Event::Rejected {
            command,
            error,
            frame: None,
        })
    }

    /// End the request that waits with a timeout; its reply may still come.
    fn expire(&mut self, waited: Nanos, waited_for: Option<WaitedFor>) -> Option<Event> {
        let waiting = waiting(&mut self.last)?;
        let attempts = waiting.attempt_times.len();
        let event = Event::Expired {
            command: waiting.base.request.command,
            requested_at: waiting.requested_at,
            attempts,
        };
        self.outstanding.expect_late(waiting, 0);
        let base = &mut waiting.base;
        let failure = base.expire(&self.protocol, waited, attempts, waited_for);
        self.end_waiting(Err(failure));
        Some(event)
    }

    /// Have everybody who waits remember an event, for the text of a timeout.
    fn note(&mut self, event: Event) -> Event {
        if let Some(waiting) = waiting(&mut self.last) {
            waiting.base.note(&event);
        }
        self.acks.note(&event);
        event
    }
}

/// Return the request that waits for its reply.
fn waiting(last: &mut Option<PendingRequest>) -> Option<&mut PendingRequest> {
    last.as_mut().filter(|last| !last.base.done)
}

/// Return an event of the framer that owns its bytes; a frame is unexpected until it is matched.
fn owned(event: framer::Event<'_>) -> Event {
    match event {
        framer::Event::Frame { offset, frame } => {
            let frame = frame.into();
            let frame = SeenFrame { offset, frame };
            Event::Unexpected { frame }
        }
        framer::Event::Noise {
            offset,
            reason,
            data,
        } => Event::Noise {
            offset,
            reason,
            data: data.concat(),
        },
    }
}

impl fmt::Debug for Exchange {
    /// Write what later decisions depend on.
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
