//! The serial protocol of myCobot arms, as an interpreter of a table.
//!
//! A [`Table`] says which messages there are; [`encode`] and [`decode`] turn values into bytes and
//! back, and a [`Framer`] cuts frames out of a stream. Nothing here knows a command by name, does
//! I/O, looks at a clock or makes text: errors are a kind and a place. The Python reference in
//! `python/cobotwire/codec/reference` is the specification; this crate gives the same answers.

mod bulk;
mod check;
mod decode;
mod encode;
mod error;
mod field;
mod frame;
mod framer;
mod given;
mod judge;
mod legal;
mod read;
mod scan;
mod seam;
mod table;
mod tally;
mod write;

pub use bulk::{
    Advise, Cells, ColumnReader, Columns, Numbers, OffsetReader, Offsets, Plans, Rows, Spans,
};
pub use check::{Check, crc16_modbus};
pub use decode::{Decoded, decode, read};
pub use encode::{Choice, encode};
pub use error::{
    BadRaw, BadValue, DecodeError, EncodeError, Misfit, Reason, TableError, ValueFault,
};
pub use field::{Case, Field, Number, Order};
pub use frame::{Frame, FrameFormat, OwnedFrame};
pub use framer::{Event, Framer};
pub use given::{Given, Row, Unread};
pub use judge::{Rules, Verdict};
pub use legal::Form;
pub use read::Value;
pub use table::{Command, Direction, Layout, Listening, Table};
pub use tally::Tally;
