//! Reads `tests/found`: inputs that once failed, each with its expected result. Python's tests read
//! the same files; the top of each file explains its format.

use cobotwire_core::{Direction, Listening, Reason};

/// A stream and its events.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stream {
    pub table: String,
    pub listening: Listening,
    pub unknown: bool,
    /// The bytes of each chunk, and whether silence follows it.
    pub chunks: Vec<(Vec<u8>, bool)>,
    /// The size of each event, and the reason of noise; a frame has no reason.
    pub events: Vec<(usize, Option<Reason>)>,
}

impl Stream {
    /// Return all its bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let chunks = self.chunks.iter().map(|(bytes, _)| &bytes[..]);
        chunks.collect::<Vec<_>>().concat()
    }
}

/// Bytes to decode, and the result: a command and its variant, or a reason and an offset.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Single {
    pub table: String,
    pub direction: Direction,
    pub of: Option<String>,
    pub bytes: Vec<u8>,
    pub outcome: (String, usize),
}

/// Return the streams of `streams.txt`.
pub fn streams(text: &str) -> Vec<Stream> {
    lines(text).map(stream).collect()
}

/// Return the frames of `frames.txt`.
pub fn singles(text: &str) -> Vec<Single> {
    lines(text).map(single).collect()
}

fn lines(text: &str) -> impl Iterator<Item = [&str; 3]> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.filter(|line| !line.trim().is_empty()).map(|line| {
        let parts: Vec<&str> = line.split('|').map(str::trim).collect();
        parts.try_into().expect("a line has three parts")
    })
}

fn stream([what, chunks, events]: [&str; 3]) -> Stream {
    let words: Vec<&str> = what.split_whitespace().collect();
    Stream {
        table: words[0].to_owned(),
        listening: listening(words[1]),
        unknown: words.get(2).is_some_and(|word| *word == "unknown"),
        chunks: chunks.split_inclusive(['/', '!']).map(chunk).collect(),
        events: events.split(',').filter_map(event).collect(),
    }
}

fn chunk(text: &str) -> (Vec<u8>, bool) {
    (hex(text.trim_end_matches(['/', '!'])), text.ends_with('!'))
}

fn event(text: &str) -> Option<(usize, Option<Reason>)> {
    let (word, size) = text.trim().split_once(' ')?;
    let reason = Reason::ALL.into_iter().find(|reason| reason.word() == word);
    assert!(
        reason.is_some() || word == "frame",
        "{word} is not an event"
    );
    Some((size.parse().expect("a size"), reason))
}

fn single([what, bytes, outcome]: [&str; 3]) -> Single {
    let words: Vec<&str> = what.split_whitespace().collect();
    let Listening::To(direction) = listening(words[1]) else {
        panic!("a frame has one direction");
    };
    let (word, number) = outcome.split_once(' ').expect("a word and a number");
    Single {
        table: words[0].to_owned(),
        direction,
        of: words.get(2).map(|name| (*name).to_owned()),
        bytes: hex(bytes),
        outcome: (word.to_owned(), number.parse().expect("a number")),
    }
}

fn listening(word: &str) -> Listening {
    match word {
        "request" => Listening::To(Direction::Request),
        "reply" => Listening::To(Direction::Reply),
        "both" => Listening::Both,
        other => panic!("{other} is not a direction"),
    }
}

fn hex(text: &str) -> Vec<u8> {
    let bytes = text.split_whitespace();
    bytes
        .map(|byte| u8::from_str_radix(byte, 16).expect("hex"))
        .collect()
}
