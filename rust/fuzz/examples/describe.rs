//! Prints a fuzz input as lines for `tests/found`: `describe TARGET FILE`.
//!
//! The expected result comes from the oracle, so this works for inputs that break the core. Review
//! it before you commit it.

use std::{env, fs};

use cobotwire_core::{Direction, Listening, Table};
use cobotwire_fuzz::bytes::Bytes;
use cobotwire_fuzz::input::Input;
use cobotwire_fuzz::oracle::{Found, Oracle};
use cobotwire_fuzz::subjects::LISTENING;
use cobotwire_fuzz::{random, reading};

fn main() {
    let mut words = env::args().skip(1);
    let (Some(target), Some(path)) = (words.next(), words.next()) else {
        panic!("describe TARGET FILE");
    };
    let data = fs::read(path).expect("a readable file");
    match &target[..] {
        "tables" => println!("{:#?}", random::table(&mut Bytes(&data))),
        "exchange" => println!("{data:?}"),
        "decode" => frames(&Input::read(&data)),
        "columns" | "linear" => pattern(&Input::read(&data)),
        _ => stream(&Input::read(&data)),
    }
}

/// Print the stream, and how a long stream was made from it.
fn pattern(input: &Input) {
    stream(input);
    if input.long {
        println!("a long stream was made from this: {:?}", input.cutting);
    }
}

/// Print a line for `streams.txt`.
fn stream(input: &Input) {
    let oracle = input.oracle();
    let unknown = if input.unknown { " unknown" } else { "" };
    let listening = listening(LISTENING[input.listening]);
    let mut chunks = String::new();
    let mut events: Vec<(usize, &str)> = Vec::new();
    let mut silence: Vec<u8> = Vec::new();
    let all = input.chunks();
    for (index, chunk) in all.iter().enumerate() {
        let last = index + 1 == all.len();
        silence.extend(chunk.bytes);
        chunks += &hex(chunk.bytes);
        chunks += match (chunk.flush, last) {
            (true, _) => " ! ",
            (false, true) => "",
            (false, false) => " / ",
        };
        if chunk.flush || last {
            add(oracle, &silence, &mut events);
            silence.clear();
        }
    }
    let events = events.iter().map(|(size, word)| format!("{word} {size}"));
    let events = events.collect::<Vec<_>>().join(", ");
    let name = &input.subject.name;
    println!("{name} {listening}{unknown} | {} | {events}", chunks.trim());
}

/// Add the events up to a silence; join noise with the noise before it.
fn add(oracle: &Oracle, bytes: &[u8], events: &mut Vec<(usize, &'static str)>) {
    for (size, reason) in oracle.spans(bytes, true).0 {
        let word = reason.map_or("frame", |reason| reason.word());
        match events.last_mut() {
            Some((before, last)) if reason.is_some() && *last == word => *before += size,
            _ => events.push((size, word)),
        }
    }
}

/// Print lines for `frames.txt`: the input itself and the frames in it, in both directions.
fn frames(input: &Input) {
    for (index, direction) in [(0, Direction::Reply), (1, Direction::Request)] {
        let oracle = input.subject.oracle(index, false);
        let mut at = 0;
        let mut singles = vec![&input.stream[..]];
        for (size, reason) in oracle.spans(&input.stream, true).0 {
            if reason.is_none() && size < input.stream.len() {
                singles.push(&input.stream[at..at + size]);
            }
            at += size;
        }
        for bytes in singles {
            let outcome = outcome(input, oracle, direction, bytes);
            let way = listening(Listening::To(direction));
            println!("{} {way} | {} | {outcome}", input.subject.name, hex(bytes));
        }
    }
}

fn outcome(input: &Input, oracle: &Oracle, direction: Direction, bytes: &[u8]) -> String {
    let (reason, offset) = match oracle.look(bytes) {
        Found::Frame(size) if size == bytes.len() => {
            return value(input, direction, bytes);
        }
        Found::Frame(size) => ("trailing", size),
        Found::Waits => ("truncated", bytes.len()),
        Found::Noise(reason) => {
            // The longest prefix that still waits ends before the byte that rejects the frame.
            let mut ends = 0..bytes.len();
            let end = ends.rfind(|end| oracle.look(&bytes[..*end]) == Found::Waits);
            (reason.word(), end.unwrap_or_default())
        }
    };
    format!("{reason} {offset}")
}

fn value(input: &Input, direction: Direction, bytes: &[u8]) -> String {
    let table: &Table = &input.subject.table;
    match reading::read(table, direction, bytes, None).expect("a legal frame has a variant") {
        Ok(decoded) => {
            let name = &input.subject.names[decoded.variant.command];
            format!("{name} {}", decoded.variant.variant)
        }
        Err(bad) => format!("bad-value {}", bad.offset),
    }
}

fn listening(listening: Listening) -> &'static str {
    match listening {
        Listening::To(Direction::Request) => "request",
        Listening::To(Direction::Reply) => "reply",
        Listening::Both => "both",
    }
}

fn hex(bytes: &[u8]) -> String {
    let bytes: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    bytes.join(" ")
}
