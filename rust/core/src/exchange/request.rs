//! Requests that are validated and encoded, not yet sent.

use alloc::vec::Vec;

use super::matching::{Arguments, fields};
use super::{Addressee, Facts, Protocol, Replier, TextFault};
use crate::decode::{Decoded, decode};
use crate::direction::Direction;
use crate::encode::{Choice, encode};
use crate::field::Field;
use crate::given::Given;
use crate::message::{Command, Variant};
use crate::write::EncodeError;

/// An encoded request.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// The index of the command.
    pub command: usize,
    /// The frame.
    pub frame: Vec<u8>,
    /// The text that follows some frames.
    pub text: Vec<u8>,
    /// Who replies.
    pub replier: Replier,
    /// The arguments, with the values that a reply would repeat; empty if no reply repeats any.
    pub(super) arguments: Arguments,
}

/// Why a request was not encoded; `E` is the [`EncodeError`] of a value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RequestError<E> {
    /// The command has a reply, and nobody replies to the address.
    Unanswered,
    /// The command has a value for each joint of the arm, but the addressed device has only this
    /// number of joints.
    LacksJoints(usize),
    /// A value is not allowed, or there is no such command or address.
    Values(E),
    /// A text cannot be sent.
    Text(TextFault),
}

impl Request {
    /// Validate and encode a request. Default `address`: the first one of the frame format, if it
    /// has addresses. Default `variant`: the first one that allows the values. `texts` are the
    /// fields of a text after the frame.
    ///
    /// # Errors
    /// There is no such command or address, or an argument is not allowed.
    pub fn encode<V: Given>(
        protocol: &Protocol,
        command: usize,
        values: &V::Row,
        texts: &[&str],
        address: Option<u8>,
        variant: Option<usize>,
    ) -> Result<Self, RequestError<EncodeError<V>>> {
        let format = protocol.table.frame();
        let address = address.or(format.addresses.first().copied());
        let found = (protocol.table.commands().get(command)).zip(protocol.facts.get(command));
        let (record, facts) = found.ok_or(RequestError::Values(EncodeError::VariantId))?;
        let replier = protocol.replier(address);
        if replier == Replier::Nobody && facts.requires_reply() {
            return Err(RequestError::Unanswered);
        }
        if let Some(joints) = protocol.lacks_joints(address, record) {
            return Err(RequestError::LacksJoints(joints));
        }
        let choice = Choice { variant, address };
        let frame = encode(format, record, Direction::Request, values, choice);
        let frame = frame.map_err(RequestError::Values)?;
        let form = facts.request_text.as_ref();
        let text = form.map(|form| form.encode(texts)).transpose();
        let text = text.map_err(RequestError::Text)?;
        // The arguments are decoded from the frame, since a reply repeats the rounded values.
        let repeats = text.is_none() && facts.can_repeat();
        let own = || decode(&protocol.table, Direction::Request, &frame, Some(command)).ok();
        let own = repeats.then(own).flatten();
        Ok(Self {
            arguments: own.map_or(Vec::new(), |own| arguments(facts, &own)),
            text: text.unwrap_or_default(),
            command,
            frame,
            replier,
        })
    }

    /// Return the request that a frame is; `None`: the protocol has no such request.
    #[must_use]
    pub fn from_frame(protocol: &Protocol, frame: &[u8]) -> Option<Self> {
        let decoded = decode(&protocol.table, Direction::Request, frame, None).ok()?;
        let command = decoded.variant.command;
        let facts = protocol.facts.get(command)?;
        Some(Self {
            command,
            frame: frame.into(),
            text: Vec::new(),
            replier: protocol.replier(decoded.address),
            arguments: arguments(facts, &decoded),
        })
    }
}

/// Return the arguments of a request that a reply may repeat.
fn arguments(facts: &Facts, decoded: &Decoded) -> Arguments {
    let names = facts.request.get(decoded.variant.variant);
    let names = names.filter(|_| facts.can_repeat());
    let found = fields(names.map_or(&[], Vec::as_slice), decoded);
    let owned = found.map(|(named, value)| (named.name.clone(), value.to_vec()));
    owned.collect()
}

impl Facts {
    /// Return whether the protocol requires a reply.
    #[must_use]
    pub fn requires_reply(&self) -> bool {
        (!self.reply.is_empty() && !self.ack && !self.event) || self.text.is_some()
    }

    /// Return whether a reply can repeat arguments of its request.
    fn can_repeat(&self) -> bool {
        self.reply.iter().flatten().any(|named| named.echo)
    }
}

impl Protocol {
    /// Return whether a command with this id requires a reply.
    pub(super) fn has_query(&self, id: Option<u16>) -> bool {
        let mut facts = self.facts.iter().enumerate();
        facts.any(|(command, facts)| self.id(command) == id && facts.requires_reply())
    }

    /// Return who replies to a request to an address.
    fn replier(&self, address: Option<u8>) -> Replier {
        let known = self.addressee(address).map(|known| known.replier);
        known.unwrap_or(address.map_or(Replier::Unaddressed, Replier::Address))
    }

    fn addressee(&self, address: Option<u8>) -> Option<&Addressee> {
        let mut known = self.addresses.iter();
        known.find(|known| Some(known.value) == address)
    }

    /// Return the number of joints of an address's device if a command has a value for each joint
    /// of the protocol, and the device has fewer.
    fn lacks_joints(&self, address: Option<u8>, command: &Command) -> Option<usize> {
        let joints = self.addressee(address)?.joints;
        let variants = command.request.iter().chain(&command.reply);
        let is_row = |field: &Field| field.many && field.numbers(0).len() == self.joints;
        let mut fields = variants.flat_map(Variant::fields);
        (joints != 0 && joints != self.joints && fields.any(is_row)).then_some(joints)
    }
}
