//! Outstanding replies: those to requests that were given up, or were sent more than once.
//!
//! A late reply looks like the reply to the next request of the same command. So that request is
//! held until the late reply is too late to come at all. It is not sent earlier, even if a late
//! reply has come: some lines double replies.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::alignment::Part;
use super::events::SeenFrame;
use super::facts::{Nanos, Protocol};
use super::matching::{can_reply_to, replies_differ};
use super::pending::PendingRequest;
use super::request::Request;

/// A reply to a request that may come before `until`.
#[derive(Clone, Debug)]
pub(super) struct OutstandingReply {
    pub(super) request: Arc<Request>,
    pub(super) until: Nanos,
}

/// The outstanding replies of one transport, oldest first; some may have expired.
#[derive(Clone, Debug, Default)]
pub(super) struct OutstandingReplies(pub(super) Vec<OutstandingReply>);

impl OutstandingReplies {
    /// Expect a reply until then.
    pub(super) fn expect(&mut self, request: Arc<Request>, until: Nanos) {
        self.0.push(OutstandingReply { request, until });
    }

    /// Expect a late reply to each attempt, except for the first `received` ones.
    pub(super) fn expect_late(&mut self, pending: &PendingRequest, received: usize) {
        self.0.extend(late_replies(pending, received));
    }

    /// Expect the reply with this index no longer.
    pub(super) fn settle(&mut self, index: usize) {
        if index < self.0.len() {
            self.0.remove(index);
        }
    }

    /// Forget the replies that are too late to come.
    pub(super) fn drop_expired(&mut self, now: Nanos) {
        self.0.retain(|reply| reply.until > now);
    }

    /// Return until when a late reply can be mistaken for this request's; `None`: no reply can.
    pub(super) fn held_until(&self, protocol: &Protocol, request: &Request) -> Option<Nanos> {
        let replies = self.0.iter();
        let alike = replies.filter(|reply| !replies_differ(protocol, &reply.request, request));
        alike.map(|reply| reply.until).max()
    }

    /// Return the index of the oldest outstanding reply that a frame can be, and its request.
    pub(super) fn find(
        &self,
        protocol: &Protocol,
        frame: &SeenFrame,
        now: Nanos,
    ) -> Option<(usize, Arc<Request>)> {
        let index = self
            .0
            .iter()
            .position(|reply| reply.until > now && can_reply_to(protocol, frame, &reply.request))?;
        Some((index, Arc::clone(&self.0.get(index)?.request)))
    }

    /// Return whether a reply of the frame's command is outstanding.
    pub(super) fn has_command(&self, protocol: &Protocol, frame: &SeenFrame) -> bool {
        let mut replies = self.0.iter();
        replies.any(|reply| reply.request.can_have_reply(protocol, frame))
    }
}

/// Return the outstanding replies to a request's attempts after the first `received` ones.
pub(super) fn late_replies(
    pending: &PendingRequest,
    received: usize,
) -> impl Iterator<Item = OutstandingReply> {
    let times = pending.attempt_times.iter().skip(received);
    times.map(|sent_at| OutstandingReply {
        request: Arc::clone(&pending.base.request),
        until: sent_at.saturating_add(pending.policy.grace),
    })
}

/// A request that was sent; its reply may still come before `until`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LateFrame {
    /// The frame of the request.
    pub request: Vec<u8>,
    /// When the reply is too late to come, by the clock of the port.
    pub until: Nanos,
}

/// Replies that may still come, and what the peer may hold of a request that was cut.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PersistedState {
    /// The requests of which replies are outstanding.
    pub late: Vec<LateFrame>,
    /// Every part of a request that the peer may hold.
    pub parts: Vec<Part>,
}
