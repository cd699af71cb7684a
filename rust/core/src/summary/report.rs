//! Counts and writes the frames and noise that later bytes cannot change.

use super::clusters::{Clusters, Span};
use super::lines::{Described, Noise, Writer};
use super::{Bytes, Extent, Sink};
use crate::noise::{Cluster, Diagnosis, Expected, Finding, Kind, reason};
use crate::rules::{Rules, Verdict};

/// Counts and writes the frames and noise that later bytes cannot change.
pub(super) struct Report {
    rules: Rules,
    diagnosis: Diagnosis,
    writer: Option<Writer>,
    /// The positions of frames; the lines of the first `written` ones are written.
    frames: Vec<u64>,
    written: usize,
    /// Lines for the sink, and the position in the stream at which they start.
    lines: Vec<u8>,
    lines_from: u64,
    extents: [Extent; Kind::ALL.len()],
    /// The classes whose first finding Python has described.
    known: [bool; Kind::ALL.len()],
    scratch: Scratch,
}

/// Memory that is reused.
#[derive(Default)]
struct Scratch {
    findings: Vec<Finding>,
    data: Vec<u8>,
    marks: Vec<usize>,
}

impl Report {
    pub(super) fn new(diagnosis: Diagnosis, writer: Option<Writer>, rules: Rules) -> Self {
        Self {
            rules,
            diagnosis,
            writer,
            frames: Vec::new(),
            written: 0,
            lines: Vec::new(),
            lines_from: 0,
            extents: Default::default(),
            known: Default::default(),
            scratch: Scratch::default(),
        }
    }

    /// Return how much noise was not handed over, by class.
    pub(super) fn extents(&self) -> &[Extent] {
        &self.extents
    }

    /// Take the positions of frames to write.
    pub(super) fn add_frames(&mut self, frames: Option<&mut Vec<u64>>) {
        self.frames.drain(..self.written);
        self.written = 0;
        if let Some(frames) = frames {
            self.frames.append(frames);
        }
    }

    /// Report the noise that waits, with the frames up to its end.
    pub(super) fn close(
        &mut self,
        clusters: &mut Clusters,
        bytes: Bytes<'_>,
        sink: &mut impl Sink,
    ) {
        let Some((spans, spilled)) = clusters.take() else {
            return;
        };
        if spilled || !self.diagnose(&spans, bytes, sink) {
            self.hand_over(&spans, true, bytes, sink);
        }
        clusters.reuse(spans);
    }

    /// Count and write noise; return false if Python must diagnose it.
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
        let known = self.diagnosis.run(&cluster, findings) && self.are_known(findings);
        if known {
            self.count(findings);
            self.write_noise(&cluster, findings, bytes, sink);
        }
        self.scratch = scratch;
        known
    }

    /// Return whether Python has described a finding of each of these classes. If not, it gets all
    /// of the findings, and their classes count as described.
    fn are_known(&mut self, findings: &[Finding]) -> bool {
        let is_known = |finding: &Finding| self.known.get(finding.kind as usize) == Some(&true);
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
            let data = cluster.data.get(finding.start..finding.end);
            let described = Described {
                kind: finding.kind,
                reason: reason(&self.rules, bytes.from(from)),
                data: data.unwrap_or_default(),
                id: self.diagnosis.id(cluster, finding.start),
            };
            let noise = Noise {
                described,
                spans: &spans,
                continued: finding.continued,
            };
            if let Some(writer) = &mut self.writer {
                writer.noise(&mut self.lines, &noise, sink);
            }
        }
    }

    /// Hand over noise, with the frames before and in between.
    pub(super) fn hand_over(
        &mut self,
        spans: &[Span],
        closed: bool,
        bytes: Bytes<'_>,
        sink: &mut impl Sink,
    ) {
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
        let writer = self.writer.as_mut();
        let expected = writer.map(|writer| &mut writer.expected);
        sink.diagnose(closed, expected.unwrap_or(&mut Expected::new()));
    }

    /// Write the lines of the frames before `until`.
    pub(super) fn write_frames(&mut self, until: u64, bytes: Bytes<'_>, sink: &mut impl Sink) {
        let Some(writer) = &mut self.writer else {
            return;
        };
        let rest = self.frames.get(self.written..).unwrap_or_default();
        for at in rest.iter().take_while(|at| **at < until) {
            if let Verdict::Frame(frame) = self.rules.validate(bytes.from(*at)) {
                writer.frame(&mut self.lines, *at, frame, sink);
            }
            self.written += 1;
        }
    }

    /// Pass on all lines, which describe the stream up to `until`.
    fn pass_lines(&mut self, until: u64, sink: &mut impl Sink) {
        sink.lines(self.lines_from, until - self.lines_from, &self.lines);
        self.lines.clear();
        self.lines_from = until;
    }

    pub(super) fn end_lines(&mut self, until: u64, sink: &mut impl Sink) {
        if self.lines.is_empty() {
            self.lines_from = until;
        } else {
            self.pass_lines(until, sink);
        }
    }
}
