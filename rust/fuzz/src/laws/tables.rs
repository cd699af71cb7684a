//! Checks that any table that a caller may pass is either rejected or works.

use std::sync::Arc;

use cobotwire_core::{Direction, Listening, Plans, Table};

use super::{columns, decoding, framing};
use crate::bytes::Bytes;
use crate::input::Cutting;
use crate::oracle::Oracle;
use crate::random;
use crate::script;
use crate::subjects::{LISTENING, rules, variants};

/// Bits of a byte; its low two bits pick the directions.
const UNKNOWN: u8 = 4;
const FLUSHES: u8 = 8;
const COLUMNS: u8 = 0x10 | 0x20;
const LONG: u8 = 0x40 | 0x80;

/// Check framing and decoding with any table that is not rejected, for streams of its frames.
pub fn any_table_is_rejected_or_works(data: &[u8]) {
    let mut bytes = Bytes(data);
    let (format, commands) = random::table(&mut bytes);
    let count = commands.len();
    let table = match Table::new(format, commands) {
        Ok(table) => Arc::new(table),
        Err(error) => return assert!(error.command < count, "the error names a command"),
    };
    let flags = bytes.byte();
    let cutting = Cutting {
        class: bytes.byte(),
        seed: bytes.byte(),
        flushes: flags & FLUSHES != 0,
    };
    let unknown = flags & UNKNOWN != 0;
    let stream = script::play(&table, &variants(&table), bytes);
    let listening = LISTENING[usize::from(flags & 3) % LISTENING.len()];
    let oracle = Oracle::new(&table, listening, unknown);
    let rules = rules(&table, listening, unknown);
    framing::hold(&oracle, &rules, &cutting.cut(&stream));
    for direction in [Direction::Request, Direction::Reply] {
        decodes(&table, direction, &stream);
    }
    // Planning columns is slow, so only some tables check them.
    if flags & COLUMNS == COLUMNS {
        let source = columns::Source {
            table: &table,
            plans: &Arc::new(Plans::new(&table, listening)),
            listening,
            oracle: &Oracle::new(&table, listening, false),
        };
        let long = flags & LONG == LONG;
        columns::read(&source, (&oracle, &rules), &stream, long, cutting);
    }
}

/// Check that the stream, and each frame that the oracle finds in it, decode as in the oracle.
fn decodes(table: &Table, direction: Direction, stream: &[u8]) {
    let oracle = Oracle::new(table, Listening::To(direction), false);
    decoding::hold(table, &oracle, direction, stream);
    let mut rest = stream;
    for (size, reason) in oracle.spans(stream, true).0 {
        let (span, after) = rest.split_at(size);
        rest = after;
        if reason.is_none() {
            decoding::hold(table, &oracle, direction, span);
            decoding::read_back(table, direction, span);
        }
    }
}
