//! Answers the tests in Python, one JSON value a line: `codec`, `exchange` or `client`.

#[cfg(unix)]
mod client;
mod exchange;
mod values;

use std::io::{BufRead, Write, stdin, stdout};

/// Answer each line until there is no more.
fn main() -> std::io::Result<()> {
    let mode = std::env::args().nth(1).unwrap_or_default();
    match mode.as_str() {
        "exchange" => {
            let mut exchanges = exchange::Exchanges::default();
            answer(|line| exchanges.answer(line))
        }
        #[cfg(unix)]
        "client" => client::serve(std::env::args().skip(2)),
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
