//! Checks the inputs of `tests/found`: fuzzing found them, or people wrote them as hard cases.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Owned, events};
use crate::records::Edition;
use crate::replay::{Single, Stream};
use cobotwire_core::{DecodeError, Event, Framer, OffsetReader, Rules, decode};

fn folder(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn text(name: &str) -> String {
    fs::read_to_string(folder("../../tests/found").join(name)).expect("a readable file")
}

/// Return every edition, and the samples of features that no edition has.
fn tables() -> HashMap<String, Edition> {
    let folders = ["tests/data", "tests/samples"].map(folder);
    let entries = folders
        .iter()
        .flat_map(|folder| fs::read_dir(folder).expect("no test data: run `make products` first"));
    entries
        .map(|entry| {
            let path = entry.expect("a readable entry").path();
            let name = path.file_stem().expect("a name").to_string_lossy();
            let text = fs::read_to_string(&path).expect("a readable file");
            (name.into_owned(), Edition::read(&text))
        })
        .collect()
}

fn rules(tables: &HashMap<String, Edition>, stream: &Stream) -> Rules {
    let rules = tables[&stream.table].table.rules(stream.listening).clone();
    if stream.unknown {
        rules.accepting_unknown()
    } else {
        rules
    }
}

fn framer(tables: &HashMap<String, Edition>, stream: &Stream) -> Framer {
    Framer::new(rules(tables, stream))
}

/// Return the events recorded in the file, with their offsets and bytes.
fn recorded(stream: &Stream) -> Vec<Owned> {
    let bytes = stream.bytes();
    let mut at = 0;
    let mut all = Vec::new();
    for (size, reason) in &stream.events {
        all.push((at as u64, bytes[at..at + size].to_vec(), *reason));
        at += size;
    }
    assert_eq!(at, bytes.len(), "the file covers every byte of {stream:?}");
    all
}

/// Return the events of a stream with its recorded silences; noise of one reason is joined.
fn cut(framer: &mut Framer, stream: &Stream) -> Vec<Owned> {
    let mut all: Vec<Owned> = Vec::new();
    let mut add = |event: Event<'_>| {
        let (offset, data, reason) = crate::common::owned(event);
        match all.last_mut() {
            Some(last) if reason.is_some() && last.2 == reason => last.1.extend(data),
            _ => all.push((offset, data, reason)),
        }
    };
    for (bytes, silence) in &stream.chunks {
        framer.feed(bytes, &mut add);
        if *silence {
            framer.flush(&mut add);
        }
    }
    framer.flush(&mut add);
    all
}

#[test]
fn every_found_stream_has_its_recorded_events() {
    let tables = tables();
    let streams = crate::replay::streams(&text("streams.txt"));
    assert!(!streams.is_empty());
    for stream in &streams {
        let events = cut(&mut framer(&tables, stream), stream);
        assert_eq!(events, recorded(stream), "{stream:?}");
    }
}

#[test]
fn events_of_every_found_stream_do_not_depend_on_chunks() {
    let tables = tables();
    for stream in crate::replay::streams(&text("streams.txt")) {
        if stream.chunks.iter().any(|(_, silence)| *silence) {
            continue;
        }
        let bytes = stream.bytes();
        for size in 1..=bytes.len() {
            let found = events(&mut framer(&tables, &stream), bytes.chunks(size));
            assert_eq!(found, recorded(&stream), "in chunks of {size}: {stream:?}");
        }
    }
}

#[test]
fn bulk_reading_finds_the_frames_of_every_found_stream() {
    let tables = tables();
    for stream in crate::replay::streams(&text("streams.txt")) {
        if stream.chunks.iter().any(|(_, silence)| *silence) {
            continue;
        }
        let mut reader = OffsetReader::new(rules(&tables, &stream), None);
        let mut frames = Vec::new();
        for (bytes, _) in &stream.chunks {
            reader.feed(bytes);
            frames.extend(reader.take().frames);
        }
        reader.flush();
        frames.extend(reader.take().frames);
        let recorded = recorded(&stream).into_iter();
        let recorded: Vec<u64> = recorded
            .filter(|event| event.2.is_none())
            .map(|e| e.0)
            .collect();
        assert_eq!(frames, recorded, "{stream:?}");
    }
}

#[test]
fn every_found_frame_is_decoded_or_rejected_as_recorded() {
    let tables = tables();
    let singles = crate::replay::singles(&text("frames.txt"));
    assert!(!singles.is_empty());
    for single in &singles {
        assert_eq!(
            read(&tables[&single.table], single),
            single.outcome,
            "{single:?}"
        );
    }
}

fn read(edition: &Edition, single: &Single) -> (String, usize) {
    let of = single.of.as_ref().map(|of| {
        let mut names = edition.names.iter();
        names.position(|name| name == of).expect("a command")
    });
    match decode(&edition.table, single.direction, &single.bytes, of) {
        Ok(decoded) => {
            let name = edition.names[decoded.variant.command].clone();
            (name, decoded.variant.variant)
        }
        Err(DecodeError::Frame { reason, offset }) => (reason.word().to_owned(), offset),
        Err(DecodeError::Raw(bad)) => ("bad-value".to_owned(), bad.offset),
    }
}
