//! The laws of decoding, and that the core reads as the oracle does.

use cobotwire_core::{
    Choice, DecodeError, Direction, Event, Frame, Framer, Layout, Listening, Reason, Rules, Table,
    Value, decode, encode, read,
};

use crate::common::{Sample, Samples};
use crate::input::Input;
use crate::oracle::{Found, Oracle};
use crate::reading;
use crate::subjects::LISTENING;

/// The whole stream as a frame, and each frame in it: they read as the oracle's, or are refused for
/// its reason and at its byte; what was read builds the same bytes again.
pub fn frames_read_as_the_oracles(data: &[u8]) {
    let input = Input::read(data);
    let table = &input.subject.table;
    for (index, listening) in LISTENING.iter().enumerate() {
        let rules = input.subject.rules(index, input.unknown);
        Framer::new(rules.clone()).feed(&input.stream, |event| {
            if let Event::Frame { frame, .. } = event {
                heard(table, rules, *listening, frame);
            }
        });
        let Listening::To(direction) = listening else {
            continue;
        };
        let oracle = input.subject.oracle(index, false);
        hold(table, oracle, *direction, &input.stream);
        Framer::new(table.rules(*listening).clone()).feed(&input.stream, |event| {
            if let Event::Frame { frame, .. } = event {
                hold(table, oracle, *direction, frame.bytes());
                read_back(table, *direction, frame.bytes());
            }
        });
    }
}

/// As the framer gave it, which knows what it heard.
fn heard(table: &Table, rules: &Rules, listening: Listening, frame: Frame<'_>) {
    let bytes = frame.bytes();
    let expected = match reading::heard(table, listening, bytes) {
        Some(Ok(found)) => Ok(reading::decoded(table, found, bytes)),
        Some(Err(bad)) => Err(DecodeError::Raw(bad)),
        None => Err(DecodeError::Frame {
            reason: Reason::UnknownId,
            offset: table.frame().overhead(),
        }),
    };
    assert_eq!(read(table, rules, frame), expected);
}

/// For any table, of which `oracle` listens to that direction.
pub fn hold(table: &Table, oracle: &Oracle, direction: Direction, data: &[u8]) {
    let met = decode(table, direction, data, None);
    let (reason, offset) = match oracle.look(data) {
        Found::Frame(size) if size == data.len() => {
            let expected = reading::read(table, direction, data, None);
            let expected = expected.expect("a legal frame has a form");
            assert_eq!(met, expected.map_err(DecodeError::Raw));
            return each_call(table, direction, data);
        }
        Found::Frame(size) => (Reason::Trailing, Some(size)),
        Found::Waits => (Reason::Truncated, Some(data.len())),
        Found::Noise(reason) => (reason, None),
    };
    let Err(DecodeError::Frame {
        reason: given,
        offset: at,
    }) = met
    else {
        panic!("not refused for {reason:?}: {met:?}");
    };
    assert_eq!((given, at), (reason, offset.unwrap_or(at)));
    if offset.is_none() {
        assert!(at < data.len(), "a byte that is there refutes it");
        assert_eq!(
            oracle.look(&data[..at]),
            Found::Waits,
            "no byte before does"
        );
    }
}

/// Asked for a certain call, it reads as the first form of that call, or as none.
fn each_call(table: &Table, direction: Direction, data: &[u8]) {
    let id = data[table.frame().overhead()];
    for (of, command) in table.commands().iter().enumerate() {
        // One call of another id stands for all of them.
        if command.id == id || of == data.len() {
            one_call(table, direction, data, of);
        }
    }
    one_call(table, direction, data, table.commands().len());
}

fn one_call(table: &Table, direction: Direction, data: &[u8], of: usize) {
    let read = decode(table, direction, data, Some(of));
    match reading::read(table, direction, data, Some(of)) {
        Some(expected) => assert_eq!(read, expected.map_err(DecodeError::Raw)),
        None => assert!(matches!(
            read,
            Err(DecodeError::Frame {
                reason: Reason::BadLength | Reason::UnknownId,
                ..
            })
        )),
    }
}

/// What a frame was read as, in that form and to that address, is that frame: every word on the
/// wire that is allowed stands for a value of its own.
///
/// That holds by any table that makes sense ([`makes_sense`]): its scales are exact enough for a
/// double to be rounded back to the step that it came from.
pub fn read_back(table: &Table, direction: Direction, data: &[u8]) {
    let Ok(decoded) = decode(table, direction, data, None) else {
        return;
    };
    let command = &table.commands()[decoded.form.command];
    let layout = &command.layouts(direction)[decoded.form.layout];
    if !makes_sense(layout) {
        return;
    }
    let choice = Choice {
        form: Some(decoded.form.layout),
        address: decoded.address,
    };
    let values = Samples(samples(&decoded.values));
    let built = encode::<Sample>(table.frame(), command, direction, &values, choice);
    assert_eq!(built.as_deref(), Ok(data), "{:?}", decoded.form);
}

fn samples(values: &[Value]) -> Vec<Sample> {
    let mut rest = values.iter();
    let mut all = Vec::new();
    while let Some(value) = rest.next() {
        all.push(match value {
            Value::Row(count) => {
                let elements: Vec<Value> = rest.by_ref().take(*count).copied().collect();
                Sample::Row(samples(&elements))
            }
            Value::Whole(whole) => Sample::Whole(*whole),
            Value::Real(real) => Sample::Real(*real),
        });
    }
    all
}

/// Whether what can be read can be built: the closed list stands within the bounds, which only the
/// encoder looks at then, and what picks a case is not itself picked.
fn makes_sense(layout: &Layout) -> bool {
    layout.fields().iter().all(|field| {
        let selector = field.selector.map(|index| &layout.fields()[index]);
        let numbers = || field.cases.iter().flat_map(|case| &case.numbers);
        let within = |choice: &i64| {
            numbers().all(|number| (number.minimum..=number.maximum).contains(choice))
        };
        selector.is_none_or(|selector| selector.selector.is_none())
            && field.choices.iter().all(within)
    })
}
