//! Determines which of the one-way requests that were sent have been acknowledged.
//!
//! An acknowledgement carries the command's id, and perhaps a constant and arguments of the
//! request. If several requests with equal ids and arguments were sent and some acknowledgements
//! are lost, it is unknown which request each belongs to. So a request counts as acknowledged only
//! when the number of received acknowledgements exceeds the number that the other requests can
//! still have caused. So an acknowledged request may seem unacknowledged. The reverse cannot happen
//! if each acknowledgement comes once and in time. A lost acknowledgement causes doubt only until
//! it is too late to come.

use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::outcome::Got;
use super::pending::{GRACE, Pending};
use super::{
    Answer, Facts, Failure, Nanos, Protocol, Replier, Request, Safety, SeenFrame, Ticket, WaitedFor,
};
use crate::decode::Decoded;

/// Some firmware acknowledges a motion only when it ends.
const MOTION: Nanos = 60_000_000_000;

pub(super) type Ended = Vec<(Ticket, Result<Answer, Failure>)>;

/// An acknowledgement that may come.
#[derive(Clone, Debug)]
struct ExpectedAck {
    /// The request. Sending the same request again makes another object.
    request: Arc<Request>,
    sent_at: Nanos,
    /// The time after which it no longer counts.
    until: Nanos,
    /// Where in the received stream it can begin at the earliest.
    offset: u64,
    /// For each similar acknowledgement of another request, the time until which it may come; the
    /// earliest is first.
    doubts: Vec<Nanos>,
    /// Whether it may still come, if each received acknowledgement belongs to the oldest request.
    expected: bool,
    /// Whether a caller waits for it, and it is not yet certain that it has come.
    uncertain: bool,
    /// Whether it has certainly come, whichever requests the other acknowledgements belong to.
    certain: bool,
}

impl ExpectedAck {
    fn doubt(&mut self, until: impl IntoIterator<Item = Nanos>) {
        self.doubts.extend(until);
        self.doubts.sort_unstable();
    }

    /// Count a similar acknowledgement; the first ones may belong to other requests.
    fn count(&mut self, frame: &SeenFrame, began_at: Nanos) {
        self.doubts.retain(|until| *until > began_at);
        if self.doubts.is_empty() {
            self.certain |= frame.offset >= self.offset;
        } else if self.request.replier != Replier::Anybody {
            // After broadcasts, each other request may have several acknowledgements.
            self.doubts.remove(0);
        }
    }
}

/// The acknowledgements of requests with one command id.
#[derive(Clone, Debug, Default)]
struct CommandAcks {
    /// The acknowledgements that are expected or uncertain, oldest first.
    known: Vec<ExpectedAck>,
    /// The request of which a copy was received.
    copied: Option<Arc<Request>>,
    /// The time since which at least one acknowledgement has been expected.
    began_at: Nanos,
}

impl CommandAcks {
    fn expected(&self) -> impl DoubleEndedIterator<Item = &ExpectedAck> {
        self.known.iter().filter(|ack| ack.expected)
    }

    fn uncertain(&mut self) -> impl Iterator<Item = &mut ExpectedAck> {
        self.known.iter_mut().filter(|ack| ack.uncertain)
    }

    /// Expect an acknowledgement.
    fn add(&mut self, protocol: &Protocol, mut ack: ExpectedAck) {
        self.forget_expired(ack.sent_at);
        if self.expected().next().is_none() {
            self.began_at = ack.sent_at;
        }
        for earlier in self.uncertain() {
            if !protocol.replies_differ(&earlier.request, &ack.request) {
                earlier.doubt([ack.until]);
            }
        }
        if ack.uncertain {
            ack.doubt(self.doubts_of(protocol, &ack));
        }
        self.known.push(ack);
    }

    /// Expect each acknowledgement only for the time `within` after its request.
    fn shorten(&mut self, protocol: &Protocol, within: Nanos, now: Nanos) {
        for ack in self.known.iter_mut().filter(|ack| ack.expected) {
            ack.until = ack.until.min(ack.sent_at.saturating_add(within));
        }
        self.forget_expired(now);
        let others = self.clone();
        for ack in self.uncertain() {
            ack.doubts.clear();
            ack.doubt(others.doubts_of(protocol, ack));
        }
    }

    /// Assign a frame to the oldest acknowledgement that it `fits`; count it for every uncertain
    /// one that it fits.
    fn take(&mut self, fits: impl Fn(&ExpectedAck) -> bool, frame: &SeenFrame, began_at: Nanos) {
        let mut known = self.known.iter_mut();
        if let Some(ack) = known.find(|ack| ack.expected && fits(ack)) {
            // Several devices may acknowledge a broadcast: it stays until its time is over.
            ack.expected = ack.request.replier == Replier::Anybody;
        }
        for ack in self.uncertain().filter(|ack| fits(ack)) {
            ack.count(frame, began_at);
        }
        self.known.retain(|ack| ack.expected || ack.uncertain);
    }

    /// Return, for each similar acknowledgement that is expected, the time until which it may come.
    fn doubts_of(&self, protocol: &Protocol, ack: &ExpectedAck) -> Vec<Nanos> {
        let alike = |other: &&ExpectedAck| {
            !Arc::ptr_eq(&other.request, &ack.request)
                && !protocol.replies_differ(&other.request, &ack.request)
        };
        let alike = self.expected().filter(alike);
        alike.map(|other| other.until).collect()
    }

    fn forget_expired(&mut self, now: Nanos) {
        let mut expired = true;
        for ack in &mut self.known {
            // Expired ones are dropped only if all older ones are: while an older one may still
            // come, those after it stay.
            expired &= !ack.expected || ack.until <= now;
            ack.expected &= !expired;
            ack.uncertain &= ack.until > now && !ack.certain;
        }
        self.known.retain(|ack| ack.expected || ack.uncertain);
    }

    /// Return whether an acknowledgement of `newest` shows that motions are acknowledged at once.
    ///
    /// It must come at once. Also, either no other acknowledgement was expected when `newest` was
    /// sent, or at every time since `began_at`, which is longer ago than a motion may take, one was
    /// expected. In the second case an earlier acknowledgement was lost.
    fn are_motions_at_once(&self, protocol: &Protocol, newest: &ExpectedAck, now: Nanos) -> bool {
        let at_once = now.saturating_sub(newest.sent_at) < GRACE;
        let single = self.began_at == newest.sent_at;
        let long = now.saturating_sub(self.began_at) > MOTION;
        let moves = |facts: &Facts| facts.safety == Safety::Motion;
        protocol.is(newest.request.command, moves) && at_once && (single || long)
    }
}

/// The acknowledgements of the requests that were sent lately, and the callers that wait.
#[derive(Clone, Debug, Default)]
pub(super) struct Acks {
    commands: BTreeMap<u16, CommandAcks>,
    pub(super) waiting: Vec<Pending>,
    /// Whether this firmware was seen to acknowledge a motion at its start.
    motions_at_once: bool,
}

impl Acks {
    /// Note that a request is sent; its acknowledgement may begin at `offset` or later. A caller
    /// waits for it if there is a `pending`. Return the time until which it is expected.
    pub(super) fn expect(
        &mut self,
        protocol: &Protocol,
        request: &Arc<Request>,
        now: Nanos,
        offset: u64,
        pending: Option<Pending>,
    ) -> Nanos {
        let at_once = self.motions_at_once || protocol.reports_ends;
        let moves = |facts: &Facts| facts.safety == Safety::Motion;
        let slow = protocol.is(request.command, moves) && !at_once;
        let usual = if slow { MOTION } else { GRACE };
        let within = pending.as_ref().map_or(0, |pending| pending.wait);
        let until = now.saturating_add(within.max(usual));
        let ack = ExpectedAck {
            request: Arc::clone(request),
            sent_at: now,
            until,
            offset,
            doubts: Vec::new(),
            expected: true,
            uncertain: pending.is_some(),
            certain: false,
        };
        let id = protocol.id(request.command).unwrap_or_default();
        self.commands.entry(id).or_default().add(protocol, ack);
        self.waiting.extend(pending.map(|mut wait| {
            wait.begin(now, offset);
            wait
        }));
        until
    }

    /// Note a copy of a request. It is an acknowledgement without data, unless the transport
    /// echoes.
    pub(super) fn note_copy(&mut self, protocol: &Protocol, frame: &SeenFrame) {
        let Some(acks) = self.commands.get_mut(&protocol.id_of(frame)) else {
            return;
        };
        let copies = |ack: &&ExpectedAck| ack.request.frame == frame.bytes();
        let sent: Vec<&ExpectedAck> = acks.expected().filter(copies).collect();
        // It must be clear which of the expected acknowledgements was copied.
        if let [ack] = sent.as_slice()
            && acks.doubts_of(protocol, ack).is_empty()
        {
            acks.copied = Some(Arc::clone(&ack.request));
        }
    }

    /// Count a frame that is an acknowledgement; `None`: it is not one. `began_at` is the time at
    /// which its first byte came, or 0 if that is unknown. Return the command of the oldest request
    /// that it can belong to, its message, and the waits that it ends.
    pub(super) fn take(
        &mut self,
        protocol: &Protocol,
        frame: &SeenFrame,
        now: Nanos,
        began_at: Nanos,
    ) -> Option<(usize, Decoded, Ended)> {
        let acks = self.commands.get_mut(&protocol.id_of(frame))?;
        acks.forget_expired(began_at);
        // The frame is decoded once for each command.
        let mut messages = BTreeMap::new();
        for ack in &acks.known {
            let command = ack.request.command;
            let read = || protocol.read(frame, command).ok();
            messages.entry(command).or_insert_with(read);
        }
        let fits = |ack: &ExpectedAck| {
            let message = messages.get(&ack.request.command).and_then(Option::as_ref);
            message.is_some_and(|message| {
                ack.request.can_come_from(message.address)
                    && ack.request.repeated_by(protocol, message)
            })
        };
        let oldest = acks.expected().find(|ack| fits(ack))?;
        let newest = acks.expected().rfind(|ack| fits(ack))?;
        let command = oldest.request.command;
        let message = messages.get(&command)?.clone()?;
        if frame.offset < oldest.offset {
            return None;
        }
        if acks.are_motions_at_once(protocol, newest, now) {
            self.motions_at_once = true;
            acks.shorten(protocol, GRACE, now);
        }
        // Only now: if the expected times were shortened, some acknowledgements have expired.
        acks.take(fits, frame, began_at);
        // The acknowledgement may report that the arm did not carry out the request.
        let refused = Failure::refusal(protocol, &message);
        let own = |ack: &ExpectedAck, wait: &Pending| Arc::ptr_eq(&ack.request, &wait.request);
        let over = |wait: &mut Pending| acks.known.iter().any(|ack| ack.certain && own(ack, wait));
        let ended = self.waiting.extract_if(.., over).map(|wait| {
            let answer = wait.answer(Got::default(), now);
            (wait.ticket, refused.clone().map_or(Ok(answer), Err))
        });
        Some((command, message, ended.collect()))
    }

    /// End the waits whose time is over. A copy of the request counts as its acknowledgement,
    /// unless the transport `echoes`.
    pub(super) fn wake(&mut self, protocol: &Protocol, now: Nanos, echoes: bool) -> Ended {
        let over = |wait: &mut Pending| wait.ends_first() <= now;
        let ended = self.waiting.extract_if(.., over).map(|mut wait| {
            let id = protocol.id(wait.request.command);
            let copied = id.and_then(|id| self.commands.get(&id)?.copied.as_ref());
            let copied = copied.is_some_and(|copied| Arc::ptr_eq(copied, &wait.request));
            let in_time = wait.deadline > now;
            let outcome = if copied && !echoes && !in_time {
                Ok(wait.answer(Got::default(), now))
            } else {
                Err(wait.expire(now, in_time.then_some(WaitedFor::Reply)))
            };
            (wait.ticket, outcome)
        });
        ended.collect()
    }
}
