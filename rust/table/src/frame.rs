//! Reads the frame format of a file.

use alloc::boxed::Box;
use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Display;
use core::ops::RangeInclusive;
use core::str::FromStr;

use cobotwire_core::exchange::{Addressee, Replier};
use cobotwire_core::{
    Algorithm, Check, Computed, Crc, CrcParameters, FrameFormat, Layout, Order, Part,
};
use serde_json::value::RawValue;

use crate::json::{Record, Word};
use crate::{BadEdition, Outcome, Within};

/// The most data bytes: the largest LEN of two bytes that the core supports.
pub(crate) const LONGEST: usize = 0x4000;

/// A part of a frame.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Header,
    Address,
    Length,
    Command,
    Data,
    Check,
    Footer,
}

impl Word for Place {
    const WORDS: &[(&str, Self)] = &[
        ("header", Self::Header),
        ("address", Self::Address),
        ("length", Self::Length),
        ("command", Self::Command),
        ("data", Self::Data),
        ("check", Self::Check),
        ("footer", Self::Footer),
    ];
}

/// Return the frame format; `json` are the bytes of the whole file.
pub(crate) fn frame_format(
    record: Record<'_>,
    known: &[Addressee],
    json: &[u8],
) -> Outcome<FrameFormat> {
    use Place::{Address, Check as CheckBytes, Command, Data, Footer, Header, Length};
    let (header, footer) = (hex(record, "header", 1..=4)?, hex(record, "footer", 0..=2)?);
    let mut addresses: Vec<u8> = known.iter().map(|each| each.value).collect();
    if let Some(range) = record.some("address_range") {
        let range = range.get::<u8>("first")?..=range.get("last")?;
        let named = |byte: &u8| known.iter().any(|each| each.value == *byte);
        addresses.extend(range.filter(|byte| !named(byte)));
    }
    let (algorithm, check_width) = algorithm(record, json)?;
    let (length, id) = (record.at("length"), record.at("command"));
    let sizes = [
        (Header, header.len()),
        (Address, usize::from(!addresses.is_empty())),
        (Length, length.within_or("width", 1..=2, 1)?),
        (Command, id.within_or("width", 1..=2, 1)?),
        (Data, 0),
        (CheckBytes, check_width),
        (Footer, footer.len()),
    ];
    let size = |part: &Place| {
        let own = sizes.iter().filter(|(each, _)| each == part);
        own.map(|(_, size)| *size).sum::<usize>()
    };
    // The parts between header and data, and those that LEN counts.
    let order = record.words_or("layout", &[Address, Length, Command])?;
    let counted = record.words_or("counted", &[Command, Data, CheckBytes, Footer])?;
    let reply_has_id = !record.any::<bool>("replies_without_id")?;
    let times = |parts: &[Place], part| parts.iter().filter(|each| **each == part).count();
    let can_be_last = |last: &&Place| **last == Command || reply_has_id;
    let last = order.last().filter(can_be_last);
    let mut between = order.iter();
    let known = between.all(|part| matches!(part, Address | Length | Command));
    if !known
        || (times(&order, Length), times(&order, Command)) != (1, 1)
        || !(size(&Address)..=1).contains(&times(&order, Address))
        || !matches!(last, Some(Length | Command))
    {
        return BadEdition::because(
            "layout must have length and command once each, and address if frames have one; it \
             must end with length or command, and with command if replies have no command",
        );
    }
    if counted.iter().any(|part| times(&counted, *part) != 1)
        || !counted.contains(&Data)
        || !(reply_has_id || counted.contains(&Command))
    {
        return BadEdition::because(
            "counted must contain data, and command if replies have no command; no part may \
             occur twice",
        );
    }
    let offset = |part: Place| {
        let parts = [&Header].into_iter().chain(&order);
        let before = parts.take_while(|each| **each != part);
        before.map(size).sum::<usize>()
    };
    let number = |part: Place, of: Record<'_>| -> Outcome<Part> {
        Ok(Part {
            at: offset(part),
            wide: size(&part) == 2,
            order: of.word_or("order", Order::Big)?,
        })
    };
    let uncounted = sizes.iter().filter(|(part, _)| !counted.contains(part));
    let layout = Layout {
        address_at: (!addresses.is_empty()).then(|| offset(Address)),
        length: number(Length, length)?,
        id: number(Command, id)?,
        data_at: offset(Data),
        overhead: uncounted.map(|(_, size)| size).sum(),
        reply_has_id,
    };
    let check = match (algorithm, &*footer) {
        (None, &[footer]) => Check::Footer(footer),
        (None, _) => return BadEdition::because("footer must be one byte, since check is footer"),
        (algorithm, _) => {
            let from = record.word("check_from")?;
            let fixed = order.contains(&from) && size(&from) > 0;
            if from != Header && !fixed && !(from == Data && reply_has_id) {
                return BadEdition::because(
                    "check_from must be a part that all frames have, before the check",
                );
            }
            Check::Computed(Box::new(Computed {
                width: check_width,
                order: record.word_or("check_order", Order::Big)?,
                from: offset(from),
                algorithm,
                footer,
            }))
        }
    };
    Ok(FrameFormat {
        header,
        addresses,
        check,
        maximum_length: record.within("maximum_length", 0..=LONGEST as i64)?,
        layout,
    })
}

/// Return the bytes that a text states as pairs of hexadecimal digits.
fn hex(record: Record<'_>, key: &str, sizes: RangeInclusive<usize>) -> Outcome<Vec<u8>> {
    let text: &str = record.any(key)?;
    let digits: Vec<char> = text.chars().filter(|char| *char != ' ').collect();
    let bytes = digits.chunks(2).map(|pair| match pair {
        [high, low] => u8::try_from(high.to_digit(16)? << 4 | low.to_digit(16)?).ok(),
        _ => None,
    });
    match bytes.collect::<Option<Vec<u8>>>() {
        Some(bytes) if sizes.contains(&bytes.len()) => Ok(bytes),
        _ => {
            let (least, most) = sizes.into_inner();
            let text = format!("{key} must be {least} to {most} bytes, as pairs of hex digits");
            BadEdition::because(text)
        }
    }
}

const ALGORITHMS: [(&str, Algorithm, &[usize]); 6] = [
    ("sum", Algorithm::Sum, &[1, 2, 4]),
    ("inverted-sum", Algorithm::InvertedSum, &[1, 2, 4]),
    ("negated-sum", Algorithm::NegatedSum, &[1, 2, 4]),
    ("xor", Algorithm::Xor, &[1]),
    ("fletcher", Algorithm::Fletcher(256), &[2]),
    ("fletcher-16", Algorithm::Fletcher(255), &[2]),
];

/// Return the algorithm of the check, and its width in bytes; `None`: the check is only a footer.
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

/// Return the JSON text under a key of an object. The parameters of a CRC can have more bits than
/// `serde_json` numbers.
fn part<'a>(object: &'a str, key: &str) -> Outcome<&'a str> {
    let object: Result<BTreeMap<String, &RawValue>, _> = serde_json::from_str(object);
    let object = object.or_else(BadEdition::because)?;
    let found = object.get(key).map(|value| value.get());
    found.map_or_else(|| BadEdition::because("it is missing").within(key, ""), Ok)
}

/// Return the number or flag under a key of an object.
fn stated<T: FromStr<Err: Display>>(object: &str, key: &str) -> Outcome<T> {
    let value = part(object, key)?.parse();
    value.or_else(BadEdition::because).within(key, "")
}

fn crc(json: &[u8], size: usize) -> Outcome<Algorithm> {
    let file = str::from_utf8(json).or_else(BadEdition::because)?;
    let crc = part(part(file, "frame")?, "crc")?;
    let crc = CrcParameters {
        width: stated(crc, "width")?,
        poly: stated(crc, "poly")?,
        init: stated(crc, "init")?,
        refin: stated(crc, "refin")?,
        refout: stated(crc, "refout")?,
        xorout: stated(crc, "xorout")?,
    };
    let fits = |number: u128| number.checked_shr(crc.width).unwrap_or_default() == 0;
    match Crc::new(crc).filter(|crc| crc.size() == size) {
        Some(made) if fits(crc.poly | crc.init | crc.xorout) => Ok(Algorithm::Crc(made)),
        _ => BadEdition::because(
            "crc must have 1 to 120 bits, its parameters at most as many; check_width must be its size in bytes",
        ),
    }
}

/// Return the addresses that the file names.
pub(crate) fn addresses(record: Record<'_>) -> Outcome<Vec<Addressee>> {
    let address = |record: Record<'_>| {
        let value = record.get("value")?;
        let replier = match record.or("replies", "own")? {
            "own" => Replier::Address(value),
            "any" => Replier::Anybody,
            "one" => Replier::Somebody,
            "none" => Replier::Nobody,
            _ => return BadEdition::because("replies must be own, any, one or none"),
        };
        Ok(Addressee {
            name: record.get("name")?,
            value,
            replier,
            joints: record.any::<u8>("joints")?.into(),
        })
    };
    let records = record.records("addresses")?.into_iter();
    records.map(address).collect()
}
