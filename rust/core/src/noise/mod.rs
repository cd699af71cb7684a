//! Diagnoses noise: finds the class of each byte that belongs to no frame.
//!
//! Python's `cobotwire.diagnose` defines the classes and describes them. This module finds the
//! frequent ones, in noise that is complete, at the speed of a capture. Python finds the others.

mod cluster;
mod damaged;
mod firmware;
mod frames;
mod plain;
mod servo;

pub(crate) use cluster::{Cluster, reason};
pub(crate) use plain::fitting;
pub(crate) use servo::Packet;
pub use servo::{Expected, Instruction, Operand, ServoBus};

use std::sync::Arc;

use crate::direction::{Direction, Listening};
use crate::rules::Rules;
use crate::table::Table;
use damaged::Lengths;

/// A class of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Bytes in which nothing is found.
    Unrecognised,
    /// Bytes that look like a wrong baud rate.
    Garbage,
    /// NULs in a row, fewer than a reboot sends.
    Nuls,
    /// The firmware's `cmd_len error`.
    CommandError,
    /// A line of text.
    Text,
    /// Header and id of a command, without a legal frame.
    Damaged,
    /// A complete frame with an id that the edition lacks.
    Unlisted,
    /// A legal frame of the other direction.
    Opposite,
    /// A packet of the servo bus.
    Servo,
    /// A class that only Python knows.
    Other,
}

impl Kind {
    /// The classes that this module knows.
    pub const ALL: [Self; 9] = [
        Self::Unrecognised,
        Self::Garbage,
        Self::Nuls,
        Self::CommandError,
        Self::Text,
        Self::Damaged,
        Self::Unlisted,
        Self::Opposite,
        Self::Servo,
    ];

    /// Return the name of the class in the API.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Unrecognised => "unrecognised",
            Self::Garbage => "garbage",
            Self::Nuls => "nuls",
            Self::CommandError => "cmd-len-error",
            Self::Text => "text",
            Self::Damaged => "damaged-frame",
            Self::Unlisted => "unlisted-frame",
            Self::Opposite => "opposite-frame",
            Self::Servo => "servo",
            Self::Other => "other",
        }
    }

    /// Return the size of a full piece; longer noise of these classes is cut into pieces.
    fn piece(self) -> Option<usize> {
        match self {
            Self::Unrecognised | Self::Garbage => Some(plain::PIECE),
            Self::Nuls => Some(plain::NULS),
            Self::Text => Some(firmware::LINE),
            _ => None,
        }
    }
}

/// Noise that belongs together: the bytes of a cluster from `start` to before `end`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Finding {
    pub(crate) kind: Kind,
    pub(crate) start: usize,
    pub(crate) end: usize,
    /// Whether it is the next piece of the finding before it.
    pub(crate) continued: bool,
}

/// A finding that starts at a position: its class and its end.
type Verdict = Option<(Kind, usize)>;

/// Diagnoses the noise of a stream.
#[derive(Clone)]
pub(crate) struct Diagnosis {
    /// The rules of the stream, which tell why a byte is noise.
    rules: Rules,
    /// The rules of the directions that the stream listens to, with the ids of the table only.
    listed: Rules,
    /// The rules of the direction that the stream does not listen to.
    other: Option<Rules>,
    /// The rules that accept any id.
    any: Rules,
    lengths: Lengths,
    bus: Arc<ServoBus>,
    /// What can start with each byte, plain noise excepted: a sum of `FRAME`, `PACKET`, `NUL`,
    /// `TEXT`.
    starts: Box<[u8; 256]>,
}

const FRAME: u8 = 1;
const PACKET: u8 = 2;
const NUL: u8 = 4;
const TEXT: u8 = 8;

impl Diagnosis {
    pub(crate) fn new(
        table: &Table,
        listening: Listening,
        rules: Rules,
        bus: Arc<ServoBus>,
    ) -> Self {
        let listed = table.rules(listening).clone();
        let other = match listening {
            Listening::To(Direction::Request) => Some(Direction::Reply),
            Listening::To(Direction::Reply) => Some(Direction::Request),
            Listening::Both => None,
        };
        let header = table.frame().header.first().copied().unwrap_or_default();
        let mut starts = Box::new([0; 256]);
        for (byte, all) in (0..=u8::MAX).zip(starts.iter_mut()) {
            let can = |is: bool, start: u8| if is { start } else { 0 };
            *all = can(byte == header, FRAME)
                | can(byte == bus.first(), PACKET)
                | can(byte == 0, NUL)
                | can(firmware::readable(byte), TEXT);
        }
        Self {
            rules,
            other: other.map(|way| table.rules(Listening::To(way)).clone()),
            any: listed.clone().accepting_unknown(),
            listed,
            lengths: Lengths::new(table),
            bus,
            starts,
        }
    }

    /// Return the id of the bytes that start like a frame; `None` if they end before the id.
    pub(crate) fn id(&self, cluster: &Cluster<'_>, at: usize) -> Option<u16> {
        self.heading(cluster.rest(at)).map(|(_, id)| id)
    }

    /// Find the classes of all bytes of a cluster. Return false if Python must find one of them.
    pub(crate) fn run(&self, cluster: &Cluster<'_>, findings: &mut Vec<Finding>) -> bool {
        findings.clear();
        let (mut at, mut in_text) = (0, false);
        let mut next = None;
        while at < cluster.data.len() {
            let first = next.take().or_else(|| self.recognise(cluster, at, in_text));
            let (kind, end) = first.unwrap_or_else(|| {
                let (end, after) = self.plain(cluster, at);
                next = after;
                (plain::classify(cluster, at, end), end)
            });
            if kind == Kind::Other || end <= at {
                return false;
            }
            in_text = matches!(kind, Kind::Text | Kind::CommandError);
            findings.push(Finding {
                kind,
                start: at,
                end,
                continued: continues(cluster, findings.last(), kind, at),
            });
            at = end;
        }
        true
    }

    /// Return the end of the plain noise at `start`, and what starts there.
    fn plain(&self, cluster: &Cluster<'_>, start: usize) -> (usize, Verdict) {
        let limit = cluster.segment_end(start).min(start + plain::PIECE);
        let rest = cluster.data.get(start + 1..limit).unwrap_or_default();
        for (place, byte) in (start + 1..).zip(rest) {
            if self.starts_with(*byte) != 0
                && let Some(found) = self.recognise(cluster, place, false)
            {
                return (place, Some(found));
            }
        }
        (limit, None)
    }

    /// Return what can start with a byte.
    #[inline]
    fn starts_with(&self, byte: u8) -> u8 {
        self.starts
            .get(usize::from(byte))
            .copied()
            .unwrap_or_default()
    }

    /// Return what starts at `at`; `after_text`: the finding before it is text.
    #[inline]
    fn recognise(&self, cluster: &Cluster<'_>, at: usize, after_text: bool) -> Verdict {
        let starts = self.starts_with(*cluster.data.get(at)?);
        let frame = starts & FRAME != 0;
        frame
            .then(|| {
                self.frame(cluster, at)
                    .or_else(|| self.damaged(cluster, at))
            })
            .flatten()
            .or_else(|| (starts & PACKET != 0).then(|| self.packet(cluster, at))?)
            .or_else(|| (starts & NUL != 0).then(|| plain::nuls(cluster, at))?)
            .or_else(|| (starts & TEXT != 0).then(|| firmware::line(cluster, at, after_text))?)
    }

    fn packet(&self, cluster: &Cluster<'_>, at: usize) -> Verdict {
        Some((Kind::Servo, self.bus.end(cluster.data, at)?))
    }
}

/// Return whether a finding continues the last one, which was cut at its limit.
fn continues(cluster: &Cluster<'_>, last: Option<&Finding>, kind: Kind, at: usize) -> bool {
    let Some(last) = last.filter(|last| last.kind == kind) else {
        return false;
    };
    let full = Some(last.end - last.start) == kind.piece();
    let ended = at > 0 && cluster.data.get(at - 1) == Some(&b'\n');
    full && !ended && !cluster.is_mark(at)
}
