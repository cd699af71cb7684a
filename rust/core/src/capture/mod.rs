//! Reads pcapng recordings of serial traffic into columns, with the time of each message.
//!
//! The file arrives in chunks. `blocks` cuts it, `section` and `packet` interpret the blocks, and
//! `stream` joins the packets of each direction of each interface, decodes them in bulk, and maps
//! the positions of what it finds to times. The Python reader in `python/cobotwire/capture` is the
//! specification.

mod blocks;
mod body;
mod clock;
mod damage;
mod interface;
mod packet;
mod parser;
mod pieces;
mod reader;
mod stream;

pub use damage::{Damage, Fault};
pub use interface::Interface;
pub use packet::PacketDirection;
pub use reader::{CaptureReader, Decoder, Decoders};
pub use stream::{StreamBatch, Times};
