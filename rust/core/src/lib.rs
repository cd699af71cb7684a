//! The serial protocol of myCobot arms, as an interpreter of a table.
//!
//! A [`Table`] defines the messages; [`encode`] and [`decode`] turn values into bytes and back, and
//! a [`Framer`] cuts frames out of a stream. This crate knows no command by name, does no I/O,
//! reads no clock and writes no error texts: an error is a kind and a position. The Python
//! reference in `python/cobotwire/codec/reference` is the specification; this crate returns the
//! same results. An [`exchange::Exchange`] matches requests and replies on a transport;
//! `python/cobotwire/session` is its specification.
//!
//! Without the feature `std`, which is on by default, it needs only `alloc`. Then a
//! [`Table`] stays in the thread that made it, and there is no bulk decoding, no reading of
//! captures and no summary. Without the feature `exchange`, also on by default, there is no
//! [`exchange`]. An edition's table takes 0.6 to 0.9 MB, and its construction 128 KiB of stack.

#![cfg_attr(not(feature = "std"), no_std)]
// Some code is used only by modules of a feature.
#![cfg_attr(not(all(feature = "std", feature = "exchange")), allow(dead_code))]

#[macro_use]
extern crate alloc;

#[cfg(feature = "std")]
mod bulk;
#[cfg(feature = "std")]
mod capture;
mod check;
mod crc;
mod decode;
mod direction;
mod encode;
#[cfg(feature = "exchange")]
pub mod exchange;
mod field;
mod frame;
mod framer;
mod given;
mod legal;
mod message;
#[cfg(feature = "std")]
mod noise;
mod number;
mod owned;
mod plain;
mod read;
mod reason;
mod rules;
mod scan;
mod seam;
mod step;
#[cfg(feature = "std")]
mod summary;
mod table;
mod tally;
mod template;
mod write;

#[cfg(feature = "std")]
pub use bulk::{
    Advise, Cells, ColumnReader, Columns, Counted, Numbers, OffsetReader, Offsets, Plans, Rows,
    Spans, Workers,
};
#[cfg(feature = "std")]
pub use capture::{
    CaptureReader, Damage, Decoder, Decoders, Fault, Interface, PacketDirection, StreamBatch, Times,
};
pub use check::{Algorithm, Check, Computed};
pub use crc::{Crc, CrcParameters};
pub use decode::{DecodeError, Decoded, decode, read};
pub use direction::{Direction, Listening};
pub use encode::{Choice, encode};
pub use field::{Case, Field, Shape};
pub use frame::{Frame, FrameFormat, Layout, Part};
pub use framer::{Event, Framer};
pub use given::{Given, Row, Unread, ValueFault};
pub use message::{Command, Variant, VariantId};
#[cfg(feature = "std")]
pub use noise::{Expected, Instruction, Kind, Operand, ServoBus};
pub use number::{Bits, Encoding, Misfit, Number, NumberEncoding, Order, Value};
pub use owned::OwnedFrame;
pub use plain::{PlainMessage, encode_plain, read_plain};
pub use read::BadRaw;
pub use reason::Reason;
pub use rules::{Rules, Verdict};
#[cfg(feature = "std")]
pub use summary::{Described, Extent, Names, Sink, Summary, Texts};
pub use table::{Table, TableError};
pub use tally::Tally;
pub use template::{Exact, LONGEST_PLAIN, Place, PlainNumbers};
pub use write::{BadValue, EncodeError};
