//! Surveys a whole stream: counts its messages and its noise, and writes lines of JSON if wanted.
//!
//! Legal messages and the frequent classes of noise never reach Python. The rest is handed over:
//! frames without a legal message, noise of other classes, and the first noise of each class.

mod clusters;
mod lines;
mod repr;

use std::sync::Arc;

pub use lines::Texts;

use crate::bulk::{Census, Counted, Plans, Stream};
use crate::direction::Listening;
use crate::judge::{Rules, Verdict};
use crate::noise::{Cluster, Diagnosis, Finding, Kind, Packets, reason};
use crate::reason::Reason;
use crate::table::Table;
use crate::tally::Tally;
use clusters::{Clusters, Span};
use lines::{Noise, Writer};

/// Receives what a survey does not only count, in the order of the stream.
pub trait Sink {
    /// Receive the lines of `size` bytes of the stream, from `offset` on. They hold no noise that
    /// was handed over.
    fn lines(&mut self, offset: u64, size: u64, lines: &[u8]);

    /// Receive a frame without a legal message.
    fn frame(&mut self, offset: u64, data: &[u8]);

    /// Receive noise to diagnose.
    fn noise(&mut self, offset: u64, data: &[u8], reason: Reason);

    /// No later noise belongs to the noise before.
    fn end(&mut self);
}

/// How much noise of one class there is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Extent {
    /// The number of findings.
    pub count: u64,
    /// The number of their bytes.
    pub bytes: u64,
}

/// Surveys one stream.
pub struct Survey {
    stream: Stream,
    census: Census,
    /// The bytes of the stream that are not reported yet.
    buffer: Vec<u8>,
    /// Where they start.
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

impl Survey {
    /// Return a survey of a new stream. With `texts` it writes lines.
    #[must_use]
    pub fn new(
        table: Arc<Table>,
        plans: Arc<Plans>,
        rules: Rules,
        listening: Listening,
        packets: Packets,
        texts: Option<Texts>,
    ) -> Self {
        Self {
            stream: Stream::new(rules.clone()),
            census: Census::new(Arc::clone(&table), plans, texts.is_some()),
            buffer: Vec::new(),
            base: 0,
            clusters: Clusters::default(),
            report: Report {
                diagnosis: Diagnosis::new(&table, listening, rules.clone(), packets),
                writer: texts.map(|texts| Writer::new(texts, listening)),
                table,
                rules,
                frames: Vec::new(),
                lines: Vec::new(),
                lines_from: 0,
                extents: Default::default(),
                known: Default::default(),
                scratch: Scratch::default(),
            },
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
        self.census.counted()
    }

    /// Return how much noise was not handed over, by class, in the order of [`Kind::ALL`].
    #[must_use]
    pub fn extents(&self) -> &[Extent] {
        &self.report.extents
    }

    /// Feed bytes.
    pub fn feed(&mut self, chunk: &[u8], sink: &mut impl Sink) {
        self.buffer.extend_from_slice(chunk);
        self.stream.feed(chunk, &mut self.census);
        self.settle(false, sink);
    }

    /// Report everything: no more bytes follow.
    pub fn flush(&mut self, sink: &mut impl Sink) {
        self.stream.flush(&mut self.census);
        self.settle(true, sink);
    }

    /// Report everything that later bytes cannot change.
    fn settle(&mut self, at_end: bool, sink: &mut impl Sink) {
        let bytes = Bytes {
            bytes: &self.buffer,
            base: self.base,
        };
        let (clusters, report) = (&mut self.clusters, &mut self.report);
        report
            .frames
            .append(self.census.frames.as_mut().unwrap_or(&mut Vec::new()));
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
            report.hand_over(&spans, bytes, sink);
        }
        let until = clusters.start().unwrap_or(next);
        report.write_frames(until, bytes, sink);
        report.end_lines(until, sink);
        self.buffer.drain(..(until - self.base) as usize);
        self.base = until;
    }
}

/// Counts and writes what is certain.
struct Report {
    table: Arc<Table>,
    rules: Rules,
    diagnosis: Diagnosis,
    writer: Option<Writer>,
    /// The positions of the frames that are not written yet.
    frames: Vec<u64>,
    /// Lines for the sink, and the position in the stream at which they start.
    lines: Vec<u8>,
    lines_from: u64,
    extents: [Extent; Kind::ALL.len()],
    /// The classes of which Python has seen the first finding.
    known: [bool; Kind::ALL.len()],
    scratch: Scratch,
}

/// Memory that is used again.
#[derive(Default)]
struct Scratch {
    findings: Vec<Finding>,
    data: Vec<u8>,
    marks: Vec<usize>,
}

impl Report {
    /// Report the noise that waits, with the frames up to its end.
    fn close(&mut self, clusters: &mut Clusters, bytes: Bytes<'_>, sink: &mut impl Sink) {
        let Some((spans, spilled)) = clusters.take() else {
            return;
        };
        if spilled || !self.diagnose(&spans, bytes, sink) {
            self.hand_over(&spans, bytes, sink);
            sink.end();
        }
        clusters.reuse(spans);
    }

    /// Count and write noise; return false if it is for Python.
    fn diagnose(&mut self, spans: &[Span], bytes: Bytes<'_>, sink: &mut impl Sink) -> bool {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.marks.clear();
        scratch.data.clear();
        let mut size = 0;
        for span in spans {
            size += (span.1 - span.0) as usize;
            scratch.marks.push(size);
            if spans.len() > 1 {
                scratch.data.extend_from_slice(bytes.span(*span));
            }
        }
        let cluster = Cluster {
            data: match spans {
                [span] => bytes.span(*span),
                _ => &scratch.data,
            },
            marks: &scratch.marks,
            spans,
            stream: bytes.bytes,
            base: bytes.base,
        };
        let findings = &mut scratch.findings;
        let known = self.diagnosis.run(&cluster, findings) && self.are_known(&cluster, findings);
        if known {
            self.count(findings);
            self.write_noise(&cluster, findings, bytes, sink);
        }
        self.scratch = scratch;
        known
    }

    /// Return whether Python need not see any of the findings. If not, it will see all of them.
    fn are_known(&mut self, cluster: &Cluster<'_>, findings: &[Finding]) -> bool {
        let is_known = |finding: &Finding| {
            self.known.get(finding.kind as usize) == Some(&true)
                && (self.writer.is_none() || self.has_fixed_text(cluster, finding))
        };
        let all = findings.iter().all(is_known);
        if !all {
            for finding in findings {
                if let Some(known) = self.known.get_mut(finding.kind as usize) {
                    *known = true;
                }
            }
        }
        all
    }

    /// Return whether the line of a finding needs nothing that Python finds out.
    fn has_fixed_text(&self, cluster: &Cluster<'_>, finding: &Finding) -> bool {
        let data = cluster.data.get(finding.start..).unwrap_or_default();
        matches!(finding.kind, Kind::Unrecognised | Kind::CommandError)
            && !data.starts_with(&self.rules.frame().header)
    }

    fn count(&mut self, findings: &[Finding]) {
        for finding in findings {
            if let Some(extent) = self.extents.get_mut(finding.kind as usize) {
                extent.count += u64::from(!finding.continued);
                extent.bytes += (finding.end - finding.start) as u64;
            }
        }
    }

    /// Write the lines of findings, and of the frames before them.
    fn write_noise(
        &mut self,
        cluster: &Cluster<'_>,
        findings: &[Finding],
        bytes: Bytes<'_>,
        sink: &mut impl Sink,
    ) {
        if self.writer.is_none() {
            return;
        }
        for finding in findings {
            let spans = cluster.spans_of(finding.start, finding.end);
            let from = spans.first().map_or(0, |(from, _)| *from);
            self.write_frames(from, bytes, sink);
            let noise = Noise {
                kind: finding.kind,
                data: cluster
                    .data
                    .get(finding.start..finding.end)
                    .unwrap_or_default(),
                reason: reason(&self.rules, bytes.from(from)),
                spans: &spans,
                continued: finding.continued,
            };
            if let Some(writer) = &self.writer {
                writer.noise(&mut self.lines, &noise);
            }
        }
    }

    /// Hand over noise, with the frames before and in between.
    fn hand_over(&mut self, spans: &[Span], bytes: Bytes<'_>, sink: &mut impl Sink) {
        for (from, to) in spans {
            self.write_frames(*from, bytes, sink);
            self.pass_lines(*from, sink);
            let mut at = *from;
            while at < *to {
                let why = reason(&self.rules, bytes.from(at));
                let alike = |place: &u64| reason(&self.rules, bytes.from(*place)) == why;
                let end = (at + 1..*to).find(|place| !alike(place)).unwrap_or(*to);
                sink.noise(at, bytes.span((at, end)), why);
                at = end;
            }
            self.lines_from = *to;
        }
    }

    /// Write the lines of the frames before `until`, and hand over those without a legal message.
    fn write_frames(&mut self, until: u64, bytes: Bytes<'_>, sink: &mut impl Sink) {
        let Some(writer) = &self.writer else {
            return;
        };
        let count = self.frames.iter().take_while(|at| **at < until).count();
        let mut rejected = Vec::new();
        for at in self.frames.iter().take(count) {
            let Verdict::Frame(frame) = self.rules.judge(bytes.from(*at)) else {
                continue;
            };
            if !writer.frame(&mut self.lines, &self.table, *at, frame) {
                rejected.push((*at, self.lines.len(), frame.bytes()));
            }
        }
        self.frames.drain(..count);
        let mut start = 0;
        for (at, end, data) in rejected {
            let lines = self.lines.get(start..end).unwrap_or_default();
            sink.lines(self.lines_from, at - self.lines_from, lines);
            sink.frame(at, data);
            self.lines_from = at + data.len() as u64;
            start = end;
        }
        self.lines.drain(..start);
    }

    /// Pass on all lines; those of the stream before `until` are complete.
    fn pass_lines(&mut self, until: u64, sink: &mut impl Sink) {
        sink.lines(self.lines_from, until - self.lines_from, &self.lines);
        self.lines.clear();
        self.lines_from = until;
    }

    fn end_lines(&mut self, until: u64, sink: &mut impl Sink) {
        if self.lines.is_empty() {
            self.lines_from = until;
        } else {
            self.pass_lines(until, sink);
        }
    }
}
