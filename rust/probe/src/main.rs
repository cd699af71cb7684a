//! Serves the Python tests: each line of input is a list of steps in JSON, and each line of output
//! the list of their results. With the argument `client` it is a client instead: see `client.rs`.

// A wrong step is a mistake in a test: the program panics, and the test fails.
#![allow(clippy::indexing_slicing, clippy::unwrap_used)]

#[cfg(unix)]
mod client;
mod exchange;
mod values;

use std::collections::BTreeMap;
use std::io::{self, BufRead, Write, stdin, stdout};
use std::sync::Arc;

use cobotwire::Value;
use cobotwire_core::exchange::PersistedState;
use cobotwire_core::{Choice, Direction, decode, encode};
use cobotwire_table::Edition;
use serde_json::{Value as Json, json};

use crate::exchange::Open;
use crate::values::{from_hex, index, row_of};

/// An edition, or why it was rejected.
type Read = Result<Arc<Edition>, String>;

/// What earlier steps have read and opened.
#[derive(Default)]
struct Probe {
    editions: BTreeMap<String, Read>,
    exchanges: BTreeMap<u64, Open>,
    left: PersistedState,
}

fn main() -> io::Result<()> {
    #[cfg(unix)]
    if std::env::args().nth(1).as_deref() == Some("client") {
        return client::serve(std::env::args().skip(2));
    }
    let (mut probe, mut output) = (Probe::default(), stdout().lock());
    for line in stdin().lock().lines() {
        let steps: Vec<Vec<Json>> = serde_json::from_str(&line?)?;
        let results: Json = steps.iter().map(|step| probe.result(step)).collect();
        writeln!(output, "{results}")?;
        output.flush()?;
    }
    Ok(())
}

impl Probe {
    /// Do `["read" or "table", path]`, `["encode", path, direction, command, values]`,
    /// `["decode", path, direction, bytes]`, `["new", path, exchange]`, or a step of an exchange:
    /// `[method, path, exchange, now, arguments...]`.
    fn result(&mut self, step: &[Json]) -> Json {
        let path = step[1].as_str().unwrap();
        let edition = match self.edition(path) {
            Ok(edition) => edition,
            Err(why) => return json!(why),
        };
        match step[0].as_str().unwrap() {
            "read" => Json::Null,
            "table" => {
                let table = &edition.protocol.table;
                json!(format!("{:?} {:?}", table.frame(), table.commands()))
            }
            "encode" => json!(encode_error(&edition, &step[2..])),
            "decode" => json!(decode_error(&edition, &step[2..])),
            "new" => {
                let number = step[2].as_u64().unwrap();
                self.exchanges.insert(number, Open::new(edition));
                Json::Null
            }
            method => {
                let (number, now) = (step[2].as_u64().unwrap(), step[3].as_u64().unwrap());
                let open = self.exchanges.get_mut(&number).unwrap();
                open.step(method, now, &step[4..], &mut self.left)
            }
        }
    }

    fn edition(&mut self, path: &str) -> Read {
        let known = self.editions.entry(path.into()).or_insert_with(|| {
            let edition = Edition::read(&std::fs::read(path).unwrap());
            edition.map(Arc::new).map_err(|why| why.to_string())
        });
        known.clone()
    }
}

fn direction(word: &Json) -> Direction {
    if word == "request" {
        Direction::Request
    } else {
        Direction::Reply
    }
}

/// Return the text of the error of a message that cannot be encoded.
fn encode_error(edition: &Edition, step: &[Json]) -> Option<String> {
    let (direction, index) = (direction(&step[0]), index(edition, &step[1]));
    let (table, values) = (&edition.protocol.table, row_of(&step[2]));
    let (command, choice) = (&table.commands()[index], Choice::default());
    let error = encode::<Value>(table.frame(), command, direction, &values, choice).err()?;
    Some(edition.encode_error((index, direction), &error, values.len(), None))
}

/// Return the text of the error of bytes that cannot be decoded.
fn decode_error(edition: &Edition, step: &[Json]) -> Option<String> {
    let (direction, data) = (direction(&step[0]), from_hex(&step[1]));
    let error = decode(&edition.protocol.table, direction, &data, None).err()?;
    Some(edition.decode_error(direction, error, &data))
}
