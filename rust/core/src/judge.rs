//! Whether a frame stands at the start of some bytes: the one rule of framer and decoder.

use std::sync::Arc;

use crate::error::Reason;
use crate::frame::{Frame, OVERHEAD};
use crate::legal::{Form, Legal, has, mark};
use crate::table::{Command, Direction, FrameFormat};

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
        // An id and a footer at least: that is LEN 2.
        (2..=self.frame.maximum_length.min(255))
            .filter_map(|length| usize::try_from(length).ok())
            .for_each(|length| mark(&mut self.lengths, length));
        self
    }

    /// Which message a frame is; `None` if the table lacks its id.
    #[must_use]
    pub fn form(&self, frame: Frame<'_>) -> Option<Form> {
        self.legal.form(frame.id(), frame.length())
    }

    /// Bytes of the longest frame that can stand.
    #[must_use]
    pub fn longest(&self) -> usize {
        OVERHEAD
            + self
                .lengths
                .iter()
                .rposition(|legal| *legal)
                .unwrap_or_default()
    }

    /// Whether a frame stands at the start of `rest`. Takes the same time whatever the bytes.
    #[inline]
    #[must_use]
    pub fn judge<'a>(&self, rest: &'a [u8]) -> Verdict<'a> {
        let [first, second] = self.frame.header;
        match *rest {
            [byte, ..] if byte != first => Verdict::Refuted(Reason::NoHeader),
            [_, byte, ..] if byte != second => Verdict::Refuted(Reason::NoHeader),
            [_, _, length, ..] if !has(&self.lengths, length) => {
                Verdict::Refuted(Reason::BadLength)
            }
            [_, _, length, id, ..] => self.judge_body(rest, length, id),
            _ => Verdict::Waits,
        }
    }

    #[inline]
    fn judge_body<'a>(&self, rest: &'a [u8], length: u8, id: u8) -> Verdict<'a> {
        if !self.legal.has(id, length) {
            if has(&self.legal.ids, id) {
                return Verdict::Refuted(Reason::BadLength);
            }
            if !self.accept_unknown {
                return Verdict::Refuted(Reason::UnknownId);
            }
        }
        match rest.get(..OVERHEAD + usize::from(length)) {
            None => Verdict::Waits,
            Some(bytes) if bytes.last() == Some(&self.frame.footer) => {
                Verdict::Stands(Frame::new(bytes, id))
            }
            Some(_) => Verdict::Refuted(Reason::BadFooter),
        }
    }
}
