//! Reads whole captures at the speed of memory: the positions of frames, and their values in
//! columns.
//!
//! It finds the same frames as [`crate::Framer`], but searches blocks of 128 KiB and then decodes
//! all frames of a message together, instead of one frame after the other.

mod block;
mod buckets;
mod cells;
mod columns;
mod counts;
mod decode;
mod lanes;
mod offsets;
mod plan;
mod rows;
mod sample;
mod scale;
mod search;
mod spans;
mod speculative;
mod stream;
mod words;

pub use cells::{Advise, Cells, Numbers};
pub(crate) use columns::Workspace;
pub use columns::{ColumnReader, Columns};
pub use counts::Counted;
pub(crate) use counts::Counts;
pub use offsets::{OffsetReader, Offsets};
pub use plan::Plans;
pub use rows::Rows;
pub use spans::Spans;
pub use speculative::Workers;
pub(crate) use stream::Stream;
