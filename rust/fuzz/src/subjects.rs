//! The tables that are fuzzed: every edition, and the samples of what no edition has.

use std::sync::{Arc, LazyLock, OnceLock};

use cobotwire_core::{Direction, Form, Listening, Plans, Rules, Table};

use crate::oracle::Oracle;
use crate::records::Edition;

/// The files as the core's tests have them; a new edition is a new line here.
const FILES: [(&str, &str); 7] = [
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
    ("long", include_str!("../../core/tests/samples/long.json")),
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
    /// The same table, to be shared.
    pub table: Arc<Table>,
    /// Every form of its messages, for the script to pick from.
    pub forms: Vec<Form>,
    oracles: Vec<Oracle>,
    rules: Vec<Rules>,
    plans: [OnceLock<Arc<Plans>>; LISTENING.len()],
}

impl Subject {
    /// The oracle for one of [`LISTENING`], by its index.
    pub fn oracle(&self, listening: usize, unknown: bool) -> &Oracle {
        &self.oracles[2 * listening + usize::from(unknown)]
    }

    /// The core's rules for the same.
    pub fn rules(&self, listening: usize, unknown: bool) -> &Rules {
        &self.rules[2 * listening + usize::from(unknown)]
    }

    /// How columns are read. To make that takes long, and not every target needs it.
    pub fn plans(&self, listening: usize) -> &Arc<Plans> {
        let make = || Arc::new(Plans::new(&self.table, LISTENING[listening]));
        self.plans[listening].get_or_init(make)
    }
}

/// All of them.
pub fn all() -> &'static [Subject] {
    static ALL: LazyLock<Vec<Subject>> = LazyLock::new(|| FILES.map(subject).into());
    &ALL
}

fn subject((name, text): (&'static str, &str)) -> Subject {
    let edition = Edition::read(text);
    let table = &edition.table;
    let each = || {
        LISTENING
            .iter()
            .flat_map(|way| [(*way, false), (*way, true)])
    };
    let oracles = each().map(|(way, unknown)| Oracle::new(table, way, unknown));
    let rules = each().map(|(way, unknown)| rules(table, way, unknown));
    Subject {
        name,
        oracles: oracles.collect(),
        rules: rules.collect(),
        forms: forms(table),
        table: Arc::new(table.clone()),
        plans: Default::default(),
        edition,
    }
}

/// The rules for listening so; `unknown`: to ids, too, that the table lacks.
pub fn rules(table: &Table, listening: Listening, unknown: bool) -> Rules {
    let rules = table.rules(listening).clone();
    if unknown {
        rules.accepting_unknown()
    } else {
        rules
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
