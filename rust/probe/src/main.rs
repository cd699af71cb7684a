//! Answers the tests in Python, one JSON value a line: `codec`, `exchange`, `client` or `texts`.

#![allow(clippy::indexing_slicing)] // reading a name of a JSON value never panics

#[cfg(unix)]
mod client;
mod codec;
mod exchange;
mod texts;
mod values;

use std::io::{BufRead, Error, Write, stdin, stdout};

use cobotwire_table::Edition;

/// Answer each line until there is no more.
fn main() -> std::io::Result<()> {
    let (mode, path) = (std::env::args().nth(1), std::env::args().nth(2));
    match mode.as_deref().unwrap_or_default() {
        "codec" => {
            let edition = Edition::read(&std::fs::read(path.unwrap_or_default())?);
            let edition = edition.map_err(Error::other)?;
            answer(|line| codec::answer(&edition, line))
        }
        "exchange" => {
            let mut exchanges = exchange::Exchanges::default();
            answer(|line| exchanges.answer(line))
        }
        #[cfg(unix)]
        "client" => client::serve(std::env::args().skip(2)),
        "texts" => {
            let mut texts = texts::Texts::default();
            answer(|line| texts.answer(line))
        }
        _ => Err(Error::other("codec, exchange, client or texts?")),
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
