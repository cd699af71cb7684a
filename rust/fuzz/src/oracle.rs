//! Implements `docs/framing.md` without any optimization: it validates every position separately
//! and computes the check bit by bit.

use std::collections::HashSet;

use cobotwire_core::{
    Algorithm, Check, CrcParameters, Direction, FrameFormat, Layout, Listening, Order, Part,
    Reason, Table,
};

/// The verdict on the start of some bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// A frame of that many bytes.
    Frame(usize),
    /// No frame, whatever bytes follow.
    Noise(Reason),
    /// The start of a frame that more bytes could complete.
    Waits,
}

/// The size of one event, and the reason of noise; a frame has no reason.
pub type Span = (usize, Option<Reason>);

/// Which frames are legal.
#[derive(Clone, Debug)]
pub struct Oracle {
    frame: FrameFormat,
    /// The ids and LENs of messages; a message without an id matches every id.
    legal: HashSet<(Option<u16>, usize)>,
    ids: HashSet<Option<u16>>,
    lengths: HashSet<usize>,
    unknown: bool,
}

impl Oracle {
    pub fn new(table: &Table, listening: Listening, unknown: bool) -> Self {
        let frame = table.frame();
        let directions: &[Direction] = match &listening {
            Listening::To(direction) => std::slice::from_ref(direction),
            Listening::Both => &[Direction::Request, Direction::Reply],
        };
        let mut legal = HashSet::new();
        for command in table.commands() {
            for direction in directions {
                let id = frame.has_id(*direction).then_some(command.id);
                for variant in command.variants(*direction) {
                    legal.insert((id, length_of(frame, *direction, variant.size())));
                }
            }
        }
        let mut lengths: HashSet<usize> = legal.iter().map(|(_, length)| *length).collect();
        if unknown {
            let most = u16::try_from(frame.maximum_length).unwrap_or(0);
            lengths.extend(length_of(frame, Direction::Request, 0)..=usize::from(most));
        }
        Self {
            frame: frame.clone(),
            ids: legal.iter().map(|(id, _)| *id).collect(),
            legal,
            lengths,
            unknown,
        }
    }

    /// Return the format of its frames.
    pub fn format(&self) -> &FrameFormat {
        &self.frame
    }

    /// Return the id of a frame.
    pub fn id(&self, frame: &[u8]) -> u16 {
        number(self.frame.layout.id, frame).expect("a frame has an id")
    }

    /// Return the verdict on the start of `rest`; the earliest byte that can decide it does.
    pub fn look(&self, rest: &[u8]) -> Found {
        let starts = self.frame.header.iter().zip(rest);
        if starts.into_iter().any(|(must, is)| must != is) {
            return Found::Noise(Reason::NoHeader);
        }
        let Layout {
            address_at,
            length: length_part,
            id: id_part,
            overhead,
            ..
        } = self.frame.layout;
        let (mut length, mut id) = (None, None);
        // The reason that the earliest byte shows is reported.
        for at in self.frame.header.len()..self.frame.layout.data_at {
            if rest.len() <= at {
                return Found::Waits;
            }
            if Some(at) == address_at && !self.frame.addresses.contains(&rest[at]) {
                return Found::Noise(Reason::BadAddress);
            }
            if at + 1 == length_part.end() {
                length = number(length_part, rest).map(usize::from);
                if !self.lengths.contains(&length.unwrap_or_default()) {
                    return Found::Noise(Reason::BadLength);
                }
            }
            if at + 1 == id_part.end() {
                id = number(id_part, rest);
                if length.is_none() && !self.known(id) && !self.unknown {
                    return Found::Noise(Reason::UnknownId);
                }
            }
            if let (Some(length), Some(id)) = (length, id) {
                let legal = |id| self.legal.contains(&(id, length));
                if legal(Some(id)) || legal(None) {
                    continue;
                }
                if self.known(Some(id)) {
                    return Found::Noise(Reason::BadLength);
                }
                if !self.unknown {
                    return Found::Noise(Reason::UnknownId);
                }
            }
        }
        let size = overhead + length.unwrap_or_default();
        let Some(all) = rest.get(..size) else {
            return Found::Waits;
        };
        let (body, end) = all.split_at(size - size_of_end(&self.frame));
        if check_of(&self.frame, body) == end {
            Found::Frame(size)
        } else {
            Found::Noise(Reason::BadCheck)
        }
    }

    fn known(&self, id: Option<u16>) -> bool {
        self.ids.contains(&id) || self.ids.contains(&None)
    }

    /// Return the events that a framer must emit for these bytes at once, and the index of the
    /// first byte that waits; at the end of a stream no byte waits.
    pub fn spans(&self, bytes: &[u8], at_end: bool) -> (Vec<Span>, usize) {
        let mut spans: Vec<Span> = Vec::new();
        let mut at = 0;
        while at < bytes.len() {
            let reason = match self.look(&bytes[at..]) {
                Found::Frame(size) => {
                    spans.push((size, None));
                    at += size;
                    continue;
                }
                Found::Waits if !at_end => break,
                Found::Waits => Reason::Truncated,
                Found::Noise(reason) => reason,
            };
            at += 1;
            match spans.last_mut() {
                Some((size, last)) if *last == Some(reason) => *size += 1,
                _ => spans.push((1, Some(reason))),
            }
        }
        (spans, at)
    }
}

/// Return LEN of a message: the size of the whole frame, less what LEN does not count.
pub fn length_of(frame: &FrameFormat, direction: Direction, data: usize) -> usize {
    let start = if frame.has_id(direction) {
        frame.layout.data_at
    } else {
        frame.layout.id.at
    };
    (start + data + size_of_end(frame)).saturating_sub(frame.layout.overhead)
}

/// Return LEN or the id, if it has arrived.
pub fn number(part: Part, bytes: &[u8]) -> Option<u16> {
    let bytes = bytes.get(part.at..part.end())?;
    let digits: Vec<u16> = bytes.iter().map(|byte| u16::from(*byte)).collect();
    Some(match (digits.as_slice(), part.order) {
        ([high, low], Order::Big) | ([low, high], Order::Little) => 256 * high + low,
        _ => digits[0],
    })
}

fn size_of_end(frame: &FrameFormat) -> usize {
    match &frame.check {
        Check::Footer(_) => 1,
        Check::Computed(computed) => computed.width + computed.footer.len(),
    }
}

/// Return the bytes that must end a frame after `body`.
pub fn check_of(frame: &FrameFormat, body: &[u8]) -> Vec<u8> {
    let computed = match &frame.check {
        Check::Footer(footer) => return vec![*footer],
        Check::Computed(computed) => computed,
    };
    let counted = body.get(computed.from..).unwrap_or_default();
    let sum: i128 = counted.iter().map(|byte| i128::from(*byte)).sum();
    let number = match computed.algorithm.as_ref().expect("random checks have one") {
        Algorithm::Sum => sum,
        Algorithm::InvertedSum => -1 - sum,
        Algorithm::NegatedSum => -sum,
        Algorithm::Xor => counted.iter().fold(0, |all, byte| all ^ i128::from(*byte)),
        Algorithm::Fletcher(modulus) => {
            let modulus = i128::from(*modulus);
            let weights = (1..=counted.len() as i128).rev();
            let second: i128 = counted
                .iter()
                .zip(weights)
                .map(|(b, w)| i128::from(*b) * w)
                .sum();
            256 * (second % modulus) + sum % modulus
        }
        Algorithm::Crc(crc) => divided(crc.parameters(), counted) as i128,
    };
    let bytes = (0..computed.width).map(|place| (number >> (8 * place)) as u8);
    let mut end: Vec<u8> = bytes.collect();
    if computed.order == Order::Big {
        end.reverse();
    }
    end.extend(&computed.footer);
    end
}

/// Return a CRC by division of polynomials, bit by bit.
fn divided(crc: &CrcParameters, data: &[u8]) -> u128 {
    let top = 1 << (crc.width - 1);
    let mut remainder = crc.init;
    for byte in data {
        for bit in 0..8 {
            let place = if crc.refin { bit } else { 7 - bit };
            let carry = (remainder & top != 0) != (byte >> place & 1 == 1);
            remainder = remainder << 1 & (top | (top - 1));
            if carry {
                remainder ^= crc.poly;
            }
        }
    }
    if crc.refout {
        remainder = (0..crc.width).fold(0, |all, bit| all << 1 | (remainder >> bit & 1));
    }
    remainder ^ crc.xorout
}
