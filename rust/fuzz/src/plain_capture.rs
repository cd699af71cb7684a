//! A second implementation of reading recordings, as plain as possible: the oracle of the target
//! `captures`. It keeps the time of each byte.

use cobotwire_core::{Damage, Fault, Interface};

/// A packet with its bytes, each with its time.
pub struct Packet {
    pub interface: usize,
    /// 0 unknown, 1 received, 2 sent.
    pub direction: usize,
    pub bytes: Vec<(u8, i64)>,
    /// The times of its first and its last piece.
    pub first: i64,
    pub last: i64,
}

/// Everything in a file.
#[derive(Default)]
pub struct Capture {
    pub packets: Vec<Packet>,
    pub interfaces: Vec<Interface>,
    pub statistics: Vec<bool>,
    pub truncated_at: Option<u64>,
    pub damage: Option<Damage>,
}

/// A block's body, and the byte order of its section.
#[derive(Clone, Copy)]
struct Body<'a> {
    bytes: &'a [u8],
    big: bool,
}

struct Format {
    number: usize,
    link_type: u16,
    resolution: u8,
    seconds: i64,
}

impl Body<'_> {
    /// Return the number in `size` bytes at `at`.
    fn number(&self, at: usize, size: usize) -> Result<u64, Fault> {
        let bytes = self.bytes.get(at..at + size).ok_or(Fault::TooShort)?;
        Ok(self.value(bytes))
    }

    fn value(&self, bytes: &[u8]) -> u64 {
        let mut bytes = bytes.to_vec();
        if !self.big {
            bytes.reverse();
        }
        bytes
            .iter()
            .fold(0, |all, byte| all << 8 | u64::from(*byte))
    }

    /// Return the options after `at`, the last one first, so that `option` finds the last value.
    fn options(&self, mut at: usize) -> Result<Vec<(u64, Vec<u8>)>, Fault> {
        let mut all = vec![];
        while at < self.bytes.len() {
            let (code, size) = (self.number(at, 2)?, self.number(at + 2, 2)? as usize);
            if code == 0 {
                break;
            }
            let value = self.bytes.get(at + 4..at + 4 + size);
            all.insert(0, (code, value.ok_or(Fault::TooShort)?.to_vec()));
            at += 4 + size.div_ceil(4) * 4;
        }
        Ok(all)
    }
}

fn option(options: &[(u64, Vec<u8>)], code: u64) -> Vec<u8> {
    let found = options.iter().find(|(each, _)| *each == code);
    found.map(|(_, value)| value.clone()).unwrap_or_default()
}

/// Read a file.
pub fn read(file: &[u8]) -> Capture {
    let mut capture = Capture::default();
    let mut formats = vec![];
    let (mut at, mut big) = (0, None);
    while at < file.len() {
        match block(&file[at..], &mut big, &mut formats, &mut capture) {
            Ok(Some(size)) => at += size,
            Ok(None) => {
                capture.truncated_at = Some(at as u64);
                break;
            }
            Err(fault) => {
                let offset = at as u64;
                capture.damage = Some(Damage { offset, fault });
                break;
            }
        }
    }
    capture
}

/// Read the block at the start of `rest`; return its size, or none if it is cut off.
fn block(
    rest: &[u8],
    big: &mut Option<bool>,
    formats: &mut Vec<Format>,
    capture: &mut Capture,
) -> Result<Option<usize>, Fault> {
    let section = rest.starts_with(&[10, 13, 13, 10]);
    if rest.len() < if section { 12 } else { 8 } {
        return Ok(None);
    }
    if section {
        *big = match rest[8..12] {
            [0x1A, 0x2B, 0x3C, 0x4D] => Some(true),
            [0x4D, 0x3C, 0x2B, 0x1A] => Some(false),
            _ => return Err(Fault::NotPcapng),
        };
    }
    let big = big.ok_or(Fault::NotPcapng)?;
    let whole = Body { bytes: rest, big };
    let (kind, size) = (whole.number(0, 4)?, whole.number(4, 4)? as usize);
    let smallest = if section { 28 } else { 12 };
    if size % 4 != 0 || size < smallest || size > 16 << 20 {
        return Err(Fault::BadLength(size as u32, smallest as u32));
    }
    if rest.len() < size {
        return Ok(None);
    }
    if rest[4..8] != rest[size - 4..size] {
        return Err(Fault::LengthsDiffer);
    }
    let body = Body {
        bytes: &rest[8..size - 4],
        big,
    };
    match kind {
        0x0A0D_0D0A => {
            let major = body.number(4, 2)? as u16;
            if major != 1 {
                return Err(Fault::Version(major));
            }
            formats.clear();
            body.options(16)?;
        }
        1 => interface(body, formats, capture)?,
        2 | 3 => return Err(Fault::NoTime),
        5 => {
            let number = format(body, formats)?.number;
            capture.statistics[number] = true;
        }
        6 => {
            let packet = packet(body, format(body, formats)?)?;
            capture.packets.push(packet);
        }
        _ => {}
    }
    Ok(Some(size))
}

fn interface(
    body: Body<'_>,
    formats: &mut Vec<Format>,
    capture: &mut Capture,
) -> Result<(), Fault> {
    if capture.interfaces.len() == 1024 {
        return Err(Fault::TooManyInterfaces);
    }
    body.number(0, 8)?;
    let options = body.options(8)?;
    let (speed, offset) = (option(&options, 8), option(&options, 14));
    if speed.len() > 8 || offset.len() > 8 {
        return Err(Fault::LongNumber);
    }
    let unsigned = i128::from(body.value(&offset));
    let bits = 8 * offset.len();
    let negative = bits > 0 && unsigned >> (bits - 1) == 1;
    formats.push(Format {
        number: capture.interfaces.len(),
        link_type: body.number(0, 2)? as u16,
        resolution: option(&options, 9).first().copied().unwrap_or(6),
        seconds: (unsigned - if negative { 1 << bits } else { 0 }) as i64,
    });
    capture.statistics.push(false);
    capture.interfaces.push(Interface {
        name: option(&options, 2),
        description: option(&options, 3),
        speed: body.value(&speed),
    });
    Ok(())
}

fn format<'a>(body: Body<'_>, formats: &'a [Format]) -> Result<&'a Format, Fault> {
    let index = body.number(0, 4)?;
    let found = formats.get(index as usize);
    found.ok_or(Fault::NoInterface(index as u32))
}

fn packet(body: Body<'_>, format: &Format) -> Result<Packet, Fault> {
    if !(147..=162).contains(&format.link_type) {
        return Err(Fault::LinkType(format.link_type));
    }
    let stamp = body.number(4, 4)? << 32 | body.number(8, 4)?;
    let size = body.number(12, 4)? as usize;
    body.number(16, 4)?;
    let data = body.bytes.get(20..20 + size).ok_or(Fault::TooShort)?;
    let options = body.options(20 + size.div_ceil(4) * 4)?;
    let mut flags = option(&options, 2);
    if body.big {
        flags.reverse();
    }
    let first = i64::try_from(time(stamp, format)).map_err(|_| Fault::TimeRange)?;
    let pieces = pieces(&option(&options, 1), size as u128);
    let pieces = pieces.unwrap_or_else(|| vec![(size as u128, 0)]);
    let (mut bytes, mut last) = (vec![], first);
    for (count, late) in pieces {
        last = i64::try_from(i128::from(first) + late).map_err(|_| Fault::TimeRange)?;
        bytes.extend((0..count).map(|_| last));
    }
    Ok(Packet {
        interface: format.number,
        direction: match flags.first().map(|byte| byte & 3) {
            Some(1) => 1,
            Some(2) => 2,
            _ => 0,
        },
        bytes: data.iter().copied().zip(bytes).collect(),
        first,
        last,
    })
}

fn time(stamp: u64, format: &Format) -> i128 {
    let exponent = u32::from(format.resolution & 0x7F);
    let base: i128 = if format.resolution < 0x80 { 10 } else { 2 };
    let all = i128::from(stamp) * 1_000_000_000;
    let units = base.checked_pow(exponent);
    units.map_or(0, |units| all / units) + i128::from(format.seconds) * 1_000_000_000
}

/// Return the sizes and delays of the pieces that a comment lists, if they have `size` bytes.
fn pieces(comment: &[u8], size: u128) -> Option<Vec<(u128, i128)>> {
    // A list has only ASCII characters, so bytes that are not UTF-8 end it.
    let comment = String::from_utf8_lossy(comment);
    let lists = comment
        .split("; ")
        .filter_map(|part| part.strip_prefix("in pieces: "));
    let sum = |found: &Vec<(u128, i128)>| found.iter().map(|(count, _)| count).sum::<u128>();
    let valid = lists.map(listed).filter(|found| sum(found) == size);
    valid.last().filter(|found| !found.is_empty())
}

fn listed(list: &str) -> Vec<(u128, i128)> {
    let ends = list.match_indices(" ns");
    let piece = |(end, _)| {
        let (late, before) = last_number(&list[..end])?;
        let (count, _) = last_number(before.strip_suffix(" bytes at +")?)?;
        Some((count.into(), late.into()))
    };
    ends.filter_map(piece).collect()
}

/// Return the number of at most 19 digits at the end of a text, and what is before it.
fn last_number(text: &str) -> Option<(u64, &str)> {
    let before = text.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let digits = &text[before.len()..];
    let number = digits.parse().ok().filter(|_| digits.len() <= 19);
    number.map(|number| (number, before))
}
