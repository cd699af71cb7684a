//! Cuts a file into blocks; every length is checked before it is used.

use super::body::Order;
use super::damage::{Damage, Fault};

/// The limit of Wireshark; a longer block counts as damage.
const LARGEST: u32 = 16 * 1024 * 1024;
const SMALLEST: u32 = 12;
const SMALLEST_SECTION: u32 = 28;

/// The kind of the block that begins a section. It reads the same in either byte order.
pub(crate) const SECTION: u32 = 0x0A0D_0D0A;
const BYTE_ORDER_MAGIC: u32 = 0x1A2B_3C4D;

/// One block.
#[derive(Clone, Copy)]
pub(crate) struct Block<'a> {
    /// Its position in the file.
    pub(crate) offset: u64,
    pub(crate) kind: u32,
    pub(crate) order: Order,
    /// Everything between its two length fields.
    pub(crate) body: &'a [u8],
}

/// The next step of cutting.
pub(crate) enum Step<'a> {
    /// A block, and its length.
    Block(Block<'a>, usize),
    /// The block has at least this number of bytes, more than are available.
    Needs(usize),
}

/// Cuts a file into blocks, one after the other.
#[derive(Default)]
pub(crate) struct Cutter {
    /// The position of the next block in the file.
    pub(crate) offset: u64,
    order: Option<Order>,
}

impl Cutter {
    /// Cut the block at the start of `data`.
    pub(crate) fn next<'a>(&mut self, data: &'a [u8]) -> Result<Step<'a>, Damage> {
        self.cut(data).map_err(|fault| Damage {
            offset: self.offset,
            fault,
        })
    }

    /// Skip a block of that length.
    pub(crate) fn pass(&mut self, size: usize) {
        self.offset += size as u64;
    }

    #[inline]
    fn cut<'a>(&mut self, data: &'a [u8]) -> Result<Step<'a>, Fault> {
        let Some((kind, rest)) = data.split_first_chunk() else {
            return Ok(Step::Needs(8));
        };
        let Some((length, rest)) = rest.split_first_chunk() else {
            return Ok(Step::Needs(8));
        };
        let mut smallest = SMALLEST;
        if u32::from_le_bytes(*kind) == SECTION {
            let Some(magic) = rest.first_chunk() else {
                return Ok(Step::Needs(12));
            };
            smallest = SMALLEST_SECTION;
            self.order = Some(order(*magic)?);
        }
        let order = self.order.ok_or(Fault::NotPcapng)?;
        let size = order.word(*length);
        if size % 4 != 0 || !(smallest..=LARGEST).contains(&size) {
            return Err(Fault::BadLength(size, smallest));
        }
        // At most 16 MiB, so it fits.
        let all = size as usize;
        let Some((body, end)) = data.get(8..all).and_then(|rest| rest.split_last_chunk()) else {
            return Ok(Step::Needs(all));
        };
        if end != length {
            return Err(Fault::LengthsDiffer);
        }
        let block = Block {
            offset: self.offset,
            kind: order.word(*kind),
            order,
            body,
        };
        Ok(Step::Block(block, all))
    }
}

fn order(magic: [u8; 4]) -> Result<Order, Fault> {
    [Order::Little, Order::Big]
        .into_iter()
        .find(|order| order.word(magic) == BYTE_ORDER_MAGIC)
        .ok_or(Fault::NotPcapng)
}
