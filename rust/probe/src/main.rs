//! Answers the tests in Python, one JSON value a line: `codec`, `exchange` or `client`.

mod codec;
mod exchange;
mod values;

use cobotwire_table::Edition;
use std::io::{BufRead, Write, stdin, stdout};

/// Answer each line until there is no more.
fn main() -> std::io::Result<()> {
    let mode = std::env::args().nth(1).unwrap_or_default();
    match mode.as_str() {
        "exchange" => {
            let mut exchanges = exchange::Exchanges::default();
            answer(|line| exchanges.answer(line))
        }
        "codec" => {
            let path = std::env::args().nth(2).unwrap_or_default();
            let edition = Edition::read(&std::fs::read(path)?).map_err(std::io::Error::other)?;
            answer(|line| codec::answer(&edition, line))
        }
        _ => Err(std::io::Error::other("codec, exchange or client?")),
    }
}

fn answer(mut reply: impl FnMut(&str) -> String) -> std::io::Result<()> {
    let mut output = stdout().lock();
    for line in stdin().lock().lines() {
        writeln!(output, "{}", reply(&line?))?;
        output.flush()?;
    }
    Ok(())
}
