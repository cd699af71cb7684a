//! Checks the laws of framing, and that the core cuts streams as the oracle does.

use cobotwire_core::{Event, Framer, OwnedFrame, Reason, Rules};

use super::tally::Count;
use crate::input::{Chunk, Cutting, Input};
use crate::oracle::{Oracle, number};

/// Check after each chunk that the framer and the oracle report the same events and offsets, and
/// that the same bytes are pending.
pub fn events_equal_those_of_the_oracle(data: &[u8]) {
    let input = Input::read(data);
    hold(input.oracle(), input.rules(), &input.chunks());
}

/// Check framing for any table.
pub fn hold(oracle: &Oracle, rules: &Rules, chunks: &[Chunk<'_>]) {
    let mut framer = Framer::new(rules.clone());
    let mut line = Line {
        oracle,
        rules,
        offset: 0,
        open: vec![],
        count: Count::default(),
    };
    for chunk in chunks {
        line.open.extend(chunk.bytes);
        line.expect(&mut framer, false, |framer, sink| {
            framer.feed(chunk.bytes, sink);
        });
        if chunk.flush {
            line.expect(&mut framer, true, |framer, sink| framer.flush(sink));
        }
    }
    line.expect(&mut framer, true, |framer, sink| framer.flush(sink));
    assert_eq!(framer.pending(), 0, "after a flush nothing waits");
    line.count.check(framer.tally());
    let fed: usize = chunks.iter().map(|chunk| chunk.bytes.len()).sum();
    assert_eq!(line.offset, fed as u64, "every byte is accounted for");
}

/// The bytes of a transport that were fed and that no event covers yet.
struct Line<'a> {
    oracle: &'a Oracle,
    rules: &'a Rules,
    offset: u64,
    open: Vec<u8>,
    count: Count,
}

impl Line<'_> {
    fn expect(
        &mut self,
        framer: &mut Framer,
        at_end: bool,
        act: impl FnOnce(&mut Framer, &mut dyn FnMut(Event<'_>)),
    ) {
        let mut events: Vec<Owned> = Vec::new();
        let (oracle, rules) = (self.oracle, self.rules);
        act(framer, &mut |event| {
            check_frame(oracle, rules, event);
            events.push(owned(event));
        });
        let (spans, settled) = self.oracle.spans(&self.open, at_end);
        let mut given = events.iter();
        let mut at = 0;
        for (size, reason) in spans {
            let bytes = &self.open[at..at + size];
            let (offset, data, why) = given.next().expect("as many events as the oracle's");
            assert_eq!(
                (*offset, &data[..], *why),
                (self.offset + at as u64, bytes, reason)
            );
            self.count.add(self.oracle, bytes, reason);
            at += size;
        }
        assert_eq!(given.next(), None, "no event but the oracle's");
        self.open.drain(..settled);
        self.offset += settled as u64;
        assert_eq!(framer.pending(), self.open.len(), "the same bytes wait");
        assert!(
            framer.pending() < rules.longest(),
            "fewer bytes wait than the longest frame has"
        );
    }
}

/// Check that the accessors of a frame and of its copy agree with its bytes.
fn check_frame(oracle: &Oracle, rules: &Rules, event: Event<'_>) {
    let Event::Frame { frame, .. } = event else {
        return;
    };
    let bytes = frame.bytes();
    let layout = oracle.format().layout;
    assert_eq!(number(layout.id, bytes), Some(frame.id()));
    assert_eq!(number(layout.length, bytes), Some(frame.length()));
    assert_eq!(layout.overhead + usize::from(frame.length()), bytes.len());
    assert!(bytes.len() <= rules.longest());
    assert_eq!(OwnedFrame::from(frame).get(oracle.format()), frame);
}

/// Check that the events do not depend on the chunks, if adjacent noise of one reason is joined.
pub fn chunking_does_not_matter(data: &[u8]) {
    let input = Input::read(data);
    let whole = cut(&input, 0);
    for class in 1..=5 {
        assert_eq!(cut(&input, class), whole, "cut by class {class}");
    }
}

fn cut(input: &Input, class: u8) -> Vec<Owned> {
    let cutting = Cutting {
        class,
        seed: input.cutting.seed,
        flushes: false,
    };
    let chunks = cutting.cut(&input.stream);
    let chunks = chunks.iter().map(|chunk| chunk.bytes);
    joined(&mut input.framer(), chunks)
}

/// An event with its own bytes; `None` is a frame.
type Owned = (u64, Vec<u8>, Option<Reason>);

fn owned(event: Event<'_>) -> Owned {
    match event {
        Event::Frame { offset, frame } => (offset, frame.bytes().to_vec(), None),
        Event::Noise {
            offset,
            reason,
            data,
        } => (offset, data.concat(), Some(reason)),
    }
}

/// Return the events of a stream in chunks; noise of one reason is joined across calls.
fn joined<'a>(framer: &mut Framer, chunks: impl IntoIterator<Item = &'a [u8]>) -> Vec<Owned> {
    let mut all: Vec<Owned> = Vec::new();
    let mut add = |event: Event<'_>| {
        let (offset, data, reason) = owned(event);
        match all.last_mut() {
            Some(last) if reason.is_some() && last.2 == reason => last.1.extend(data),
            _ => all.push((offset, data, reason)),
        }
    };
    for chunk in chunks {
        framer.feed(chunk, &mut add);
    }
    framer.flush(&mut add);
    all
}
