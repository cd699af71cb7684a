//! Checks the laws of framing: every byte is accounted for, chunking does not matter, and every
//! undamaged frame is found.

use std::sync::LazyLock;

use crate::common::{Dice, Owned, events, field, number, owned, table, word};
use cobotwire_core::{Direction, Event, Framer, Listening, OwnedFrame, Reason, Table, Verdict};

/// Return a table with the replies 20 without data, 21 with one word and 22 with six words.
fn three() -> Table {
    let words = |count| field((0..count).map(|_| word(100)).collect(), true);
    table(vec![vec![], vec![words(1)], vec![words(6)]])
}

fn framer(accept_unknown: bool) -> Framer {
    static TABLE: LazyLock<Table> = LazyLock::new(three);
    let rules = TABLE.rules(Listening::To(Direction::Reply)).clone();
    Framer::new(if accept_unknown {
        rules.accepting_unknown()
    } else {
        rules
    })
}

fn cut(bytes: &[u8]) -> Vec<Owned> {
    events(&mut framer(false), [bytes])
}

#[test]
fn noise_has_its_reason() {
    assert_eq!(
        cut(&[0x00, 0x01]),
        [(0, vec![0x00, 0x01], Some(Reason::NoHeader))]
    );
    assert_eq!(cut(&[0xFE, 0xFE, 0x03])[0].2, Some(Reason::BadLength));
    assert_eq!(cut(&[0xFE, 0xFE, 0x04, 0x20])[0].2, Some(Reason::BadLength));
    assert_eq!(cut(&[0xFE, 0xFE, 0x02, 0x99])[0].2, Some(Reason::UnknownId));
    assert_eq!(
        cut(&[0xFE, 0xFE, 0x02, 0x20, 0xFB])[0].2,
        Some(Reason::BadCheck)
    );
    assert_eq!(
        cut(&[0xFE, 0xFE, 0x02]),
        [
            (0, vec![0xFE], Some(Reason::Truncated)),
            (1, vec![0xFE, 0x02], Some(Reason::NoHeader)),
        ]
    );
}

#[test]
fn an_unknown_id_is_a_frame_only_if_accepted() {
    let bytes = [0xFE, 0xFE, 0x03, 0x99, 0x00, 0xFA];
    assert_eq!(
        events(&mut framer(true), [&bytes[..]]),
        [(0, bytes.to_vec(), None)]
    );
    assert!(cut(&bytes).iter().all(|event| event.2.is_some()));
    let known_with_wrong_length = [0xFE, 0xFE, 0x03, 0x20, 0x00, 0xFA];
    let first = &events(&mut framer(true), [&known_with_wrong_length[..]])[0];
    assert_eq!(first.2, Some(Reason::BadLength));
}

#[test]
fn a_candidate_is_rejected_by_the_first_byte_that_contradicts_it() {
    let mut framer = framer(false);
    let mut seen = Vec::new();
    framer.feed(&[0xFE, 0xFE, 0x0E], |event| seen.push(owned(event)));
    assert_eq!((seen.len(), framer.pending()), (0, 3));
    framer.feed(&[0x21], |event| seen.push(owned(event)));
    assert_eq!((seen.len(), framer.pending()), (2, 0));
}

#[test]
fn flush_delivers_the_frame_after_a_false_header() {
    let bytes = [0xFE, 0xFE, 0x0E, 0x22, 0xFE, 0xFE, 0x02, 0x20, 0xFA];
    let mut framer = framer(false);
    framer.feed(&bytes, |_| panic!("nothing is certain yet"));
    let mut seen = Vec::new();
    framer.flush(|event| seen.push(owned(event)));
    assert_eq!(seen.last(), Some(&(4, bytes[4..].to_vec(), None)));
}

#[test]
fn every_byte_is_accounted_for_and_chunking_does_not_matter() {
    let mut dice = Dice(1);
    for round in 0..20_000 {
        let accept_unknown = round % 3 == 0;
        let bytes = dice.stream();
        let whole = events(&mut framer(accept_unknown), [&bytes[..]]);
        let all: Vec<u8> = whole.iter().flat_map(|event| event.1.clone()).collect();
        assert_eq!(all, bytes);
        let chunks = dice.chunks(&bytes);
        assert_eq!(
            events(&mut framer(accept_unknown), chunks.clone()),
            whole,
            "{chunks:02X?}"
        );
    }
}

#[test]
fn offsets_continue_after_flushes() {
    let mut framer = framer(false);
    framer.feed(&[0x00, 0xFE], |_| ());
    framer.flush(|_| ());
    let mut seen = Vec::new();
    framer.feed(&[0xFE, 0xFE, 0x02, 0x20, 0xFA], |event| {
        seen.push(owned(event))
    });
    assert_eq!(seen, [(2, vec![0xFE, 0xFE, 0x02, 0x20, 0xFA], None)]);
}

#[test]
fn the_framer_keeps_fewer_bytes_than_the_longest_frame() {
    let longest = three().rules(Listening::Both).longest();
    let mut dice = Dice(2);
    let mut framer = framer(false);
    for _ in 0..20_000 {
        framer.feed(&dice.stream(), |_| ());
        assert!(framer.pending() < longest);
    }
}

#[test]
fn an_undamaged_frame_is_found_whatever_lies_before_it() {
    let frame = [0xFE, 0xFE, 0x02, 0x20, 0xFA];
    let mut dice = Dice(3);
    for _ in 0..20_000 {
        let mut bytes = dice.stream();
        let start = bytes.len() as u64;
        bytes.extend(frame);
        let covers = |event: &Owned| {
            let end = event.0 + event.1.len() as u64;
            event.2.is_none() && event.0 <= start && start < end
        };
        assert!(cut(&bytes).iter().any(covers), "{bytes:02X?}");
    }
}

#[test]
fn a_request_takes_precedence_over_a_reply_with_the_same_bytes() {
    let byte = || field(vec![number(1, 1, 0, 255)], false);
    let table = table(vec![vec![byte()], vec![byte()]]);
    let rules = table.rules(Listening::Both);
    let mut framer = Framer::new(rules.clone());
    let mut variants = Vec::new();
    framer.feed(&[0xFE, 0xFE, 0x03, 0x21, 0x07, 0xFA], |event| {
        if let Event::Frame { frame, .. } = event {
            variants.extend_from_slice(rules.variants(frame));
        }
    });
    assert_eq!(variants.len(), 2); // one of each direction
    assert_eq!(
        (variants[0].direction, variants[0].command),
        (Direction::Request, 1)
    );
}

/// Feed chunks one by one, and flush; return the events. With `fast`, `feed_frame` may take chunks.
fn one_by_one(framer: &mut Framer, chunks: &[&[u8]], fast: bool) -> Vec<Owned> {
    let mut all = Vec::new();
    for chunk in chunks {
        match fast.then(|| framer.feed_frame(chunk)).flatten() {
            Some((offset, frame)) => all.push((offset, frame.bytes().to_vec(), None)),
            None => framer.feed(chunk, |event| all.push(owned(event))),
        }
    }
    framer.flush(|event| all.push(owned(event)));
    all
}

#[test]
fn a_chunk_that_is_one_frame_has_the_same_events_and_counts_on_the_fast_path() {
    const PIECES: [&[u8]; 7] = [
        &[0xFE, 0xFE, 0x02, 0x20, 0xFA],
        &[0xFE, 0xFE, 0x04, 0x21, 0x00, 0x01, 0xFA],
        &[0xFE, 0xFE, 0x04],
        &[0x21, 0x00, 0x01, 0xFA],
        &[0x00],
        &[0xFE, 0xFE, 0x02, 0x20, 0xFA, 0xFE],
        &[],
    ];
    let mut dice = Dice(4);
    for _ in 0..2000 {
        let chunks: Vec<&[u8]> = (0..6).map(|_| PIECES[dice.roll(7)]).collect();
        let (mut short, mut long) = (framer(false), framer(false));
        let expected = one_by_one(&mut long, &chunks, false);
        assert_eq!(one_by_one(&mut short, &chunks, true), expected);
        assert_eq!(short.tally(), long.tally());
        assert_eq!(short.pending(), 0);
    }
}

#[test]
fn only_a_chunk_that_is_one_frame_takes_the_fast_path() {
    let frame = [0xFE, 0xFE, 0x02, 0x20, 0xFA];
    let mut framer = framer(false);
    assert_eq!(framer.feed_frame(&frame[..4]), None);
    assert_eq!(framer.feed_frame(&[frame, frame].concat()), None);
    assert!(framer.feed_frame(&frame).is_some());
    framer.feed(&frame[..2], |_| {});
    assert_eq!(framer.feed_frame(&frame), None);
    assert_eq!(framer.tally().bytes, 7);
}

#[test]
fn a_frame_of_any_size_owns_the_bytes_that_it_was_made_of() {
    for size in 1..40_u8 {
        let words = || (0..size).map(|_| number(1, 1, 0, 255)).collect();
        let table = table(vec![vec![field(words(), true)]]);
        let mut bytes = vec![0xFE, 0xFE, size + 2, 0x20];
        bytes.extend((0..size).map(|index| 200 + index % 50));
        bytes.push(0xFA);
        let rules = table.rules(Listening::To(Direction::Reply));
        let Verdict::Frame(frame) = rules.validate(&bytes) else {
            panic!("a frame of {size} data bytes was not found");
        };
        let own = OwnedFrame::from(frame);
        assert_eq!(own.get(table.frame()), frame);
        assert_eq!(own, own.clone());
    }
}
