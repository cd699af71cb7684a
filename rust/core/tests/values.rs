//! Checks encoding and decoding: the arithmetic, the round trip, and the place of each mistake.

use crate::common::{Broken, Sample, Samples, field, frame_format, number, table, word};
use cobotwire_core::{
    BadValue, Case, Choice, DecodeError, Direction, EncodeError, Field, Misfit, Number, Order,
    Reason, Table, TableError, Value, ValueFault, decode, encode,
};

type Encoded = Result<Vec<u8>, EncodeError<Sample>>;

fn build(table: &Table, values: &[Sample]) -> Encoded {
    let values = Samples(values.to_vec());
    encode(
        table.frame(),
        &table.commands()[0],
        Direction::Request,
        &values,
        Choice::default(),
    )
}

fn one(number: Number) -> Table {
    table(vec![vec![field(vec![number], false)]])
}

fn data(table: &Table, value: Sample) -> Vec<u8> {
    let frame = build(table, &[value]).expect("the value is legal");
    frame[4..frame.len() - 1].to_vec()
}

fn fault(encoded: Encoded) -> (usize, Option<usize>, ValueFault) {
    match encoded {
        Err(EncodeError::Value(BadValue {
            field,
            element,
            fault,
            ..
        })) => (field, element, fault),
        other => panic!("no value was rejected: {other:?}"),
    }
}

#[test]
fn a_real_value_becomes_the_nearest_raw_value() {
    let hundredths = one(word(100));
    assert_eq!(data(&hundredths, Sample::Real(0.29)), [0, 29]); // 0.29 * 100 is less than 29
    assert_eq!(data(&hundredths, Sample::Real(-2.58)), [0xFE, 0xFE]);
    assert_eq!(data(&hundredths, Sample::Integer(2)), [0, 200]);
    let halves = one(number(1, 2, 0, 255));
    assert_eq!(data(&halves, Sample::Real(0.25)), [0]); // a tie goes to the even raw value
    assert_eq!(data(&halves, Sample::Real(0.75)), [2]);
}

#[test]
fn a_value_out_of_bounds_is_rejected_unless_it_rounds_into_them() {
    let table = one(number(1, 10, 10, 20));
    assert_eq!(data(&table, Sample::Real(2.04)), [20]);
    assert_eq!(
        fault(build(&table, &[Sample::Real(2.06)])).2,
        ValueFault::Range
    );
    assert_eq!(
        fault(build(&table, &[Sample::Real(1e300)])).2,
        ValueFault::Range
    );
    assert_eq!(fault(build(&table, &[Sample::Huge])).2, ValueFault::Range);
    assert_eq!(
        fault(build(&table, &[Sample::Real(f64::NAN)])).2,
        ValueFault::NotFinite
    );
    assert_eq!(fault(build(&table, &[Sample::Text])).2, ValueFault::Type);
}

#[test]
fn numbers_have_both_byte_orders_and_every_width() {
    for width in 1..=4 {
        let big = number(width, 1, 0, 255);
        let little = Number {
            order: Order::Little,
            ..big.clone()
        };
        let mut expected = vec![0; width];
        expected[width - 1] = 0xA5;
        assert_eq!(data(&one(big), Sample::Integer(0xA5)), expected);
        expected.reverse();
        assert_eq!(data(&one(little), Sample::Integer(0xA5)), expected);
    }
}

#[test]
fn every_raw_value_survives_the_round_trip() {
    for divide in [1, 10, 100] {
        let table = one(word(divide));
        for raw in 0..=u16::MAX {
            let [high, low] = raw.to_be_bytes();
            let frame = [0xFE, 0xFE, 4, 0x20, high, low, 0xFA];
            let values = decode(&table, Direction::Request, &frame, None)
                .expect("all words")
                .values;
            let value = match values[0] {
                Value::Integer(integer) => Sample::Integer(integer),
                Value::Real(real) => Sample::Real(real),
                _ => panic!("it takes one number"),
            };
            assert_eq!(data(&table, value), [high, low]);
        }
    }
}

#[test]
fn the_leftmost_mistake_is_the_one_reported() {
    let row = field(vec![word(1), word(1)], true);
    let table = table(vec![vec![row, field(vec![number(1, 1, 0, 9)], false)]]);
    let (good, bad) = (Sample::Integer(1), Sample::Integer(99_999));
    let pair = |a: &Sample, b: &Sample| Sample::Row(vec![a.clone(), b.clone()]);
    let build = |first: Sample, second: &Sample| build(&table, &[first, second.clone()]);
    let (range, kind, count) = (ValueFault::Range, ValueFault::Type, ValueFault::Count);
    assert_eq!(
        fault(build(pair(&good, &bad), &Sample::Broken)),
        (0, Some(1), range)
    );
    assert_eq!(
        fault(build(pair(&bad, &Sample::Broken), &good)),
        (0, Some(0), range)
    );
    assert_eq!(
        fault(build(Sample::Row(vec![]), &Sample::Broken)),
        (0, None, count)
    );
    assert_eq!(fault(build(good.clone(), &Sample::Broken)), (0, None, kind));
    assert_eq!(fault(build(pair(&good, &good), &bad)), (1, None, range));
    assert_eq!(
        build(pair(&good, &good), &Sample::Broken),
        Err(EncodeError::Foreign(Broken))
    );
}

#[test]
fn a_bool_is_accepted_only_for_a_flag() {
    let plain = field(vec![number(1, 1, 0, 1)], false);
    let flag = Field {
        flag: true,
        ..plain.clone()
    };
    assert_eq!(data(&table(vec![vec![flag]]), Sample::Bool(true)), [1]);
    assert_eq!(
        fault(build(&table(vec![vec![plain]]), &[Sample::Bool(true)])).2,
        ValueFault::Type
    );
}

/// Return a table in which a selector decides whether the word before it is in tenths or
/// hundredths.
fn selected() -> Table {
    let case = |when, divide| Case {
        when: vec![when],
        numbers: vec![word(divide)],
    };
    let cases = vec![case(0, 10), case(1, 100)];
    let value = Field {
        selector: Some(1),
        cases,
        ..field(vec![], false)
    };
    let choice = Field {
        choices: vec![0, 1, 2],
        ..field(vec![number(1, 1, 0, 255)], false)
    };
    table(vec![vec![value, choice]])
}

#[test]
fn a_selector_picks_the_case_and_is_checked_first() {
    let table = selected();
    let build = |value, choice| build(&table, &[Sample::Real(value), Sample::Integer(choice)]);
    assert_eq!(build(1.0, 0).unwrap()[4..7], [0, 10, 0]);
    assert_eq!(build(1.0, 1).unwrap()[4..7], [0, 100, 1]);
    assert_eq!(fault(build(f64::NAN, 9)), (1, None, ValueFault::Choice));
    assert_eq!(fault(build(f64::NAN, 2)), (1, None, ValueFault::Choice)); // no case has it
    let frame = |choice| [0xFE, 0xFE, 5, 0x20, 0, 100, choice, 0xFA];
    let decoded = |choice| decode(&table, Direction::Reply, &frame(choice), None);
    assert_eq!(
        decoded(0).unwrap().values,
        [Value::Real(10.0), Value::Integer(0)]
    );
    assert_eq!(
        decoded(1).unwrap().values,
        [Value::Real(1.0), Value::Integer(1)]
    );
    match decoded(2) {
        Err(DecodeError::Raw(bad)) => assert_eq!((bad.field, bad.raw, bad.offset), (1, 2, 6)),
        other => panic!("the frame was not rejected: {other:?}"),
    }
}

#[test]
fn a_rejected_frame_has_the_place_of_the_fault() {
    let table = one(number(1, 1, 0, 9));
    let rejected = |bytes: &[u8]| match decode(&table, Direction::Reply, bytes, None) {
        Err(DecodeError::Frame { reason, offset }) => (reason, offset),
        other => panic!("the frame was not rejected: {other:?}"),
    };
    assert_eq!(rejected(&[]), (Reason::Truncated, 0));
    assert_eq!(rejected(&[0xFE]), (Reason::Truncated, 1));
    assert_eq!(rejected(&[0xFE, 0x00]), (Reason::NoHeader, 1));
    assert_eq!(rejected(&[0xFE, 0xFE, 9]), (Reason::BadLength, 2));
    assert_eq!(rejected(&[0xFE, 0xFE, 3, 0x21]), (Reason::UnknownId, 3));
    assert_eq!(rejected(&[0xFE, 0xFE, 3, 0x20, 1]), (Reason::Truncated, 5));
    assert_eq!(
        rejected(&[0xFE, 0xFE, 3, 0x20, 1, 0xFB]),
        (Reason::BadCheck, 5)
    );
    assert_eq!(
        rejected(&[0xFE, 0xFE, 3, 0x20, 1, 0xFA, 0]),
        (Reason::Trailing, 6)
    );
}

#[test]
fn a_table_that_cannot_be_interpreted_is_rejected() {
    let misfit = |fields: Vec<Field>| {
        let variant = cobotwire_core::Variant::new(fields);
        let command = cobotwire_core::Command {
            id: 1,
            request: vec![variant],
            reply: vec![],
        };
        Table::new(frame_format(), vec![command])
            .map(|_| ())
            .unwrap_err()
    };
    let expect = |misfit| TableError { command: 0, misfit };
    let plain = || field(vec![word(1)], false);
    assert_eq!(
        misfit(vec![field(vec![number(5, 1, 0, 1)], false)]),
        expect(Misfit::Width)
    );
    assert_eq!(
        misfit(vec![field(vec![number(1, 0, 0, 1)], false)]),
        expect(Misfit::Scale)
    );
    assert_eq!(
        misfit(vec![field(vec![number(1, 1, 0, i64::MAX)], false)]),
        expect(Misfit::Bounds)
    );
    assert_eq!(
        misfit(vec![Field {
            cases: vec![],
            ..plain()
        }]),
        expect(Misfit::Cases)
    );
    assert_eq!(
        misfit(vec![field(vec![word(1), word(1)], false)]),
        expect(Misfit::Cases)
    );
    assert_eq!(
        misfit(vec![Field {
            selector: Some(1),
            ..plain()
        }]),
        expect(Misfit::Selector)
    );
    assert_eq!(
        misfit(vec![field(vec![word(1); 127], true)]),
        expect(Misfit::Length)
    );
}
