//! Makes tables from fuzz bytes: most are nearly valid, some are nonsense.

use cobotwire_core::{Case, Check, Command, Field, FrameFormat, Number, Order, Shape, Variant};

use crate::bytes::Bytes;

/// A shape byte from this value on gives the number a random width.
const WILD: u8 = 0xF0;

/// Return a frame format and up to four commands.
pub fn table(bytes: &mut Bytes<'_>) -> (FrameFormat, Vec<Command>) {
    let format = format(bytes);
    let count = 1 + bytes.pick(4);
    (format, many(bytes, count, command))
}

fn many<T>(bytes: &mut Bytes<'_>, count: usize, make: impl Fn(&mut Bytes<'_>) -> T) -> Vec<T> {
    (0..count).map(|_| make(bytes)).collect()
}

fn format(bytes: &mut Bytes<'_>) -> FrameFormat {
    let flags = bytes.byte();
    let header = if flags & 1 == 0 {
        [0xFE, 0xFE]
    } else {
        [bytes.byte(), bytes.byte()]
    };
    let check = match flags >> 1 & 3 {
        0 => Check::Crc16Modbus,
        1 => Check::Sum,
        2 => Check::Footer(0xFA),
        _ => Check::Footer(bytes.byte()),
    };
    let addresses = usize::from(flags >> 3 & 3);
    FrameFormat {
        header,
        check,
        addresses: bytes.take(addresses).to_vec(),
        maximum_length: integer(bytes, 20),
    }
}

fn command(bytes: &mut Bytes<'_>) -> Command {
    let flags = bytes.byte();
    Command {
        id: bytes.byte(),
        request: many(bytes, usize::from(flags & 3), variant),
        reply: many(bytes, usize::from(flags >> 2 & 3), variant),
    }
}

fn variant(bytes: &mut Bytes<'_>) -> Variant {
    let count = bytes.pick(4);
    Variant::new(many(bytes, count, field))
}

fn field(bytes: &mut Bytes<'_>) -> Field {
    let flags = bytes.byte();
    let selected = flags & 3 == 3;
    let cases = match flags >> 2 & 3 {
        3 => bytes.pick(4),
        count if selected => usize::from(count) + 1,
        _ => 1,
    };
    let choices = usize::from(flags >> 4 & 3);
    let many_numbers = flags & 0x40 != 0;
    Field {
        flag: flags & 0x80 != 0,
        many: many_numbers,
        choices: many(bytes, choices, |bytes| integer(bytes, 4)),
        selector: selected.then(|| bytes.pick(4)),
        cases: many(bytes, cases, |bytes| case(bytes, many_numbers)),
        shape: Shape::Numbers,
        each: 0,
        varies: false,
    }
}

fn case(bytes: &mut Bytes<'_>, many_numbers: bool) -> Case {
    let flags = bytes.byte();
    let numbers = match (many_numbers, flags >> 2 & 3) {
        (true, _) => bytes.pick(8),
        (false, 3) => bytes.pick(3),
        (false, _) => 1,
    };
    // Repeat the numbers: this makes long frames from few fuzz bytes.
    let copies = match (many_numbers, flags >> 4 & 3) {
        (true, 3) => bytes.pick(64),
        _ => 1,
    };
    Case {
        when: many(bytes, usize::from(flags & 3), |bytes| integer(bytes, 4)),
        numbers: vec![many(bytes, numbers, number); copies].concat(),
    }
}

fn number(bytes: &mut Bytes<'_>) -> Number {
    let shape = bytes.byte();
    let width = match shape {
        WILD.. => usize::try_from(integer(bytes, 8)).unwrap_or(usize::MAX),
        _ => 1 + usize::from(shape & 3),
    };
    let float = shape & 0x30 == 0x30;
    let width = match width {
        1..=4 if float => 4 << (shape & 1),
        _ => width,
    };
    let scaled = shape & 8 != 0 && !float;
    let scale = |bytes: &mut Bytes<'_>| if scaled { integer(bytes, 100) } else { 1 };
    Number {
        width,
        order: if shape & 4 == 0 {
            Order::Big
        } else {
            Order::Little
        },
        signed_at: integer(bytes, 127),
        multiply: scale(bytes),
        divide: scale(bytes),
        minimum: integer(bytes, -100),
        maximum: integer(bytes, 100),
        float,
        choices: vec![],
        flag: false,
        bits: None,
    }
}

/// Return a number near `ordinary`, or one near a power of two or at the edge of its type.
fn integer(bytes: &mut Bytes<'_>, ordinary: i64) -> i64 {
    let byte = bytes.byte();
    let edge = 1_i64 << (byte & 63);
    match byte {
        0xFF => i64::MIN,
        0xFE => i64::MAX,
        0xC0.. => edge.wrapping_neg(),
        0x80.. => edge.wrapping_sub(1),
        0x60.. => edge,
        _ => ordinary + i64::from(byte) - 8,
    }
}
