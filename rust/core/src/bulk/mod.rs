//! Whole captures at the speed of memory: where the frames are, and their values in columns.
//!
//! The framing is that of [`crate::Framer`], frame for frame; what differs is that frames are looked
//! for in blocks of 64 KiB and then decoded message by message, not one after the other.

mod block;
mod buckets;
mod cells;
mod columns;
mod decode;
mod lanes;
mod offsets;
mod plan;
mod sample;
mod scale;
mod spans;
mod stream;
mod window;
mod words;

pub use cells::{Advise, Cells, Numbers};
pub use columns::{ColumnReader, Columns, Rows};
pub use offsets::{OffsetReader, Offsets};
pub use plan::Plans;
pub use spans::Spans;
