//! Acknowledgements: which of the one-way requests that were sent has been acknowledged.
//!
//! An acknowledgement carries the command's id, perhaps a constant and arguments of the request.
//! Where several requests with the same of these were sent and some acknowledgements are lost, it is
//! unknown which request each belongs to. So a request counts as acknowledged once more
//! acknowledgements have come than the other requests can still have caused. It may seem
//! unacknowledged although it was, never the reverse, if each acknowledgement comes once and in
//! time. An acknowledgement that was lost causes doubt only until it is too late to come.

use alloc::collections::BTreeMap;
use alloc::sync::Arc;
use alloc::vec::Vec;

use super::events::{Event, SeenFrame};
use super::facts::{Nanos, Protocol, Replier, Safety};
use super::matching::{address_of, id_of, read_reply, replies_differ};
use super::outcome::{Answer, Failure, WaitedFor};
use super::pending::{GRACE, NEVER, Pending, PendingAck, Ticket};
use super::refusal::refusal;
use super::request::Request;
use crate::decode::Decoded;

/// Some firmware acknowledges a motion only when it ends.
const MOTION: Nanos = 60_000_000_000;

/// How waits have ended.
pub(super) type Ended = Vec<(Ticket, Result<Answer, Failure>)>;

/// An acknowledgement that may come.
#[derive(Clone, Debug)]
struct ExpectedAck {
    number: u64,
    request: Arc<Request>,
    sent_at: Nanos,
    /// After this it no longer counts.
    until: Nanos,
    /// Where in the received stream it can begin at the earliest.
    offset: u64,
    /// Until when the acknowledgement of each other request may come, and look like this one;
    /// soonest first.
    doubts: Vec<Nanos>,
    /// Whether it may still come, if each one belongs to the oldest request.
    expected: bool,
    /// Whether a caller waits for it; so it is doubted until it is certain.
    uncertain: bool,
    /// Whether it has come, whichever requests the other ones belong to.
    certain: bool,
}

impl ExpectedAck {
    fn doubt(&mut self, mut until: Vec<Nanos>) {
        until.sort_unstable();
        self.doubts = until;
    }

    /// Count an acknowledgement of the command: of another request, as long as it can be.
    fn count(&mut self, frame: &SeenFrame, began_at: Nanos) {
        self.doubts.retain(|until| *until > began_at);
        if self.doubts.is_empty() {
            self.certain |= frame.offset >= self.offset;
        } else if self.request.replier != Replier::Anybody {
            // Of a broadcast several devices may acknowledge each other request.
            self.doubts.remove(0);
        }
    }
}

/// A frame that may be an acknowledgement, decoded once for each command.
struct Candidate<'a> {
    protocol: &'a Protocol,
    address: Option<u8>,
    messages: BTreeMap<usize, Decoded>,
}

impl<'a> Candidate<'a> {
    fn new(protocol: &'a Protocol, frame: &SeenFrame, acks: &CommandAcks) -> Self {
        let mut commands: Vec<usize> = acks.known.iter().map(|ack| ack.request.command).collect();
        commands.dedup();
        let read = |command| Some((command, read_reply(protocol, frame, command).ok()?));
        Self {
            protocol,
            address: address_of(protocol, frame),
            messages: commands.into_iter().filter_map(read).collect(),
        }
    }

    /// Return the frame as the acknowledgement of a request; `None`: it cannot be that.
    fn of(&self, request: &Request) -> Option<&Decoded> {
        let message = self.messages.get(&request.command)?;
        let own =
            request.can_come_from(self.address) && request.repeated_by(self.protocol, message);
        own.then_some(message)
    }
}

/// The requests of one command id.
#[derive(Clone, Debug, Default)]
struct CommandAcks {
    /// Those that are expected or uncertain, oldest first.
    known: Vec<ExpectedAck>,
    /// The request of which a copy came.
    copied: Option<u64>,
    /// Since when acknowledgements have been expected without a break.
    began_at: Nanos,
}

impl CommandAcks {
    fn expected(&self) -> impl DoubleEndedIterator<Item = &ExpectedAck> {
        self.known.iter().filter(|ack| ack.expected)
    }

    /// Expect an acknowledgement, for which a caller waits if it is uncertain.
    fn add(&mut self, protocol: &Protocol, mut ack: ExpectedAck) {
        self.forget_expired(ack.sent_at);
        if self.expected().next().is_none() {
            self.began_at = ack.sent_at;
        }
        for earlier in self.known.iter_mut().filter(|ack| ack.uncertain) {
            if !replies_differ(protocol, &earlier.request, &ack.request) {
                let mut until = core::mem::take(&mut earlier.doubts);
                until.push(ack.until);
                earlier.doubt(until);
            }
        }
        if ack.uncertain {
            ack.doubt(self.doubts_of(protocol, &ack));
        }
        self.known.push(ack);
    }

    /// Expect each acknowledgement only that long after its request.
    fn shorten(&mut self, protocol: &Protocol, within: Nanos, now: Nanos) {
        for ack in self.known.iter_mut().filter(|ack| ack.expected) {
            ack.until = ack.until.min(ack.sent_at.saturating_add(within));
        }
        self.forget_expired(now);
        let doubts: Vec<_> = self
            .known
            .iter()
            .map(|ack| self.doubts_of(protocol, ack))
            .collect();
        for (ack, until) in self
            .known
            .iter_mut()
            .zip(doubts)
            .filter(|(ack, _)| ack.uncertain)
        {
            ack.doubt(until);
        }
    }

    /// Note a copy of a request, if it is clear which of the expected ones was copied.
    fn note_copy(&mut self, protocol: &Protocol, frame: &SeenFrame) {
        let copies = |ack: &&ExpectedAck| ack.request.frame == frame.bytes();
        let sent: Vec<&ExpectedAck> = self.expected().filter(copies).collect();
        if let [ack] = sent.as_slice()
            && self.doubts_of(protocol, ack).is_empty()
        {
            self.copied = Some(ack.number);
        }
    }

    /// Settle the oldest acknowledgement that a frame can be; count it for all that wait. Return
    /// the numbers of those that are certain now.
    fn take(&mut self, candidate: &Candidate<'_>, frame: &SeenFrame, began_at: Nanos) -> Vec<u64> {
        let mut known = self.known.iter_mut();
        let settled = known.find(|ack| ack.expected && candidate.of(&ack.request).is_some());
        if let Some(ack) = settled {
            // Several devices may acknowledge a broadcast: it stays until its time is over.
            ack.expected = ack.request.replier == Replier::Anybody;
        }
        let mut certain = Vec::new();
        for ack in self.known.iter_mut().filter(|ack| ack.uncertain) {
            if candidate.of(&ack.request).is_some() {
                ack.count(frame, began_at);
                certain.extend(ack.certain.then_some(ack.number));
            }
        }
        self.known.retain(|ack| ack.expected || ack.uncertain);
        certain
    }

    /// Return until when all that is expected besides an acknowledgement may look like it.
    fn doubts_of(&self, protocol: &Protocol, ack: &ExpectedAck) -> Vec<Nanos> {
        let others = self.expected().filter(|other| other.number != ack.number);
        let alike = others.filter(|other| !replies_differ(protocol, &other.request, &ack.request));
        alike.map(|other| other.until).collect()
    }

    fn forget_expired(&mut self, now: Nanos) {
        let mut expired = true;
        for ack in &mut self.known {
            // Only the oldest ones: what is behind one that may still come stays.
            expired &= !ack.expected || ack.until <= now;
            ack.expected &= !expired;
            ack.uncertain &= ack.until > now && !ack.certain;
        }
        self.known.retain(|ack| ack.expected || ack.uncertain);
    }
}

/// The acknowledgements of the requests that were sent lately, and the callers that wait.
#[derive(Clone, Debug)]
pub(super) struct Acks {
    commands: BTreeMap<u16, CommandAcks>,
    pub(super) waiting: Vec<PendingAck>,
    /// Whether this firmware was seen to acknowledge a motion at its start. It does if another
    /// message reports the end.
    motions_at_once: bool,
    /// How many were expected so far.
    count: u64,
}

impl Acks {
    /// Expect nothing; `motions_at_once`: a message of the device reports the end of a motion.
    pub(super) fn new(motions_at_once: bool) -> Self {
        Self {
            commands: BTreeMap::new(),
            waiting: Vec::new(),
            motions_at_once,
            count: 0,
        }
    }

    /// Return when the first wait ends.
    pub(super) fn next_end(&self) -> Nanos {
        let ends = self
            .waiting
            .iter()
            .map(|wait| wait.until.min(wait.base.ends_by));
        ends.min().unwrap_or(NEVER)
    }

    /// Note that a request goes out; its acknowledgement can begin at `offset`. A caller waits for
    /// it if there is a `pending`, `within` that time. Return until when it is expected.
    pub(super) fn expect(
        &mut self,
        protocol: &Protocol,
        request: &Arc<Request>,
        (now, offset): (Nanos, u64),
        within: Option<Nanos>,
        pending: Option<Pending>,
    ) -> Nanos {
        let Some((command, facts)) = protocol.command(request.command) else {
            return now;
        };
        let slow = facts.safety == Safety::Motion && !self.motions_at_once;
        let usual = if slow { MOTION } else { GRACE };
        let until = now.saturating_add(within.unwrap_or_default().max(usual));
        self.count += 1;
        let ack = ExpectedAck {
            number: self.count,
            request: Arc::clone(request),
            sent_at: now,
            until,
            offset,
            doubts: Vec::new(),
            expected: true,
            uncertain: pending.is_some(),
            certain: false,
        };
        self.commands
            .entry(command.id)
            .or_default()
            .add(protocol, ack);
        self.waiting.extend(pending.map(|base| PendingAck {
            base,
            ack: self.count,
            sent_at: now,
            until: now.saturating_add(within.unwrap_or_default()),
        }));
        until
    }

    /// Note a copy of a request, which is a bare acknowledgement unless the line echoes.
    pub(super) fn note_copy(&mut self, protocol: &Protocol, frame: &SeenFrame) {
        if let Some(acks) = self.commands.get_mut(&id_of(protocol, frame)) {
            acks.note_copy(protocol, frame);
        }
    }

    /// Count a frame that is an acknowledgement; `None`: it is not one. `began_at` is when its first
    /// byte came; 0 if that is not known. Return the command of the oldest request that it can
    /// belong to, its message, and the waits that it ends.
    pub(super) fn take(
        &mut self,
        protocol: &Protocol,
        frame: &SeenFrame,
        now: Nanos,
        began_at: Nanos,
    ) -> Option<(usize, Decoded, Ended)> {
        let acks = self.commands.get_mut(&id_of(protocol, frame))?;
        acks.forget_expired(began_at);
        let candidate = Candidate::new(protocol, frame, acks);
        let fits = |ack: &&ExpectedAck| candidate.of(&ack.request).is_some();
        let oldest = acks.expected().find(fits)?;
        let newest = acks.expected().rev().find(fits)?;
        let message = candidate.of(&oldest.request)?.clone();
        let command = oldest.request.command;
        if frame.offset < oldest.offset {
            return None;
        }
        if is_motion_at_once(protocol, acks, newest, now) {
            self.motions_at_once = true;
            acks.shorten(protocol, GRACE, now);
        }
        // What learning has shortened may be over by now.
        let certain = acks.take(&candidate, frame, began_at);
        let ended = self.end_certain(protocol, &certain, &message, now);
        Some((command, message, ended))
    }

    /// End waits with their acknowledgement, which may say that the arm did not do it.
    fn end_certain(
        &mut self,
        protocol: &Protocol,
        certain: &[u64],
        message: &Decoded,
        now: Nanos,
    ) -> Ended {
        let waiting = &mut self.waiting;
        let ended = waiting.extract_if(.., |wait| certain.contains(&wait.ack));
        let outcome = |wait: PendingAck| {
            let outcome = match refusal(protocol, message) {
                Some(refused) => Err(refused),
                None => Ok(wait.acknowledged(now)),
            };
            (wait.base.ticket, outcome)
        };
        ended.map(outcome).collect()
    }

    /// End the waits whose time is over: a copy counts, unless the line `echoes`.
    pub(super) fn wake(&mut self, protocol: &Protocol, now: Nanos, echoes: bool) -> Ended {
        let over = |wait: &mut PendingAck| wait.until.min(wait.base.ends_by) <= now;
        let ended: Vec<PendingAck> = self.waiting.extract_if(.., over).collect();
        let outcome = |mut wait: PendingAck| {
            let command = protocol.command(wait.base.request.command);
            let acks = command.and_then(|(command, _)| self.commands.get(&command.id));
            let copied = acks.is_some_and(|acks| acks.copied == Some(wait.ack));
            let in_time = wait.until > now;
            let outcome = if copied && !echoes && !in_time {
                Ok(wait.acknowledged(now))
            } else {
                let waited = now.saturating_sub(wait.sent_at);
                let waited_for = in_time.then_some(WaitedFor::Reply);
                Err(wait.base.expire(protocol, waited, 1, waited_for))
            };
            (wait.base.ticket, outcome)
        };
        ended.into_iter().map(outcome).collect()
    }

    /// End every wait: the transport is gone.
    pub(super) fn fail(&mut self) -> Ended {
        let waiting = self.waiting.drain(..);
        waiting
            .map(|wait| (wait.base.ticket, Err(Failure::Link)))
            .collect()
    }

    /// Have those who wait remember an event, for the text of a timeout.
    pub(super) fn note(&mut self, event: &Event) {
        for wait in &mut self.waiting {
            wait.base.note(event);
        }
    }

    /// Forget the wait of a caller who waits no longer.
    pub(super) fn give_up(&mut self, ticket: Ticket) {
        self.waiting.retain(|wait| wait.base.ticket != ticket);
    }
}

/// Return whether motions are acknowledged at once.
///
/// They are if the acknowledgement of a single motion comes at once. They are too if the newest
/// motion always seems to be the acknowledged one for longer than a motion may take: then an earlier
/// acknowledgement was lost.
fn is_motion_at_once(
    protocol: &Protocol,
    acks: &CommandAcks,
    newest: &ExpectedAck,
    now: Nanos,
) -> bool {
    let command = protocol.command(newest.request.command);
    let moves = command.is_some_and(|(_, facts)| facts.safety == Safety::Motion);
    let single = acks.began_at == newest.sent_at;
    let at_once = now.saturating_sub(newest.sent_at) < GRACE;
    moves && at_once && (single || now.saturating_sub(acks.began_at) > MOTION)
}
