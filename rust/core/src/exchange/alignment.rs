//! Determines what must be sent after a request that was only partly written, before the next one.
//!
//! A write may end after a part of a frame. The peer's parser then waits for the rest, and takes
//! the next request as that rest: both together can be a legal frame that nobody sent. So fill
//! bytes are sent first. They end the incomplete frame and make its check wrong, whatever LEN the
//! parser accepts.
//!
//! Fill bytes cannot help if the part that was written contains a whole legal frame: a parser that
//! rejects the outer frame finds the inner one. Then the rest of the frame is sent instead, so that
//! the arm executes what the caller requested, and never something else.

use alloc::sync::Arc;
use alloc::vec::Vec;

use super::{Exchange, Protocol};
use crate::check::Check;
use crate::direction::{Direction, Listening};
use crate::frame::FrameFormat;
use crate::framer::{Event, Framer};

/// The first `written` bytes of a request: the part of it that the peer has.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)] // the names of the fields explain them
pub struct Part {
    pub request: Arc<[u8]>,
    pub written: usize,
}

impl Part {
    fn new(request: &Arc<[u8]>, written: usize) -> Self {
        let request = Arc::clone(request);
        Self { request, written }
    }

    fn split(&self) -> (&[u8], &[u8]) {
        self.request.split_at(self.written.min(self.request.len()))
    }
}

/// The parts of a request that the peer may hold, and the bytes that end them.
#[derive(Clone, Debug, Default)]
pub(super) struct Alignment {
    /// What must be written before the next request; empty if the peer holds no part.
    pub(super) align: Vec<u8>,
    /// Every part that the peer may hold.
    pub(super) held: Vec<Part>,
    /// The last frame sent on this transport; empty if none was sent.
    pub(super) last_request: Vec<u8>,
}

impl Alignment {
    /// Note that the transport is lost. The last request, and earlier ones that were still on their
    /// way, may be cut anywhere.
    pub(super) fn lose(&mut self, protocol: &Protocol) {
        let last = core::mem::take(&mut self.last_request);
        if last.is_empty() {
            return;
        }
        let format = protocol.table.frame();
        let rules = protocol.table.rules(Listening::To(Direction::Request));
        let (_, longest) = rules.legal().lengths().unwrap_or_default();
        let mut head = last.clone();
        head.resize(format.layout.length.end(), 0);
        format.layout.length.write(&mut head, longest);
        let mut parts = core::mem::take(&mut self.held);
        parts.push(Part::new(&(&*head).into(), head.len()));
        parts.extend(all_parts(format, &last));
        self.hold(protocol, parts);
    }

    pub(super) fn hold(&mut self, protocol: &Protocol, parts: Vec<Part>) {
        let fill = fill_bytes(protocol.table.frame(), &parts);
        self.align = match &*parts {
            [] => Vec::new(),
            [part] if exposes(protocol, part, &fill) => part.split().1.into(),
            _ => fill,
        };
        self.held = parts;
    }
}

/// The methods for requests that were only partly written.
impl Exchange {
    /// Return what must be written before the next request; empty if the peer holds no part of one.
    #[must_use]
    pub fn align(&self) -> &[u8] {
        &self.alignment.align
    }

    /// Note that the bytes of [`Self::align`] and the request after them were written completely.
    pub fn aligned(&mut self) {
        self.alignment.align.clear();
        self.alignment.held.clear();
    }

    /// Note that only the first `written` bytes of `align + request` were written; `None`: the
    /// number is unknown. Return how many of them belong to the request.
    pub fn cut(&mut self, align: &[u8], request: &[u8], written: Option<usize>) -> Option<usize> {
        let (own, protocol) = (&mut self.alignment, &*self.protocol);
        let (format, mut parts) = (protocol.table.frame(), own.held.clone());
        let Some(written) = written else {
            parts.extend(all_parts(format, request));
            own.hold(protocol, parts);
            return None;
        };
        if written == 0 {
            return Some(0);
        }
        let sent = written.checked_sub(align.len());
        if let Some(sent) = sent {
            // A text may follow the frame. If only the text is cut, the peer holds no part of a
            // frame.
            let within = (1..frame_size(format, request)).contains(&sent);
            parts = Vec::from_iter(within.then(|| Part::new(&request.into(), sent)));
        } else if let [part] = parts.as_mut_slice()
            && own.align == part.split().1
        {
            part.written = part.written.saturating_add(written);
        } else {
            return Some(0);
        }
        own.hold(protocol, parts);
        Some(sent.unwrap_or_default())
    }
}

/// Return whether a parser would find a frame in a part followed by its fill bytes.
fn exposes(protocol: &Protocol, part: &Part, fill: &[u8]) -> bool {
    let rules = protocol.table.rules(Listening::To(Direction::Request));
    let (mut framer, mut found) = (Framer::new(rules.clone()), false);
    let mut look = |event: Event<'_>| found |= matches!(event, Event::Frame { .. });
    framer.feed(&[part.split().0, fill].concat(), &mut look);
    framer.flush(&mut look);
    found
}

/// Return bytes that end any frame that begins in a part, and complete none of them.
///
/// They do so for every LEN, not only for those of the table: a parser may know other commands, or
/// accept any LEN. They repeat a pair of different values that no header or footer has. Two equal
/// values could be the command and the check of a frame that ends with a sum.
fn fill_bytes(format: &FrameFormat, parts: &[Part]) -> Vec<u8> {
    let footer = match &format.check {
        Check::Footer(footer) => core::slice::from_ref(footer),
        Check::Computed(computed) => &computed.footer,
    };
    let parts: Vec<&[u8]> = parts.iter().map(|part| part.split().0).collect();
    let free = |value: &u8| !format.header.contains(value) && !footer.contains(value);
    let values: Vec<u8> = (0..=u8::MAX).filter(free).collect();
    let pairs = (values.iter()).flat_map(|one| values.iter().map(move |two| [*one, *two]));
    let fill = |pair: [u8; 2]| {
        let ends = parts.iter().flat_map(|part| {
            let frames = frames(format, part, &pair).into_iter();
            frames.map(|(_, end)| end.saturating_sub(part.len()))
        });
        let size = ends.max().unwrap_or_default().max(1);
        pair.into_iter().cycle().take(size).collect::<Vec<u8>>()
    };
    let mut fills = pairs.map(fill);
    let made = fills.find(|fill| !parts.iter().any(|part| completes_one(format, part, fill)));
    // A pair is always found: a frame has one right check, so most pairs do not complete it.
    made.unwrap_or_default()
}

/// Return start and end of each frame that begins in a part, if the fill bytes follow repeatedly.
fn frames(format: &FrameFormat, part: &[u8], fill: &[u8]) -> Vec<(usize, usize)> {
    let (header, length) = (&format.header, format.layout.length);
    let after = fill.iter().cycle().take(length.end());
    let data: Vec<u8> = part.iter().chain(after).copied().collect();
    let starts = (0..part.len()).filter(|start| {
        let rest = part.get(*start..).unwrap_or_default();
        header.starts_with(rest.get(..header.len()).unwrap_or(rest))
    });
    let frame = |start: usize| {
        let read = length.read(data.get(start..).unwrap_or_default());
        let size = format.layout.overhead + usize::from(read.unwrap_or_default());
        (start, start + size)
    };
    starts.map(frame).collect()
}

/// Return whether fill bytes complete a frame that begins in the part.
fn completes_one(format: &FrameFormat, part: &[u8], fill: &[u8]) -> bool {
    let (data, layout) = ([part, fill].concat(), format.layout);
    let head = layout.length.end().max(layout.id.end());
    frames(format, part, fill).into_iter().any(|(start, end)| {
        let check_at = end.saturating_sub(format.check.size());
        if end <= part.len() || check_at < start + head {
            return false;
        }
        let mut whole: Vec<u8> = data.get(start..check_at).unwrap_or_default().into();
        format.check.end(&mut whole);
        data.get(start..end) == Some(&whole)
    })
}

fn all_parts(format: &FrameFormat, request: &[u8]) -> impl Iterator<Item = Part> + use<> {
    let (size, request) = (frame_size(format, request), request.into());
    (1..size).map(move |written| Part::new(&request, written))
}

fn frame_size(format: &FrameFormat, request: &[u8]) -> usize {
    let length = format.layout.length.read(request);
    format.layout.overhead + usize::from(length.unwrap_or_default())
}
