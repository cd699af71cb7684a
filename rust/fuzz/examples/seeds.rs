//! Writes the first corpus: `seeds FOLDER` makes a folder a target there, with a file for each
//! vector of each table, all vectors of a table in a row, and what stands in `tests/found`.

use std::path::Path;
use std::{env, fs, io};

use cobotwire_core::{Direction, Listening};
use cobotwire_fuzz::input::Input;
use cobotwire_fuzz::replay;
use cobotwire_fuzz::subjects::{self, LISTENING};

/// The targets whose input is a head and a stream. `tables` makes its own tables and has no seeds.
const TARGETS: [&str; 4] = ["framer", "chunks", "decode", "linear"];

const FOUND: [&str; 2] = [
    include_str!("../../../tests/found/streams.txt"),
    include_str!("../../../tests/found/frames.txt"),
];

fn main() -> io::Result<()> {
    let folder = env::args_os().nth(1).expect("seeds FOLDER");
    let seeds: Vec<Vec<u8>> = vectors().chain(found()).collect();
    for target in TARGETS {
        let folder = Path::new(&folder).join(target);
        fs::create_dir_all(&folder)?;
        for (number, seed) in seeds.iter().enumerate() {
            fs::write(folder.join(format!("seed-{number:04}")), seed)?;
        }
    }
    println!("{} seeds a target", seeds.len());
    Ok(())
}

fn vectors() -> impl Iterator<Item = Vec<u8>> {
    subjects::all()
        .iter()
        .enumerate()
        .flat_map(|(index, subject)| {
            let mut row = Vec::new();
            let mut seeds = Vec::new();
            for vector in &subject.edition.vectors {
                let listening = Listening::To(vector.direction);
                for bytes in vector.frame.iter().chain(&vector.printed) {
                    row.extend(bytes);
                    seeds.push(seed(index, listening, false, bytes));
                }
            }
            seeds.push(seed(index, Listening::Both, false, &row));
            seeds
        })
}

fn found() -> impl Iterator<Item = Vec<u8>> {
    let [streams, singles] = FOUND;
    let streams = replay::streams(streams).into_iter().map(|stream| {
        let table = table(&stream.table);
        seed(table, stream.listening, stream.unknown, &stream.bytes())
    });
    let singles = replay::singles(singles).into_iter().map(|single| {
        let direction: Direction = single.direction;
        let table = table(&single.table);
        seed(table, Listening::To(direction), false, &single.bytes)
    });
    streams.chain(singles)
}

fn table(name: &str) -> usize {
    let mut all = subjects::all().iter();
    all.position(|subject| subject.name == name)
        .expect("a table that is fuzzed")
}

fn seed(subject: usize, listening: Listening, unknown: bool, stream: &[u8]) -> Vec<u8> {
    let mut ways = LISTENING.iter();
    let listening = ways.position(|way| *way == listening).expect("all are");
    [&Input::head(subject, listening, unknown), stream].concat()
}
