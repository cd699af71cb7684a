//! Makes tables from fuzz bytes: most are nearly valid, some are nonsense.

use cobotwire_core::{
    Algorithm, Case, Check, Command, Computed, Crc, CrcParameters, Field, FrameFormat, Layout,
    Number, NumberEncoding, Order, Part, Shape, Variant,
};

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
    let header = match flags & 7 {
        0 => vec![bytes.byte()],
        1 => bytes.take(3).to_vec(),
        2 => vec![0xFF, 0xFF, 0xFD, 0x00],
        3 => vec![bytes.byte(), bytes.byte()],
        _ => vec![0xFE, 0xFE],
    };
    let header = if header.is_empty() {
        vec![0xFE]
    } else {
        header
    };
    let addresses = bytes.take(usize::from(flags >> 3 & 3)).to_vec();
    let layout = if flags & 0x20 == 0 {
        Layout::usual(header.len(), !addresses.is_empty())
    } else {
        layout(bytes, header.len(), !addresses.is_empty())
    };
    FrameFormat {
        check: check(bytes, &layout),
        header,
        addresses,
        maximum_length: integer(bytes, 20),
        layout,
    }
}

/// Return a layout with its parts in any order, and a LEN that counts any number of them.
fn layout(bytes: &mut Bytes<'_>, header: usize, address: bool) -> Layout {
    let flags = bytes.byte();
    let order = |bit: u8| match flags >> bit & 1 {
        0 => Order::Big,
        _ => Order::Little,
    };
    let mut length = Part {
        at: 0,
        wide: flags & 1 == 1,
        order: order(1),
    };
    let mut id = Part {
        at: 0,
        wide: flags & 4 == 4,
        order: order(3),
    };
    let mut at = header;
    let mut address_at = None;
    let places: &[u8] = match flags >> 4 & 3 {
        0 => b"ali",
        1 => b"lai",
        2 => b"ial",
        _ => b"ail",
    };
    for place in places {
        match place {
            b'l' => {
                length.at = at;
                at = length.end();
            }
            b'i' => {
                id.at = at;
                at = id.end();
            }
            _ if address => {
                address_at = Some(at);
                at += 1;
            }
            _ => {}
        }
    }
    Layout {
        address_at,
        length,
        id,
        data_at: at,
        overhead: usize::from(bytes.byte()) % (at + 1),
        reply_has_id: flags & 0x40 == 0 || id.end() < at,
    }
}

fn check(bytes: &mut Bytes<'_>, layout: &Layout) -> Check {
    let flags = bytes.byte();
    let algorithm = match flags & 7 {
        0 => Algorithm::Sum,
        1 => Algorithm::InvertedSum,
        2 => Algorithm::NegatedSum,
        3 => Algorithm::Xor,
        4 => Algorithm::Fletcher(if flags & 8 == 0 { 256 } else { 255 }),
        5 => Algorithm::Crc(crc(bytes)),
        6 => return Check::Footer(0xFA),
        _ => return Check::Footer(bytes.byte()),
    };
    let width = match &algorithm {
        Algorithm::Crc(crc) => crc.size(),
        Algorithm::Fletcher(_) => 2,
        _ => 1 + usize::from(flags >> 4 & 1),
    };
    Check::Computed(Box::new(Computed {
        algorithm: Some(algorithm),
        width,
        order: if flags & 0x20 == 0 {
            Order::Big
        } else {
            Order::Little
        },
        from: usize::from(bytes.byte()) % (layout.data_at + 1),
        footer: bytes.take(usize::from(flags >> 6)).to_vec(),
    }))
}

fn crc(bytes: &mut Bytes<'_>) -> Crc {
    let width = 1 + u32::from(bytes.byte()) % 120;
    let mut number =
        || (0..16).fold(0, |all, _| all << 8 | u128::from(bytes.byte())) >> (128 - width);
    let (poly, init, xorout, flags) = (number(), number(), number(), number());
    Crc::new(CrcParameters {
        width,
        poly,
        init,
        refin: flags & 1 == 1,
        refout: flags & 2 == 2,
        xorout,
    })
    .expect("the width is legal")
}

fn command(bytes: &mut Bytes<'_>) -> Command {
    let flags = bytes.byte();
    Command {
        id: u16::from(bytes.byte()),
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
    let encoding = NumberEncoding::ALL.get(usize::from(4 - (shape >> 4 & 3)));
    let encoding = encoding.map(|(_, encoding)| *encoding).unwrap_or_default();
    let float = encoding == NumberEncoding::Float;
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
        encoding,
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
