//! Reads the frame format of a file.

use alloc::boxed::Box;
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::RangeInclusive;

use cobotwire_core::exchange::{Addressee, Replier};
use cobotwire_core::{Algorithm, Check, Computed, Crc, CrcParameters, FrameFormat, Layout, Part};
use serde::Deserialize;

use crate::json::Record;
use crate::{Address, BadEdition, Outcome};

/// The most data bytes: the longest LEN of two bytes that the core supports.
pub(crate) const LONGEST: usize = 0x4000;

/// A part of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Place {
    Header,
    Address,
    Length,
    Command,
    Data,
    Check,
    Footer,
}

/// The numbers of a CRC, which can have more bits than a generic number of JSON.
#[derive(Deserialize)]
struct Wide {
    frame: WideFrame,
}

#[derive(Deserialize)]
struct WideFrame {
    crc: Option<CrcParameters>,
}

/// The sizes of a frame's parts, and the order of those between header and data.
struct Sizes {
    sizes: [(Place, usize); 7],
    layout: Vec<Place>,
}

impl Sizes {
    fn of(&self, part: Place) -> usize {
        let found = self.sizes.iter().find(|(each, _)| *each == part);
        found.map_or(0, |(_, size)| *size)
    }

    /// Return the offset of a part, which is the header, a fixed part, or the data.
    fn offset(&self, part: Place) -> usize {
        let parts = [&Place::Header].into_iter().chain(&self.layout);
        let before = parts.take_while(|each| **each != part);
        before.map(|each| self.of(*each)).sum()
    }

    /// Return an unsigned number of the frame: LEN or the command id.
    fn part(&self, part: Place, number: Record<'_>) -> Outcome<Part> {
        Ok(Part {
            at: self.offset(part),
            wide: self.of(part) == 2,
            order: number.any("order")?,
        })
    }
}

/// Return the frame format; `json` are the bytes of the whole file.
pub(crate) fn frame_format(record: Record<'_>, json: &[u8]) -> Outcome<FrameFormat> {
    use Place::{Address, Check as CheckBytes, Command, Data, Footer, Header, Length};
    let (header, footer) = (hex(record, "header", 1..=4)?, hex(record, "footer", 0..=2)?);
    let addresses = address_bytes(record)?;
    let (algorithm, check_width) = algorithm(record, json)?;
    let (length, id) = (record.at("length"), record.at("command"));
    let sizes = Sizes {
        sizes: [
            (Header, header.len()),
            (Address, usize::from(!addresses.is_empty())),
            (Length, length.within_or("width", 1..=2, 1)?),
            (Command, id.within_or("width", 1..=2, 1)?),
            (Data, 0),
            (CheckBytes, check_width),
            (Footer, footer.len()),
        ],
        layout: record.or("layout", vec![Address, Length, Command])?,
    };
    let reply_has_id = !record.any::<bool>("replies_without_id")?;
    let counted = record.or("counted", vec![Command, Data, CheckBytes, Footer])?;
    check_layout(&sizes, &counted, reply_has_id)?;
    let mut uncounted = Vec::from(sizes.sizes);
    uncounted.retain(|(part, _)| !counted.contains(part));
    let layout = Layout {
        address_at: (!addresses.is_empty()).then(|| sizes.offset(Address)),
        length: sizes.part(Length, length)?,
        id: sizes.part(Command, id)?,
        data_at: sizes.offset(Data),
        overhead: uncounted.iter().map(|(_, size)| size).sum(),
        reply_has_id,
    };
    let check = match (algorithm, &*footer) {
        (None, &[footer]) => Check::Footer(footer),
        (None, _) => return BadEdition::because("footer must be one byte, since check is footer"),
        (algorithm, _) => Check::Computed(Box::new(Computed {
            width: check_width,
            order: record.any("check_order")?,
            from: check_from(record, &sizes, reply_has_id)?,
            algorithm,
            footer,
        })),
    };
    Ok(FrameFormat {
        header,
        addresses,
        check,
        maximum_length: record.within("maximum_length", 0..=LONGEST as i64)?,
        layout,
    })
}

/// Return bytes, which are pairs of hexadecimal digits.
fn hex(record: Record<'_>, key: &str, sizes: RangeInclusive<usize>) -> Outcome<Vec<u8>> {
    let text: &str = record.any(key)?;
    let digits: Vec<char> = text.chars().filter(|char| *char != ' ').collect();
    let bytes = digits.chunks(2).map(|pair| match pair {
        [high, low] => u8::try_from(high.to_digit(16)? << 4 | low.to_digit(16)?).ok(),
        _ => None,
    });
    match bytes.collect::<Option<Vec<u8>>>() {
        Some(bytes) if sizes.contains(&bytes.len()) => Ok(bytes),
        _ => BadEdition::because(format!("{key} must be {sizes:?} bytes, as pairs of digits")),
    }
}

fn check_layout(sizes: &Sizes, counted: &[Place], reply_has_id: bool) -> Outcome<()> {
    use Place::{Address, Command, Data, Length};
    let times = |parts: &[Place], part| parts.iter().filter(|each| **each == part).count();
    let layout = &*sizes.layout;
    let addresses = times(layout, Address);
    let all = (times(layout, Length), times(layout, Command)) == (1, 1)
        && (sizes.of(Address)..=1).contains(&addresses)
        && layout.len() == 2 + addresses;
    let once = counted.iter().all(|part| times(counted, *part) == 1);
    BadEdition::because(match layout.last() {
        _ if !all => {
            "layout must have length, command, and an address if frames have it, each once"
        }
        Some(Address) => "layout must end with length or command",
        Some(Length) if !reply_has_id => "layout must end with command, since replies have none",
        _ if !once || !counted.contains(&Data) => {
            "counted must have data and other parts of a frame, each once"
        }
        _ if !reply_has_id && !counted.contains(&Command) => {
            "counted must have command, since replies have data in its place"
        }
        _ => return Ok(()),
    })
}

fn check_from(record: Record<'_>, sizes: &Sizes, reply_has_id: bool) -> Outcome<usize> {
    let part = record.get("check_from")?;
    let stands = match part {
        Place::Header => true,
        Place::Data => reply_has_id,
        _ => sizes.layout.contains(&part) && sizes.of(part) > 0,
    };
    if stands {
        return Ok(sizes.offset(part));
    }
    BadEdition::because("check_from must be a part before the check that all frames have")
}

const ALGORITHMS: [(&str, Algorithm, &[usize]); 6] = [
    ("sum", Algorithm::Sum, &[1, 2, 4]),
    ("inverted-sum", Algorithm::InvertedSum, &[1, 2, 4]),
    ("negated-sum", Algorithm::NegatedSum, &[1, 2, 4]),
    ("xor", Algorithm::Xor, &[1]),
    ("fletcher", Algorithm::Fletcher(256), &[2]),
    ("fletcher-16", Algorithm::Fletcher(255), &[2]),
];

/// Return how the check is computed, and its bytes; `None`: it is only a footer.
fn algorithm(record: Record<'_>, json: &[u8]) -> Outcome<(Option<Algorithm>, usize)> {
    let word: &str = record.get("check")?;
    if word == "footer" {
        return Ok((None, 0));
    }
    let width = record.get("check_width")?;
    if record.some("crc").is_some() {
        return Ok((Some(crc(json, width)?), width));
    }
    let mut known = ALGORITHMS.into_iter();
    match known.find(|(name, ..)| *name == word) {
        Some((_, algorithm, widths)) if widths.contains(&width) => Ok((Some(algorithm), width)),
        Some((.., widths)) => BadEdition::because(format!("check_width must be one of {widths:?}")),
        None => {
            let names = ALGORITHMS.map(|(name, ..)| name).join(", ");
            BadEdition::because(format!("check must be footer, {names}, or a CRC"))
        }
    }
}

fn crc(json: &[u8], size: usize) -> Outcome<Algorithm> {
    let wide: Wide = serde_json::from_slice(json).or_else(BadEdition::because)?;
    let crc = wide.frame.crc.and_then(|crc| {
        let fits = |number: u128| number.checked_shr(crc.width).unwrap_or_default() == 0;
        let all = [crc.poly, crc.init, crc.xorout].into_iter().all(fits);
        Crc::new(crc).filter(|crc| all && crc.size() == size)
    });
    match crc {
        Some(crc) => Ok(Algorithm::Crc(crc)),
        None => BadEdition::because(
            "crc must have 1 to 120 bits, numbers of that many bits, and check_width its bytes",
        ),
    }
}

fn address_bytes(record: Record<'_>) -> Outcome<Vec<u8>> {
    let named = record.records("addresses")?.into_iter();
    let named: Outcome<Vec<u8>> = named.map(|each| each.get("value")).collect();
    let mut bytes = named?;
    if let Some(range) = record.some("address_range") {
        for byte in range.get::<u8>("first")?..=range.get("last")? {
            if !bytes.contains(&byte) {
                bytes.push(byte);
            }
        }
    }
    Ok(bytes)
}

/// Return the addresses that the file names.
pub(crate) fn addresses(record: Record<'_>) -> Outcome<Vec<(Address, Addressee)>> {
    let address = |record: Record<'_>| {
        let (name, value) = (record.get("name")?, record.get("value")?);
        let replier = match record.or("replies", "own")? {
            "own" => Replier::Address(value),
            "any" => Replier::Anybody,
            "one" => Replier::Somebody,
            "none" => Replier::Nobody,
            _ => return BadEdition::because("replies must be own, any, one, none"),
        };
        let joints = record.any::<u8>("joints")?.into();
        Ok((
            Address { name, value },
            Addressee {
                value,
                replier,
                joints,
            },
        ))
    };
    let records = record.records("addresses")?.into_iter();
    records.map(address).collect()
}
