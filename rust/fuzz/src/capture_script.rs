//! Turns fuzz bytes into a recording: most of its blocks are valid, so that the reader gets beyond
//! the first one.

use crate::bytes::Bytes;
use crate::subjects::Subject;

const STEPS: [u64; 8] = [
    0,
    1,
    1_000,
    1_000_000,
    499_999_999,
    500_000_000,
    2_000_000_000,
    1 << 40,
];
const COMMENTS: [&str; 6] = [
    "noise no-header",
    "in pieces: 1 bytes at +0 ns, 4 bytes at +100 ns",
    "x; in pieces: 3 bytes at +5 ns,14 bytes at +700000000 ns; bytes",
    "in pieces: 0 bytes at +9 ns, 5 bytes at +9223372036854775807 ns",
    "in pieces: 99999999999999999999 bytes at +1 ns 5 bytes at +2 ns",
    "in pieces: 5 bytes at +1 ns; in pieces: 17 bytes at +3 ns; in pieces:5 bytes at +4 ns",
];

/// Writes blocks in one byte order.
struct Writer {
    file: Vec<u8>,
    big: bool,
    time: u64,
}

/// Make a recording of frames of a subject.
pub fn play(subject: &Subject, mut bytes: Bytes<'_>) -> Vec<u8> {
    let mut writer = Writer {
        file: vec![],
        big: false,
        time: 1 << 60,
    };
    writer.section(bytes.byte());
    writer.interface(bytes.byte());
    while !bytes.is_done() && writer.file.len() < 1 << 16 {
        match bytes.pick(16) {
            0 => writer.section(bytes.byte()),
            1 => writer.interface(bytes.byte()),
            2 => writer.statistics(bytes.byte()),
            3 => {
                let kind = bytes.byte().into();
                writer.block(kind, &[1; 8]);
            }
            4 => {
                let at = bytes.word() % writer.file.len();
                writer.file[at] = bytes.byte();
            }
            5 => {
                let cut = bytes.pick(64).min(writer.file.len() - 1);
                writer.file.truncate(writer.file.len() - cut);
            }
            6 => writer.packet(&mut bytes.clone(), bytes.clone().take(9)),
            _ => {
                let picked = subject.frames.get(bytes.pick(subject.frames.len() + 1));
                writer.packet(&mut bytes, picked.map_or(b"noise", |frame| &frame[..]));
            }
        }
    }
    writer.file
}

impl Writer {
    fn number(&self, number: u64, size: usize) -> Vec<u8> {
        let bytes = number.to_be_bytes();
        let mut bytes = bytes[8 - size..].to_vec();
        if !self.big {
            bytes.reverse();
        }
        bytes
    }

    fn words(&self, words: &[u64]) -> Vec<u8> {
        words
            .iter()
            .flat_map(|word| self.number(*word, 4))
            .collect()
    }

    fn option(&self, code: u64, value: &[u8]) -> Vec<u8> {
        let head = [self.number(code, 2), self.number(value.len() as u64, 2)].concat();
        [head, padded(value)].concat()
    }

    fn block(&mut self, kind: u64, body: &[u8]) {
        let size = self.number(body.len() as u64 + 12, 4);
        let block = [&self.number(kind, 4), &size, body, &size].concat();
        self.file.extend(block);
    }

    fn section(&mut self, choice: u8) {
        self.big = choice & 1 != 0;
        let mut body = self.words(&[0x1A2B_3C4D]);
        body.extend([self.number(1, 2), self.number(0, 2), vec![0xFF; 8]].concat());
        if choice & 2 != 0 {
            body.extend(self.option(4, b"cobotwire"));
        }
        self.block(0x0A0D_0D0A, &body);
    }

    fn interface(&mut self, choice: u8) {
        let mut body = [self.number(147 + u64::from(choice % 16), 2), vec![0; 6]].concat();
        body.extend(self.option(2, b"/dev/x"));
        if choice & 16 == 0 {
            body.extend(self.option(9, &[9]));
        } else {
            body.extend(self.option(9, &[choice]));
        }
        if choice & 32 != 0 {
            body.extend(self.option(14, &self.number(u64::MAX, 8)));
        }
        self.block(1, &body);
    }

    fn statistics(&mut self, choice: u8) {
        let body = self.words(&[u64::from(choice % 4), 0, 0]);
        self.block(5, &body);
    }

    fn packet(&mut self, bytes: &mut Bytes<'_>, data: &[u8]) {
        let choice = bytes.byte();
        let step = STEPS[usize::from(choice % 8)];
        self.time = match choice & 128 {
            0 => self.time.saturating_add(step),
            _ => self.time.saturating_sub(step),
        };
        let from = if choice & 64 == 0 {
            0
        } else {
            bytes.pick(data.len())
        };
        let data = &data[from..];
        let index = u64::from(choice & 32 != 0);
        let size = data.len() as u64;
        let mut body = self.words(&[index, self.time >> 32, self.time, size, size]);
        body.extend(padded(data));
        let other = bytes.byte();
        if other & 4 != 0 {
            let comment = COMMENTS[usize::from(other / 8) % COMMENTS.len()];
            body.extend(self.option(1, comment.as_bytes()));
        }
        body.extend(self.option(2, &self.number(u64::from(other & 3), 4)));
        self.block(6, &body);
    }
}

fn padded(data: &[u8]) -> Vec<u8> {
    let mut padded = data.to_vec();
    padded.resize(data.len().div_ceil(4) * 4, 0);
    padded
}
