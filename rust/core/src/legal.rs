//! Which frames are legal: id and LEN, to the form of the message.

use crate::frame::FrameFormat;
use crate::table::{Command, Direction};

/// One form of one command's message in one direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// The direction.
    pub direction: Direction,
    /// Index of the command in the table.
    pub command: usize,
    /// Index of the form among the command's in that direction.
    pub layout: usize,
}

/// The legal frames by id and LEN.
#[derive(Debug)]
pub(crate) struct Legal {
    /// A row for each id, a cell for each LEN up to the longest: 0, or 1 + the index of a
    /// group.
    /// Two bytes a cell and short rows, so that what a stream uses of it stays in the cache.
    cells: Vec<u16>,
    stride: usize,
    /// The forms that share an id and a LEN: their values tell them apart, tried in this order.
    groups: Vec<Vec<Form>>,
    pub(crate) ids: [bool; 256],
    pub(crate) lengths: [bool; 256],
}

impl Legal {
    /// The index of the directions' forms; earlier directions and commands have precedence.
    pub(crate) fn new(frame: &FrameFormat, commands: &[Command], all: &[Direction]) -> Self {
        let forms: Vec<(u8, usize, Form)> = all
            .iter()
            .flat_map(|direction| forms(frame, commands, *direction))
            .collect();
        let longest = forms.iter().map(|(_, length, _)| *length).max();
        let stride = longest.map_or(0, |length| length + 1);
        let mut legal = Self {
            cells: vec![0; 256 * stride],
            stride,
            groups: Vec::new(),
            ids: [false; 256],
            lengths: [false; 256],
        };
        for (id, length, form) in forms {
            legal.add(id, length, form);
        }
        legal
    }

    fn add(&mut self, id: u8, length: usize, form: Form) {
        mark(&mut self.ids, usize::from(id));
        mark(&mut self.lengths, length);
        let Some(cell) = self.cells.get_mut(usize::from(id) * self.stride + length) else {
            return;
        };
        if let Some(group) = self.groups.get_mut(usize::from(*cell).wrapping_sub(1)) {
            group.push(form);
            return;
        }
        self.groups.push(vec![form]);
        // There are fewer groups than ids x LENs, which is what the cell can count.
        *cell = u16::try_from(self.groups.len()).unwrap_or_default();
    }

    /// The forms with that id and LEN, those with precedence first.
    pub(crate) fn forms(&self, id: u8, length: u8) -> &[Form] {
        self.groups
            .get(usize::from(self.cell(id, length)).wrapping_sub(1))
            .map_or(&[], Vec::as_slice)
    }

    /// Whether there is one.
    #[inline]
    pub(crate) fn has(&self, id: u8, length: u8) -> bool {
        self.cell(id, length) != 0
    }

    #[inline]
    fn cell(&self, id: u8, length: u8) -> u16 {
        let column = usize::from(length);
        if column >= self.stride {
            return 0;
        }
        self.cells
            .get(usize::from(id) * self.stride + column)
            .copied()
            .unwrap_or_default()
    }
}

fn forms(
    frame: &FrameFormat,
    commands: &[Command],
    direction: Direction,
) -> impl Iterator<Item = (u8, usize, Form)> {
    commands
        .iter()
        .enumerate()
        .flat_map(move |(command, record)| {
            record
                .layouts(direction)
                .iter()
                .enumerate()
                .map(move |(layout, form)| {
                    (
                        record.id,
                        frame.length(form.size()),
                        Form {
                            direction,
                            command,
                            layout,
                        },
                    )
                })
        })
}

pub(crate) fn mark(set: &mut [bool; 256], index: usize) {
    if let Some(entry) = set.get_mut(index) {
        *entry = true;
    }
}

pub(crate) fn has(set: &[bool; 256], index: u8) -> bool {
    set.get(usize::from(index)).copied().unwrap_or_default()
}
