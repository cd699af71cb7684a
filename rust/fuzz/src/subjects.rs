//! The tables that are fuzzed: two editions, and samples of features that these editions lack.

use std::sync::{Arc, LazyLock, OnceLock};

use cobotwire_core::{Direction, Listening, Plans, Rules, Table, VariantId};
use cobotwire_table::Edition;

use crate::oracle::Oracle;
use crate::script;

/// The files of the tables.
const FILES: [&[u8]; 7] = [
    include_bytes!("../../../python/cobotwire/editions/mycobot/edition.json"),
    include_bytes!("../../../python/cobotwire/editions/mycobot280/edition.json"),
    include_bytes!("../../../tests/found/sample.json"),
    include_bytes!("../../../tests/found/crc.json"),
    include_bytes!("../../../tests/found/sum.json"),
    include_bytes!("../../../tests/found/long.json"),
    include_bytes!("../../../tests/found/alike.json"),
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
    pub name: String,
    pub table: Arc<Table>,
    /// The names of the table's commands.
    pub names: Vec<String>,
    /// Every variant of its messages, for the script to pick from.
    pub variants: Vec<VariantId>,
    /// A legal frame of each variant, in the same order.
    pub frames: Vec<Vec<u8>>,
    oracles: Vec<Oracle>,
    rules: Vec<Rules>,
    plans: [OnceLock<Arc<Plans>>; LISTENING.len()],
}

impl Subject {
    /// Return the oracle for one of [`LISTENING`], by its index.
    pub fn oracle(&self, listening: usize, unknown: bool) -> &Oracle {
        &self.oracles[2 * listening + usize::from(unknown)]
    }

    /// Return the core's rules for one of [`LISTENING`], by its index.
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

fn subject(file: &[u8]) -> Subject {
    let edition = Edition::read(file).expect("the file is the table of a protocol");
    let table = &edition.protocol.table;
    let each = || {
        LISTENING
            .iter()
            .flat_map(|way| [(*way, false), (*way, true)])
    };
    let oracles = each().map(|(way, unknown)| Oracle::new(table, way, unknown));
    let rules = each().map(|(way, unknown)| rules(table, way, unknown));
    let variants = variants(table);
    Subject {
        oracles: oracles.collect(),
        rules: rules.collect(),
        frames: script::every(table, &variants),
        variants,
        plans: Default::default(),
        name: edition.name,
        names: edition.commands.into_iter().map(|each| each.name).collect(),
        table: Arc::new(edition.protocol.table),
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
