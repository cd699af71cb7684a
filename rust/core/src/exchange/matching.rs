//! What a received frame can be, by pure functions. The protocol has no sequence numbers to tell.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::events::{Event, SeenFrame};
use super::facts::{Named, Protocol, Replier};
use super::request::Request;
use super::values::{fields, same};
use crate::decode::{DecodeError, Decoded, read};
use crate::direction::{Direction, Listening};
use crate::field::Field;
use crate::message::Variant;
use crate::number::{Number, Value};

/// Return a frame as a reply of one command.
pub(super) fn read_reply(
    protocol: &Protocol,
    frame: &SeenFrame,
    of: usize,
) -> Result<Decoded, DecodeError> {
    let table = &protocol.table;
    let rules = table.rules(Listening::To(Direction::Reply));
    read(table, rules, frame.get(table.frame()), Some(of))
}

/// Return the number in the place of the command id.
pub(super) fn id_of(protocol: &Protocol, frame: &SeenFrame) -> u16 {
    frame.get(protocol.table.frame()).id()
}

/// Return the address byte, if the format has one.
pub(super) fn address_of(protocol: &Protocol, frame: &SeenFrame) -> Option<u8> {
    let format = protocol.table.frame();
    format.address(frame.get(format))
}

impl Request {
    /// Return whether a reply of this address can belong to it.
    pub(super) fn can_come_from(&self, address: Option<u8>) -> bool {
        match self.replier {
            Replier::Unaddressed => address.is_none(),
            Replier::Address(own) => address == Some(own),
            Replier::Anybody | Replier::Somebody => true,
            Replier::Nobody => false,
        }
    }

    /// Return whether a frame can be a reply of its command, whatever its values. The command id
    /// tells; in a format without ids in replies, the size does.
    pub(super) fn can_have_reply(&self, protocol: &Protocol, frame: &SeenFrame) -> bool {
        if protocol.table.frame().layout.reply_has_id {
            let command = protocol.table.commands().get(self.command);
            return command.is_some_and(|command| command.id == id_of(protocol, frame));
        }
        !matches!(
            read_reply(protocol, frame, self.command),
            Err(DecodeError::Frame { .. })
        )
    }

    /// Return whether a reply of its command repeats its own arguments.
    pub(super) fn repeated_by(&self, protocol: &Protocol, reply: &Decoded) -> bool {
        let facts = protocol.facts.get(reply.variant.command);
        let names = facts.and_then(|facts| facts.reply.get(reply.variant.variant));
        let names = names.filter(|_| !self.arguments.is_empty());
        let mut found = fields(names.map_or(&[], Vec::as_slice), reply);
        found.all(|(named, value)| {
            !named.echo || same(self.argument(&named.name).unwrap_or(value), value)
        })
    }

    fn argument(&self, name: &str) -> Option<&[Value]> {
        let mut arguments = self.arguments.iter();
        let (_, value) = arguments.find(|(own, _)| **own == *name)?;
        Some(value)
    }
}

/// Return a frame of the request's command as its reply, whichever arguments it repeats; `None`: it
/// replies to something else.
pub(super) fn as_reply(
    protocol: &Protocol,
    frame: &SeenFrame,
    request: &Request,
) -> Option<Result<Decoded, DecodeError>> {
    if !request.can_come_from(address_of(protocol, frame)) {
        return None;
    }
    let reply = read_reply(protocol, frame, request.command);
    let elsewhere = reply.is_err() && replies_elsewhere(protocol, frame, request.command);
    (!elsewhere).then_some(reply)
}

/// Return whether a frame is a legal reply to a request that is no longer waited for.
pub(super) fn can_reply_to(protocol: &Protocol, frame: &SeenFrame, request: &Request) -> bool {
    // The request's own bytes may be only their echo, with the reply still to come.
    if !request.can_have_reply(protocol, frame) || frame.bytes() == request.frame {
        return false;
    }
    read_reply(protocol, frame, request.command).is_ok_and(|reply| {
        request.can_come_from(reply.address) && request.repeated_by(protocol, &reply)
    })
}

/// Return a frame as a message that the device sends without a request, or as an unexpected one.
pub(super) fn as_event(protocol: &Protocol, frame: SeenFrame) -> Event {
    let id = id_of(protocol, &frame);
    let commands = protocol.table.commands().iter().zip(&protocol.facts);
    let events = commands
        .enumerate()
        .filter(|(_, (command, facts))| facts.event && command.id == id);
    for (command, _) in events {
        if let Ok(decoded) = read_reply(protocol, &frame, command) {
            return Event::DeviceEvent {
                command,
                decoded,
                frame,
            };
        }
    }
    Event::Unexpected { frame }
}

/// Return whether a frame that is no legal reply of a command replies to one that shares its id.
///
/// A constant in each reply tells them apart, for instance the number of the register that a device
/// behind the arm reports. The rest of such a reply may be illegal.
fn replies_elsewhere(protocol: &Protocol, frame: &SeenFrame, of: usize) -> bool {
    let format = protocol.table.frame();
    let frame = frame.get(format);
    let data = format.data(frame, Direction::Reply);
    let commands = protocol.table.commands();
    let others = commands.iter().enumerate().any(|(index, other)| {
        let shares = other.id == frame.id() || !format.layout.reply_has_id;
        shares && index != of && !other.reply.is_empty()
    });
    let own = commands.get(of).map_or(&[][..], |command| &command.reply);
    others && !own.iter().any(|variant| has_constants(variant, data))
}

/// Return whether data bytes can be this variant, as far as its constants show.
fn has_constants(variant: &Variant, data: &[u8]) -> bool {
    let mut places = places(variant).into_iter();
    variant.size() == data.len()
        && places.all(|(at, (field, number))| {
            field.choices.len() != 1 || field.allows(number, number.unpack(data, at))
        })
}

/// Return the fields and numbers that no selector decides, by their offset.
fn places(variant: &Variant) -> BTreeMap<usize, (&Field, &Number)> {
    let mut found = BTreeMap::new();
    let fields = variant.fields().iter().enumerate();
    for (index, field) in fields.filter(|(_, field)| field.selector.is_none()) {
        let mut at = variant.start(index);
        for number in field.numbers(0) {
            found.insert(at, (field, number));
            at += number.step();
        }
    }
    found
}

/// Return whether no data bytes are legal in both variants. That is known if their sizes differ, or
/// if a number of each, at the same place, have no raw value in common, such as two constants.
fn exclude(one: &Variant, other: &Variant) -> bool {
    let there = places(other);
    one.size() != other.size()
        || places(one).iter().any(|(at, (field, number))| {
            there.get(at).is_some_and(|(other, beside)| {
                alike(number, beside) && !meet((field, number), (other, beside))
            })
        })
}

/// Return whether the same bytes hold the same raw value in both numbers.
fn alike(one: &Number, other: &Number) -> bool {
    let place = |number: &Number| {
        let bits = number.bits.map(|bits| (bits.shift, bits.count));
        let Number { width, order, .. } = *number;
        (width, order, number.signed_at, number.float, bits)
    };
    place(one) == place(other)
}

/// Return whether a raw value is legal in both numbers of fields.
fn meet(one: (&Field, &Number), other: (&Field, &Number)) -> bool {
    for ((field, number), (two, there)) in [(one, other), (other, one)] {
        let own = [&field.choices, &number.choices];
        if let Some(choices) = own.into_iter().find(|choices| !choices.is_empty()) {
            return choices.iter().any(|raw| two.allows(there, *raw));
        }
    }
    one.1.minimum.max(other.1.minimum) <= one.1.maximum.min(other.1.maximum)
}

/// Return whether no frame is a legal reply to both commands.
fn exclusive(protocol: &Protocol, one: usize, other: usize) -> bool {
    let reply = |command: usize| {
        let command = protocol.table.commands().get(command);
        command.map_or(&[][..], |command| &command.reply)
    };
    let (one, other) = (reply(one), reply(other));
    // A text has no constants.
    let framed = !one.is_empty() && !other.is_empty();
    framed
        && one
            .iter()
            .all(|one| other.iter().all(|other| exclude(one, other)))
}

/// Return whether a reply of one address can belong to both requests.
fn repliers_meet(one: Replier, other: Replier) -> bool {
    let all = |replier| matches!(replier, Replier::Anybody | Replier::Somebody);
    one == other || all(one) || all(other)
}

/// Return whether no reply to one request can be mistaken for a reply to the other.
pub(super) fn replies_differ(protocol: &Protocol, one: &Request, other: &Request) -> bool {
    let Some((_, facts)) = protocol.command(other.command) else {
        return false;
    };
    let id = |command| protocol.command(command).map(|(record, _)| record.id);
    let ids_differ = id(one.command) != id(other.command);
    let has_id = protocol.table.frame().layout.reply_has_id;
    if (has_id && ids_differ) || !repliers_meet(one.replier, other.replier) {
        return true;
    }
    if one.command != other.command {
        return exclusive(protocol, one.command, other.command);
    }
    let differs = |name: &str| {
        let values = one.argument(name).zip(other.argument(name));
        values.is_some_and(|(one, other)| !same(one, other))
    };
    // Older firmware leaves the repeated argument out, so every variant must tell them apart.
    let tells = |variant: &Vec<Named>| {
        let mut fields = variant.iter();
        fields.any(|named| named.echo && differs(&named.name))
    };
    !facts.reply.is_empty() && facts.reply.iter().all(tells)
}
