//! Reads the frame format of a file.

use alloc::boxed::Box;
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;
use core::ops::RangeInclusive;

use cobotwire_core::exchange::Replier;
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
    let algorithm = algorithm(record, json)?;
    let check_width = match algorithm {
        Some(_) => record.get("check_width")?,
        None => 0,
    };
    let (length, id) = (record.at("length"), record.at("command"));
    let sizes = Sizes {
        sizes: [
            (Header, header.len()),
            (Address, usize::from(!addresses.is_empty())),
            (Length, length.size("width", 1..=2)?),
            (Command, id.size("width", 1..=2)?),
            (Data, 0),
            (CheckBytes, check_width),
            (Footer, footer.len()),
        ],
        layout: record.or("layout", vec![Address, Length, Command])?,
    };
    let reply_has_id = !record.any::<bool>("replies_without_id")?;
    let counted = record.or("counted", vec![Command, Data, CheckBytes, Footer])?;
    check_layout(&sizes, &counted, reply_has_id)?;
    let uncounted = sizes
        .sizes
        .iter()
        .filter(|(part, _)| !counted.contains(part));
    let layout = Layout {
        address_at: (!addresses.is_empty()).then(|| sizes.offset(Address)),
        length: sizes.part(Length, length)?,
        id: sizes.part(Command, id)?,
        data_at: sizes.offset(Data),
        overhead: uncounted.map(|(_, size)| size).sum(),
        reply_has_id,
    };
    let check = match (algorithm, &*footer) {
        (None, &[footer]) => Check::Footer(footer),
        (None, _) => {
            return BadEdition::because("footer must have one byte, since check is footer");
        }
        (Some(algorithm), _) => Check::Computed(Box::new(Computed {
            width: check_width,
            order: record.any("check_order")?,
            from: check_from(record, &sizes, reply_has_id)?,
            algorithm: Some(algorithm),
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
    let times = |parts: &[Place], part| parts.iter().filter(|each| **each == part).count();
    let (layout, no_id) = (&*sizes.layout, !reply_has_id);
    let addresses = times(layout, Place::Address);
    let both = times(layout, Place::Length) == 1 && times(layout, Place::Command) == 1;
    let all = both && addresses <= 1 && layout.len() == 2 + addresses;
    let once = counted.iter().all(|part| times(counted, *part) == 1);
    let counts = |part| times(counted, part) == 1;
    BadEdition::because(match layout.last() {
        _ if !all || addresses < sizes.of(Place::Address) => {
            "layout must have length, command, and an address if frames have it, each once"
        }
        Some(Place::Address) => "layout must end with length or command",
        Some(Place::Length) if no_id => "layout must end with command, since replies have none",
        _ if !once || !counts(Place::Data) => {
            "counted must have data and other parts of a frame, each once"
        }
        _ if no_id && !counts(Place::Command) => {
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

fn algorithm(record: Record<'_>, json: &[u8]) -> Outcome<Option<Algorithm>> {
    let word: &str = record.get("check")?;
    if record.some("crc").is_some() && word != "footer" {
        return crc(json, record.get("check_width")?).map(Some);
    }
    let (algorithm, widths): (_, &[usize]) = match word {
        "footer" => return Ok(None),
        "sum" => (Algorithm::Sum, &[1, 2, 4]),
        "inverted-sum" => (Algorithm::InvertedSum, &[1, 2, 4]),
        "negated-sum" => (Algorithm::NegatedSum, &[1, 2, 4]),
        "xor" => (Algorithm::Xor, &[1]),
        "fletcher" => (Algorithm::Fletcher(256), &[2]),
        "fletcher-16" => (Algorithm::Fletcher(255), &[2]),
        _ => {
            return BadEdition::because(
                "check must be footer, sum, inverted-sum, negated-sum, xor, fletcher, fletcher-16, or a CRC",
            );
        }
    };
    if !widths.contains(&record.get("check_width")?) {
        return BadEdition::because(format!("check_width must be one of {widths:?}"));
    }
    Ok(Some(algorithm))
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
    let mut bytes = named
        .map(|each| each.get("value"))
        .collect::<Outcome<Vec<u8>>>()?;
    if let Some(range) = record.some("address_range") {
        let all = range.get::<u8>("first")?..=range.get("last")?;
        let others: Vec<u8> = all.filter(|each| !bytes.contains(each)).collect();
        bytes.extend(others);
    }
    Ok(bytes)
}

/// Return the addresses that the file names.
pub(crate) fn addresses(record: Record<'_>) -> Outcome<Vec<Address>> {
    let address = |record: Record<'_>| {
        let value = record.get("value")?;
        Ok(Address {
            name: record.get("name")?,
            value,
            replier: match record.or("replies", "own")? {
                "own" => Replier::Address(value),
                "any" => Replier::Anybody,
                "one" => Replier::Somebody,
                "none" => Replier::Nobody,
                _ => return BadEdition::because("replies must be own, any, one, none"),
            },
            joints: record.any::<u8>("joints")?.into(),
        })
    };
    record
        .records("addresses")?
        .into_iter()
        .map(address)
        .collect()
}
