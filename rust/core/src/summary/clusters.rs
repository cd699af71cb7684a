//! Collects noise until no later noise can belong to it.

/// Noise may continue after frames of at most this many bytes together.
const REACH: u64 = 64;
/// Noise that is longer than this is handed over before its end is known.
const LIMIT: u64 = 1 << 20;

/// Consecutive bytes of noise: their start and their end.
pub(super) type Span = (u64, u64);

/// The noise that waits, because later noise may belong to it.
#[derive(Default)]
pub(super) struct Clusters {
    spans: Vec<Span>,
    /// Noise before this position was handed over, although more may belong to it.
    spilled: Option<u64>,
}

impl Clusters {
    /// Return whether noise at `next` is too far away to belong to the noise that waits.
    pub(super) fn is_apart(&self, next: u64) -> bool {
        self.spans.last().is_some_and(|(_, to)| next > to + REACH)
    }

    pub(super) fn add(&mut self, from: u64, to: u64) {
        let from = from.max(self.spilled.unwrap_or_default());
        match self.spans.last_mut() {
            Some((_, end)) if *end == from => *end = to,
            _ => self.spans.push((from, to)),
        }
    }

    /// Return where the noise that waits starts.
    pub(super) fn start(&self) -> Option<u64> {
        self.spans.first().map(|(from, _)| *from)
    }

    /// Return all noise that waits, and whether noise before it was handed over.
    pub(super) fn take(&mut self) -> Option<(Vec<Span>, bool)> {
        self.start()?;
        let spilled = self.spilled.take().is_some();
        Some((std::mem::take(&mut self.spans), spilled))
    }

    /// Return all noise if there is too much to wait for its end; `open` follows the spans.
    pub(super) fn spill(&mut self, open: Option<Span>) -> Option<Vec<Span>> {
        let size = |(from, to): &Span| to - from;
        let all = self.spans.iter().chain(&open).map(size).sum::<u64>();
        if all <= LIMIT {
            return None;
        }
        if let Some((from, to)) = open {
            self.add(from, to);
        }
        let (_, to) = *self.spans.last()?;
        self.spilled = Some(to);
        Some(std::mem::replace(&mut self.spans, vec![(to, to)]))
    }

    /// Store the memory of `spans` for later use.
    pub(super) fn reuse(&mut self, mut spans: Vec<Span>) {
        spans.clear();
        self.spans = spans;
    }
}
