//! Other frame formats: with a CRC, or with an address byte and a sum; and variants that share an
//! id and a size.

use crate::common::{
    Sample, Samples, computed, crc16_modbus, events, field, frame_format, number, table, table_of,
};
use cobotwire_core::{
    Algorithm, Choice, DecodeError, Decoded, Direction, EncodeError, Field, FrameFormat, Framer,
    Layout, Listening, Reason, Table, Value, decode, encode,
};

const CRC_FRAME: [u8; 7] = [0xFE, 0xFE, 0x04, 0x58, 0x01, 0xFD, 0x87]; // of a real arm
const SUM_FRAME: [u8; 7] = [0xFE, 0xFE, 0x02, 0x03, 0x20, 0xF0, 0x10];

fn byte() -> Field {
    field(vec![number(1, 1, 0, 255)], false)
}

/// 0x20 to 0x58, each of one byte.
fn with_crc() -> Table {
    let frame = FrameFormat {
        check: crc16_modbus(),
        ..frame_format()
    };
    table_of(frame, vec![vec![byte()]; 0x39])
}

/// 0x20: one byte, to one of three addresses.
fn with_sum() -> Table {
    let frame = FrameFormat {
        check: computed(Algorithm::Sum, 1, 4),
        addresses: vec![1, 0, 2],
        layout: Layout::usual(2, true),
        ..frame_format()
    };
    table_of(frame, vec![vec![byte()]])
}

fn build(table: &Table, command: usize, values: &[i64], choice: Choice) -> Encoded {
    let values = Samples(values.iter().copied().map(Sample::Integer).collect());
    let command = &table.commands()[command];
    encode(table.frame(), command, Direction::Request, &values, choice)
}

type Encoded = Result<Vec<u8>, EncodeError<Sample>>;

fn read(table: &Table, data: &[u8], of: Option<usize>) -> Result<Decoded, DecodeError> {
    decode(table, Direction::Request, data, of)
}

fn rejected(table: &Table, data: &[u8], of: Option<usize>) -> (Reason, usize) {
    match read(table, data, of) {
        Err(DecodeError::Frame { reason, offset }) => (reason, offset),
        other => panic!("the frame was not rejected: {other:?}"),
    }
}

fn first_noise(table: &Table, data: &[u8]) -> Option<Reason> {
    let mut framer = Framer::new(table.rules(Listening::Both).clone());
    events(&mut framer, [data])[0].2
}

/// Return the frame with one byte changed.
fn changed<const N: usize>(mut frame: [u8; N], place: usize) -> [u8; N] {
    frame[place] ^= 0x10;
    frame
}

#[test]
fn crc16_modbus_has_the_published_check_value() {
    for (data, crc) in [(&b"123456789"[..], [0x4B, 0x37]), (b"", [0xFF, 0xFF])] {
        let mut frame = data.to_vec();
        crc16_modbus().end(&mut frame);
        assert_eq!(frame[data.len()..], crc);
    }
}

#[test]
fn a_frame_may_end_with_a_crc() {
    let table = with_crc();
    assert_eq!(
        build(&table, 0x38, &[1], Choice::default()).unwrap(),
        CRC_FRAME
    );
    assert_eq!(
        read(&table, &CRC_FRAME, None).unwrap().values,
        [Value::Integer(1)]
    );
    assert_eq!(first_noise(&table, &CRC_FRAME), None);
    for place in 4..7 {
        let bad = changed(CRC_FRAME, place);
        assert_eq!(rejected(&table, &bad, None), (Reason::BadCheck, 5));
        assert_eq!(first_noise(&table, &bad), Some(Reason::BadCheck));
    }
}

#[test]
fn a_frame_may_have_an_address_and_a_sum() {
    let table = with_sum();
    let to = |address| Choice {
        address,
        variant: None,
    };
    assert_eq!(build(&table, 0, &[0xF0], to(Some(2))).unwrap(), SUM_FRAME);
    assert_eq!(build(&table, 0, &[0xF0], to(None)).unwrap()[2], 1);
    assert_eq!(
        build(&table, 0, &[0xF0], to(Some(3))),
        Err(EncodeError::Address)
    );
    let decoded = read(&table, &SUM_FRAME, None).unwrap();
    assert_eq!(decoded.address, Some(2));
    assert_eq!(decoded.values, [Value::Integer(0xF0)]);
    for (place, reason, offset) in [
        (2, Reason::BadAddress, 2),
        (3, Reason::BadLength, 3),
        (4, Reason::UnknownId, 4),
        (5, Reason::BadCheck, 6),
        (6, Reason::BadCheck, 6),
    ] {
        let bad = changed(SUM_FRAME, place);
        assert_eq!(rejected(&table, &bad, None), (reason, offset));
        assert_eq!(first_noise(&table, &bad), Some(reason));
    }
    for end in 0..7 {
        assert_eq!(
            rejected(&table, &SUM_FRAME[..end], None),
            (Reason::Truncated, end)
        );
    }
}

#[test]
fn an_address_is_rejected_if_the_format_has_none() {
    let table = with_crc();
    let choice = Choice {
        address: Some(0),
        variant: None,
    };
    assert_eq!(build(&table, 0, &[1], choice), Err(EncodeError::Address));
    assert_eq!(read(&table, &CRC_FRAME, None).unwrap().address, None);
}

#[test]
fn an_unknown_id_has_at_least_room_for_its_check() {
    let rules = with_crc()
        .rules(Listening::Both)
        .clone()
        .accepting_unknown();
    let mut frame = vec![0xFE, 0xFE, 0x03, 0x99];
    crc16_modbus().end(&mut frame);
    let mut found = events(&mut Framer::new(rules.clone()), [&frame[..]]);
    assert_eq!(found, [(0, frame, None)]);
    found = events(
        &mut Framer::new(rules),
        [&[0xFE, 0xFE, 0x02, 0x99, 0x00][..]],
    );
    assert_eq!(found[0].2, Some(Reason::BadLength));
}

/// 0x20 allows 0 to 4 in its first variant and 6 to 9 in its second; another command with this id
/// allows 3 to 7.
fn alike() -> Table {
    let of = |low, high| vec![field(vec![number(1, 1, low, high)], false)];
    let mut commands = table(vec![of(0, 4), vec![], of(3, 7)]).commands().to_vec();
    let second = table(vec![of(6, 9)]).commands()[0].request[0].clone();
    commands[0].request.push(second);
    commands[2].id = commands[0].id;
    Table::new(frame_format(), commands).unwrap()
}

#[test]
fn values_decide_between_variants_that_share_an_id_and_a_size() {
    let table = alike();
    let frame = |value| [0xFE, 0xFE, 0x03, 0x20, value, 0xFA];
    let variant = |value, of| {
        let decoded = read(&table, &frame(value), of)?;
        Ok((decoded.variant.command, decoded.variant.variant))
    };
    assert_eq!(variant(3, None), Ok((0, 0)));
    assert_eq!(variant(6, None), Ok((0, 1)));
    assert_eq!(variant(5, None), Ok((2, 0)));
    assert_eq!(variant(6, Some(2)), Ok((2, 0)));
    for (value, of, blamed) in [(10, None, 0), (10, Some(2), 2), (9, Some(2), 2)] {
        match variant(value, of) {
            Err(DecodeError::Raw(bad)) => {
                assert_eq!((bad.variant.command, bad.variant.variant), (blamed, 0))
            }
            other => panic!("the value was not rejected: {other:?}"),
        }
    }
}

#[test]
fn a_frame_of_another_command_than_the_one_named_is_rejected_before_its_end() {
    let table = alike();
    let start = [0xFE, 0xFE, 0x03, 0x20];
    assert_eq!(rejected(&table, &start, Some(1)), (Reason::UnknownId, 3));
    assert_eq!(rejected(&table, &start, Some(0)), (Reason::Truncated, 4));
    let start = [0xFE, 0xFE, 0x02, 0x20];
    assert_eq!(rejected(&table, &start, Some(0)), (Reason::BadLength, 2));
    assert_eq!(rejected(&table, &start, Some(1)), (Reason::UnknownId, 3));
}

#[test]
fn the_first_variant_that_allows_the_values_is_encoded_unless_one_is_chosen() {
    let table = alike();
    let pick = |variant| Choice {
        variant,
        address: None,
    };
    let variant = |value, variant| match build(&table, 0, &[value], pick(variant)) {
        Ok(frame) => Ok(frame[4]),
        Err(EncodeError::Value(bad)) => Err(Some(bad.variant)),
        Err(_) => Err(None),
    };
    assert_eq!(variant(4, None), Ok(4));
    assert_eq!(variant(6, None), Ok(6));
    assert_eq!(variant(5, None), Err(Some(0)));
    assert_eq!(variant(6, Some(0)), Err(Some(0)));
    assert_eq!(variant(4, Some(1)), Err(Some(1)));
    assert_eq!(variant(4, Some(2)), Err(None));
}
