//! Reads the frame format of a file.

use alloc::boxed::Box;
use alloc::format;
use alloc::vec;
use alloc::vec::Vec;

use cobotwire_core::exchange::{Addressee, Replier};
use cobotwire_core::{
    Algorithm, Check, Computed, Crc, CrcParameters, FrameFormat, Layout, Order, Part,
};
use serde::Deserialize;

use crate::Address;
use crate::json::{BadEdition, Node, Outcome, Record};
use crate::types::order;

/// The most data bytes: the longest LEN of two bytes that the core supports.
pub(crate) const LONGEST: i64 = 0x4000;

/// The numbers of a CRC, which can have more bits than a generic number of JSON.
#[derive(Deserialize)]
struct Wide {
    frame: WideFrame,
}

#[derive(Deserialize)]
struct WideFrame {
    crc: Option<WideCrc>,
}

#[derive(Deserialize)]
struct WideCrc {
    width: u32,
    poly: u128,
    init: u128,
    refin: bool,
    refout: bool,
    xorout: u128,
}

/// The sizes of a frame's parts.
struct Sizes<'a> {
    header: usize,
    address: usize,
    length: usize,
    command: usize,
    check: usize,
    footer: usize,
    layout: Vec<&'a str>,
}

impl Sizes<'_> {
    fn of(&self, part: &str) -> Option<usize> {
        Some(match part {
            "header" => self.header,
            "address" => self.address,
            "length" => self.length,
            "command" => self.command,
            "data" => 0,
            "check" => self.check,
            "footer" => self.footer,
            _ => return None,
        })
    }

    /// Return the offset of a part, which is the header, a fixed part, or the data.
    fn offset(&self, part: &str) -> usize {
        let parts = ["header"].into_iter().chain(self.layout.iter().copied());
        let before = parts.take_while(|each| *each != part);
        before.filter_map(|each| self.of(each)).sum()
    }
}

/// Return the frame format; `json` are the bytes of the whole file.
pub(crate) fn frame_format(record: Record<'_>, json: &[u8]) -> Outcome<FrameFormat> {
    let header = record.need("header")?.bytes(4)?;
    let footer = record
        .get("footer")
        .map_or(Ok(Vec::new()), |footer| footer.bytes(2))?;
    if header.is_empty() {
        return Err(BadEdition::new(
            "header is empty; allowed: one to four bytes",
        ));
    }
    let (length, id) = (unsigned(record, "length")?, unsigned(record, "command")?);
    let addresses = address_bytes(record)?;
    let algorithm = algorithm(record, json)?;
    let check_width = match algorithm {
        Some(_) => record.size("check_width", 16)?,
        None => 0,
    };
    let sizes = Sizes {
        header: header.len(),
        address: usize::from(!addresses.is_empty()),
        length: if length.wide { 2 } else { 1 },
        command: if id.wide { 2 } else { 1 },
        check: check_width,
        footer: footer.len(),
        layout: words(record, "layout", &["address", "length", "command"])?,
    };
    let reply_has_id = !record.is("replies_without_id")?;
    let counted = words(record, "counted", &["command", "data", "check", "footer"])?;
    check_layout(&sizes, &counted, reply_has_id)?;
    let parts = ["header", "address", "length", "command", "check", "footer"];
    let uncounted = parts.iter().filter(|part| !counted.contains(part));
    let layout = Layout {
        address_at: (!addresses.is_empty()).then(|| sizes.offset("address")),
        length: Part {
            at: sizes.offset("length"),
            ..length
        },
        id: Part {
            at: sizes.offset("command"),
            ..id
        },
        data_at: sizes.offset("data"),
        overhead: uncounted.filter_map(|part| sizes.of(part)).sum(),
        reply_has_id,
    };
    let check = match (algorithm, footer.as_slice()) {
        (None, &[footer]) => Check::Footer(footer),
        (None, _) => {
            return Err(BadEdition::new(
                "footer must have one byte, since check is footer",
            ));
        }
        (Some(algorithm), _) => Check::Computed(Box::new(Computed {
            width: check_width,
            order: record.get("check_order").map_or(Ok(Order::Big), order)?,
            from: check_from(record, &sizes, reply_has_id)?,
            algorithm: Some(algorithm),
            footer,
        })),
    };
    Ok(FrameFormat {
        header,
        addresses,
        check,
        maximum_length: record.within("maximum_length", 0..=LONGEST)?,
        layout,
    })
}

fn words<'a>(record: Record<'a>, key: &'a str, usual: &[&'a str]) -> Outcome<Vec<&'a str>> {
    let given: Vec<&str> = record.list(key)?.map(Node::text).collect::<Outcome<_>>()?;
    Ok(if given.is_empty() {
        usual.to_vec()
    } else {
        given
    })
}

fn check_layout(sizes: &Sizes<'_>, counted: &[&str], reply_has_id: bool) -> Outcome<()> {
    fn times(parts: &[&str], part: &str) -> usize {
        parts.iter().filter(|each| **each == part).count()
    }
    let layout = sizes.layout.as_slice();
    let addresses = times(layout, "address");
    let all = times(layout, "length") == 1 && times(layout, "command") == 1 && addresses <= 1;
    if !all || layout.len() != 2 + addresses || addresses < sizes.address {
        return Err(BadEdition::new(
            "layout must have length, command, and an address if frames have it, each once",
        ));
    }
    match (layout.last(), reply_has_id) {
        (Some(&"address"), _) => {
            return Err(BadEdition::new("layout must end with length or command"));
        }
        (Some(&"length"), false) => {
            return Err(BadEdition::new(
                "layout must end with command, since replies have none",
            ));
        }
        _ => {}
    }
    let once = |part: &&str| sizes.of(part).is_some() && times(counted, part) == 1;
    if !counted.iter().all(once) || !counted.contains(&"data") {
        return Err(BadEdition::new(
            "counted must have data and other parts of a frame, each once",
        ));
    }
    if !reply_has_id && !counted.contains(&"command") {
        return Err(BadEdition::new(
            "counted must have command, since replies have data in its place",
        ));
    }
    Ok(())
}

fn check_from(record: Record<'_>, sizes: &Sizes<'_>, reply_has_id: bool) -> Outcome<usize> {
    let word = record.need("check_from")?;
    let part = word.text()?;
    let stands = sizes.layout.contains(&part) && sizes.of(part) != Some(0);
    if part == "header" || stands || (part == "data" && reply_has_id) {
        return Ok(sizes.offset(part));
    }
    Err(word.unknown("a part before the check that all frames have"))
}

fn algorithm(record: Record<'_>, json: &[u8]) -> Outcome<Option<Algorithm>> {
    let word = record.need("check")?;
    if record.get("crc").is_some() && word.text()? != "footer" {
        return crc(json, record.size("check_width", 16)?).map(Some);
    }
    let (algorithm, widths): (_, &[usize]) = match word.text()? {
        "footer" => return Ok(None),
        "sum" => (Algorithm::Sum, &[1, 2, 4]),
        "inverted-sum" => (Algorithm::InvertedSum, &[1, 2, 4]),
        "negated-sum" => (Algorithm::NegatedSum, &[1, 2, 4]),
        "xor" => (Algorithm::Xor, &[1]),
        "fletcher" => (Algorithm::Fletcher(256), &[2]),
        "fletcher-16" => (Algorithm::Fletcher(255), &[2]),
        _ => {
            return Err(word.unknown(
                "footer, sum, inverted-sum, negated-sum, xor, fletcher, fletcher-16, or a CRC",
            ));
        }
    };
    if !widths.contains(&record.size("check_width", 16)?) {
        return Err(record.need("check_width")?.unknown(&format!("{widths:?}")));
    }
    Ok(Some(algorithm))
}

fn crc(json: &[u8], size: usize) -> Outcome<Algorithm> {
    let found = serde_json::from_slice(json).map(|wide: Wide| wide.frame.crc);
    let crc = found.map_err(|error| BadEdition::new(format!("crc: {error}")))?;
    let crc = crc.and_then(|crc| {
        let WideCrc {
            width,
            poly,
            init,
            refin,
            refout,
            xorout,
        } = crc;
        let fits = |number: u128| number.checked_shr(width).unwrap_or_default() == 0;
        let parameters = CrcParameters {
            width,
            poly,
            init,
            refin,
            refout,
            xorout,
        };
        let all = fits(poly) && fits(init) && fits(xorout);
        Crc::new(parameters).filter(|crc| all && crc.size() == size)
    });
    let text = "crc must have 1 to 120 bits, numbers of that many bits, and check_width its bytes";
    crc.map(Algorithm::Crc).ok_or_else(|| BadEdition::new(text))
}

/// Return an unsigned number of the frame: LEN or the command id; its offset is not known yet.
fn unsigned<'a>(record: Record<'a>, key: &'a str) -> Outcome<Part> {
    let Some(node) = record.get(key) else {
        return Ok(Part::byte(0));
    };
    let number = node.record()?;
    Ok(Part {
        at: 0,
        wide: number
            .get("width")
            .map_or(Ok(1), |width| width.within(1..=2))?
            == 2,
        order: number.get("order").map_or(Ok(Order::Big), order)?,
    })
}

fn address_bytes(record: Record<'_>) -> Outcome<Vec<u8>> {
    let mut bytes = vec![];
    for address in record.records("addresses")? {
        bytes.push(address.need("value")?.byte()?);
    }
    let named = bytes.len();
    if let Some(range) = record.get("address_range") {
        let range = range.record()?;
        let (first, last) = (range.need("first")?.byte()?, range.need("last")?.byte()?);
        let others = (first..=last).filter(|each| !bytes.iter().take(named).any(|one| one == each));
        let others: Vec<u8> = others.collect();
        bytes.extend(others);
    }
    Ok(bytes)
}

/// Return the addresses that the file names.
pub(crate) fn addresses(record: Record<'_>) -> Outcome<(Vec<Address>, Vec<Addressee>)> {
    let mut found = (Vec::new(), Vec::new());
    for address in record.records("addresses")? {
        let value = address.need("value")?.byte()?;
        let replier = match address.get("replies") {
            None => Replier::Address(value),
            Some(word) => match word.text()? {
                "own" => Replier::Address(value),
                "any" => Replier::Anybody,
                "one" => Replier::Somebody,
                "none" => Replier::Nobody,
                _ => return Err(word.unknown("own, any, one, none")),
            },
        };
        let joints = address
            .get("joints")
            .map_or(Ok(0), |node| node.within(0..=255))?;
        let joints = usize::try_from(joints).unwrap_or_default();
        found.0.push(Address {
            name: address.name()?.into(),
            value,
            replier,
            joints,
        });
        found.1.push(Addressee {
            value,
            replier,
            joints,
        });
    }
    Ok(found)
}
