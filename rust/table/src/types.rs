//! Turns the types of a file into the numbers of a table.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;
use core::cell::Cell;

use cobotwire_core as core_table;
use cobotwire_core::{Bits, NumberEncoding, Order};

use crate::json::{Record, Word};
use crate::{BadEdition, Number, Outcome, Within};

/// The most memory of all numbers and fields together, in bytes. Each number repeats the choices of
/// its type, and a message has as many variants as the product of the sizes of its lists, so a
/// short file could fill the memory.
const MOST_MEMORY: usize = 1 << 27;

/// The types of a file, by their names.
pub(crate) struct Types<'a> {
    wires: BTreeMap<&'a str, Record<'a>>,
    types: BTreeMap<&'a str, Record<'a>>,
    /// The number of bytes that further numbers and fields may take.
    left: Cell<usize>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    Quantity,
    Enum,
    Flag,
    Value,
    Bits,
    Bytes,
    Text,
    List,
}

impl Word for Kind {
    const WORDS: &[(&str, Self)] = &[
        ("quantity", Self::Quantity),
        ("enum", Self::Enum),
        ("flag", Self::Flag),
        ("value", Self::Value),
        ("bits", Self::Bits),
        ("bytes", Self::Bytes),
        ("text", Self::Text),
        ("list", Self::List),
    ];
}

impl Word for Order {
    const WORDS: &[(&str, Self)] = &[("big", Self::Big), ("little", Self::Little)];
}

impl Word for NumberEncoding {
    const WORDS: &[(&str, Self)] = &Self::ALL;
}

/// The numbers of a type in wire order, and the name, unit and labels of each, for printed values.
#[derive(Clone, Default)]
pub(crate) struct Numbers {
    pub(crate) wire: Vec<core_table::Number>,
    pub(crate) texts: Vec<Number>,
    /// About how many bytes of memory they take.
    pub(crate) weight: usize,
}

impl Numbers {
    /// Return `count` unsigned bytes, each of which is at most `most`.
    pub(crate) fn bytes(count: usize, most: i64) -> Self {
        let byte = core_table::Number {
            width: 1,
            signed_at: 255,
            multiply: 1,
            divide: 1,
            maximum: most,
            ..core_table::Number::default()
        };
        Self {
            wire: vec![byte; count],
            texts: vec![Number::default()],
            weight: count * size_of::<core_table::Number>(),
        }
    }

    fn push(&mut self, wire: core_table::Number, name: &str, of: Record<'_>) -> Outcome<()> {
        let text = Number {
            name: name.into(),
            unit: of.any("unit")?,
            labels: of.any("labels")?,
        };
        let words = name.len() + text.unit.len() + words(&text.labels);
        self.weight += size_of_val(&wire) + 8 * wire.choices.len() + size_of_val(&text) + words;
        self.wire.push(wire);
        self.texts.push(text);
        Ok(())
    }
}

impl<'a> Types<'a> {
    pub(crate) fn new(file: Record<'a>) -> Outcome<Self> {
        let by_name = |key| -> Outcome<BTreeMap<_, _>> {
            let records = file.records(key)?.into_iter();
            records.map(|record| Ok((record.name()?, record))).collect()
        };
        Ok(Self {
            wires: by_name("wires")?,
            types: by_name("types")?,
            left: Cell::new(MOST_MEMORY),
        })
    }

    /// Return the type under a key. The value is a type's name, or the record of a type.
    pub(crate) fn get(&self, record: Record<'a>, key: &str) -> Outcome<Record<'a>> {
        referred(&self.types, record.at(key)).within(key, "")
    }

    /// Subtract memory from what is left; fail if there is not enough.
    pub(crate) fn spend(&self, bytes: usize) -> Outcome<()> {
        let left = self.left.get().checked_sub(bytes);
        let too_much = || BadEdition::because("all types and messages take too much memory");
        self.left.set(left.map_or_else(too_much, Ok)?);
        Ok(())
    }

    /// Return the numbers of a type that is one number, or a row of named numbers.
    pub(crate) fn numbers(&self, of: Record<'a>) -> Outcome<Numbers> {
        let (mut numbers, name) = (Numbers::default(), of.any("name")?);
        let mut push = |name, of: Record<'a>| {
            let before = numbers.weight;
            numbers.push(self.number(of).within("type", of.any("name")?)?, name, of)?;
            self.spend(numbers.weight - before)
        };
        if kind(of)? != Kind::Value {
            push("", of)?;
            return Ok(numbers);
        }
        for item in of.records("items").within("type", name)? {
            let inner = self.get(item, "type").within("type", name)?;
            push(item.name()?, inner).within("type", name)?;
        }
        Ok(numbers)
    }

    fn number(&self, of: Record<'a>) -> Outcome<core_table::Number> {
        let wire = referred(&self.wires, of.at("wire")).within("wire", "")?;
        number(wire, of, &all_choices(of)?)
    }
}

/// Return about how many bytes of memory labels take.
pub(crate) fn words(labels: &[String]) -> usize {
    labels.iter().map(|label| 24 + label.len()).sum()
}

fn referred<'a>(known: &BTreeMap<&str, Record<'a>>, reference: Record<'a>) -> Outcome<Record<'a>> {
    let found = match reference.0.as_str() {
        None => Some(reference).filter(|here| here.0.is_object()),
        Some(name) => known.get(name).copied(),
    };
    let unknown = || BadEdition::because(format_args!("the file does not define {}", reference.0));
    found.map_or_else(unknown, Ok)
}

/// Return the numbers of a type of bit fields.
pub(crate) fn bits(of: Record<'_>) -> Outcome<Numbers> {
    let mut numbers = Numbers::default();
    for part in of.records("numbers")? {
        let name = part.name()?;
        let number = part_of_word(part).within("bits", name)?;
        numbers.push(number, name, part)?;
    }
    // Codecs read and write parts of the same bytes together.
    let more = |number: &core_table::Number| number.bits.is_some_and(|bits| bits.more);
    let torn = numbers.wire.windows(2).any(|pair| {
        matches!(pair, [one, two] if more(one) && (one.width, one.order) != (two.width, two.order))
    });
    if torn || numbers.wire.last().is_none_or(more) {
        return BadEdition::because(
            "bit fields that share bytes must have the same width and byte order, and only the last has more: false",
        );
    }
    Ok(numbers)
}

fn part_of_word(part: Record<'_>) -> Outcome<core_table::Number> {
    Ok(core_table::Number {
        multiply: part.get("multiply")?,
        divide: part.get("divide")?,
        flag: part.any::<&str>("kind")? == "flag",
        bits: Some(Bits {
            shift: part.get("shift")?,
            count: part.get("bits")?,
            more: part.any("more")?,
        }),
        ..number(part, part, &[])?
    })
}

/// Return a number: its bytes are those of a wire; its limits come from its choices or its type.
fn number(wire: Record<'_>, of: Record<'_>, all: &[i64]) -> Outcome<core_table::Number> {
    let (multiply, divide) = of.rational("scale")?;
    let mut number = core_table::Number {
        width: wire.get("width")?,
        order: wire.word("order")?,
        signed_at: wire.get("signed_at")?,
        multiply,
        divide,
        encoding: wire.word_or("encoding", NumberEncoding::Integer)?,
        choices: of.any("choices")?,
        ..core_table::Number::default()
    };
    let (low, high) = number.natural_range();
    let (least, most) = (all.iter().min().copied(), all.iter().max().copied());
    number.minimum = least.map_or_else(|| of.or("minimum", low), Ok)?;
    number.maximum = most.map_or_else(|| of.or("maximum", high), Ok)?;
    number.check().or_else(BadEdition::because)?;
    let ends = [number.minimum, number.maximum];
    fitting(&number, ends.iter().chain(&number.choices))?;
    Ok(number)
}

/// Check that the bytes of a number can hold these raw values.
pub(crate) fn fitting<'a>(
    number: &core_table::Number,
    raws: impl IntoIterator<Item = &'a i64>,
) -> Outcome<()> {
    let largest = 1 << (8 * number.width.min(4));
    let mut raws = raws.into_iter();
    match raws.find(|raw| !number.is_float() && raw.unsigned_abs() >= largest) {
        None => Ok(()),
        Some(raw) => BadEdition::because(format_args!("its bytes cannot hold {raw}")),
    }
}

pub(crate) fn kind(of: Record<'_>) -> Outcome<Kind> {
    of.word("kind")
}

/// Return all legal raw values of a type; empty if it has a range.
pub(crate) fn all_choices(of: Record<'_>) -> Outcome<Vec<i64>> {
    if kind(of)? == Kind::Flag {
        return Ok(vec![0, 1]);
    }
    let members = of.records("members")?;
    if members.is_empty() {
        return of.any("choices");
    }
    members.iter().map(|member| member.get("value")).collect()
}
