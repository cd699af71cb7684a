//! Reads the table of every edition.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

use std::fs;
use std::path::Path;

use cobotwire_table::Edition;

#[test]
fn every_edition_is_read() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/cobotwire/editions");
    let mut read = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path().join("edition.json");
        let Ok(json) = fs::read(&path) else { continue };
        let edition = Edition::read(&json).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        assert_eq!(edition.commands.len(), edition.protocol.facts.len());
        assert_eq!(
            edition.commands.len(),
            edition.protocol.table.commands().len()
        );
        read += 1;
    }
    assert_eq!(read, 16);
}
