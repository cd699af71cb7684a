//! Checks the laws of decoding, and that the core decodes as the oracle does.

use cobotwire_core::{
    Choice, DecodeError, Direction, Event, Frame, Framer, Listening, Reason, Rules, Table, Value,
    Variant, decode, encode, read,
};

use crate::input::Input;
use crate::oracle::{Found, Oracle, number};
use crate::reading;
use crate::sample::{Sample, Samples};
use crate::subjects::LISTENING;

/// Check that the whole stream, taken as one frame, and each frame in it have the oracle's result:
/// the same values, or the same reason and offset. Decoded values encode to the same bytes.
pub fn frames_decode_as_in_the_oracle(data: &[u8]) {
    let input = Input::read(data);
    let table = &input.subject.table;
    for (index, listening) in LISTENING.iter().enumerate() {
        let rules = input.subject.rules(index, input.unknown);
        Framer::new(rules.clone()).feed(&input.stream, |event| {
            if let Event::Frame { frame, .. } = event {
                as_received(table, rules, *listening, frame);
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

/// Check that reading a validated frame has the same result as validating and decoding its bytes.
fn as_received(table: &Table, rules: &Rules, listening: Listening, frame: Frame<'_>) {
    let bytes = frame.bytes();
    let expected = match reading::received(table, listening, bytes) {
        Some(Ok(found)) => Ok(reading::decoded(table, found, bytes)),
        Some(Err(bad)) => Err(DecodeError::Raw(bad)),
        None => Err(DecodeError::Frame {
            reason: Reason::UnknownId,
            offset: table.frame().layout.id.at,
        }),
    };
    assert_eq!(read(table, rules, frame, None), expected);
    for direction in [Direction::Request, Direction::Reply] {
        let one_way = table.rules(Listening::To(direction));
        for of in [None, Some(0), Some(bytes.len())] {
            let decoded_again = decode(table, direction, bytes, of);
            assert_eq!(read(table, one_way, frame, of), decoded_again);
        }
    }
}

/// Check decoding of one direction, for any table; `oracle` has the same direction.
pub fn hold(table: &Table, oracle: &Oracle, direction: Direction, data: &[u8]) {
    let met = decode(table, direction, data, None);
    let (reason, offset) = match oracle.look(data) {
        Found::Frame(size) if size == data.len() => {
            let expected = reading::read(table, direction, data, None);
            let expected = expected.expect("a legal frame has a variant");
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
        panic!("not rejected for {reason:?}: {met:?}");
    };
    assert_eq!((given, at), (reason, offset.unwrap_or(at)));
    if offset.is_none() {
        assert!(at < data.len(), "a byte of the data rejects it");
        assert_eq!(
            oracle.look(&data[..at]),
            Found::Waits,
            "no byte before does"
        );
    }
}

/// Check that a frame that is decoded as a given command has the command's first variant that
/// allows the values.
fn each_call(table: &Table, direction: Direction, data: &[u8]) {
    let id = number(table.frame().layout.id, data);
    let named = table.frame().has_id(direction);
    for (of, command) in table.commands().iter().enumerate() {
        // One command with another id represents all commands with other ids.
        if !named || Some(command.id) == id || of == data.len() {
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

/// Check that the values of a frame, with its variant and address, encode to the same frame: each
/// legal raw value has a distinct physical value.
///
/// This holds for every consistent table ([`makes_sense`]): its scales are exact enough to round a
/// double back to its raw value.
pub fn read_back(table: &Table, direction: Direction, data: &[u8]) {
    let Ok(decoded) = decode(table, direction, data, None) else {
        return;
    };
    let command = &table.commands()[decoded.variant.command];
    let variant = &command.variants(direction)[decoded.variant.variant];
    if !makes_sense(variant) {
        return;
    }
    let choice = Choice {
        variant: Some(decoded.variant.variant),
        address: decoded.address,
    };
    let values = Samples(samples(&decoded.values));
    let built = encode::<Sample>(table.frame(), command, direction, &values, choice);
    assert_eq!(built.as_deref(), Ok(data), "{:?}", decoded.variant);
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
            Value::Integer(integer) => Sample::Integer(*integer),
            Value::Real(real) => Sample::Real(*real),
            // Random tables have only numbers.
            Value::Rows(_) | Value::Bytes(_) | Value::Text(..) => unreachable!("{value:?}"),
        });
    }
    all
}

/// Return whether every message that decodes can be encoded: the choices lie within the bounds
/// (only the encoder also checks those), and no selector has a selector itself.
fn makes_sense(variant: &Variant) -> bool {
    variant.fields().iter().all(|field| {
        let selector = field.selector.map(|index| &variant.fields()[index]);
        let numbers = || field.cases.iter().flat_map(|case| &case.numbers);
        let within = |choice: &i64| {
            numbers().all(|number| (number.minimum..=number.maximum).contains(choice))
        };
        selector.is_none_or(|selector| selector.selector.is_none())
            && field.choices.iter().all(within)
    })
}
