//! Writes the initial corpus: `seeds FOLDER` makes a folder there for each target. The files in it
//! hold one frame of each variant, all frames of each table in a row, and the inputs of
//! `tests/found`; random bytes for targets that make their own tables or recordings.

use std::path::Path;
use std::{env, fs, io};

use cobotwire_core::Listening;
use cobotwire_fuzz::input::Input;
use cobotwire_fuzz::replay;
use cobotwire_fuzz::subjects::{self, LISTENING};

/// The targets whose input is a head and a stream.
const TARGETS: [&str; 3] = ["framer", "chunks", "decode"];
/// The targets that need much time for each input.
const SLOW_TARGETS: [&str; 2] = ["columns", "linear"];

const FOUND: [&str; 2] = [
    include_str!("../../../tests/found/streams.txt"),
    include_str!("../../../tests/found/frames.txt"),
];

fn main() -> io::Result<()> {
    let folder = env::args_os().nth(1).expect("seeds FOLDER");
    let folder = Path::new(&folder);
    let streams: Vec<Vec<u8>> = rows().chain(found()).collect();
    let all: Vec<Vec<u8>> = frames().chain(streams.clone()).collect();
    for target in TARGETS {
        write(&folder.join(target), &all)?;
    }
    for target in SLOW_TARGETS {
        write(&folder.join(target), &streams)?;
    }
    write(&folder.join("tables"), &dice())?;
    write(&folder.join("captures"), &dice())?;
    write(&folder.join("exchange"), &dice())?;
    println!("{} seeds", all.len());
    Ok(())
}

fn write(folder: &Path, seeds: &[Vec<u8>]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    for (number, seed) in seeds.iter().enumerate() {
        fs::write(folder.join(format!("seed-{number:04}")), seed)?;
    }
    Ok(())
}

/// Return seeds for the targets that make their own tables or recordings: random bytes, long enough
/// for a table and a stream.
fn dice() -> Vec<Vec<u8>> {
    let mut state = 1_u32;
    let mut byte = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 24) as u8
    };
    let sizes = (0..300).map(|number| 20 + number);
    sizes
        .map(|size| (0..size).map(|_| byte()).collect())
        .collect()
}

/// Return a seed for a frame of each variant.
fn frames() -> impl Iterator<Item = Vec<u8>> {
    let subjects = subjects::all().iter().enumerate();
    subjects.flat_map(|(index, subject)| {
        let frames = subject.variants.iter().zip(&subject.frames);
        frames.map(move |(variant, frame)| {
            seed(index, Listening::To(variant.direction), false, frame)
        })
    })
}

/// Return a seed for each table: all its frames, one after the other.
fn rows() -> impl Iterator<Item = Vec<u8>> {
    let subjects = subjects::all().iter().enumerate();
    subjects.map(|(index, subject)| seed(index, Listening::Both, false, &subject.frames.concat()))
}

fn found() -> impl Iterator<Item = Vec<u8>> {
    let [streams, singles] = FOUND;
    let streams = replay::streams(streams).into_iter().map(|stream| {
        let table = table(&stream.table);
        seed(table, stream.listening, stream.unknown, &stream.bytes())
    });
    let singles = replay::singles(singles).into_iter().map(|single| {
        let listening = Listening::To(single.direction);
        seed(table(&single.table), listening, false, &single.bytes)
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
    let listening = ways
        .position(|way| *way == listening)
        .expect("LISTENING has every value");
    [&Input::head(subject, listening, unknown), stream].concat()
}
