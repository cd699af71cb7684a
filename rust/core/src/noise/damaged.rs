//! Damaged frames: header and id of a command, but no legal frame.

use std::sync::Arc;

use super::{Cluster, Diagnosis, FRAME, Kind, PACKET, TEXT, Verdict, firmware};
use crate::check::Check;
use crate::direction::Direction;
use crate::reason::Reason;
use crate::table::Table;

/// By how many bytes the size of a damaged frame may differ; the smallest differences first.
const SLACK: [isize; 5] = [0, -1, 1, -2, 2];
const MOST_SLACK: usize = 2;

/// Every LEN that is legal with an id, in any direction; by id, in ascending order.
#[derive(Clone)]
pub(super) struct Lengths(Arc<Vec<Vec<u16>>>);

impl Lengths {
    pub(super) fn new(table: &Table) -> Self {
        let mut all: Vec<Vec<u16>> = Vec::new();
        for command in table.commands() {
            let id = usize::from(command.id);
            all.resize(all.len().max(id + 1), Vec::new());
            let Some(lengths) = all.get_mut(id) else {
                continue;
            };
            for direction in [Direction::Request, Direction::Reply] {
                for variant in command.variants(direction) {
                    let length = table.frame().length(variant.size(), direction);
                    lengths.extend(u16::try_from(length));
                }
            }
        }
        for lengths in &mut all {
            lengths.sort_unstable();
            lengths.dedup();
        }
        Self(Arc::new(all))
    }

    fn of(&self, id: u16) -> Option<&[u16]> {
        let lengths = self.0.get(usize::from(id)).map(Vec::as_slice);
        lengths.filter(|lengths| !lengths.is_empty())
    }
}

impl Diagnosis {
    /// Recognise the remains of a frame at `at`.
    pub(super) fn damaged(&self, cluster: &Cluster<'_>, at: usize) -> Verdict {
        let rest = cluster.rest(at);
        if self.is_cut(rest) {
            let truncated = cluster.reason(&self.rules, at) == Reason::Truncated;
            return truncated.then_some((Kind::Damaged, at + rest.len()));
        }
        let lengths = self.damaged_lengths(cluster, at)?;
        Some((Kind::Damaged, at + self.extent(cluster, at, lengths)))
    }

    /// Return the legal LENs if a damaged frame starts at `at`.
    fn damaged_lengths(&self, cluster: &Cluster<'_>, at: usize) -> Option<&[u16]> {
        let (_, id) = self.heading(cluster.rest(at))?;
        let lengths = self.lengths.of(id)?;
        let reason = cluster.reason(&self.rules, at);
        let damage = matches!(
            reason,
            Reason::BadLength | Reason::BadCheck | Reason::Truncated
        );
        damage.then_some(lengths)
    }

    /// Return the size of the damaged frame at `at`: up to a footer near a legal end, or else as
    /// LEN states.
    fn extent(&self, cluster: &Cluster<'_>, at: usize, lengths: &[u16]) -> usize {
        let rest = cluster.rest(at);
        let reach = rest.len().min(self.longest() + MOST_SLACK);
        let mut places = 1..reach;
        let limit = places.find(|inside| self.stops(cluster, at + inside));
        let limit = limit.unwrap_or(reach);
        let data = rest.get(..limit).unwrap_or_default();
        let claimed = self.heading(rest).map_or(0, |(length, _)| length);
        let known = lengths.contains(&claimed);
        let first = known.then_some(claimed);
        let others = lengths.iter().copied().filter(|length| *length != claimed);
        for length in first.into_iter().chain(others) {
            let size = self.overhead() + usize::from(length);
            let ends = SLACK
                .iter()
                .filter_map(|extra| size.checked_add_signed(*extra));
            if let Some(end) = self.footer_at(data, ends) {
                return end;
            }
        }
        let longest = lengths.last().copied().unwrap_or_default();
        limit.min(self.overhead() + usize::from(if known { claimed } else { longest }))
    }

    /// Return the first of these ends that a footer precedes.
    fn footer_at(&self, data: &[u8], mut ends: impl Iterator<Item = usize>) -> Option<usize> {
        let footer = match &self.rules.frame().check {
            Check::Footer(footer) => std::slice::from_ref(footer),
            Check::Computed(computed) if computed.algorithm.is_none() => &computed.footer,
            Check::Computed(_) => return None,
        };
        ends.find(|end| {
            data.get(..*end)
                .is_some_and(|frame| frame.ends_with(footer))
        })
    }

    /// Return whether something else starts at `at`, inside a damaged frame.
    fn stops(&self, cluster: &Cluster<'_>, at: usize) -> bool {
        let rest = cluster.data.get(at..).unwrap_or_default();
        let starts = rest.first().map_or(0, |byte| self.starts_with(*byte));
        starts & PACKET != 0 && self.bus.end(cluster.data, at).is_some()
            || starts & TEXT != 0 && firmware::starts_message(rest)
            || starts & FRAME != 0 && self.damaged_lengths(cluster, at).is_some()
    }
}
