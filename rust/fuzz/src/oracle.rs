//! Implements `docs/framing.md` without any optimization: it judges every position separately and
//! computes the check bit by bit.

use std::collections::HashSet;

use cobotwire_core::{Check, Direction, FrameFormat, Listening, Reason, Table};

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
    legal: HashSet<(u8, usize)>,
    ids: HashSet<u8>,
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
            for variant in directions.iter().flat_map(|way| command.variants(*way)) {
                legal.insert((command.id, frame.length(variant.size())));
            }
        }
        let mut lengths: HashSet<usize> = legal.iter().map(|(_, length)| *length).collect();
        if unknown {
            let most = usize::try_from(frame.maximum_length).unwrap_or(0).min(255);
            lengths.extend(frame.length(0)..=most);
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
    pub fn id(&self, frame: &[u8]) -> u8 {
        frame[self.frame.overhead()]
    }

    /// Return the verdict on the start of `rest`; the first byte that decides it counts.
    pub fn look(&self, rest: &[u8]) -> Found {
        let starts = self.frame.header.iter().zip(rest);
        if starts.into_iter().any(|(must, is)| must != is) {
            return Found::Noise(Reason::NoHeader);
        }
        let mut at = 2;
        if !self.frame.addresses.is_empty() {
            match rest.get(at) {
                None => return Found::Waits,
                Some(address) if !self.frame.addresses.contains(address) => {
                    return Found::Noise(Reason::BadAddress);
                }
                Some(_) => at += 1,
            }
        }
        let Some(length) = rest.get(at).map(|length| usize::from(*length)) else {
            return Found::Waits;
        };
        if !self.lengths.contains(&length) {
            return Found::Noise(Reason::BadLength);
        }
        let Some(id) = rest.get(at + 1) else {
            return Found::Waits;
        };
        if !self.legal.contains(&(*id, length)) && self.ids.contains(id) {
            return Found::Noise(Reason::BadLength);
        }
        if !self.ids.contains(id) && !self.unknown {
            return Found::Noise(Reason::UnknownId);
        }
        let size = at + 1 + length;
        let Some(all) = rest.get(..size) else {
            return Found::Waits;
        };
        let (body, end) = all.split_at(size - self.frame.check.size());
        if check_of(&self.frame, body) == end {
            Found::Frame(size)
        } else {
            Found::Noise(Reason::BadCheck)
        }
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

/// Return the bytes that must end a frame after `body`.
pub fn check_of(frame: &FrameFormat, body: &[u8]) -> Vec<u8> {
    match frame.check {
        Check::Footer(footer) => vec![footer],
        Check::Crc16Modbus => crc(body).to_be_bytes().to_vec(),
        Check::Sum => {
            let counted = body.iter().skip(frame.overhead());
            vec![counted.fold(0, |sum: u8, byte| sum.wrapping_add(*byte))]
        }
    }
}

fn crc(body: &[u8]) -> u16 {
    let mut crc = 0xFFFF;
    for byte in body {
        crc ^= u16::from(*byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0xA001
            } else {
                crc >> 1
            };
        }
    }
    crc
}
