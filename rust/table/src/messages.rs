//! Turns the fields of a message into its variants: one for each number of elements that its lists
//! may have.

use alloc::collections::BTreeSet;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use cobotwire_core as wire;
use cobotwire_core::Shape;
use cobotwire_core::exchange::Named;

use crate::frame::LONGEST;
use crate::json::{Record, Word};
use crate::types::{Kind, Numbers, Types, all_choices, bits, fitting, kind, words};
use crate::{BadEdition, Field, Outcome, Value, Within};

impl Word for wire::Encoding {
    const WORDS: &[(&str, Self)] = &[
        ("ascii", Self::Ascii),
        ("utf-8", Self::Utf8),
        ("latin-1", Self::Latin1),
    ];
}

/// One variant of a message: for the table, for texts and clients, and for the exchange.
type Variant = (wire::Variant, (Vec<Field>, Vec<Named>));

/// Makes the variants of the messages of a file.
pub(crate) struct Messages<'a> {
    types: Types<'a>,
    /// The most data bytes of a message that has lists of varying length.
    most: usize,
}

/// A list with a number of elements that varies.
#[derive(Clone, Copy)]
struct Varying<'a> {
    name: &'a str,
    least: usize,
    most: usize,
    /// The bytes of an element.
    each: usize,
    /// The number of elements in the variant that is made next.
    count: usize,
}

impl<'a> Messages<'a> {
    pub(crate) fn new(file: Record<'a>) -> Outcome<Self> {
        let most = file.at("frame").within("maximum_data", 0..=LONGEST)?;
        let types = Types::new(file)?;
        Ok(Self { types, most })
    }

    /// Return the variants of a message; the file has one or more lists of fields for it.
    pub(crate) fn variants(&self, lists: Vec<Record<'a>>) -> Outcome<Vec<Variant>> {
        let mut made = Vec::new();
        for list in lists {
            let records = &*list.items()?;
            let mut varying = self.varying(records)?;
            // The lists are as short as they can be.
            let shortest = self.variant(records, &varying)?;
            let room = self.most.checked_sub(shortest.0.size());
            if room.is_some() || varying.is_empty() {
                made.push(shortest);
            }
            while room.is_some_and(|room| lengthen(&mut varying, room)) {
                made.push(self.variant(records, &varying)?);
            }
        }
        Ok(made)
    }

    /// Return the lists of a message that have a varying length.
    fn varying(&self, records: &[Record<'a>]) -> Outcome<Vec<Varying<'a>>> {
        let (mut found, mut names) = (Vec::new(), BTreeSet::new());
        for record in records {
            let name = record.name()?;
            if !names.insert(name) {
                return BadEdition::because("the message has it twice").within("field", name);
            }
            found.extend(self.list(*record, name).within("field", name)?);
        }
        Ok(found)
    }

    /// Return a field as a list of varying length, if it is one.
    fn list(&self, record: Record<'a>, name: &'a str) -> Outcome<Option<Varying<'a>>> {
        let of = self.of(record)?;
        let found = of.zip(of.map(bounds).transpose()?);
        let Some((of, (least, most))) = found.filter(|(_, (least, most))| least < most) else {
            return Ok(None);
        };
        let numbers = self.shaped(of)?.1.wire;
        let (each, count) = (numbers.iter().map(wire::Number::step).sum(), least);
        if each == 0 {
            return BadEdition::because("its elements have no bytes");
        }
        Ok(Some(Varying {
            name,
            least,
            most,
            each,
            count,
        }))
    }

    fn variant(&self, records: &[Record<'a>], lists: &[Varying<'_>]) -> Outcome<Variant> {
        let (mut fields, mut texts, mut names) = (Vec::new(), Vec::new(), Vec::new());
        for record in records {
            let name = record.name()?;
            let (field, mut text) = self.field(*record, records, lists).within("field", name)?;
            text.name = name.into();
            self.types.spend(memory(&field, &text))?;
            names.push(Named {
                name: name.into(),
                echo: record.some("echo").is_some(),
                status: field.choices.len() != 1 || !text.labels.is_empty(),
            });
            fields.push(field);
            texts.push(text);
        }
        Ok((wire::Variant::new(fields), (texts, names)))
    }

    fn field(
        &self,
        record: Record<'a>,
        records: &[Record<'a>],
        lists: &[Varying<'_>],
    ) -> Outcome<(wire::Field, Field)> {
        let list = |name: &str| lists.iter().find(|list| list.name == name);
        if let Some(counted) = record.get::<Option<&str>>("counts")? {
            let Some(list) = list(counted) else {
                return BadEdition::because(
                    "counts must name a list of varying length in the same message",
                );
            };
            let (mut field, mut text) = self.plain(record, records, Some(list.count as i64))?;
            field.varies = true;
            text.sizes = Some((list.least, list.most));
            (text.counts, text.constant) = (Some(counted.into()), false);
            return Ok((field, text));
        }
        use Kind::{Bits, Bytes, List, Text};
        match self.of(record)? {
            Some(of) if matches!(kind(of)?, Bits | Bytes | List | Text) => {
                self.repeated(of, list(record.name()?))
            }
            _ => self.plain(record, records, record.get("const")?),
        }
    }

    /// Return the type of a field; `None` if it has cases.
    fn of(&self, record: Record<'a>) -> Outcome<Option<Record<'a>>> {
        let found = record.some("type").map(|_| self.types.get(record, "type"));
        found.transpose()
    }

    /// Return a field of bits, bytes, a text or a list; `list` has its number of elements if it
    /// varies.
    fn repeated(
        &self,
        of: Record<'a>,
        list: Option<&Varying<'_>>,
    ) -> Outcome<(wire::Field, Field)> {
        let (mut field, numbers, mut text) = self.shaped(of)?;
        let count = list.map_or(bounds(of)?.0, |list| list.count);
        self.types.spend(numbers.weight.saturating_mul(count))?;
        field.cases = vec![wire::Case {
            when: Vec::new(),
            numbers: vec![numbers.wire; count].concat(),
        }];
        field.varies = list.is_some();
        text.cases = vec![numbers.texts];
        text.sizes = list.map(|list| (list.least, list.most));
        Ok((field, text))
    }

    /// Return a field of bits, bytes, a text or a list without its numbers, the numbers of one
    /// element, and its texts.
    fn shaped(&self, of: Record<'a>) -> Outcome<(wire::Field, Numbers, Field)> {
        let (mut field, mut text) = (wire::Field::default(), Field::default());
        let shape = kind(of)?;
        let in_list = shape == Kind::List;
        let element = in_list.then(|| self.types.get(of, "of"));
        let of = element.unwrap_or(Ok(of))?;
        let kind = kind(of)?;
        field.many = true;
        let numbers = match kind {
            Kind::Bits if !in_list => bits(of)?,
            Kind::Bytes if !in_list => {
                field.shape = Shape::Bytes;
                Numbers::bytes(1, 255)
            }
            Kind::Text => {
                let encoding = of.word("encoding")?;
                field.shape = Shape::Text(encoding, of.get("padding")?);
                let count = if in_list { bounds(of)?.0 } else { 1 };
                field.each = if in_list { count } else { 0 };
                let ascii = encoding == wire::Encoding::Ascii;
                Numbers::bytes(count, if ascii { 127 } else { 255 })
            }
            _ => {
                let numbers = self.types.numbers(of)?;
                field.each = numbers.wire.len() * usize::from(kind == Kind::Value);
                (field.flag, field.choices) = (kind == Kind::Flag, all_choices(of)?);
                text.labels = labels(of)?;
                numbers
            }
        };
        Ok((field, numbers, text))
    }

    /// Return a field of one number, or of a row of named numbers.
    fn plain(
        &self,
        record: Record<'a>,
        records: &[Record<'a>],
        fixed: Option<i64>,
    ) -> Outcome<(wire::Field, Field)> {
        let mut cases = record.records("cases")?;
        if cases.is_empty() {
            cases.push(record);
        }
        let (mut field, mut text) = (wire::Field::default(), Field::default());
        for case in &cases {
            let numbers = self.types.numbers(self.types.get(*case, "type")?)?;
            field.cases.push(wire::Case {
                when: case.any("when")?,
                numbers: numbers.wire,
            });
            text.cases.push(numbers.texts);
        }
        let first = self.types.get(*cases.first().unwrap_or(&record), "type")?;
        let kind = kind(first)?;
        (field.flag, field.many) = (kind == Kind::Flag, kind == Kind::Value);
        let selector: Option<&str> = record.get("selector")?;
        let index = |name| records.iter().position(|each| each.name() == Ok(name));
        // An unknown name becomes an index that the core rejects.
        field.selector = selector.map(|name| index(name).unwrap_or(records.len()));
        field.choices = match fixed {
            Some(fixed) => vec![fixed],
            // Each case of a quantity with a selector has its own choices, stored in its number.
            None if field.selector.is_some() && kind == Kind::Quantity => Vec::new(),
            None => all_choices(first)?,
        };
        for number in field.cases.iter().flat_map(|case| &case.numbers) {
            fitting(number, &field.choices)?;
        }
        text.constant = fixed.is_some();
        if fixed.is_none() {
            text.labels = labels(first)?;
        }
        let constant = fixed.map(|fixed| vec![fixed; field.numbers(0).len()]);
        if let Some(raws) = constant.map_or_else(|| record.get("default"), |raws| Ok(Some(raws)))? {
            text.default = physical(&raws, &field).within("default", "")?;
        }
        for each in first.records("meanings")? {
            let meaning = (each.get("first")?, each.get("last")?, each.get("says")?);
            text.meanings.push(meaning);
        }
        Ok((field, text))
    }
}

fn labels(of: Record<'_>) -> Outcome<Vec<String>> {
    let members = of.records("members")?.into_iter();
    members.map(|member| member.get("name")).collect()
}

/// Set the next combination of list lengths; the last list changes first. All lists together may
/// take `room` bytes more than at their smallest lengths. Return false after the last combination.
fn lengthen(mut lists: &mut [Varying<'_>], room: usize) -> bool {
    let more = |list: &Varying<'_>| (list.count - list.least) * list.each;
    while let Some((last, earlier)) = lists.split_last_mut() {
        last.count += 1;
        let all = more(last) + earlier.iter().map(more).sum::<usize>();
        if last.count <= last.most && all <= room {
            return true;
        }
        last.count = last.least;
        lists = earlier;
    }
    false
}

/// Return the smallest and the largest number of elements of a type.
fn bounds(of: Record<'_>) -> Outcome<(usize, usize)> {
    let bound = |key| of.within_or(key, 0..=LONGEST, 1);
    Ok((bound("least")?, bound("most")?))
}

/// Convert raw values of a field's first case to physical values.
fn physical(raws: &[i64], field: &wire::Field) -> Outcome<Option<Value>> {
    let numbers = field.numbers(0);
    if numbers.len() != raws.len() {
        return BadEdition::because("it must have one raw value for each number");
    }
    let mut values = Vec::from_iter(field.many.then_some(wire::Value::Row(raws.len())));
    for (number, raw) in numbers.iter().zip(raws) {
        fitting(number, [raw])?;
        values.push(number.physical(*raw));
    }
    Ok(Value::nested(&mut values.into_iter()))
}

/// Return about how many bytes of memory a field takes, without its numbers.
fn memory(field: &wire::Field, text: &Field) -> usize {
    let whens = field.cases.iter().map(|case| 8 * case.when.len());
    let says = text.meanings.iter().map(|(.., says)| 48 + says.len());
    let lists = words(&text.labels) + 8 * field.choices.len() + 2 * text.name.len();
    size_of_val(field) + size_of_val(text) + lists + whens.chain(says).sum::<usize>()
}
