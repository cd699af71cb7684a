//! Judges whether a frame starts some bytes: the one legality check of framer and decoder.

use crate::frame::{Frame, FrameFormat};
use crate::legal::{Heading, Legal};
use crate::message::{Command, Direction, VariantId};
use crate::reason::Reason;

/// The verdict on the bytes at a position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict<'a> {
    /// A frame starts there.
    Frame(Frame<'a>),
    /// No frame starts there, whatever bytes follow.
    Refuted(Reason),
    /// More bytes could still make it a frame.
    Waits,
}

/// The LEN and the id of a candidate.
#[derive(Clone, Copy)]
pub(crate) struct Claim {
    pub(crate) length: u8,
    pub(crate) id: u8,
}

/// The legal frames, and whether ids that the table lacks are accepted.
#[derive(Clone, Debug)]
pub struct Rules {
    frame: FrameFormat,
    legal: Legal,
    /// Whether LEN and id directly follow the header, as in nearly all formats.
    plain: bool,
}

impl Rules {
    /// Return the rules for these directions; earlier ones take precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        Self {
            frame: frame.clone(),
            legal: Legal::new(frame, commands, all),
            plain: frame.addresses.is_empty(),
        }
    }

    /// Return the same rules, but accept an id that the table lacks with any LEN up to the
    /// edition's maximum: for sniffing unknown firmware.
    #[must_use]
    pub fn accepting_unknown(self) -> Self {
        let most = usize::try_from(self.frame.maximum_length.min(255)).unwrap_or_default();
        let legal = self.legal.believing(self.frame.length(0), most);
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

    pub(crate) fn legal(&self) -> &Legal {
        &self.legal
    }

    /// Return whether LEN and id directly follow the header.
    pub(crate) fn plain(&self) -> bool {
        self.plain
    }

    pub(crate) fn frame(&self) -> &FrameFormat {
        &self.frame
    }

    /// Return the size of the longest legal frame.
    #[must_use]
    pub fn longest(&self) -> usize {
        let most = self.legal.lengths().map_or(0, |(_, most)| most);
        self.frame.overhead() + usize::from(most)
    }

    /// Judge whether a frame starts `rest`. This takes no longer than reading the longest frame
    /// once, whatever the bytes.
    #[inline]
    #[must_use]
    pub fn judge<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        // The fast path for most positions: the same as `judge_stepwise`, with four bytes at once.
        if let Some(&[first, second, length, id]) = rest.first_chunk()
            && self.plain
        {
            return if [first, second] == self.frame.header {
                self.judge_body(rest, 3, Claim { length, id })
            } else {
                Verdict::Refuted(Reason::NoHeader)
            };
        }
        self.judge_stepwise(rest)
    }

    #[inline(never)]
    fn judge_stepwise<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        match self.claim(rest) {
            Err(reason) => Verdict::Refuted(reason),
            Ok(None) => Verdict::Waits,
            Ok(Some(claim)) => self.judge_body(rest, self.frame.overhead(), claim),
        }
    }

    /// Return the LEN and the id of a candidate; `None` if they have not come yet.
    pub(crate) fn claim(&self, rest: &[u8]) -> Result<Option<Claim>, Reason> {
        let [first, second] = self.frame.header;
        match rest {
            [byte, ..] if *byte != first => Err(Reason::NoHeader),
            [_, byte, ..] if *byte != second => Err(Reason::NoHeader),
            [_, _, after @ ..] if self.plain => self.claim_after(after),
            [_, _, address, ..] if !self.frame.addresses.contains(address) => {
                Err(Reason::BadAddress)
            }
            [_, _, _, after @ ..] => self.claim_after(after),
            _ => Ok(None),
        }
    }

    fn claim_after(&self, after: &[u8]) -> Result<Option<Claim>, Reason> {
        match *after {
            [length, ..] if !self.legal.is_length(length) => Err(Reason::BadLength),
            [length, id, ..] => Ok(Some(Claim { length, id })),
            _ => Ok(None),
        }
    }

    /// Judge a candidate; its header and LEN have `start` bytes.
    #[inline]
    fn judge_body<'a>(&self, rest: &'a [u8], start: usize, claim: Claim) -> Verdict<'a> {
        let Claim { length, id } = claim;
        if let Heading::Refuted(reason) = self.legal.heading(length, id) {
            return Verdict::Refuted(reason);
        }
        match rest.get(..start + usize::from(length)) {
            None => Verdict::Waits,
            Some(bytes) if self.frame.check.holds(bytes, start) => {
                Verdict::Frame(Frame::new(bytes, length, id))
            }
            Some(_) => Verdict::Refuted(Reason::BadCheck),
        }
    }
}
