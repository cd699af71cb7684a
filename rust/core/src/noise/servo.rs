//! Packets of the servo bus that leak onto the line.

use crate::frame::FrameFormat;

/// The legal packets of the servo bus.
#[derive(Clone, Debug)]
pub struct Packets {
    frame: FrameFormat,
    lengths: Vec<u16>,
}

impl Packets {
    /// Return the packets of that format with one of these LENs; what else they hold does not
    /// matter.
    #[must_use]
    pub fn new(frame: FrameFormat, lengths: Vec<u16>) -> Self {
        Self { frame, lengths }
    }

    /// Return the first byte of a packet.
    pub(super) fn first(&self) -> u8 {
        self.frame.header.first().copied().unwrap_or_default()
    }

    /// Return the end of the packet at `at`, if there is one. A frame may interrupt it.
    pub(super) fn end(&self, data: &[u8], at: usize) -> Option<usize> {
        let rest = data.get(at..)?;
        let layout = self.frame.layout;
        if !rest.starts_with(&self.frame.header) {
            return None;
        }
        let address = rest.get(layout.address_at?)?;
        let length = layout.length.read(rest)?;
        if !self.frame.addresses.contains(address) || !self.lengths.contains(&length) {
            return None;
        }
        let packet = rest.get(..layout.overhead + usize::from(length))?;
        self.frame.check.holds(packet).then_some(at + packet.len())
    }
}
