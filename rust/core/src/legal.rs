//! Which frames are legal: id and LEN, to the forms of the messages.

use std::sync::Arc;

use crate::error::Reason;
use crate::frame::FrameFormat;
use crate::table::{Command, Direction};

/// One form of one command's message in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Form {
    /// The direction.
    pub direction: Direction,
    /// Index of the command in the table.
    pub command: usize,
    /// Index of the form among the command's in that direction.
    pub layout: usize,
}

/// What a header with some LEN and id claims to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Heading {
    /// A message of this group.
    Group(u16),
    /// An id that the table lacks, and that is believed.
    Unknown,
    /// None.
    Refuted(Reason),
}

// Cells of the table below that are no group. There are fewer groups than ids x LENs.
pub(crate) const BAD_LENGTH: u16 = u16::MAX;
pub(crate) const UNKNOWN_ID: u16 = u16::MAX - 1;
/// The highest cell that says that a frame may stand.
pub(crate) const BELIEVED: u16 = u16::MAX - 2;

/// What a header claims, by its LEN (the low byte of the index) and its id (the high byte).
pub(crate) type Headings = [u16; 0x1_0000];

/// The legal frames by id and LEN.
#[derive(Clone, Debug)]
pub(crate) struct Legal {
    /// The bytes of a header are the index. A stream uses few of its cache lines.
    headings: Arc<Headings>,
    /// The forms that share an id and a LEN: their values tell them apart, tried in this order.
    groups: Arc<[Vec<Form>]>,
    known: [bool; 256],
    /// The LENs of any frame: they refute a candidate before its id is there.
    lengths: [bool; 256],
}

impl Legal {
    /// The index of the directions' forms; earlier directions and commands have precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        let mut headings = [BAD_LENGTH; 0x1_0000];
        let mut known = [false; 256];
        let mut groups: Vec<Vec<Form>> = Vec::new();
        let mut lengths = [false; 256];
        let forms = all.iter().flat_map(|way| forms(frame, commands, *way));
        for (id, length, form) in forms {
            mark(&mut lengths, length);
            mark(&mut known, usize::from(id));
            let Some(cell) = headings.get_mut(usize::from(id) << 8 | length) else {
                continue;
            };
            if let Some(group) = groups.get_mut(usize::from(*cell)) {
                group.push(form);
            } else {
                *cell = u16::try_from(groups.len()).unwrap_or(BAD_LENGTH);
                groups.push(vec![form]);
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

    /// The same, but an id that it lacks is a frame with any LEN that is legal for others or
    /// between `least` and `most`.
    pub(crate) fn believing(mut self, least: usize, most: usize) -> Self {
        (least..=most).for_each(|length| mark(&mut self.lengths, length));
        let mut headings = *self.headings;
        fill_unknown(&mut headings, &self.known, &self.lengths, BELIEVED);
        self.headings = Arc::new(headings);
        self
    }

    /// What a header with that LEN and id claims to be.
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

    /// All headings, for those who look at many.
    pub(crate) fn headings(&self) -> &Headings {
        &self.headings
    }

    /// Whether any frame has that LEN.
    #[inline]
    pub(crate) fn is_length(&self, length: u8) -> bool {
        let legal = self.lengths.get(usize::from(length));
        legal.copied().unwrap_or_default()
    }

    /// The smallest and the largest LEN of any frame; `None`: there are no frames.
    pub(crate) fn lengths(&self) -> Option<(u8, u8)> {
        let least = self.lengths.iter().position(|legal| *legal)?;
        let most = self.lengths.iter().rposition(|legal| *legal)?;
        Some((u8::try_from(least).ok()?, u8::try_from(most).ok()?))
    }

    /// All groups; a heading's number is the index here.
    pub(crate) fn groups(&self) -> &[Vec<Form>] {
        &self.groups
    }

    /// The forms with that LEN and id, those with precedence first.
    pub(crate) fn forms(&self, length: u8, id: u8) -> &[Form] {
        let Heading::Group(group) = self.heading(length, id) else {
            return &[];
        };
        let forms = self.groups.get(usize::from(group));
        forms.map_or(&[], Vec::as_slice)
    }
}

/// Each form of a direction, with its id and LEN.
fn forms(
    frame: &FrameFormat,
    commands: &[Command],
    direction: Direction,
) -> Vec<(u8, usize, Form)> {
    let mut all = Vec::new();
    for (command, record) in commands.iter().enumerate() {
        for (layout, form) in record.layouts(direction).iter().enumerate() {
            let form_of = Form {
                direction,
                command,
                layout,
            };
            all.push((record.id, frame.length(form.size()), form_of));
        }
    }
    all
}

/// What the ids that the table lacks are, with a LEN of some frame; with another, LEN refutes it.
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
