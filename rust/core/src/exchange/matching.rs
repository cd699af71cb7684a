//! Decides what a received frame can be, with pure functions. The protocol has no sequence numbers.

use alloc::boxed::Box;
use alloc::vec::Vec;

use super::{Event, Facts, Named, Protocol, Replier, Request, SeenFrame};
use crate::decode::{DecodeError, Decoded, read};
use crate::direction::{Direction, Listening};
use crate::message::Variant;
use crate::number::Value;

/// Values by the name of their field.
pub(super) type Arguments = Vec<(Box<str>, Vec<Value>)>;

/// Return the fields of a message with their values.
pub(super) fn fields<'a>(
    names: &'a [Named],
    decoded: &'a Decoded,
) -> impl Iterator<Item = (&'a Named, &'a [Value])> {
    names.iter().zip(decoded.fields())
}

/// Return whether two fields have the same value; the integer 1 equals the float 1.0.
pub(super) fn same(one: &[Value], other: &[Value]) -> bool {
    let equal = |pair: (&Value, &Value)| match pair {
        (Value::Integer(whole), Value::Real(real)) | (Value::Real(real), Value::Integer(whole)) => {
            *real == *whole as f64
        }
        (one, other) => one == other,
    };
    one.len() == other.len() && one.iter().zip(other).all(equal)
}

impl Protocol {
    /// Return the id of a command.
    pub(super) fn id(&self, command: usize) -> Option<u16> {
        Some(self.table.commands().get(command)?.id)
    }

    /// Return whether a condition holds for the facts of a command.
    pub(super) fn is(&self, command: usize, holds: impl Fn(&Facts) -> bool) -> bool {
        self.facts.get(command).is_some_and(holds)
    }

    /// Return the variants of a command's reply.
    fn replies(&self, command: usize) -> &[Variant] {
        let command = self.table.commands().get(command);
        command.map_or(&[], |command| &command.reply)
    }

    /// Decode a frame as a reply of one command.
    pub(super) fn read(&self, frame: &SeenFrame, of: usize) -> Result<Decoded, DecodeError> {
        let rules = self.table.rules(Listening::To(Direction::Reply));
        let frame = frame.frame.get(self.table.frame());
        read(&self.table, rules, frame, Some(of))
    }

    /// Return the number at the offset of the command id.
    pub(super) fn id_of(&self, frame: &SeenFrame) -> u16 {
        frame.frame.get(self.table.frame()).id()
    }

    fn has_ids(&self) -> bool {
        self.table.frame().layout.reply_has_id
    }

    /// Decode a frame as the reply to a request, without comparing repeated arguments. `None`: the
    /// frame replies to something else.
    pub(super) fn as_reply(
        &self,
        frame: &SeenFrame,
        request: &Request,
    ) -> Option<Result<Decoded, DecodeError>> {
        let format = self.table.frame();
        let can_reply = !self.replies(request.command).is_empty()
            && request.can_have_reply(self, frame)
            && request.can_come_from(format.address(frame.frame.get(format)));
        if !can_reply {
            return None;
        }
        let reply = self.read(frame, request.command);
        let elsewhere = reply.is_err() && self.replies_elsewhere(frame, request.command);
        (!elsewhere).then_some(reply)
    }

    /// Return whether a frame is a legal reply to a request that is no longer waited for.
    pub(super) fn can_reply_to(&self, frame: &SeenFrame, request: &Request) -> bool {
        // A frame equal to the request may be its echo; the reply may still come.
        if !request.can_have_reply(self, frame) || frame.bytes() == request.frame {
            return false;
        }
        let own = |reply: Decoded| {
            request.can_come_from(reply.address) && request.repeated_by(self, &reply)
        };
        self.read(frame, request.command).is_ok_and(own)
    }

    /// Return a frame as a message that the device sends without a request, or as unexpected.
    pub(super) fn as_event(&self, frame: SeenFrame) -> Event {
        let id = Some(self.id_of(&frame));
        for (command, facts) in self.facts.iter().enumerate() {
            if facts.event
                && self.id(command) == id
                && let Ok(decoded) = self.read(&frame, command)
            {
                return Event::DeviceEvent {
                    command,
                    decoded,
                    frame,
                };
            }
        }
        Event::Unexpected { frame }
    }

    /// Return whether a frame that is not a legal reply of a command is the reply of another
    /// command with the same id.
    ///
    /// A constant in the replies distinguishes commands that share an id, such as the register
    /// number of a device to which the arm forwards requests. The rest of the frame may be illegal.
    fn replies_elsewhere(&self, frame: &SeenFrame, of: usize) -> bool {
        let format = self.table.frame();
        let frame = frame.frame.get(format);
        let data = format.data(frame, Direction::Reply);
        let mut commands = self.table.commands().iter().enumerate();
        let others = commands.any(|(index, other)| {
            let shares = other.id == frame.id() || !self.has_ids();
            shares && index != of && !other.reply.is_empty()
        });
        let own = |variant: &Variant| variant.has_constants(data);
        others && !self.replies(of).iter().any(own)
    }

    /// Return whether no frame is a legal reply to both commands; false if the reply of one is not
    /// a frame.
    fn exclusive(&self, one: usize, other: usize) -> bool {
        let (one, other) = (self.replies(one), self.replies(other));
        let excluded = |variant: &Variant| other.iter().all(|other| variant.excludes(other));
        !one.is_empty() && !other.is_empty() && one.iter().all(excluded)
    }

    /// Return whether no reply to one request can be mistaken for a reply to the other.
    pub(super) fn replies_differ(&self, one: &Request, other: &Request) -> bool {
        let ids_differ = self.has_ids() && self.id(one.command) != self.id(other.command);
        let any = [Replier::Anybody, Replier::Somebody];
        let meet = any.contains(&one.replier) || any.contains(&other.replier);
        if ids_differ || !(meet || one.replier == other.replier) {
            return true;
        }
        if one.command != other.command {
            return self.exclusive(one.command, other.command);
        }
        let differs = |name: &str| {
            let values = one.argument(name).zip(other.argument(name));
            values.is_some_and(|(one, other)| !same(one, other))
        };
        // Older firmware replies with a variant without the echo, so every variant must echo an
        // argument that differs between the two requests.
        let tells = |variant: &Vec<Named>| {
            let mut fields = variant.iter();
            fields.any(|named| named.echo && differs(&named.name))
        };
        self.is(other.command, |facts| {
            !facts.reply.is_empty() && facts.reply.iter().all(tells)
        })
    }
}

impl Request {
    /// Return whether a reply from this address can belong to the request.
    pub(super) fn can_come_from(&self, address: Option<u8>) -> bool {
        match self.replier {
            Replier::Unaddressed => address.is_none(),
            Replier::Address(own) => address == Some(own),
            Replier::Anybody | Replier::Somebody => true,
            Replier::Nobody => false,
        }
    }

    /// Return whether a frame can be a reply to the request; the values do not matter. The command
    /// id decides; in a format without ids in replies, the size does.
    pub(super) fn can_have_reply(&self, protocol: &Protocol, frame: &SeenFrame) -> bool {
        if protocol.has_ids() {
            return protocol.id(self.command) == Some(protocol.id_of(frame));
        }
        let reply = protocol.read(frame, self.command);
        !matches!(reply, Err(DecodeError::Frame { .. }))
    }

    /// Return whether each echo field of a reply has the value that this request sent.
    pub(super) fn repeated_by(&self, protocol: &Protocol, reply: &Decoded) -> bool {
        let facts = protocol.facts.get(reply.variant.command);
        let names = facts.and_then(|facts| facts.reply.get(reply.variant.variant));
        let mut found = fields(names.map_or(&[], Vec::as_slice), reply);
        let own = |(named, value): (&Named, &[Value])| {
            !named.echo || same(self.argument(&named.name).unwrap_or(value), value)
        };
        self.arguments.is_empty() || found.all(own)
    }

    fn argument(&self, name: &str) -> Option<&[Value]> {
        let mut arguments = self.arguments.iter();
        let (_, value) = arguments.find(|(own, _)| **own == *name)?;
        Some(value)
    }
}
