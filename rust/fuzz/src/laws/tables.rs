//! A table is a caller's data: whatever it says, it is refused, or it works.

use cobotwire_core::{Direction, Form, Listening, Table};

use super::{decoding, framing};
use crate::input::{Bytes, Cutting};
use crate::oracle::Oracle;
use crate::random;
use crate::script;
use crate::subjects::{LISTENING, forms};

/// Framing and decoding hold by any table that is not refused, for streams of its own frames.
pub fn any_table_is_refused_or_works(data: &[u8]) {
    let mut bytes = Bytes(data);
    let (format, commands) = random::table(&mut bytes);
    let count = commands.len();
    let table = match Table::new(format, commands) {
        Ok(table) => table,
        Err(error) => return assert!(error.command < count, "the error names a command"),
    };
    let cutting = Cutting {
        class: bytes.byte(),
        seed: bytes.byte(),
        flushes: bytes.byte() & 1 != 0,
    };
    let forms: Vec<Form> = forms(&table);
    let stream = script::play(&table, &forms, bytes);
    for listening in LISTENING {
        for unknown in [false, true] {
            let oracle = Oracle::new(&table, listening, unknown);
            let mut rules = table.rules(listening).clone();
            if unknown {
                rules = rules.accepting_unknown();
            }
            framing::hold(&oracle, &rules, &cutting.cut(&stream));
        }
    }
    for direction in [Direction::Request, Direction::Reply] {
        decodes(&table, direction, &stream);
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
