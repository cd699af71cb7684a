//! Finds the legal variants of messages by id and LEN.

#[cfg(not(feature = "std"))]
use alloc::collections::BTreeMap as Map;
use alloc::sync::Arc;
use alloc::vec::Vec;
#[cfg(feature = "std")]
use std::collections::HashMap as Map;

use crate::direction::Direction;
use crate::frame::FrameFormat;
use crate::message::{Command, VariantId};
use crate::reason::Reason;

/// What a header with a certain LEN and id can be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Heading {
    /// A message of this group.
    Group(u16),
    /// A frame with an id that the table lacks and that is accepted.
    Unknown,
    /// Not a frame.
    Rejected(Reason),
}

// Cells of `Headings` that are not the index of a group. There are fewer groups than cells.
pub(crate) const BAD_LENGTH: u16 = u16::MAX;
pub(crate) const UNKNOWN_ID: u16 = u16::MAX - 1;
/// The number of groups that bulk reading tells apart.
const GROUPS: u16 = 0x7FFD;
/// The cell of a frame with an unknown id that is accepted: the highest cell of a legal frame.
pub(crate) const ACCEPTED: u16 = u16::MAX - 2;

/// What a header can be, by its LEN (the low byte of the index) and its id (the high byte).
pub(crate) type Headings = [u16; 0x1_0000];

/// The legal frames by id and LEN.
#[derive(Clone, Debug)]
pub(crate) struct Legal {
    /// Indexed by the bytes of a header. A stream uses few of its cache lines.
    headings: Arc<Headings>,
    /// The groups of frames with a LEN or an id above 255, by LEN and id.
    wide: Arc<Map<(u16, u16), u16>>,
    /// The groups of frames without an id, by LEN.
    without_id: Arc<Map<u16, u16>>,
    /// The variants that share an id and a LEN; a frame is the first of them that allows its
    /// values.
    groups: Arc<[Vec<VariantId>]>,
    known: Arc<Set>,
    /// The LENs of all frames. Any other LEN rejects a candidate before its id has come.
    lengths: Arc<Set>,
    /// Whether ids that the table lacks are accepted.
    permissive: bool,
}

impl Legal {
    /// Index the variants of the directions; earlier directions and commands take precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        let mut groups = Groups::default();
        let (mut known, mut lengths) = (Set::default(), Set::default());
        for (id, length, variant) in all.iter().flat_map(|way| variants(frame, commands, *way)) {
            lengths.add(length);
            match id {
                Some(id) => known.add(id),
                None => known.add_all(),
            }
            groups.add(length, id, variant);
        }
        let mut headings = [BAD_LENGTH; 0x1_0000];
        let mut wide = Map::new();
        for ((length, id), group) in groups.named {
            match (u8::try_from(length), u8::try_from(id)) {
                (Ok(length), Ok(id)) => {
                    if let Some(cell) = headings.get_mut(usize::from(cell_of(length, id))) {
                        *cell = group;
                    }
                }
                _ => {
                    wide.insert((length, id), group);
                }
            }
        }
        for (length, group) in &groups.without_id {
            let Ok(length) = u8::try_from(*length) else {
                continue;
            };
            for id in 0..=u8::MAX {
                let cell = headings.get_mut(usize::from(cell_of(length, id)));
                if let Some(cell) = cell.filter(|cell| **cell == BAD_LENGTH) {
                    *cell = *group;
                }
            }
        }
        fill_unknown(&mut headings, &known, &lengths, UNKNOWN_ID);
        Self {
            headings: Arc::new(headings),
            wide: Arc::new(wide),
            without_id: Arc::new(groups.without_id),
            groups: groups.variants.into(),
            known: Arc::new(known),
            lengths: Arc::new(lengths),
            permissive: false,
        }
    }

    /// Accept frames with ids that the table lacks, if their LEN is legal for another id or lies
    /// between `least` and `most`.
    pub(crate) fn permissive(mut self, least: u16, most: u16) -> Self {
        let mut lengths = Set::clone(&self.lengths);
        (least..=most).for_each(|length| lengths.add(length));
        let mut headings = *self.headings;
        fill_unknown(&mut headings, &self.known, &lengths, ACCEPTED);
        self.headings = Arc::new(headings);
        self.lengths = Arc::new(lengths);
        self.permissive = true;
        self
    }

    /// Return what a header with that LEN and id can be.
    #[inline]
    pub(crate) fn heading(&self, length: u8, id: u8) -> Heading {
        let cell = self.headings.get(usize::from(cell_of(length, id))).copied();
        heading(cell.unwrap_or(BAD_LENGTH))
    }

    /// Return what a header with a LEN and an id of any size can be.
    pub(crate) fn wide_heading(&self, length: u16, id: u16) -> Heading {
        if let (Ok(length), Ok(id)) = (u8::try_from(length), u8::try_from(id)) {
            return self.heading(length, id);
        }
        let group = self.wide.get(&(length, id));
        if let Some(group) = group.or_else(|| self.without_id.get(&length)) {
            return heading(*group);
        }
        if self.known.has(id) || !self.lengths.has(length) {
            heading(BAD_LENGTH)
        } else if self.permissive {
            Heading::Unknown
        } else {
            heading(UNKNOWN_ID)
        }
    }

    /// Return all headings, for code that looks up many of them.
    pub(crate) fn headings(&self) -> &Headings {
        &self.headings
    }

    /// Return whether any frame has that LEN.
    #[inline]
    pub(crate) fn is_length(&self, length: u16) -> bool {
        self.lengths.has(length)
    }

    /// Return whether any frame has that id, or unknown ids are accepted.
    pub(crate) fn is_id(&self, id: u16) -> bool {
        self.permissive || self.known.has(id)
    }

    /// Return the smallest and the largest LEN of any frame; `None`: there are no frames.
    pub(crate) fn lengths(&self) -> Option<(u16, u16)> {
        self.lengths.ends()
    }

    /// Return all groups; the number in a [`Heading::Group`] is the index of one.
    pub(crate) fn groups(&self) -> &[Vec<VariantId>] {
        &self.groups
    }

    /// Return the variants with that LEN and id, in order of precedence.
    pub(crate) fn variants(&self, length: u16, id: u16) -> &[VariantId] {
        let Heading::Group(group) = self.wide_heading(length, id) else {
            return &[];
        };
        let variants = self.groups.get(usize::from(group));
        variants.map_or(&[], Vec::as_slice)
    }
}

/// The index of the cell of a LEN and an id.
#[inline]
fn cell_of(length: u8, id: u8) -> u16 {
    u16::from_le_bytes([length, id])
}

#[inline]
fn heading(cell: u16) -> Heading {
    match cell {
        UNKNOWN_ID => Heading::Rejected(Reason::UnknownId),
        BAD_LENGTH => Heading::Rejected(Reason::BadLength),
        ACCEPTED => Heading::Unknown,
        group => Heading::Group(group),
    }
}

/// A set of numbers of 16 bits.
#[derive(Clone, Debug, Default)]
pub(crate) struct Set(Vec<bool>);

impl Set {
    fn add(&mut self, number: u16) {
        let index = usize::from(number);
        if self.0.len() <= index {
            self.0.resize(index + 1, false);
        }
        if let Some(entry) = self.0.get_mut(index) {
            *entry = true;
        }
    }

    fn add_all(&mut self) {
        self.0 = vec![true; 0x1_0000];
    }

    #[inline]
    fn has(&self, number: u16) -> bool {
        let entry = self.0.get(usize::from(number));
        entry.copied().unwrap_or_default()
    }

    fn ends(&self) -> Option<(u16, u16)> {
        let least = self.0.iter().position(|entry| *entry)?;
        let most = self.0.iter().rposition(|entry| *entry)?;
        Some((u16::try_from(least).ok()?, u16::try_from(most).ok()?))
    }
}

/// The groups while they are being collected.
#[derive(Default)]
struct Groups {
    named: Map<(u16, u16), u16>,
    without_id: Map<u16, u16>,
    variants: Vec<Vec<VariantId>>,
}

impl Groups {
    /// Add a variant. A variant without an id can match every id with its LEN.
    fn add(&mut self, length: u16, id: Option<u16>, variant: VariantId) {
        let Some(id) = id else {
            let named = self.named.iter().filter(|((of, _), _)| *of == length);
            let groups: Vec<u16> = named.map(|(_, group)| *group).collect();
            for group in groups {
                self.push(group, variant);
            }
            let known = self.without_id.get(&length).copied();
            let group = known.or_else(|| self.open());
            if let Some(group) = group {
                self.without_id.insert(length, group);
                self.push(group, variant);
            }
            return;
        };
        let known = self.named.get(&(length, id)).copied();
        if let Some(group) = known.or_else(|| self.open()) {
            self.named.insert((length, id), group);
            self.push(group, variant);
        }
    }

    /// Return a new group; `None` if there are too many.
    fn open(&mut self) -> Option<u16> {
        let group = u16::try_from(self.variants.len()).ok()?;
        (group < GROUPS).then(|| {
            self.variants.push(Vec::new());
            group
        })
    }

    fn push(&mut self, group: u16, variant: VariantId) {
        if let Some(variants) = self.variants.get_mut(usize::from(group)) {
            variants.push(variant);
        }
    }
}

/// Return each variant of a direction, with its id, if it has one, and its LEN.
fn variants(
    frame: &FrameFormat,
    commands: &[Command],
    direction: Direction,
) -> Vec<(Option<u16>, u16, VariantId)> {
    let mut all = Vec::new();
    for (command, record) in commands.iter().enumerate() {
        for (index, variant) in record.variants(direction).iter().enumerate() {
            let variant_id = VariantId {
                direction,
                command,
                variant: index,
            };
            let id = frame.has_id(direction).then_some(record.id);
            // LEN fits: Table::new checked that.
            let length = frame.length(variant.size(), direction);
            all.extend(u16::try_from(length).map(|length| (id, length, variant_id)));
        }
    }
    all
}

/// Set the cells of ids that the table lacks: `cell` for a LEN of some frame, bad length for
/// others.
fn fill_unknown(headings: &mut Headings, known: &Set, lengths: &Set, cell: u16) {
    for (id, row) in (0..=u16::MAX).zip(headings.chunks_exact_mut(256)) {
        if known.has(id) {
            continue;
        }
        for (length, entry) in (0..=u16::MAX).zip(row) {
            *entry = if lengths.has(length) {
                cell
            } else {
                BAD_LENGTH
            };
        }
    }
}
