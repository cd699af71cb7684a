//! Requests in progress, and how often each is sent: the caller's choice.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::events::Event;
use super::facts::{Facts, Nanos, Protocol, Safety, TextForm};
use super::outcome::{Answer, Failure, WaitedFor};
use super::received::{Received, ReceivedMeanwhile};
use super::request::Request;
use super::text::TextCollector;
use crate::decode::Decoded;

/// The latest reply that was seen on a real line came 727 ms after its request.
pub(super) const GRACE: Nanos = 1_000_000_000;
/// A time that never comes.
pub(super) const NEVER: Nanos = Nanos::MAX;

/// Identifies a request of a caller who waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticket(pub(super) u64);

/// Splits the time to reply of a query into attempts. Only queries are ever sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RetryPolicy {
    /// How often a query is sent at most; 0 counts as 1.
    pub attempts: u8,
    /// What each attempt gets at least; a shorter time has fewer attempts.
    pub shortest_attempt: Nanos,
    /// For how long after an attempt its late reply is still expected.
    pub grace: Nanos,
}

impl Default for RetryPolicy {
    fn default() -> Self {
        Self {
            attempts: 3,
            shortest_attempt: 100_000_000,
            grace: GRACE,
        }
    }
}

impl RetryPolicy {
    /// Return into how many attempts the `wait` of a request is split. A command that is not a
    /// query gets one. So does a text reply: two that follow each other look like one longer text.
    fn attempts_of(&self, facts: &Facts, wait: Nanos) -> u64 {
        if facts.safety != Safety::Query || facts.text.is_some() {
            return 1;
        }
        let fitting = wait / self.shortest_attempt.max(1);
        fitting.clamp(1, u64::from(self.attempts).max(1))
    }
}

/// What every caller who waits has.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) ticket: Ticket,
    pub(super) request: Arc<Request>,
    /// When its caller waits no longer.
    pub(super) ends_by: Nanos,
    pub(super) done: bool,
    pub(super) received: ReceivedMeanwhile,
}

impl Pending {
    /// Remember an event that was not the reply, for the text of a timeout.
    pub(super) fn note(&mut self, event: &Event) {
        self.received.add(event);
    }

    /// Return the failure of a time that is over, with what was received meanwhile.
    pub(super) fn expire(
        &mut self,
        protocol: &Protocol,
        waited: Nanos,
        attempts: usize,
        waited_for: Option<WaitedFor>,
    ) -> Failure {
        let id = |command| protocol.command(command).map(|(record, _)| record.id);
        let own = id(self.request.command);
        let received = core::mem::take(&mut self.received);
        Failure::Timeout {
            waited,
            attempts,
            waited_for,
            received: received.items(|command| id(command) == own),
        }
    }
}

/// A request that waits for its turn, then for its reply.
#[derive(Clone, Debug)]
pub(super) struct PendingRequest {
    pub(super) base: Pending,
    pub(super) policy: RetryPolicy,
    pub(super) queued_at: Nanos,
    /// Since when unread bytes have kept it from being sent.
    pub(super) undrained_since: Nanos,
    /// When it was sent; empty while it waits for its turn.
    pub(super) attempt_times: Vec<Nanos>,
    pub(super) requested_at: Nanos,
    /// Where in the received stream its reply can begin at the earliest.
    pub(super) offset: u64,
    /// A copy of the request that is also a legal reply.
    pub(super) candidate: Option<Decoded>,
    /// Collects a reply that is text outside any frame.
    pub(super) text: Option<(TextForm, TextCollector)>,
    wait: Nanos,
    attempts: u64,
    deadline: Nanos,
}

impl PendingRequest {
    /// Queue a request; the arm has `wait` to reply, `None`: the time of the protocol.
    pub(super) fn new(
        base: Pending,
        facts: Option<&Facts>,
        wait: Option<Nanos>,
        policy: RetryPolicy,
        now: Nanos,
    ) -> Self {
        let wait = wait
            .or(facts.map(|facts| facts.deadline))
            .unwrap_or_default();
        let form = facts.and_then(|facts| facts.text.clone());
        Self {
            base,
            policy,
            queued_at: now,
            undrained_since: NEVER,
            attempt_times: Vec::new(),
            requested_at: 0,
            offset: 0,
            candidate: None,
            text: form.map(|form| (form, TextCollector::default())),
            wait,
            attempts: facts.map_or(1, |facts| policy.attempts_of(facts, wait)),
            deadline: NEVER,
        }
    }

    /// Return when the wait ends unless more is received.
    pub(super) fn ends_at(&self) -> Nanos {
        let silence = self.text.as_ref().and_then(|(form, text)| {
            // A text that has begun may end after the deadline, but a babbling line may not go on.
            let most = self.deadline.saturating_add(form.silence);
            Some(text.ends_at(form)?.min(most))
        });
        silence.unwrap_or(self.deadline)
    }

    /// Return when it is to be sent again. An attempt that was sent late still gets its full time.
    pub(super) fn repeat_at(&self) -> Nanos {
        let times = &self.attempt_times;
        match times.last() {
            Some(last) if (times.len() as u64) < self.attempts => {
                let at = last.saturating_add(self.wait / self.attempts);
                if at < self.deadline { at } else { NEVER }
            }
            _ => NEVER,
        }
    }

    /// Return whether it was sent more than once.
    pub(super) fn repeated(&self) -> bool {
        self.attempt_times.len() > 1
    }

    /// Note that unread bytes keep it from being sent.
    pub(super) fn note_undrained(&mut self, now: Nanos) {
        self.undrained_since = self.undrained_since.min(now);
    }

    /// Note that it is sent for the first time; its reply can begin at `offset`.
    pub(super) fn begin(&mut self, now: Nanos, offset: u64) {
        self.offset = offset;
        self.deadline = now.saturating_add(self.wait);
        self.requested_at = now;
        self.attempt_times = [now].into();
    }

    /// Note that the last attempt was written only now.
    pub(super) fn written(&mut self, now: Nanos) {
        if let [only] = self.attempt_times.as_mut_slice() {
            *only = now;
            self.deadline = now.saturating_add(self.wait);
        } else if let Some(last) = self.attempt_times.last_mut() {
            *last = now;
        }
    }
}

/// A one-way request whose caller waits for its acknowledgement.
#[derive(Clone, Debug)]
pub(super) struct PendingAck {
    pub(super) base: Pending,
    /// The acknowledgement that is expected, by its number.
    pub(super) ack: u64,
    pub(super) sent_at: Nanos,
    /// When the wait ends.
    pub(super) until: Nanos,
}

/// Return the failure of a request that was not sent, since the line brings more than can be read.
pub(super) fn not_drained(waited: Nanos) -> Failure {
    Failure::Timeout {
        waited,
        attempts: 0,
        waited_for: None,
        received: [Received::unread()].into(),
    }
}

impl PendingAck {
    /// Return what a wait that has succeeded has got.
    pub(super) fn acknowledged(&self, now: Nanos) -> Answer {
        Answer {
            decoded: None,
            texts: Vec::new(),
            requested_at: self.sent_at,
            replied_at: now,
        }
    }
}
