//! Whether a frame stands at the start of some bytes: the one rule of framer and decoder.

use crate::error::Reason;
use crate::frame::{Frame, FrameFormat};
use crate::legal::{Form, Heading, Legal};
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
    legal: Legal,
    /// Whether LEN and id stand right behind the header, as in nearly all formats.
    plain: bool,
}

impl Rules {
    /// The rules for listening to these directions; earlier ones have precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        Self {
            frame: frame.clone(),
            legal: Legal::new(frame, commands, all),
            plain: frame.addresses.is_empty(),
        }
    }

    /// The same, but an id that the table lacks is a frame with any LEN up to the edition's
    /// maximum: for sniffing unknown firmware.
    #[must_use]
    pub fn accepting_unknown(self) -> Self {
        let most = usize::try_from(self.frame.maximum_length.min(255)).unwrap_or_default();
        let legal = self.legal.believing(self.frame.length(0), most);
        Self { legal, ..self }
    }

    /// Which messages a frame can be, those with precedence first; none if the table lacks its id.
    #[must_use]
    pub fn forms(&self, frame: Frame<'_>) -> &[Form] {
        self.legal.forms(frame.length(), frame.id())
    }

    /// The same of a frame that is not yet known to be one.
    pub(crate) fn claimed(&self, claim: Claim) -> &[Form] {
        self.legal.forms(claim.length, claim.id)
    }

    pub(crate) fn legal(&self) -> &Legal {
        &self.legal
    }

    /// Whether LEN and id stand right behind the header.
    pub(crate) fn plain(&self) -> bool {
        self.plain
    }

    pub(crate) fn frame(&self) -> &FrameFormat {
        &self.frame
    }

    /// Bytes of the longest frame that can stand.
    #[must_use]
    pub fn longest(&self) -> usize {
        let most = self.legal.lengths().map_or(0, |(_, most)| most);
        self.frame.overhead() + usize::from(most)
    }

    /// Whether a frame stands at the start of `rest`. Takes no longer than reading the longest
    /// frame once, whatever the bytes.
    #[inline]
    #[must_use]
    pub fn judge<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        // The same as below in one look at four bytes, for the bulk of all bytes.
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

    /// What a candidate there claims; `None`: so many bytes are not there yet.
    pub(crate) fn claim(&self, rest: &[u8]) -> Result<Option<Claim>, Reason> {
        let [first, second] = self.frame.header;
        match rest {
            [byte, ..] if *byte != first => Err(Reason::NoHeader),
            [_, byte, ..] if *byte != second => Err(Reason::NoHeader),
            [_, _, behind @ ..] if self.plain => self.claim_behind(behind),
            [_, _, address, ..] if !self.frame.addresses.contains(address) => {
                Err(Reason::BadAddress)
            }
            [_, _, _, behind @ ..] => self.claim_behind(behind),
            _ => Ok(None),
        }
    }

    fn claim_behind(&self, behind: &[u8]) -> Result<Option<Claim>, Reason> {
        match *behind {
            [length, ..] if !self.legal.is_length(length) => Err(Reason::BadLength),
            [length, id, ..] => Ok(Some(Claim { length, id })),
            _ => Ok(None),
        }
    }

    /// A candidate whose header and LEN are `start` bytes.
    #[inline]
    fn judge_body<'a>(&self, rest: &'a [u8], start: usize, claim: Claim) -> Verdict<'a> {
        let Claim { length, id } = claim;
        if let Heading::Refuted(reason) = self.legal.heading(length, id) {
            return Verdict::Refuted(reason);
        }
        match rest.get(..start + usize::from(length)) {
            None => Verdict::Waits,
            Some(bytes) if self.frame.check.holds(bytes, start) => {
                Verdict::Stands(Frame::new(bytes, length, id))
            }
            Some(_) => Verdict::Refuted(Reason::BadCheck),
        }
    }
}
