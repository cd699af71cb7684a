//! The exchange.
#![allow(missing_docs, unused_variables, clippy::unused_self)]

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::events::Event;
use super::facts::{Nanos, Protocol};
use super::outcome::{Answer, Failure};
use super::pending::{RetryPolicy, Ticket};
use super::request::Request;

/// The first `written` bytes of a request, which is all that the peer has of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    pub request: Vec<u8>,
    pub written: usize,
}

/// A request that was sent; its reply may still come before `until`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LateFrame {
    pub request: Vec<u8>,
    pub until: Nanos,
}

/// Replies that may still come, and what the peer may hold of a request that was cut.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PersistedState {
    pub late: Vec<LateFrame>,
    pub parts: Vec<Part>,
}

/// Requests that take turns, one-way requests, and the frames that come back.
#[derive(Clone, Debug)]
pub struct Exchange {
    protocol: Arc<Protocol>,
}

impl Exchange {
    #[must_use]
    pub fn new(protocol: Arc<Protocol>) -> Self {
        Self { protocol }
    }
    pub fn enqueue(
        &mut self,
        request: Request,
        wait: Option<Nanos>,
        policy: RetryPolicy,
        now: Nanos,
        ends_by: Option<Nanos>,
    ) -> Ticket {
        Ticket(0)
    }
    pub fn send_one_way(
        &mut self,
        request: Request,
        now: Nanos,
        ack_within: Option<Nanos>,
        ends_by: Option<Nanos>,
    ) -> (Vec<u8>, Option<Ticket>) {
        (Vec::new(), None)
    }
    pub fn give_up(&mut self, ticket: Ticket) {}
    pub fn fail(&mut self, now: Nanos) -> Vec<Event> {
        Vec::new()
    }
    pub fn fail_waiting(&mut self) {}
    pub fn take(&mut self, ticket: Ticket) -> Option<Result<Answer, Failure>> {
        None
    }
    #[must_use]
    pub fn persist(&self, now: Nanos) -> PersistedState {
        PersistedState::default()
    }
    pub fn restore(&mut self, state: &PersistedState) {}
    pub fn advance(&mut self, data: &[u8], now: Nanos) -> Vec<Event> {
        Vec::new()
    }
    pub fn receive(&mut self, data: &[u8], now: Nanos) -> Vec<Event> {
        Vec::new()
    }
    pub fn wake(&mut self, now: Nanos) -> Vec<Event> {
        Vec::new()
    }
    pub fn end_overdue(&mut self, now: Nanos) -> Vec<Event> {
        Vec::new()
    }
    pub fn note_full(&mut self, full: bool) {}
    #[must_use]
    pub fn has_next(&self, now: Nanos) -> bool {
        false
    }
    pub fn outgoing(&mut self, now: Nanos, drained: bool) -> Vec<u8> {
        Vec::new()
    }
    #[must_use]
    pub fn sent_last(&self) -> Option<Ticket> {
        None
    }
    pub fn written(&mut self, ticket: Ticket, now: Nanos) {}
    #[must_use]
    pub fn idle(&self, now: Nanos) -> Option<Nanos> {
        None
    }
    #[must_use]
    pub fn busy(&self) -> bool {
        false
    }
    #[must_use]
    pub fn align(&self) -> &[u8] {
        &[]
    }
    pub fn aligned(&mut self) {}
    pub fn cut(&mut self, align: &[u8], request: &[u8], written: Option<usize>) -> Option<usize> {
        None
    }
}
