//! Turns the fields of a message into its variants: one for each number of elements that its lists
//! may have.

use alloc::format;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use cobotwire_core as wire;
use cobotwire_core::Shape;

use crate::Field;
use crate::frame::LONGEST;
use crate::json::{BadEdition, Node, Outcome, Record, Within};
use crate::types::{Numbers, Types, all_choices, encoding, fits, kind, labels};

/// The most memory of all fields together, in bytes. A message has as many variants as the product
/// of the sizes of its lists, so a short file could fill the memory.
const MOST_MEMORY: usize = 1 << 27;

/// One variant of a message.
pub(crate) struct Variant {
    pub(crate) fields: Vec<wire::Field>,
    pub(crate) texts: Vec<Field>,
}

/// Makes the variants of the messages of a file.
pub(crate) struct Messages<'a> {
    types: Types<'a>,
    /// The most data bytes of a message with lists that vary.
    most: usize,
    /// How many bytes more all fields together may take.
    left: usize,
}

/// A list of which the number of elements varies.
#[derive(Clone, Copy)]
struct Varying<'a> {
    name: &'a str,
    least: usize,
    most: usize,
    /// The bytes of an element.
    each: usize,
    /// The number of elements in the variant that is made.
    count: usize,
}

/// What a shaped field consists of.
struct Elements {
    kind: &'static str,
    shape: Shape,
    each: usize,
    /// The numbers of one element.
    numbers: Numbers,
    choices: Vec<i64>,
    labels: Vec<String>,
}

impl<'a> Messages<'a> {
    pub(crate) fn new(root: Record<'a>, most: usize) -> Outcome<Self> {
        let (types, left) = (Types::new(root)?, MOST_MEMORY);
        Ok(Self { types, most, left })
    }

    /// Return the variants of a message; the file has one or more lists of fields for it.
    pub(crate) fn variants(&mut self, lists: Vec<Vec<Record<'a>>>) -> Outcome<Vec<Variant>> {
        let mut made = Vec::new();
        for records in lists {
            let mut varying = self.varying(&records)?;
            if varying.is_empty() {
                made.push(self.variant(&records, &varying)?);
                continue;
            }
            // The lists are as short as they can be.
            let shortest = self.variant(&records, &varying)?;
            let size = wire::Variant::new(shortest.fields).size();
            let Some(room) = self.most.checked_sub(size) else {
                continue;
            };
            loop {
                made.push(self.variant(&records, &varying)?);
                if !lengthen(&mut varying, room) {
                    break;
                }
            }
        }
        Ok(made)
    }

    /// Return the lists of a message that vary.
    fn varying(&self, records: &[Record<'a>]) -> Outcome<Vec<Varying<'a>>> {
        let mut found = Vec::new();
        for (index, record) in records.iter().enumerate() {
            let name = record.name()?;
            let others = records.iter().take(index);
            for other in others {
                if other.name()? == name {
                    return Err(BadEdition::new(format!("two fields are called {name}")));
                }
            }
            let Some((least, most)) = self.sizes(*record).within("field", name)? else {
                continue;
            };
            let elements = self.elements(self.types.record(record.need("type")?)?);
            let each = elements.within("field", name)?.numbers.size();
            if each == 0 {
                return Err(BadEdition::new("its elements have no bytes")).within("field", name);
            }
            let count = least;
            found.push(Varying {
                name,
                least,
                most,
                each,
                count,
            });
        }
        Ok(found)
    }

    /// Return the least and the most elements of a field, if they differ.
    fn sizes(&self, record: Record<'a>) -> Outcome<Option<(usize, usize)>> {
        let Some(reference) = record.get("type") else {
            return Ok(None);
        };
        let (least, most) = bounds(self.types.record(reference)?)?;
        Ok((least < most).then_some((least, most)))
    }

    fn variant(&mut self, records: &[Record<'a>], lists: &[Varying<'a>]) -> Outcome<Variant> {
        let (mut fields, mut texts) = (Vec::new(), Vec::new());
        for record in records {
            let name = record.name()?;
            let (field, mut text) = self.field(*record, records, lists).within("field", name)?;
            text.echo = record.get("echo").is_some();
            let taken = memory(&field, &text);
            self.left = self.left.checked_sub(taken).ok_or_else(|| {
                BadEdition::new("the variants of all messages together take too much memory")
            })?;
            fields.push(field);
            texts.push(text);
        }
        Ok(Variant { fields, texts })
    }

    fn field(
        &self,
        record: Record<'a>,
        records: &[Record<'a>],
        lists: &[Varying<'a>],
    ) -> Outcome<(wire::Field, Field)> {
        let name = record.name()?;
        if let Some(counts) = record.get("counts") {
            let list = lists
                .iter()
                .find(|list| Some(list.name) == counts.if_text());
            let list = list.ok_or_else(|| counts.unknown("a list of the message that varies"))?;
            let count = i64::try_from(list.count).unwrap_or_default();
            let (mut field, mut text) = self.plain(record, records, Some(count))?;
            field.varies = true;
            text.sizes = Some((list.least, list.most));
            text.counts = Some(list.name.into());
            return Ok((field, text));
        }
        if let Some(reference) = record.get("type") {
            let of = self.types.record(reference)?;
            if matches!(kind(of)?, "bits" | "bytes" | "text" | "list") {
                let list = lists.iter().find(|list| list.name == name);
                return self.shaped(name, of, list);
            }
        }
        let fixed = record.get("const").map(Node::integer).transpose()?;
        self.plain(record, records, fixed)
    }

    /// Return a field of bits, bytes, a text or a list.
    fn shaped(
        &self,
        name: &str,
        of: Record<'a>,
        list: Option<&Varying<'a>>,
    ) -> Outcome<(wire::Field, Field)> {
        let Elements {
            kind,
            shape,
            each,
            numbers,
            choices,
            labels,
        } = self.elements(of)?;
        let count = list.map_or(bounds(of)?.0, |list| list.count);
        let size = numbers.wire.len().saturating_mul(count);
        if size > self.left / size_of::<wire::Number>() {
            return Err(BadEdition::new("it has too many numbers"));
        }
        let all = numbers.wire.iter().cycle().take(size).cloned().collect();
        let field = wire::Field {
            flag: kind == "flag",
            many: true,
            choices,
            selector: None,
            cases: vec![wire::Case {
                when: Vec::new(),
                numbers: all,
            }],
            shape,
            each,
            varies: list.is_some(),
        };
        let text = Field {
            name: name.into(),
            kind,
            labels,
            cases: vec![numbers.texts],
            sizes: list.map(|list| (list.least, list.most)),
            ..Field::default()
        };
        Ok((field, text))
    }

    fn elements(&self, of: Record<'a>) -> Outcome<Elements> {
        let numbers = |numbers| Elements {
            kind: "number",
            shape: Shape::Numbers,
            each: 0,
            numbers,
            choices: Vec::new(),
            labels: Vec::new(),
        };
        let text = |of, count| {
            let (encoding, padding) = encoding(of)?;
            let most = if encoding == wire::Encoding::Ascii {
                127
            } else {
                255
            };
            let (kind, shape) = ("text", Shape::Text(encoding, padding));
            Ok(Elements {
                kind,
                shape,
                ..numbers(Numbers::bytes(count, most))
            })
        };
        match kind(of)? {
            "bits" => self.types.bits(of).map(numbers),
            "bytes" => {
                let (kind, shape) = ("bytes", Shape::Bytes);
                Ok(Elements {
                    kind,
                    shape,
                    ..numbers(Numbers::bytes(1, 255))
                })
            }
            "text" => text(of, 1),
            _ => {
                let of = self.types.record(of.need("of")?)?;
                let kind = plain_kind(kind(of)?);
                if kind == "text" {
                    let each = bounds(of)?.0;
                    return Ok(Elements {
                        each,
                        ..text(of, each)?
                    });
                }
                let found = self.types.numbers(of)?;
                let each = if kind == "value" { found.wire.len() } else { 0 };
                let kind = if kind == "value" { "number" } else { kind };
                let (choices, labels) = (all_choices(of)?, labels(of)?);
                Ok(Elements {
                    kind,
                    each,
                    choices,
                    labels,
                    ..numbers(found)
                })
            }
        }
    }

    /// Return a field of one number, or of a row of named numbers.
    fn plain(
        &self,
        record: Record<'a>,
        records: &[Record<'a>],
        fixed: Option<i64>,
    ) -> Outcome<(wire::Field, Field)> {
        let name = record.name()?;
        let selector = record.text("selector")?;
        let mut all = record.records("cases")?;
        if all.is_empty() {
            all.push(record);
        }
        let (mut cases, mut texts, mut first) = (Vec::new(), Vec::new(), None);
        for case in all {
            let of = self.types.record(case.need("type")?)?;
            first = first.or(Some(of));
            let numbers = self.types.numbers(of)?;
            let when = case.integers("when")?;
            cases.push(wire::Case {
                when,
                numbers: numbers.wire,
            });
            texts.push(numbers.texts);
        }
        let first = first.ok_or_else(|| BadEdition::new("it has no type"))?;
        let kind = kind(first)?;
        let choices = match (fixed, selector, kind) {
            (Some(fixed), ..) => vec![fixed],
            // Each case of a selected quantity has its own choices, in its number.
            (None, selector, "quantity") if !selector.is_empty() => Vec::new(),
            _ => all_choices(first)?,
        };
        let field = wire::Field {
            flag: kind == "flag",
            many: kind == "value",
            choices,
            selector: selector_of(selector, records)?,
            cases,
            shape: Shape::Numbers,
            each: 0,
            varies: false,
        };
        let text = Field {
            name: name.into(),
            kind: match plain_kind(kind) {
                "flag" => "flag",
                "enum" => "enum",
                _ => "number",
            },
            labels: if fixed.is_some() {
                Vec::new()
            } else {
                labels(first)?
            },
            default: default(record, &field)?,
            cases: texts,
            constant: fixed,
            meanings: meanings(first)?,
            ..Field::default()
        };
        let numbers = field.cases.iter().flat_map(|case| &case.numbers);
        let mut raws =
            numbers.flat_map(|number| field.choices.iter().map(move |raw| (number, raw)));
        match raws.find(|(number, raw)| !fits(number, **raw)) {
            None => Ok((field, text)),
            Some((_, raw)) => Err(BadEdition::new(format!("its bytes cannot hold {raw}"))),
        }
    }
}

/// Set the next numbers of elements; the last list changes first. All lists together may take that
/// many bytes more than their shortest ones. Return false after the last variant.
fn lengthen(lists: &mut [Varying<'_>], room: usize) -> bool {
    for index in (0..lists.len()).rev() {
        if let Some(list) = lists.get_mut(index) {
            list.count += 1;
        }
        let more = lists
            .iter()
            .map(|list| (list.count - list.least) * list.each);
        let fits = more.sum::<usize>() <= room;
        if let Some(list) = lists.get_mut(index) {
            if fits && list.count <= list.most {
                return true;
            }
            list.count = list.least;
        }
    }
    false
}

/// Return the least and the most elements of a type.
fn bounds(of: Record<'_>) -> Outcome<(usize, usize)> {
    let size = |node: Option<Node<'_>>| node.map_or(Ok(1), |node| node.within(0..=LONGEST));
    let (least, most) = (size(of.get("least"))?, size(of.get("most"))?);
    let size = |size| usize::try_from(size).unwrap_or_default();
    Ok((size(least), size(most)))
}

/// Return a kind as a constant.
fn plain_kind(kind: &str) -> &'static str {
    let known = ["flag", "enum", "value", "text"];
    known
        .into_iter()
        .find(|word| *word == kind)
        .unwrap_or("number")
}

fn selector_of(name: &str, records: &[Record<'_>]) -> Outcome<Option<usize>> {
    if name.is_empty() {
        return Ok(None);
    }
    let index = records
        .iter()
        .position(|each| each.name().is_ok_and(|each| each == name));
    let missing = || BadEdition::new("selector is not the name of a field of the message");
    index.map(Some).ok_or_else(missing)
}

/// Return the value of an argument that is left out, in physical units.
fn default(record: Record<'_>, field: &wire::Field) -> Outcome<Option<Vec<f64>>> {
    if record.get("default").is_none() {
        return Ok(None);
    }
    let raws = record.integers("default")?;
    let numbers = field.cases.first().map_or(&[][..], |case| &case.numbers);
    let fit = numbers
        .iter()
        .zip(&raws)
        .all(|(number, raw)| fits(number, *raw));
    if !fit || numbers.len() != raws.len() {
        return Err(BadEdition::new(
            "default is not a raw value for each number",
        ));
    }
    let values = numbers
        .iter()
        .zip(raws)
        .map(|(number, raw)| match number.physical(raw) {
            wire::Value::Real(real) => real,
            _ => raw as f64,
        });
    Ok(Some(values.collect()))
}

fn meanings(of: Record<'_>) -> Outcome<Vec<(i64, i64, String)>> {
    let meaning = |each: Record<'_>| {
        let end = |name| each.need(name)?.integer();
        Ok((end("first")?, end("last")?, each.need("says")?.string()?))
    };
    of.records("meanings")?.into_iter().map(meaning).collect()
}

/// Return about how many bytes a field takes.
fn memory(field: &wire::Field, text: &Field) -> usize {
    let numbers = field.cases.iter().flat_map(|case| &case.numbers);
    let numbers = numbers.map(|number| size_of_val(number) + 8 * number.choices.len());
    let named = text.cases.iter().flatten();
    let named = named
        .map(|each| size_of_val(each) + each.name.len() + each.unit.len() + words(&each.labels));
    let whens = field
        .cases
        .iter()
        .map(|case| size_of_val(case) + 8 * case.when.len());
    let says = text.meanings.iter().map(|(.., says)| 48 + says.len());
    let lists = words(&text.labels) + 8 * field.choices.len() + 2 * text.name.len();
    size_of_val(field)
        + size_of_val(text)
        + lists
        + numbers.chain(named).chain(whens).chain(says).sum::<usize>()
}

fn words(labels: &[String]) -> usize {
    labels
        .iter()
        .map(|label| size_of::<String>() + label.len())
        .sum()
}
