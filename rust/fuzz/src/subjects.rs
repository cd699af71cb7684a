//! The tables that are fuzzed: every edition, and the samples of what no edition has.

use std::sync::LazyLock;

use cobotwire_core::{Direction, Form, Listening, Table};

use crate::oracle::Oracle;
use crate::records::Edition;

/// The files as the core's tests have them; a new edition is a new line here.
const FILES: [(&str, &str); 6] = [
    (
        "mycobot",
        include_str!("../../core/tests/data/mycobot.json"),
    ),
    (
        "mycobot280",
        include_str!("../../core/tests/data/mycobot280.json"),
    ),
    (
        "sample",
        include_str!("../../core/tests/samples/sample.json"),
    ),
    ("crc", include_str!("../../core/tests/samples/crc.json")),
    ("sum", include_str!("../../core/tests/samples/sum.json")),
    ("alike", include_str!("../../core/tests/samples/alike.json")),
];

/// The ways to listen, in the order in which fuzz bytes pick them.
pub const LISTENING: [Listening; 3] = [
    Listening::To(Direction::Reply),
    Listening::To(Direction::Request),
    Listening::Both,
];

/// A table and what was made of it beforehand, so that a run costs only its own bytes.
pub struct Subject {
    /// Its name, as `tests/found` has it.
    pub name: &'static str,
    /// The table, with names and vectors.
    pub edition: Edition,
    /// Every form of its messages, for the script to pick from.
    pub forms: Vec<Form>,
    oracles: Vec<Oracle>,
}

impl Subject {
    /// The oracle for one of [`LISTENING`], by its index.
    pub fn oracle(&self, listening: usize, unknown: bool) -> &Oracle {
        &self.oracles[2 * listening + usize::from(unknown)]
    }
}

/// All of them.
pub fn all() -> &'static [Subject] {
    static ALL: LazyLock<Vec<Subject>> = LazyLock::new(|| FILES.map(subject).into());
    &ALL
}

fn subject((name, text): (&'static str, &str)) -> Subject {
    let edition = Edition::read(text);
    let oracles = LISTENING.iter().flat_map(|listening| {
        [false, true].map(|unknown| Oracle::new(&edition.table, *listening, unknown))
    });
    Subject {
        name,
        oracles: oracles.collect(),
        forms: forms(&edition.table),
        edition,
    }
}

/// Every form of every message of a table.
pub fn forms(table: &Table) -> Vec<Form> {
    let mut all = Vec::new();
    for (command, record) in table.commands().iter().enumerate() {
        for direction in [Direction::Request, Direction::Reply] {
            for layout in 0..record.layouts(direction).len() {
                all.push(Form {
                    direction,
                    command,
                    layout,
                });
            }
        }
    }
    all
}
