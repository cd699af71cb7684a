//! The tables that are fuzzed: every edition, and the samples of features that no edition has.

use std::sync::{Arc, LazyLock, OnceLock};

use cobotwire_core::{Direction, Listening, Plans, Rules, Table, VariantId};

use crate::oracle::Oracle;
use crate::records::Edition;

/// The files of the core's tests; a new edition is a new line here. `make products` writes the
/// first two.
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

/// A table, and everything that is derived from it once, so that a run only processes its own
/// bytes.
pub struct Subject {
    /// Its name in `tests/found`.
    pub name: &'static str,
    /// The table, with names and vectors.
    pub edition: Edition,
    /// The same table behind an `Arc`.
    pub table: Arc<Table>,
    /// Every variant of its messages, for the script to pick from.
    pub variants: Vec<VariantId>,
    oracles: Vec<Oracle>,
    rules: Vec<Rules>,
    plans: [OnceLock<Arc<Plans>>; LISTENING.len()],
}

impl Subject {
    /// Return the oracle for one of [`LISTENING`], by its index.
    pub fn oracle(&self, listening: usize, unknown: bool) -> &Oracle {
        &self.oracles[2 * listening + usize::from(unknown)]
    }

    /// Return the core's rules for the same.
    pub fn rules(&self, listening: usize, unknown: bool) -> &Rules {
        &self.rules[2 * listening + usize::from(unknown)]
    }

    /// Return the plans for columns. They are made on first use: that is slow, and few targets need
    /// them.
    pub fn plans(&self, listening: usize) -> &Arc<Plans> {
        let make = || Arc::new(Plans::new(&self.table, LISTENING[listening]));
        self.plans[listening].get_or_init(make)
    }
}

/// Return all subjects.
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
        variants: variants(table),
        table: Arc::new(table.clone()),
        plans: Default::default(),
        edition,
    }
}

/// Return the rules for these directions; with `unknown`, they accept ids that the table lacks.
pub fn rules(table: &Table, listening: Listening, unknown: bool) -> Rules {
    let rules = table.rules(listening).clone();
    if unknown {
        rules.accepting_unknown()
    } else {
        rules
    }
}

/// Return every variant of every message of a table.
pub fn variants(table: &Table) -> Vec<VariantId> {
    let mut all = Vec::new();
    for (command, record) in table.commands().iter().enumerate() {
        for direction in [Direction::Request, Direction::Reply] {
            for variant in 0..record.variants(direction).len() {
                all.push(VariantId {
                    direction,
                    command,
                    variant,
                });
            }
        }
    }
    all
}
