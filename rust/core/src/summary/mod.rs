//! Summarizes a whole stream: counts its messages and its noise, and optionally writes JSON lines.
//!
//! Frames and the frequent classes of noise never reach Python. The rest is handed over: noise of
//! other classes, and the first noise of each class. Python also writes the texts of errors and of
//! most noise, each once.

mod clusters;
mod firmware_text;
mod lines;
mod memo;
mod readings;
mod report;
mod repr;
mod servo_text;
mod values;

use std::sync::Arc;

pub use lines::{Described, Texts};
pub use readings::Names;

use crate::bulk::{Counted, Counts, Plans, Stream};
use crate::decode::DecodeError;
use crate::direction::{Direction, Listening};
use crate::noise::{Diagnosis, Expected, ServoBus};
use crate::reason::Reason;
use crate::rules::Rules;
use crate::table::Table;
use crate::tally::Tally;
use clusters::{Clusters, Span};
use lines::Writer;
use report::Report;

/// Receives everything that a summary reports besides counts, in the order of the stream.
pub trait Sink {
    /// Receive the lines of `size` bytes of the stream, from `offset` on. They hold no noise that
    /// was handed over.
    fn lines(&mut self, offset: u64, size: u64, lines: &[u8]);

    /// Receive noise to diagnose.
    fn noise(&mut self, offset: u64, data: &[u8], reason: Reason);

    /// Diagnose the noise received so far; `closed`: no later noise belongs to it. Servo packets in
    /// it update `expected`.
    fn diagnose(&mut self, closed: bool, expected: &mut Expected);

    /// Return what is wrong with bytes that are not a legal message.
    fn detail(&mut self, direction: Direction, error: DecodeError, data: &[u8]) -> String;

    /// Return text and facts of noise, as they are in a line of JSON.
    fn describe(&mut self, noise: &Described<'_>) -> String;
}

/// The amount of noise of one class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// The number of findings.
    pub count: u64,
    /// The number of their bytes.
    pub bytes: u64,
}

/// Summarizes one stream.
pub struct Summary {
    stream: Stream,
    counts: Counts,
    /// The bytes of the stream that are not reported yet.
    buffer: Vec<u8>,
    /// The position of the buffer's first byte in the stream.
    base: u64,
    clusters: Clusters,
    report: Report,
}

/// The bytes of a stream from `base` on.
#[derive(Clone, Copy)]
struct Bytes<'a> {
    bytes: &'a [u8],
    base: u64,
}

impl<'a> Bytes<'a> {
    fn from(self, place: u64) -> &'a [u8] {
        let at = usize::try_from(place.saturating_sub(self.base)).unwrap_or(usize::MAX);
        self.bytes.get(at..).unwrap_or_default()
    }

    fn span(self, (from, to): Span) -> &'a [u8] {
        let rest = self.from(from);
        rest.get(..(to - from) as usize).unwrap_or(rest)
    }
}

impl Summary {
    /// Return a summary of a new stream. With `texts` it writes lines.
    #[must_use]
    pub fn new(
        table: Arc<Table>,
        plans: Arc<Plans>,
        rules: Rules,
        listening: Listening,
        bus: Arc<ServoBus>,
        texts: Option<Texts>,
    ) -> Self {
        Self {
            stream: Stream::new(rules.clone()),
            counts: Counts::new(Arc::clone(&table), plans, texts.is_some()),
            buffer: Vec::new(),
            base: 0,
            clusters: Clusters::default(),
            report: Report::new(
                Diagnosis::new(&table, listening, rules.clone(), Arc::clone(&bus)),
                texts.map(|texts| Writer::new(texts, table, listening, bus)),
                rules,
            ),
        }
    }

    /// Return the counts of the framer.
    #[must_use]
    pub fn tally(&self) -> &Tally {
        self.stream.tally()
    }

    /// Return the counts of the messages, in the order of their first frames.
    #[must_use]
    pub fn counted(&self) -> Vec<Counted> {
        self.counts.counted()
    }

    /// Return how much noise was not handed over, by class, in the order of [`Kind::ALL`].
    #[must_use]
    pub fn extents(&self) -> &[Extent] {
        self.report.extents()
    }

    /// Feed bytes.
    pub fn feed(&mut self, chunk: &[u8], sink: &mut impl Sink) {
        self.buffer.extend_from_slice(chunk);
        self.stream.feed(chunk, &mut self.counts);
        self.settle(false, sink);
    }

    /// Report everything: no more bytes follow.
    pub fn flush(&mut self, sink: &mut impl Sink) {
        self.stream.flush(&mut self.counts);
        self.settle(true, sink);
    }

    /// Report everything that later bytes cannot change.
    fn settle(&mut self, at_end: bool, sink: &mut impl Sink) {
        let bytes = Bytes {
            bytes: &self.buffer,
            base: self.base,
        };
        let (clusters, report) = (&mut self.clusters, &mut self.report);
        report.add_frames(self.counts.frames.as_mut());
        let noise = self.stream.take_noise();
        for (from, size) in noise.offsets.into_iter().zip(noise.sizes) {
            if clusters.is_apart(from) {
                report.close(clusters, bytes, sink);
            }
            clusters.add(from, from + size);
        }
        let open = self.stream.open_noise();
        let done = self.base + (self.buffer.len() - self.stream.pending()) as u64;
        let next = open.map_or(done, |(from, _)| from);
        if at_end || clusters.is_apart(next) {
            report.close(clusters, bytes, sink);
        }
        if let Some(spans) = clusters.spill(open) {
            report.hand_over(&spans, false, bytes, sink);
        }
        let until = clusters.start().unwrap_or(next);
        report.write_frames(until, bytes, sink);
        report.end_lines(until, sink);
        self.buffer.drain(..(until - self.base) as usize);
        self.base = until;
    }
}
