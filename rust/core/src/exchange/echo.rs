//! Detects a transport that echoes: a loopback and some adapters send our own bytes back.
//!
//! The bytes of a few requests are legal replies too. So the first copy of such a request is only a
//! candidate. If another reply follows, that one is taken. If none does by the deadline, the
//! candidate is taken, unless the transport is known to echo: it has sent back a request that
//! cannot be a reply.

use alloc::vec::Vec;

use super::text::find;
use super::{Request, SeenFrame};

/// A request that was sent. Up to `copies` echoes of it may begin at `offset` of the stream or
/// later.
#[derive(Clone, Debug)]
struct Sent {
    frame: Vec<u8>,
    offset: u64,
    copies: usize,
}

impl Sent {
    /// Take a frame if it is one of the copies; return whether it is.
    fn take(&mut self, frame: &SeenFrame) -> bool {
        let own = self.copies > 0 && frame.bytes() == self.frame && frame.offset >= self.offset;
        self.copies -= usize::from(own);
        own
    }
}

/// Looks for copies of the last request, and of the last one-way request, which may be sent while
/// the other one waits for its reply.
#[derive(Clone, Debug, Default)]
pub(super) struct EchoDetector {
    /// Whether the transport was seen to echo.
    pub(super) proven: bool,
    /// The last request, and the last one-way request.
    sent: [Option<Sent>; 2],
    noise: Vec<u8>,
}

impl EchoDetector {
    /// Note a request that is sent; its copy may begin at `offset` of the received stream or later.
    pub(super) fn sent(&mut self, request: &Request, offset: u64, is_one_way: bool) {
        let [last, one_way] = &mut self.sent;
        *(if is_one_way { one_way } else { last }) = Some(Sent {
            frame: request.frame.clone(),
            offset,
            copies: 1,
        });
        self.noise.clear();
    }

    /// Note that the last request with a reply is sent once more.
    pub(super) fn sent_again(&mut self) {
        if let [Some(last), _] = &mut self.sent {
            last.copies += 1;
        }
        self.noise.clear();
    }

    /// Look for copies in noise: most requests are not legal replies, so their echoes are noise.
    pub(super) fn add_noise(&mut self, offset: u64, data: &[u8]) {
        let watched = || self.sent.iter().flatten();
        let first = watched().map(|sent| sent.offset).min();
        let Some(first) = first.filter(|_| !self.proven) else {
            return;
        };
        self.noise.extend_from_slice(since(first, offset, data));
        self.proven = watched().any(|sent| find(&self.noise, &sent.frame).is_some());
        let longest = watched().map(|sent| sent.frame.len()).max();
        let old = self.noise.len().saturating_sub(longest.unwrap_or_default());
        self.noise.drain(..old);
    }

    /// Return whether a frame is a copy of a request. A request that was sent has one copy; the
    /// next equal frame comes from the arm itself.
    pub(super) fn take_copy(&mut self, frame: &SeenFrame) -> bool {
        self.noise.clear();
        let mut watched = self.sent.iter_mut().flatten();
        watched.any(|sent| sent.take(frame))
    }
}

/// Return the bytes from position `first` of the stream on; `data` begins at `offset`.
pub(super) fn since(first: u64, offset: u64, data: &[u8]) -> &[u8] {
    let skipped = usize::try_from(first.saturating_sub(offset)).unwrap_or(usize::MAX);
    data.get(skipped..).unwrap_or_default()
}
