//! Whole frames in the noise: of the other direction, or with an id that the edition lacks.

use super::{Cluster, Diagnosis, Kind, Verdict};
use crate::rules;
use crate::rules::Rules;

impl Diagnosis {
    /// Recognise the whole frame at `at`.
    pub(super) fn frame(&self, cluster: &Cluster<'_>, at: usize) -> Verdict {
        let rest = cluster.rest(at);
        let (length, id) = self.heading(rest)?;
        let end = self.overhead() + usize::from(length);
        if end < self.head() || end > self.longest() {
            return None;
        }
        let data = rest.get(..end)?;
        if self
            .other
            .as_ref()
            .is_some_and(|other| is_frame(other, data))
        {
            return Some((Kind::Opposite, at + end));
        }
        let unlisted = !self.listed.legal().is_id(id) && is_frame(&self.any, data);
        unlisted.then_some((Kind::Unlisted, at + end))
    }

    /// Return LEN and id of a candidate; `None` if it has no header, or ends before them.
    pub(super) fn heading(&self, rest: &[u8]) -> Option<(u16, u16)> {
        let layout = self.rules.frame().layout;
        let candidate = rest.starts_with(&self.rules.frame().header);
        candidate.then_some((layout.length.read(rest)?, layout.id.read(rest)?))
    }

    /// Return whether a candidate ends before its id.
    pub(super) fn is_cut(&self, rest: &[u8]) -> bool {
        let header = &self.rules.frame().header;
        let size = header.len().min(rest.len());
        rest.len() < self.head() && header.get(..size) == rest.get(..size) && size > 0
    }

    /// Return the number of bytes up to the id.
    pub(super) fn head(&self) -> usize {
        let layout = self.rules.frame().layout;
        layout.id.end().max(layout.length.end())
    }

    pub(super) fn overhead(&self) -> usize {
        self.rules.frame().layout.overhead
    }

    pub(super) fn longest(&self) -> usize {
        self.overhead() + usize::try_from(self.rules.frame().maximum_length).unwrap_or_default()
    }
}

fn is_frame(rules: &Rules, data: &[u8]) -> bool {
    matches!(rules.validate(data), rules::Verdict::Frame(frame) if frame.bytes().len() == data.len())
}
