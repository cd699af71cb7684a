//! Reads the table of every edition, and files that are damaged in many ways.

// A failing test may panic.
#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used
)]

use std::fs;
use std::path::Path;

use cobotwire_table::Edition;

mod damage;

use damage::{changed, used};

/// The index of the smallest file.
const MYCOBOT: usize = 8;

fn files() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/cobotwire/editions");
    let folders = fs::read_dir(folder).unwrap();
    let paths = folders.map(|entry| entry.unwrap().path().join("edition.json"));
    let mut paths: Vec<_> = paths.filter(|path| path.exists()).collect();
    paths.sort();
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// Return a small random number generator, so that the tests need no crate for it.
fn dice(mut state: u64) -> impl FnMut(usize) -> usize {
    move |sides| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 33) as usize % sides
    }
}

#[test]
fn every_edition_is_read() {
    let files = files();
    assert_eq!(files.len(), 16);
    for json in files {
        let edition = Edition::read(&json).unwrap();
        let table = &edition.protocol.table;
        assert_eq!(edition.commands.len(), table.commands().len());
        assert_eq!(edition.commands.len(), edition.protocol.facts.len());
        for (command, facts) in table.commands().iter().zip(&edition.protocol.facts) {
            assert_eq!(command.request.len(), facts.request.len());
            assert_eq!(command.reply.len(), facts.reply.len());
        }
    }
}

#[test]
fn damaged_bytes_give_a_table_or_a_sentence() {
    let (file, mut roll) = (files().swap_remove(MYCOBOT), dice(38));
    for _ in 0..60 {
        let mut damaged = file.clone();
        for _ in 0..=roll(3) {
            let at = roll(damaged.len());
            match roll(8) {
                0 => damaged.truncate(at + 1),
                1..4 => drop(damaged.drain(at..damaged.len().min(at + 9))),
                _ => damaged[at] = roll(256) as u8,
            }
        }
        used(&damaged);
    }
}

#[test]
fn other_values_give_a_table_or_a_sentence() {
    let files = files();
    let mut roll = dice(1);
    // The second has addresses, floats or lists that the first lacks.
    for index in [MYCOBOT, 7, 14] {
        let document = serde_json::from_slice(&files[index]).unwrap();
        for _ in 0..60 {
            used(&changed(&document, &mut roll));
        }
    }
}

#[test]
fn a_mistake_is_named_with_its_place() {
    let file = String::from_utf8(files().swap_remove(MYCOBOT)).unwrap();
    for (old, new, sentence) in [
        (
            "\"version\": 3",
            "\"version\": 4",
            "the file has version 4 of the format, not 3",
        ),
        (
            "\"deadline_ms\": 500, \"reply\"",
            "\"deadline_ms\": \"x\", \"reply\"",
            "command is_power_on: deadline_ms: invalid type: string \"x\", expected u64",
        ),
    ] {
        let error = Edition::read(file.replacen(old, new, 1).as_bytes()).unwrap_err();
        assert_eq!(error.to_string(), sentence);
    }
    let deep = "[".repeat(100_000);
    let error = Edition::read(deep.as_bytes()).unwrap_err().to_string();
    assert!(
        error.starts_with("the file is not JSON: recursion limit"),
        "{error}"
    );
}

#[test]
fn short_file_cannot_fill_the_memory() {
    let mut file: serde_json::Value =
        serde_json::from_slice(&files().swap_remove(MYCOBOT)).unwrap();
    // Each of 3,000 numbers repeats 100,000 choices: 2.4 GB.
    let wide = serde_json::json!({"name": "wide", "kind": "quantity", "wire": "byte", "choices": vec![1; 100_000]});
    let items = vec![serde_json::json!({"name": "x", "type": "wide"}); 3000];
    let row = serde_json::json!({"name": "row", "kind": "value", "items": items});
    file["types"].as_array_mut().unwrap().extend([wide, row]);
    file["commands"][0]["reply"] = serde_json::json!([[{"name": "row", "type": "row"}]]);
    let json = serde_json::to_vec(&file).unwrap();
    assert!(json.len() < 1 << 20);
    let error = Edition::read(&json).unwrap_err().to_string();
    assert!(
        error.ends_with("all types and messages take too much memory"),
        "{error}"
    );
}
