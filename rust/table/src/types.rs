//! Turns the types of a file into the numbers of a table.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use cobotwire_core as core_table;
use cobotwire_core::{Bits, Encoding, Order};

use crate::Number;
use crate::json::{BadEdition, Node, Outcome, Record, Within};

/// The types of a file, by their names.
pub(crate) struct Types<'a> {
    wires: BTreeMap<&'a str, Record<'a>>,
    types: BTreeMap<&'a str, Record<'a>>,
}

/// The numbers of a type in the order of the wire, and what texts need of each.
#[derive(Clone, Default)]
pub(crate) struct Numbers {
    pub(crate) wire: Vec<core_table::Number>,
    pub(crate) texts: Vec<Number>,
}

impl Numbers {
    fn one(wire: core_table::Number) -> Self {
        let (wire, texts) = (vec![wire], vec![Number::default()]);
        Self { wire, texts }
    }

    /// Return that many unsigned bytes, which are at most `most`.
    pub(crate) fn bytes(count: usize, most: i64) -> Self {
        let byte = core_table::Number {
            width: 1,
            order: Order::Big,
            signed_at: 255,
            multiply: 1,
            divide: 1,
            minimum: 0,
            maximum: most,
            float: false,
            choices: Vec::new(),
            flag: false,
            bits: None,
        };
        Self {
            wire: vec![byte; count],
            texts: vec![Number::default()],
        }
    }

    /// Return the number of their bytes.
    pub(crate) fn size(&self) -> usize {
        let steps = self.wire.iter().map(|number| match number.bits {
            Some(Bits { more: true, .. }) => 0,
            _ => number.width,
        });
        steps.sum()
    }
}

impl<'a> Types<'a> {
    pub(crate) fn new(root: Record<'a>) -> Outcome<Self> {
        let by_name = |key| -> Outcome<BTreeMap<_, _>> {
            let records = root.records(key)?.into_iter();
            records.map(|record| Ok((record.name()?, record))).collect()
        };
        Ok(Self {
            wires: by_name("wires")?,
            types: by_name("types")?,
        })
    }

    /// Return the record of a type, which a reference names or is.
    pub(crate) fn record(&self, reference: Node<'a>) -> Outcome<Record<'a>> {
        named(&self.types, reference, "type")
    }

    /// Return the numbers of a type that is one number, or a row of named numbers.
    pub(crate) fn numbers(&self, record: Record<'a>) -> Outcome<Numbers> {
        let name = record.text("name")?;
        if kind(record)? != "value" {
            return self
                .number(record)
                .map(Numbers::one)
                .within("type", name)
                .and_then(|mut numbers| {
                    if let Some(first) = numbers.texts.first_mut() {
                        first.unit = record.text("unit")?.into();
                    }
                    Ok(numbers)
                });
        }
        let mut numbers = Numbers::default();
        for item in record.records("items").within("type", name)? {
            let of = self.record(item.need("type")?).within("type", name)?;
            let number = self.number(of).within("type", of.text("name")?);
            numbers.wire.push(number.within("type", name)?);
            numbers.texts.push(Number {
                name: item.name()?.into(),
                unit: of.text("unit")?.into(),
                labels: Vec::new(),
            });
        }
        Ok(numbers)
    }

    fn number(&self, record: Record<'a>) -> Outcome<core_table::Number> {
        let wire = named(&self.wires, record.need("wire")?, "wire")?;
        let (width, signed_at) = (wire.size("width", 8)?, wire.need("signed_at")?.integer()?);
        let float = is_float(wire)?;
        let (multiply, divide) = record.get("scale").map_or(Ok((1, 1)), Node::rational)?;
        let choices = record.integers("choices")?;
        let (low, high) = match (kind(record)?, all_choices(record)?.as_slice()) {
            ("flag", _) => (0, 1),
            (_, []) => {
                let (low, high) = natural_range(width, signed_at, float);
                let low = record.integer("minimum", low)?;
                (low, record.integer("maximum", high)?)
            }
            (_, [first, rest @ ..]) => rest.iter().fold((*first, *first), |(low, high), each| {
                (low.min(*each), high.max(*each))
            }),
        };
        checked(core_table::Number {
            width,
            order: order(wire.need("order")?)?,
            signed_at,
            multiply,
            divide,
            minimum: low,
            maximum: high,
            float,
            choices,
            flag: false,
            bits: None,
        })
    }

    /// Return the parts of words.
    pub(crate) fn bits(&self, record: Record<'a>) -> Outcome<Numbers> {
        let mut numbers = Numbers::default();
        for part in record.records("numbers")? {
            let name = part.name()?;
            numbers.wire.push(bits(part).within("bits", name)?);
            numbers.texts.push(Number {
                name: name.into(),
                unit: part.text("unit")?.into(),
                labels: part.texts("labels")?,
            });
        }
        // Codecs read and write parts of the same bytes together.
        let more = |number: &core_table::Number| number.bits.is_some_and(|bits| bits.more);
        let torn = numbers.wire.windows(2).any(|pair| {
            matches!(pair, [one, two] if more(one) && (one.width, one.order) != (two.width, two.order))
        });
        if torn || numbers.wire.last().is_none_or(more) {
            let text =
                "the parts of a word must have its width and order, and the last one ends it";
            return Err(BadEdition::new(text));
        }
        Ok(numbers)
    }
}

fn named<'a>(
    known: &BTreeMap<&str, Record<'a>>,
    reference: Node<'a>,
    what: &str,
) -> Outcome<Record<'a>> {
    let Some(name) = reference.if_text() else {
        return reference.record();
    };
    let found = known.get(name).copied();
    found.ok_or_else(|| reference.unknown(&format!("the name of a {what} of the file")))
}

fn bits(record: Record<'_>) -> Outcome<core_table::Number> {
    let need = |name| record.need(name)?.integer();
    checked(core_table::Number {
        width: record.size("width", 4)?,
        order: order(record.need("order")?)?,
        signed_at: need("signed_at")?,
        multiply: need("multiply")?,
        divide: need("divide")?,
        minimum: need("minimum")?,
        maximum: need("maximum")?,
        float: is_float(record)?,
        choices: record.integers("choices")?,
        flag: record.text("kind")? == "flag",
        bits: Some(Bits {
            shift: u32::try_from(record.size("shift", 31)?).unwrap_or_default(),
            count: u32::try_from(record.within("bits", 1..=32)?).unwrap_or_default(),
            more: record.is("more")?,
        }),
    })
}

fn checked(number: core_table::Number) -> Outcome<core_table::Number> {
    let ends = [number.minimum, number.maximum];
    let mut raws = ends.iter().chain(&number.choices);
    match raws.find(|raw| !fits(&number, **raw)) {
        None => Ok(number),
        Some(raw) => Err(BadEdition::new(format!("its bytes cannot hold {raw}"))),
    }
}

/// Return whether the bytes of a number can hold a raw value, so that it can be scaled.
pub(crate) fn fits(number: &core_table::Number, raw: i64) -> bool {
    number.float || raw.unsigned_abs() < 1 << (8 * number.width.min(4))
}

/// Return the kind of a type.
pub(crate) fn kind<'a>(record: Record<'a>) -> Outcome<&'a str> {
    record.need("kind")?.text()
}

/// Return all legal raw values of a type; none if it has a range.
pub(crate) fn all_choices(record: Record<'_>) -> Outcome<Vec<i64>> {
    if kind(record)? == "flag" {
        return Ok(vec![0, 1]);
    }
    let members = record.records("members")?.into_iter();
    let values = members.map(|member| member.need("value")?.integer());
    let values: Vec<i64> = values.collect::<Outcome<_>>()?;
    if values.is_empty() {
        return record.integers("choices");
    }
    Ok(values)
}

/// Return the words of a type's choices.
pub(crate) fn labels(record: Record<'_>) -> Outcome<Vec<String>> {
    let members = record.records("members")?.into_iter();
    members.map(|member| Ok(member.name()?.into())).collect()
}

/// Return the encoding of a text, and its padding if it has one.
pub(crate) fn encoding(record: Record<'_>) -> Outcome<(Encoding, Option<u8>)> {
    let word = record.need("encoding")?;
    let encoding = match word.text()? {
        "ascii" => Encoding::Ascii,
        "latin-1" => Encoding::Latin1,
        "utf-8" => Encoding::Utf8,
        _ => return Err(word.unknown("ascii, latin-1, utf-8")),
    };
    Ok((encoding, record.get("padding").map(Node::byte).transpose()?))
}

/// Return an order of bytes.
pub(crate) fn order(word: Node<'_>) -> Outcome<Order> {
    match word.text()? {
        "big" => Ok(Order::Big),
        "little" => Ok(Order::Little),
        _ => Err(word.unknown("big, little")),
    }
}

fn is_float(record: Record<'_>) -> Outcome<bool> {
    let Some(word) = record.get("encoding") else {
        return Ok(false);
    };
    match word.text()? {
        "float" => Ok(true),
        "integer" => Ok(false),
        _ => Err(word.unknown("integer, float")),
    }
}

/// Return the lowest and the highest raw value that bytes can hold; floats: finite ones.
fn natural_range(width: usize, signed_at: i64, float: bool) -> (i64, i64) {
    let (wide, infinite) = (i64::MAX, 0x7FF0_0000_0000_0000);
    match (float, width) {
        (true, 4) => (-0x7F80_0000, 0x7F7F_FFFF),
        (true, _) => (-infinite, infinite - 1),
        (false, 0..=4) => {
            let top = (1 << (8 * width)) - 1;
            (
                if signed_at < top {
                    signed_at.saturating_sub(top)
                } else {
                    0
                },
                signed_at,
            )
        }
        // The core takes no integer of so many bytes.
        (false, _) => (0, wide),
    }
}
