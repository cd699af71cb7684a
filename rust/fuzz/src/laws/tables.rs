//! A table is a caller's data: whatever it says, it is refused, or it works.

use std::sync::Arc;

use cobotwire_core::{Direction, Listening, Plans, Table};

use super::{columns, decoding, framing};
use crate::input::{Bytes, Cutting};
use crate::oracle::Oracle;
use crate::random;
use crate::script;
use crate::subjects::{LISTENING, forms, rules};

/// Bits of a byte; its low two pick how to listen.
const UNKNOWN: u8 = 4;
const FLUSHES: u8 = 8;
const COLUMNS: u8 = 0x10 | 0x20;
const LONG: u8 = 0x40 | 0x80;

/// Framing and decoding hold by any table that is not refused, for streams of its own frames.
pub fn any_table_is_refused_or_works(data: &[u8]) {
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
    let stream = script::play(&table, &forms(&table), bytes);
    let listening = LISTENING[usize::from(flags & 3) % LISTENING.len()];
    let oracle = Oracle::new(&table, listening, unknown);
    let rules = rules(&table, listening, unknown);
    framing::hold(&oracle, &rules, &cutting.cut(&stream));
    for direction in [Direction::Request, Direction::Reply] {
        decodes(&table, direction, &stream);
    }
    // To plan how columns are read takes so long that not every table can have it.
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

/// The stream and what the oracle finds in it.
fn decodes(table: &Table, direction: Direction, stream: &[u8]) {
    let oracle = Oracle::new(table, Listening::To(direction), false);
    decoding::hold(table, &oracle, direction, stream);
    let mut rest = stream;
    for (size, reason) in oracle.spans(stream, true).0 {
        let (span, behind) = rest.split_at(size);
        rest = behind;
        if reason.is_none() {
            decoding::hold(table, &oracle, direction, span);
            decoding::read_back(table, direction, span);
        }
    }
}
