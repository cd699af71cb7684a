//! A block of a stream, and a fast check of one position in it.
//!
//! A margin follows the last position, so a frame that starts in the block ends in the array.
//! Positions are taken modulo the size of the block; so the compiler needs no bounds checks.

use crate::check::Check;
use crate::legal::{ACCEPTED, Headings, UNKNOWN_ID};
use crate::reason::Reason;
use crate::rules::Rules;
use cobotwire_simd::{Pattern, SEEN, Window};

/// The number of positions in a block.
pub(crate) const BLOCK: usize = 1 << PLACE;
/// The number of bits of a position in a block. In a larger block there are more frames of each
/// rare message to decode together; a smaller one leaves more of the cache to other data.
const PLACE: u32 = 17;
/// The number of bytes after the last position: more than the longest frame that LEN can express.
pub(crate) const MARGIN: usize = 1 << 10;
/// More than the number of frames that can start in a block; the shortest frame has more than four
/// bytes.
pub(crate) const MOST: usize = BLOCK / 4;
/// The number of lanes: parts of a block whose scans are interleaved. Two lanes are 1.4 times as
/// fast as one, and three are 1.5 times as fast; four need more registers than the processor has.
pub(crate) const LANES: usize = 3;
/// The bytes of a block.
pub(crate) type Block = [u8; BLOCK + MARGIN];

/// A frame in a block: where it starts, and its group in the table of legal frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Found(u32);

impl Found {
    #[inline(always)]
    pub(crate) fn new(at: usize, group: u16) -> Self {
        Self(at as u32 | u32::from(group) << PLACE)
    }

    /// Return where it starts.
    #[inline(always)]
    pub(crate) fn at(self) -> u32 {
        self.0 % BLOCK as u32
    }

    /// Return the index of its group of messages; no group has this index if the id is unknown.
    #[inline(always)]
    pub(crate) fn group(self) -> usize {
        (self.0 >> PLACE) as usize
    }

    /// Return whether the id is unknown.
    pub(crate) fn is_unknown(self) -> bool {
        self.group() == Self::new(0, ACCEPTED).group()
    }
}

/// The rules of a plain format with a footer, in compact form.
#[derive(Clone, Copy)]
pub(crate) struct Quick<'a> {
    /// The header; its first byte is the low byte.
    header: u16,
    footer: u8,
    headings: &'a Headings,
    pattern: Pattern,
}

/// The verdict on a position of a block.
pub(crate) enum Look {
    /// A frame.
    Frame { size: u16, group: u16, id: u8 },
    /// No frame, for this reason.
    Noise(Reason),
}

impl<'a> Quick<'a> {
    /// Return the rules, if the format is plain and has a footer.
    pub(crate) fn new(rules: &'a Rules) -> Option<Self> {
        let Check::Footer(footer) = rules.frame().check else {
            return None;
        };
        let header = rules.plain_header()?;
        let (least, most) = rules.legal().lengths()?;
        let (least, most) = (u8::try_from(least).ok()?, u8::try_from(most).ok()?);
        Some(Self {
            header: u16::from_le_bytes(header),
            footer,
            headings: rules.legal().headings(),
            pattern: Pattern::new(header, least, most),
        })
    }

    /// Make a first check of several positions.
    #[inline(always)]
    pub(crate) fn window(self, data: &Block, at: usize) -> Window {
        let seen = data.get(at % BLOCK..).and_then(<[u8]>::first_chunk);
        self.pattern.look(seen.unwrap_or(&[0; SEEN])) // never the default: the margin follows
    }

    #[inline(always)]
    #[allow(clippy::indexing_slicing)] // in bounds by their types; see above
    pub(crate) fn look(self, data: &Block, at: usize) -> Look {
        let start = at % BLOCK;
        let [first, second, length, id] = [0, 1, 2, 3].map(|index| data[start + index]);
        if u16::from_le_bytes([first, second]) != self.header {
            return Look::Noise(Reason::NoHeader);
        }
        let group = self.headings[usize::from(u16::from_le_bytes([length, id]))];
        if group > ACCEPTED {
            return Look::Noise(rejection(group));
        }
        if data[start + 2 + usize::from(length)] != self.footer {
            return Look::Noise(Reason::BadCheck);
        }
        let size = 3 + u16::from(length);
        Look::Frame { size, group, id }
    }
}

#[inline]
fn rejection(cell: u16) -> Reason {
    if cell == UNKNOWN_ID {
        Reason::UnknownId
    } else {
        Reason::BadLength
    }
}
