//! Whether a frame stands at the start of some bytes: the one rule of framer and decoder.

use std::sync::Arc;

use crate::error::Reason;
use crate::frame::{Frame, FrameFormat};
use crate::legal::{Form, Legal, has, mark};
use crate::table::{Command, Direction};

/// What the bytes at a position are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict<'a> {
    /// A frame stands there.
    Stands(Frame<'a>),
    /// None does, and no further byte can change that.
    Refuted(Reason),
    /// More bytes could still make it a frame.
    Waits,
}

/// What a candidate says of itself, once so much of it is there.
#[derive(Clone, Copy)]
pub(crate) struct Claim {
    pub(crate) length: u8,
    pub(crate) id: u8,
}

/// The legal frames, and whether ids that the table lacks are believed.
#[derive(Clone, Debug)]
pub struct Rules {
    frame: FrameFormat,
    legal: Arc<Legal>,
    accept_unknown: bool,
    lengths: [bool; 256],
}

impl Rules {
    /// The rules for listening to these directions; earlier ones have precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        let legal = Legal::new(frame, commands, all);
        Self {
            frame: frame.clone(),
            lengths: legal.lengths,
            legal: Arc::new(legal),
            accept_unknown: false,
        }
    }

    /// The same, but an id that the table lacks is a frame with any LEN up to the edition's
    /// maximum: for sniffing unknown firmware.
    #[must_use]
    pub fn accepting_unknown(mut self) -> Self {
        self.accept_unknown = true;
        let most = usize::try_from(self.frame.maximum_length.min(255)).unwrap_or_default();
        (self.frame.length(0)..=most).for_each(|length| mark(&mut self.lengths, length));
        self
    }

    /// Which messages a frame can be, those with precedence first; none if the table lacks its id.
    #[must_use]
    pub fn forms(&self, frame: Frame<'_>) -> &[Form] {
        self.legal.forms(frame.id(), frame.length())
    }

    /// The same of a frame that is not yet known to be one.
    pub(crate) fn claimed(&self, claim: Claim) -> &[Form] {
        self.legal.forms(claim.id, claim.length)
    }

    /// Bytes of the longest frame that can stand.
    #[must_use]
    pub fn longest(&self) -> usize {
        let length = self.lengths.iter().rposition(|legal| *legal);
        self.frame.overhead() + length.unwrap_or_default()
    }

    /// Whether a frame stands at the start of `rest`. Takes no longer than reading the longest
    /// frame once, whatever the bytes.
    #[inline]
    #[must_use]
    pub fn judge<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        match self.claim(rest) {
            Err(reason) => Verdict::Refuted(reason),
            Ok(None) => Verdict::Waits,
            Ok(Some(claim)) => self.judge_body(rest, claim),
        }
    }

    /// What a candidate there claims; `None`: so many bytes are not there yet.
    #[inline]
    pub(crate) fn claim(&self, rest: &[u8]) -> Result<Option<Claim>, Reason> {
        let [first, second] = self.frame.header;
        match rest {
            [byte, ..] if *byte != first => Err(Reason::NoHeader),
            [_, byte, ..] if *byte != second => Err(Reason::NoHeader),
            [_, _, behind @ ..] if self.frame.addresses.is_empty() => self.claim_behind(behind),
            [_, _, address, ..] if !self.frame.addresses.contains(address) => {
                Err(Reason::BadAddress)
            }
            [_, _, _, behind @ ..] => self.claim_behind(behind),
            _ => Ok(None),
        }
    }

    #[inline]
    fn claim_behind(&self, behind: &[u8]) -> Result<Option<Claim>, Reason> {
        match *behind {
            [length, ..] if !has(&self.lengths, length) => Err(Reason::BadLength),
            [length, id, ..] => Ok(Some(Claim { length, id })),
            _ => Ok(None),
        }
    }

    #[inline]
    fn judge_body<'a>(&self, rest: &'a [u8], claim: Claim) -> Verdict<'a> {
        let Claim { length, id } = claim;
        if !self.legal.has(id, length) {
            if has(&self.legal.ids, id) {
                return Verdict::Refuted(Reason::BadLength);
            }
            if !self.accept_unknown {
                return Verdict::Refuted(Reason::UnknownId);
            }
        }
        match rest.get(..self.frame.overhead() + usize::from(length)) {
            None => Verdict::Waits,
            Some(bytes) if self.frame.check.holds(bytes, self.frame.overhead()) => {
                Verdict::Stands(Frame::new(bytes, length, id))
            }
            Some(_) => Verdict::Refuted(Reason::BadCheck),
        }
    }
}
