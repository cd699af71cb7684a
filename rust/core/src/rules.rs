//! Decides whether bytes begin with a legal frame; framer and decoder share this check.

use crate::direction::Direction;
use crate::frame::{Frame, FrameFormat, Layout};
use crate::legal::{Heading, Legal};
use crate::message::{Command, VariantId};
use crate::reason::Reason;

/// The verdict on the bytes at a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict<'a> {
    /// A legal frame.
    Frame(Frame<'a>),
    /// No frame starts there, whatever bytes follow.
    Rejected(Reason),
    /// More bytes could still make it a frame.
    Waits,
}

/// The LEN and the id of a candidate.
#[derive(Clone, Copy)]
pub(crate) struct Claim {
    pub(crate) length: u16,
    pub(crate) id: u16,
}

/// The legal frames, and whether ids that the table lacks are accepted.
#[derive(Clone, Debug)]
pub struct Rules {
    frame: FrameFormat,
    legal: Legal,
    /// Whether frames are `h h LEN id`, and LEN counts all bytes after itself, as in nearly all
    /// formats.
    plain: bool,
    /// The header of a plain format.
    first_two: [u8; 2],
    lacks_ids: bool,
}

impl Rules {
    /// Return the rules for these directions; earlier ones take precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        Self {
            frame: frame.clone(),
            legal: Legal::new(frame, commands, all),
            plain: frame.plain(),
            lacks_ids: !all.iter().any(|direction| frame.has_id(*direction)),
            first_two: frame.header.first_chunk().copied().unwrap_or_default(),
        }
    }

    /// Return the same rules, but accept an id that the table lacks with any LEN up to the
    /// edition's maximum: for sniffing unknown firmware.
    #[must_use]
    pub fn accepting_unknown(self) -> Self {
        let most = u16::try_from(self.frame.maximum_length).unwrap_or_default();
        let least = self.frame.length(0, Direction::Request);
        let legal = self
            .legal
            .permissive(u16::try_from(least).unwrap_or(u16::MAX), most);
        Self { legal, ..self }
    }

    /// Return the messages that a frame can be, in order of precedence; empty if the table lacks
    /// its id.
    #[must_use]
    pub fn variants(&self, frame: Frame<'_>) -> &[VariantId] {
        self.legal.variants(frame.length(), frame.id())
    }

    /// Return the messages that a candidate can be.
    pub(crate) fn claimed(&self, claim: Claim) -> &[VariantId] {
        self.legal.variants(claim.length, claim.id)
    }

    /// Return whether no frame carries a command id.
    pub(crate) fn lacks_ids(&self) -> bool {
        self.lacks_ids
    }

    pub(crate) fn legal(&self) -> &Legal {
        &self.legal
    }

    /// Return the header, if LEN and id directly follow its two bytes and LEN counts all bytes
    /// after itself.
    pub(crate) fn plain_header(&self) -> Option<[u8; 2]> {
        self.plain.then_some(self.first_two)
    }

    pub(crate) fn frame(&self) -> &FrameFormat {
        &self.frame
    }

    /// Return the size of the longest legal frame.
    #[must_use]
    pub fn longest(&self) -> usize {
        let most = self.legal.lengths().map_or(0, |(_, most)| most);
        let Layout {
            length,
            id,
            overhead,
            ..
        } = self.frame.layout;
        length.end().max(id.end()).max(overhead + usize::from(most))
    }

    /// Decide whether `rest` begins with a legal frame. For any bytes, this takes no longer than
    /// reading the longest frame once.
    #[inline]
    #[must_use]
    pub fn validate<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        // The fast path for most positions: the same as `validate_stepwise`, with four bytes at
        // once.
        if let Some(&[first, second, length, id]) = rest.first_chunk()
            && self.plain
        {
            return if [first, second] == self.first_two {
                self.validate_body(rest, length, id)
            } else {
                Verdict::Rejected(Reason::NoHeader)
            };
        }
        self.validate_stepwise(rest)
    }

    #[inline(never)]
    fn validate_stepwise<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        let claim = match self.claim(rest) {
            Err(reason) => return Verdict::Rejected(reason),
            Ok(None) => return Verdict::Waits,
            Ok(Some(claim)) => claim,
        };
        let Claim { length, id } = claim;
        match self.legal.wide_heading(length, id) {
            Heading::Rejected(reason) => Verdict::Rejected(reason),
            _ => self.validate_rest(rest, self.frame.layout.overhead, claim),
        }
    }

    /// Return the LEN and the id of a candidate; `None` if they have not arrived yet. The parts are
    /// validated in wire order, each as soon as its last byte has arrived.
    pub(crate) fn claim(&self, rest: &[u8]) -> Result<Option<Claim>, Reason> {
        let header = self.frame.header.iter().zip(rest);
        if header.into_iter().any(|(byte, given)| byte != given) {
            return Err(Reason::NoHeader);
        }
        let Layout {
            length,
            id,
            address_at,
            ..
        } = self.frame.layout;
        let (length_read, id_read) = (length.read(rest), id.read(rest));
        let address = address_at.and_then(|at| Some((at, rest.get(at)?)));
        let bad_address = address
            .filter(|(_, address)| !self.frame.addresses.contains(address))
            .map(|(at, _)| (at, Reason::BadAddress));
        let bad_length = length_read
            .filter(|read| !self.legal.is_length(*read))
            .map(|_| (length.at, Reason::BadLength));
        // If the id follows LEN, the caller validates both together.
        let bad_id = id_read
            .filter(|read| id.at < length.at && !self.legal.is_id(*read))
            .map(|_| (id.at, Reason::UnknownId));
        let first = [bad_address, bad_length, bad_id]
            .into_iter()
            .flatten()
            .min_by_key(|(at, _)| *at);
        if let Some((_, reason)) = first {
            return Err(reason);
        }
        Ok(length_read
            .zip(id_read)
            .map(|(length, id)| Claim { length, id }))
    }

    /// Validate a candidate of a plain format; `h h LEN` precede the id.
    #[inline]
    fn validate_body<'a>(&self, rest: &'a [u8], length: u8, id: u8) -> Verdict<'a> {
        if let Heading::Rejected(reason) = self.legal.heading(length, id) {
            return Verdict::Rejected(reason);
        }
        let (length, id) = (u16::from(length), u16::from(id));
        self.validate_rest(rest, 3, Claim { length, id })
    }

    #[inline]
    fn validate_rest<'a>(&self, rest: &'a [u8], overhead: usize, claim: Claim) -> Verdict<'a> {
        let Claim { length, id } = claim;
        match rest.get(..overhead + usize::from(length)) {
            None => Verdict::Waits,
            Some(bytes) if self.frame.check.holds(bytes) => {
                Verdict::Frame(Frame::new(bytes, length, id))
            }
            Some(_) => Verdict::Rejected(Reason::BadCheck),
        }
    }
}
