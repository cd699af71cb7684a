//! Half a request on the line: what must be sent before the next one.
//!
//! A write may end after a part of a frame. The peer's parser then waits for the rest, and takes the
//! next request for it: both together can be a legal frame that nobody sent. So fill bytes go out
//! first. They end the frame that was begun, and make its check wrong, whatever LEN the parser
//! believes.
//!
//! Fill bytes cannot help if the part that was written contains a whole legal frame: a parser that
//! rejects the outer frame finds the inner one. Then the rest of the frame is sent instead, so that
//! the arm executes what the caller requested, and never something else.

use alloc::vec::Vec;

use super::facts::Protocol;
use crate::check::Check;
use crate::direction::{Direction, Listening};
use crate::frame::{self, FrameFormat};
use crate::framer::{Event, Framer};

/// The first `written` bytes of a request, which is all that the peer has of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The request.
    pub request: Vec<u8>,
    /// How many of its bytes the peer has.
    pub written: usize,
}

impl Part {
    fn new(request: &[u8], written: usize) -> Self {
        let request = request.into();
        Self { request, written }
    }

    /// Return the bytes that the peer has.
    fn data(&self) -> &[u8] {
        self.request.get(..self.written).unwrap_or(&self.request)
    }

    /// Return the bytes that the peer does not have.
    fn rest(&self) -> &[u8] {
        self.request.get(self.written..).unwrap_or_default()
    }
}

/// Knows which parts of a request the peer may hold, and what ends them.
#[derive(Clone, Debug, Default)]
pub(super) struct Alignment {
    /// What must be written before the next request; empty on an aligned line.
    pub(super) align: Vec<u8>,
    /// Every part that the peer may hold; empty on an aligned line.
    pub(super) held: Vec<Part>,
    /// The frame that was sent last; empty if none was since the transport was lost.
    last_request: Vec<u8>,
}

impl Alignment {
    /// Note the frame that is sent now.
    pub(super) fn sent(&mut self, request: &[u8]) {
        self.last_request = request.into();
    }

    /// Note that `align` and a request after it were taken whole.
    pub(super) fn end(&mut self) {
        self.align.clear();
        self.held.clear();
    }

    /// Note that of `align + request` only `written` bytes were taken; `None`: nobody knows. Return
    /// how many of these bytes belong to the request.
    pub(super) fn cut(
        &mut self,
        protocol: &Protocol,
        align: &[u8],
        request: &[u8],
        written: Option<usize>,
    ) -> Option<usize> {
        let size = frame_size(protocol.table.frame(), request);
        let Some(written) = written else {
            let mut parts = self.held.clone();
            parts.extend(all_parts(request, size));
            self.hold(protocol, parts);
            return None;
        };
        let begun = written.checked_sub(align.len()).filter(|_| written > 0);
        if let Some(begun) = begun {
            // Text may follow a frame. It is not the beginning of a frame.
            let within = (1..size).contains(&begun);
            let part = within.then(|| Part::new(request, begun));
            self.hold(protocol, part.into_iter().collect());
            return Some(begun);
        }
        if let [part] = self.held.as_slice()
            && written > 0
            && self.align == part.rest()
        {
            let part = Part::new(&part.request, part.written.saturating_add(written));
            self.hold(protocol, [part].into());
        }
        Some(0)
    }

    /// Note that the transport is gone. The last request, and earlier ones that were still on their
    /// way, may be cut anywhere.
    pub(super) fn lose(&mut self, protocol: &Protocol) {
        let last = core::mem::take(&mut self.last_request);
        if last.is_empty() {
            return;
        }
        let format = protocol.table.frame();
        let rules = protocol.table.rules(Listening::To(Direction::Request));
        let (_, longest) = rules.legal().lengths().unwrap_or_default();
        let length = format.layout.length;
        let mut begun = last.clone();
        begun.resize(length.end(), 0);
        length.write(&mut begun, longest);
        let mut parts = core::mem::take(&mut self.held);
        parts.push(Part::new(&begun, begun.len()));
        parts.extend(all_parts(&last, frame_size(format, &last)));
        self.hold(protocol, parts);
    }

    /// Note every part that the peer may hold.
    pub(super) fn hold(&mut self, protocol: &Protocol, parts: Vec<Part>) {
        self.align = match parts.as_slice() {
            [] => Vec::new(),
            parts => ending(protocol, parts),
        };
        self.held = parts;
    }
}

/// Return what ends the part that the peer holds, whichever it is.
fn ending(protocol: &Protocol, parts: &[Part]) -> Vec<u8> {
    let data: Vec<&[u8]> = parts.iter().map(Part::data).collect();
    let fill = fill_bytes(protocol.table.frame(), &data);
    match parts {
        [part] if exposes(protocol, part, &fill) => part.rest().into(),
        _ => fill,
    }
}

/// Return whether a parser finds another frame once the fill bytes reject this one.
fn exposes(protocol: &Protocol, part: &Part, fill: &[u8]) -> bool {
    let rules = protocol.table.rules(Listening::To(Direction::Request));
    let mut framer = Framer::new(rules.clone());
    let mut found = false;
    framer.feed(&[part.data(), fill].concat(), |event| {
        found |= matches!(event, Event::Frame { .. });
    });
    framer.flush(|event| found |= matches!(event, Event::Frame { .. }));
    found
}

/// Return bytes that end any frame that begins in a part, and complete none of them.
///
/// They do so for every LEN, not only for those of the table: a parser may know other commands, or
/// believe any LEN. They repeat a pair of values that no header or footer has. Equal values would
/// not do: two of them are command and check of a frame that ends with a sum.
fn fill_bytes(format: &FrameFormat, parts: &[&[u8]]) -> Vec<u8> {
    let footer = match &format.check {
        Check::Footer(footer) => core::slice::from_ref(footer),
        Check::Computed(computed) => &computed.footer,
    };
    let free = |value: &u8| !format.header.contains(value) && !footer.contains(value);
    let values: Vec<u8> = (0..=u8::MAX).filter(free).collect();
    let mut pairs = values
        .iter()
        .flat_map(|one| values.iter().map(|two| [*one, *two]));
    let made = pairs.find_map(|pair| {
        let ends = parts.iter().flat_map(|part| {
            let frames = frames(format, part, pair);
            frames.map(|(_, end)| end.saturating_sub(part.len()))
        });
        let size = ends.max().unwrap_or_default().max(1);
        let fill: Vec<u8> = pair.into_iter().cycle().take(size).collect();
        let mut parts = parts.iter();
        (!parts.any(|part| completes_one(format, part, &fill))).then_some(fill)
    });
    // A frame has one right check, so most pairs do not complete it.
    made.unwrap_or_default()
}

/// Return start and end of each frame that begins in a part, if the pair follows repeatedly.
fn frames<'a>(
    format: &'a FrameFormat,
    part: &'a [u8],
    [even, odd]: [u8; 2],
) -> impl Iterator<Item = (usize, usize)> + 'a {
    let header = &format.header;
    let begun = (0..part.len()).filter(move |start| {
        let rest = part.get(*start..).unwrap_or_default();
        header.starts_with(rest.get(..header.len()).unwrap_or(rest))
    });
    let length = format.layout.length;
    begun.map(move |start| {
        let byte = |at: usize| match at.checked_sub(part.len()) {
            None => part.get(at).copied().unwrap_or_default(),
            Some(after) if after % 2 == 0 => even,
            Some(_) => odd,
        };
        let at = start + length.at;
        let read = frame::Part { at: 0, ..length }.read(&[byte(at), byte(at + 1)]);
        let size = format.layout.overhead + usize::from(read.unwrap_or_default());
        (start, start + size)
    })
}

/// Return whether fill bytes complete a frame that begins in the part.
fn completes_one(format: &FrameFormat, part: &[u8], fill: &[u8]) -> bool {
    let data = [part, fill].concat();
    let first = fill.first().copied().unwrap_or_default();
    let pair = [first, fill.get(1).copied().unwrap_or(first)];
    let layout = format.layout;
    let head = layout.length.end().max(layout.id.end());
    let mut frames = frames(format, part, pair);
    frames.any(|(start, end)| {
        let check_at = end.saturating_sub(format.check.size());
        if end <= part.len() || check_at < start + head {
            return false;
        }
        let mut whole: Vec<u8> = data.get(start..check_at).unwrap_or_default().into();
        format.check.end(&mut whole);
        data.get(start..end) == Some(&whole)
    })
}

fn all_parts(request: &[u8], size: usize) -> impl Iterator<Item = Part> {
    (1..size).map(|written| Part::new(request, written))
}

/// Return the size of the frame at the start of a request.
fn frame_size(format: &FrameFormat, request: &[u8]) -> usize {
    let length = format.layout.length.read(request);
    format.layout.overhead + usize::from(length.unwrap_or_default())
}
