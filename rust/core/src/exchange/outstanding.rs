//! Keeps the outstanding replies: those to requests that were given up, or sent more than once.
//!
//! A late reply looks like the reply to the next request of the same command. So that request is
//! held until the late reply can no longer come. It is not sent earlier, even if a late reply has
//! come: some transports deliver replies twice.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::pending::Pending;
use super::{Nanos, Part, Protocol, Request, SeenFrame};

/// A reply to a request that may come before `until`.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct OutstandingReply {
    pub request: Arc<Request>,
    pub until: Nanos,
}

/// The outstanding replies of one transport, oldest first; some may have expired.
#[derive(Clone, Debug, Default)]
pub(super) struct OutstandingReplies(pub(super) Vec<OutstandingReply>);

impl OutstandingReplies {
    pub(super) fn expect(&mut self, request: Arc<Request>, until: Nanos) {
        self.0.push(OutstandingReply { request, until });
    }

    /// Expect a late reply to each attempt, except for the first `received` ones.
    pub(super) fn expect_late(&mut self, pending: &Pending, received: usize) {
        for sent_at in pending.attempt_times.iter().skip(received) {
            let until = sent_at.saturating_add(pending.policy.grace);
            self.expect(Arc::clone(&pending.request), until);
        }
    }

    pub(super) fn drop_expired(&mut self, now: Nanos) {
        self.0.retain(|reply| reply.until > now);
    }

    /// Return the time until which a late reply can be mistaken for the reply to this request;
    /// `None`: no outstanding reply can.
    pub(super) fn held_until(&self, protocol: &Protocol, request: &Request) -> Option<Nanos> {
        let replies = self.0.iter();
        let alike = replies.filter(|reply| !protocol.replies_differ(&reply.request, request));
        alike.map(|reply| reply.until).max()
    }

    /// Return the index of the oldest outstanding reply that a frame can be, and its command.
    pub(super) fn find(
        &self,
        protocol: &Protocol,
        frame: &SeenFrame,
        now: Nanos,
    ) -> Option<(usize, usize)> {
        let own = |reply: &OutstandingReply| {
            reply.until > now && protocol.can_reply_to(frame, &reply.request)
        };
        let index = self.0.iter().position(own)?;
        Some((index, self.0.get(index)?.request.command))
    }

    /// Return whether a reply of the frame's command is outstanding.
    pub(super) fn has_command(&self, protocol: &Protocol, frame: &SeenFrame) -> bool {
        let own = |reply: &OutstandingReply| reply.request.can_have_reply(protocol, frame);
        self.0.iter().any(own)
    }
}

/// Replies that may still come, and the parts that the peer may hold of a request that was cut.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PersistedState {
    /// The outstanding replies, with times by the clock of the port. The next session reads their
    /// frames by its own table.
    pub late: Vec<OutstandingReply>,
    /// Every part of a request that the peer may hold.
    pub parts: Vec<Part>,
}
