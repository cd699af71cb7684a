//! Requests in progress, and how often each is sent, which the caller chooses.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::outcome::Got;
use super::text::TextCollector;
use super::{Answer, Event, Facts, Failure, Nanos, Received, Request, Safety, WaitedFor};
use crate::decode::Decoded;

/// How long a late reply is expected. The latest one seen from a real arm came after 727 ms.
pub(super) const GRACE: Nanos = 1_000_000_000;
/// A time that never comes.
pub(super) const NEVER: Nanos = Nanos::MAX;
/// At most this many frames and spans of noise are kept, and this many bytes of noise.
const ITEMS: usize = 20;
const SHOWN: usize = 24;

/// Identifies a request of a caller who waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ticket(pub(super) u64);

/// Splits the time to reply of a query into attempts. Only queries are ever sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RetryPolicy {
    /// How often a query is sent at most; 0 counts as 1.
    pub attempts: u8,
    /// The shortest time of an attempt; a shorter wait is split into fewer attempts.
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
    /// Return the number of attempts into which the `wait` of a request is split. A command that is
    /// not a query gets one. So does a text reply: two that follow each other look like one longer
    /// text.
    pub(super) fn attempts_of(&self, facts: &Facts, wait: Nanos) -> u64 {
        if facts.safety != Safety::Query || facts.text.is_some() {
            return 1;
        }
        let fitting = wait / self.shortest_attempt.max(1);
        fitting.clamp(1, u64::from(self.attempts).max(1))
    }
}

/// A request whose caller waits: for its turn, and then for its reply or acknowledgement.
#[derive(Clone, Debug)]
pub(super) struct Pending {
    pub(super) ticket: Ticket,
    pub(super) request: Arc<Request>,
    /// When its caller no longer waits.
    pub(super) ends_by: Nanos,
    pub(super) done: bool,
    /// The last frames and spans of noise, for the text of a timeout.
    pub(super) received: Vec<Received>,
    pub(super) policy: RetryPolicy,
    pub(super) queued_at: Nanos,
    /// The time since which unread bytes have prevented sending it.
    pub(super) undrained_since: Nanos,
    /// When it was sent; empty while it waits for its turn.
    pub(super) attempt_times: Vec<Nanos>,
    /// When it was sent first; until then, when it was queued.
    pub(super) requested_at: Nanos,
    /// The earliest position in the received stream at which its reply can begin.
    pub(super) offset: u64,
    /// A copy of the request that is also a legal reply.
    pub(super) candidate: Option<Decoded>,
    /// Collects a reply that is text outside any frame.
    pub(super) text: Option<TextCollector>,
    pub(super) wait: Nanos,
    pub(super) attempts: u64,
    pub(super) deadline: Nanos,
}

impl Pending {
    /// Keep an event that was not the reply, for the error text. Adjacent noise becomes one item.
    pub(super) fn note(&mut self, event: &Event) {
        let more = event.data();
        if let (Event::Noise { .. }, Some(last)) = (event, self.received.last_mut())
            && let Event::Noise { data, .. } = &mut last.event
        {
            data.extend_from_slice(more);
            data.truncate(SHOWN);
            last.size = last.size.saturating_add(more.len());
            return;
        }
        if self.received.len() == ITEMS {
            self.received.remove(0);
        }
        let mut event = event.clone();
        if let Event::Noise { data, .. } = &mut event {
            data.truncate(SHOWN);
        }
        let size = more.len();
        self.received.push(Received { event, size });
    }

    /// Return the failure of a request whose time is over, with what was received meanwhile.
    pub(super) fn expire(&mut self, now: Nanos, waited_for: Option<WaitedFor>) -> Failure {
        let since = waited_for.map_or(self.requested_at, |_| self.queued_at);
        Failure::Timeout {
            waited: now.saturating_sub(since),
            attempts: self.attempt_times.len(),
            waited_for,
            received: core::mem::take(&mut self.received),
        }
    }

    /// Return the answer with what was received.
    pub(super) fn answer(&self, (decoded, texts): Got, replied_at: Nanos) -> Answer {
        let requested_at = self.requested_at;
        Answer {
            decoded,
            texts,
            requested_at,
            replied_at,
        }
    }

    /// Return when the wait ends unless more is received.
    pub(super) fn ends_at(&self) -> Nanos {
        let silence = self.text.as_ref().and_then(|text| {
            // A text that has begun may end after the deadline; endless noise must not extend it.
            let most = self.deadline.saturating_add(text.form.silence);
            Some(text.ends_at()?.min(most))
        });
        silence.unwrap_or(self.deadline)
    }

    /// Return when the wait ends, or its caller no longer waits.
    pub(super) fn ends_first(&self) -> Nanos {
        self.ends_at().min(self.ends_by)
    }

    /// Return the time to send it again. An attempt that was sent late still gets its full time.
    pub(super) fn repeat_at(&self) -> Nanos {
        let times = &self.attempt_times;
        let more = (times.len() as u64) < self.attempts;
        let last = times.last().filter(|_| more);
        let at = last.map(|last| last.saturating_add(self.wait / self.attempts));
        at.filter(|at| *at < self.deadline).unwrap_or(NEVER)
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
        if self.attempt_times.len() == 1 {
            self.deadline = now.saturating_add(self.wait);
        }
        if let Some(last) = self.attempt_times.last_mut() {
            *last = now;
        }
    }
}
