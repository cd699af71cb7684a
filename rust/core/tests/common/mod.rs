//! Helpers of the tests: small tables and random streams.

use cobotwire_core::{
    Algorithm, Case, Check, Command, Computed, Crc, CrcParameters, Field, FrameFormat, Layout,
    Number, Order, Shape, Table, Variant,
};

/// Return an unsigned number of `width` bytes.
pub fn number(width: usize, divide: i64, minimum: i64, maximum: i64) -> Number {
    Number {
        width,
        signed_at: i64::from(u32::MAX),
        multiply: 1,
        divide,
        minimum,
        maximum,
        ..Number::default()
    }
}

pub fn field(numbers: Vec<Number>, many: bool) -> Field {
    let cases = vec![Case {
        when: vec![],
        numbers,
    }];
    Field {
        flag: false,
        many,
        choices: vec![],
        selector: None,
        cases,
        shape: Shape::Numbers,
        each: 0,
        varies: false,
    }
}

pub fn frame_format() -> FrameFormat {
    FrameFormat {
        header: vec![0xFE, 0xFE],
        addresses: vec![],
        check: Check::Footer(0xFA),
        maximum_length: 16,
        layout: Layout::usual(2, false),
    }
}

/// Return a table with a command for each item: number `n` has id `0x20 + n`, and in each direction
/// one variant with these fields.
pub fn table(variants: Vec<Vec<Field>>) -> Table {
    table_of(frame_format(), variants)
}

/// Return the same table with another frame format.
pub fn table_of(frame: FrameFormat, variants: Vec<Vec<Field>>) -> Table {
    let command = |(id, fields): (u16, Vec<Field>)| Command {
        id,
        request: vec![Variant::new(fields.clone())],
        reply: vec![Variant::new(fields)],
    };
    let commands = (0x20..).zip(variants).map(command).collect();
    Table::new(frame, commands).expect("the tests' tables are valid")
}

/// A small random number generator, so that the tests need no crate for it.
pub struct Dice(pub u64);

impl Dice {
    pub fn roll(&mut self, sides: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (self.0 >> 33) as usize % sides
    }

    pub fn byte(&mut self) -> u8 {
        self.roll(256) as u8
    }

    /// Return a stream of bytes that are hard to frame.
    pub fn stream(&mut self) -> Vec<u8> {
        const PARTS: [&[u8]; 10] = [
            &[0xFE],
            &[0xFE, 0xFE],
            &[0xFA],
            &[0x00, 0x55],
            &[0xFE, 0xFE, 0x02, 0x20, 0xFA],
            &[0xFE, 0xFE, 0x04, 0x21, 0xFE, 0xFE, 0xFA],
            &[0xFE, 0xFE, 0x04, 0x21, 0xFE, 0xFA],
            &[0xFE, 0xFE, 0x0E, 0x22],
            &[0xFE, 0xFE, 0x02, 0x99, 0xFA],
            &[0xFE, 0xFE, 0x04, 0x20],
        ];
        (0..self.roll(12))
            .flat_map(|_| PARTS[self.roll(PARTS.len())].to_vec())
            .collect()
    }

    pub fn chunks<'a>(&mut self, mut bytes: &'a [u8]) -> Vec<&'a [u8]> {
        let mut all = Vec::new();
        while !bytes.is_empty() {
            let (chunk, rest) = bytes.split_at(self.roll(bytes.len() + 1).max(1));
            all.push(chunk);
            bytes = rest;
        }
        all
    }
}

/// Return a CRC-16/MODBUS over everything before it, high byte first.
pub fn crc16_modbus() -> Check {
    let crc = Crc::new(CrcParameters {
        width: 16,
        poly: 0x8005,
        init: 0xFFFF,
        refin: true,
        refout: true,
        xorout: 0,
    });
    computed(Algorithm::Crc(crc.unwrap()), 2, 0)
}

/// Return a number of `width` bytes computed from the bytes after `from`.
pub fn computed(algorithm: Algorithm, width: usize, from: usize) -> Check {
    Check::Computed(Box::new(Computed {
        algorithm: Some(algorithm),
        width,
        order: Order::Big,
        from,
        footer: vec![],
    }))
}
