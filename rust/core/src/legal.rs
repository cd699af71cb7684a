//! Finds the legal variants of messages by id and LEN.

use std::sync::Arc;

use crate::frame::FrameFormat;
use crate::message::{Command, Direction, VariantId};
use crate::reason::Reason;

/// What a header with a certain LEN and id can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Heading {
    /// A message of this group.
    Group(u16),
    /// A frame with an id that the table lacks and that is accepted.
    Unknown,
    /// Not a frame.
    Refuted(Reason),
}

// Cells of `Headings` that are not the index of a group. There are fewer groups than cells.
pub(crate) const BAD_LENGTH: u16 = u16::MAX;
pub(crate) const UNKNOWN_ID: u16 = u16::MAX - 1;
/// The highest cell of a legal frame.
pub(crate) const BELIEVED: u16 = u16::MAX - 2;

/// What a header can be, by its LEN (the low byte of the index) and its id (the high byte).
pub(crate) type Headings = [u16; 0x1_0000];

/// The legal frames by id and LEN.
#[derive(Clone, Debug)]
pub(crate) struct Legal {
    /// Indexed by the bytes of a header. A stream uses few of its cache lines.
    headings: Arc<Headings>,
    /// The variants that share an id and a LEN; the first one that allows a frame's values counts.
    groups: Arc<[Vec<VariantId>]>,
    known: [bool; 256],
    /// The LENs of all frames. Any other LEN refutes a candidate before its id has come.
    lengths: [bool; 256],
}

impl Legal {
    /// Index the variants of the directions; earlier directions and commands take precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        let mut headings = [BAD_LENGTH; 0x1_0000];
        let mut known = [false; 256];
        let mut groups: Vec<Vec<VariantId>> = Vec::new();
        let mut lengths = [false; 256];
        let variants = all.iter().flat_map(|way| variants(frame, commands, *way));
        for (id, length, variant) in variants {
            mark(&mut lengths, length);
            mark(&mut known, usize::from(id));
            let Some(cell) = headings.get_mut(usize::from(id) << 8 | length) else {
                continue;
            };
            if let Some(group) = groups.get_mut(usize::from(*cell)) {
                group.push(variant);
            } else {
                *cell = u16::try_from(groups.len()).unwrap_or(BAD_LENGTH);
                groups.push(vec![variant]);
            }
        }
        fill_unknown(&mut headings, &known, &lengths, UNKNOWN_ID);
        Self {
            headings: Arc::new(headings),
            groups: groups.into(),
            known,
            lengths,
        }
    }

    /// Return the same index, but accept ids that the table lacks. Their LEN must be legal for
    /// another id, or lie between `least` and `most`.
    pub(crate) fn believing(mut self, least: usize, most: usize) -> Self {
        (least..=most).for_each(|length| mark(&mut self.lengths, length));
        let mut headings = *self.headings;
        fill_unknown(&mut headings, &self.known, &self.lengths, BELIEVED);
        self.headings = Arc::new(headings);
        self
    }

    /// Return what a header with that LEN and id can be.
    #[inline]
    pub(crate) fn heading(&self, length: u8, id: u8) -> Heading {
        let index = u16::from_le_bytes([length, id]);
        let cell = self.headings.get(usize::from(index)).copied();
        match cell.unwrap_or(BAD_LENGTH) {
            UNKNOWN_ID => Heading::Refuted(Reason::UnknownId),
            BAD_LENGTH => Heading::Refuted(Reason::BadLength),
            BELIEVED => Heading::Unknown,
            group => Heading::Group(group),
        }
    }

    /// Return all headings, for code that looks up many of them.
    pub(crate) fn headings(&self) -> &Headings {
        &self.headings
    }

    /// Return whether any frame has that LEN.
    #[inline]
    pub(crate) fn is_length(&self, length: u8) -> bool {
        let legal = self.lengths.get(usize::from(length));
        legal.copied().unwrap_or_default()
    }

    /// Return the smallest and the largest LEN of any frame; `None`: there are no frames.
    pub(crate) fn lengths(&self) -> Option<(u8, u8)> {
        let least = self.lengths.iter().position(|legal| *legal)?;
        let most = self.lengths.iter().rposition(|legal| *legal)?;
        Some((u8::try_from(least).ok()?, u8::try_from(most).ok()?))
    }

    /// Return all groups; a heading's number is the index here.
    pub(crate) fn groups(&self) -> &[Vec<VariantId>] {
        &self.groups
    }

    /// Return the variants with that LEN and id, in order of precedence.
    pub(crate) fn variants(&self, length: u8, id: u8) -> &[VariantId] {
        let Heading::Group(group) = self.heading(length, id) else {
            return &[];
        };
        let variants = self.groups.get(usize::from(group));
        variants.map_or(&[], Vec::as_slice)
    }
}

/// Return each variant of a direction, with its id and LEN.
fn variants(
    frame: &FrameFormat,
    commands: &[Command],
    direction: Direction,
) -> Vec<(u8, usize, VariantId)> {
    let mut all = Vec::new();
    for (command, record) in commands.iter().enumerate() {
        for (index, variant) in record.variants(direction).iter().enumerate() {
            let id = VariantId {
                direction,
                command,
                variant: index,
            };
            all.push((record.id, frame.length(variant.size()), id));
        }
    }
    all
}

/// Set the cells of ids that the table lacks: `cell` for a LEN of some frame, bad length for
/// others.
fn fill_unknown(headings: &mut Headings, known: &[bool; 256], lengths: &[bool; 256], cell: u16) {
    for (row, known) in headings.chunks_exact_mut(256).zip(known) {
        for (entry, legal) in row.iter_mut().zip(lengths).filter(|_| !known) {
            *entry = if *legal { cell } else { BAD_LENGTH };
        }
    }
}

fn mark(set: &mut [bool; 256], index: usize) {
    if let Some(entry) = set.get_mut(index) {
        *entry = true;
    }
}
