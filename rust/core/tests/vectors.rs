//! Checks vectors: frames of a table with their values.
//!
//! The generator writes the spec's vectors into `data` (`make products`), which git ignores.
//! `samples` is written by hand in the same format, for features that no edition has.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Sample, Samples, events};
use crate::records::{Edition, Vector};
use cobotwire_core::{Choice, DecodeError, Direction, Framer, Listening, Value, decode, encode};

/// Noise that forms no frame together with the bytes after it.
const NOISE: [&[u8]; 5] = [
    &[],
    &[0x00],
    &[0xFE],
    &[0xFE, 0xFE],
    &[0xFA, 0xFE, 0xFE, 0xFF, 0x0D],
];

fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests")
        .join(folder);
    let entries = fs::read_dir(folder).expect("no test data: run `make products` first");
    let paths = entries.map(|entry| entry.expect("a readable entry").path());
    paths
        .filter(|path| path.extension().is_some_and(|name| name == "json"))
        .collect()
}

fn check_all(folder: &str) {
    let files = files(folder);
    assert!(!files.is_empty(), "{folder} holds no table");
    for path in files {
        let edition = Edition::read(&fs::read_to_string(&path).expect("a readable file"));
        let checked = edition
            .vectors
            .iter()
            .filter(|vector| check(&edition, vector))
            .count();
        assert!(checked > 0, "{} holds no vector", path.display());
    }
}

#[test]
fn every_vector_of_the_spec_holds() {
    check_all("data");
}

#[test]
fn every_sample_holds() {
    check_all("samples");
}

/// Check a vector; return false for an unframed reply, which no codec handles.
fn check(edition: &Edition, vector: &Vector) -> bool {
    if let (Some(frame), false) = (&vector.frame, vector.text) {
        assert_eq!(&encoded(edition, vector), frame, "encode {}", vector.name);
        let of = Some(index(edition, vector));
        let decoded = decode(&edition.table, vector.direction, frame, of);
        let decoded = decoded.unwrap_or_else(|error| panic!("decode {}: {error:?}", vector.name));
        assert!(
            same(&decoded.values, &vector.values),
            "{}: {decoded:?}",
            vector.name
        );
        find(edition, vector.direction, frame, &vector.name);
    }
    if let (Some(printed), Some(rejected)) = (&vector.printed, &vector.rejected) {
        let met = match decode(&edition.table, vector.direction, printed, None) {
            Err(DecodeError::Frame { reason, offset }) => (reason.word().to_owned(), offset),
            Err(DecodeError::Raw(bad)) => ("bad-value".to_owned(), bad.offset),
            Ok(decoded) => panic!("{} was decoded: {decoded:?}", vector.name),
        };
        assert_eq!(&met, rejected, "{}", vector.name);
    }
    !vector.text && (vector.frame.is_some() || vector.rejected.is_some())
}

fn encoded(edition: &Edition, vector: &Vector) -> Vec<u8> {
    let (frame, command) = (
        edition.table.frame(),
        &edition.table.commands()[index(edition, vector)],
    );
    let values = Samples(vector.values.clone());
    // A vector's frame may go to any address, which follows the header.
    let addressed = !frame.addresses.is_empty();
    let at = frame.header.len();
    let choice = Choice {
        address: addressed.then(|| vector.frame.as_ref().expect("a frame")[at]),
        ..Choice::default()
    };
    encode::<Sample>(frame, command, vector.direction, &values, choice)
        .unwrap_or_else(|error| panic!("encode {}: {error:?}", vector.name))
}

fn index(edition: &Edition, vector: &Vector) -> usize {
    let mut names = edition.names.iter();
    names
        .position(|name| name == &vector.command)
        .unwrap_or_else(|| panic!("no command {}", vector.command))
}

fn same(mut decoded: &[Value], values: &[Sample]) -> bool {
    let alike = values.iter().all(|value| {
        let Some((first, rest)) = decoded.split_first() else {
            return false;
        };
        decoded = rest;
        match (first, value) {
            (Value::Integer(integer), Sample::Integer(expected)) => integer == expected,
            (Value::Integer(integer), Sample::Bool(expected)) => *integer == i64::from(*expected),
            (Value::Real(real), Sample::Real(expected)) => real == expected,
            (Value::Real(real), Sample::Integer(expected)) => *real == *expected as f64,
            (
                Value::Row(count) | Value::Bytes(count) | Value::Text(count, _),
                Sample::Row(expected),
            ) => {
                let (row, rest) = decoded.split_at(*count);
                decoded = rest;
                same(row, expected)
            }
            _ => false,
        }
    });
    alike && decoded.is_empty()
}

fn find(edition: &Edition, direction: Direction, frame: &[u8], name: &str) {
    for noise in NOISE {
        let stream = [noise, frame].concat();
        for listening in [Listening::To(direction), Listening::Both] {
            let mut framer = Framer::new(edition.table.rules(listening).clone());
            let found = events(&mut framer, [&stream[..]]);
            let expected = (noise.len() as u64, frame.to_vec(), None);
            assert_eq!(found.last(), Some(&expected), "{name} after {noise:02X?}");
        }
    }
}
