//! The texts of the errors of the codec: values, raw values and frames that are not allowed.

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::iter::once;

use cobotwire_core::{
    Algorithm, BadRaw, BadValue, Check, DecodeError, Direction, EncodeError, Encoding,
    Field as Wire, Number as WireNumber, Reason, Shape, Value as WireValue, ValueFault, Variant,
    VariantId,
};

use crate::texts::{bad_argument, either, entry, hex, one_or, protocol_error, text};
use crate::value::{general, join, printable, shortest};
use crate::{Edition, Field, Number, Value};

// Here a symbolic link to a file of the Python package; a published crate contains the file.
pub(crate) const UNITS: &str = include_str!("../units.json");

/// A field with its names, in one of its cases.
pub(crate) struct Part<'a> {
    pub(crate) name: &'a Field,
    pub(crate) wire: &'a Wire,
    pub(crate) numbers: &'a [WireNumber],
    case: usize,
}

impl Edition {
    /// Return the text of the error of values that were not encoded. `count` is their number.
    pub fn encode_error(
        &self,
        (command, direction): (usize, Direction),
        error: &EncodeError<Value>,
        count: usize,
        address: Option<u8>,
    ) -> String {
        match error {
            EncodeError::Address => {
                self.no_address(&Value::Integer(address.unwrap_or_default().into()))
            }
            EncodeError::VariantId => self.bad_variant(command, direction, count),
            EncodeError::Value(bad) => {
                let variant = VariantId {
                    direction,
                    command,
                    variant: bad.variant,
                };
                let part = self.part(variant, bad.field, bad.case);
                part.map_or(String::new(), |part| part.bad_value(bad))
            }
            EncodeError::Foreign(never) => match *never {},
        }
    }

    /// Return the text of the error of bytes that were not decoded.
    #[must_use]
    pub fn decode_error(&self, direction: Direction, error: DecodeError, data: &[u8]) -> String {
        let (detail, offset) = match error {
            DecodeError::Frame { reason, offset } => {
                (self.bad_frame(direction, reason, data), offset)
            }
            DecodeError::Raw(bad) => (self.bad_raw(&bad).unwrap_or_default(), bad.offset),
        };
        protocol_error(&detail, offset, data)
    }

    pub(crate) fn part(&self, id: VariantId, field: usize, case: usize) -> Option<Part<'_>> {
        let wire = self.protocol.table.variant(id)?.fields().get(field)?;
        let variants = self.commands.get(id.command)?.variants(id.direction);
        let name = variants.get(id.variant)?.get(field)?;
        let numbers = &wire.cases.get(case)?.numbers;
        Some(Part {
            name,
            wire,
            numbers,
            case,
        })
    }

    fn bad_variant(&self, command: usize, direction: Direction, count: usize) -> String {
        let (name, record) = (self.command_name(command), self.commands.get(command));
        let variants = record.map_or(&[][..], |record| record.variants(direction));
        let direction = direction.word();
        if variants.is_empty() {
            return text!("no-message"; command = name, direction);
        }
        let allowed = either(variants.iter().map(|fields| {
            let names = fields.iter().map(|field| field.name.clone());
            format!("({})", join(names, ", "))
        }));
        let kind = one_or(count, "value-count", "values-count");
        printable(&text!(kind; count, message = format!("{name} {direction}"), allowed))
    }

    fn bad_raw(&self, bad: &BadRaw) -> Option<String> {
        let (part, at) = (self.part(bad.variant, bad.field, bad.case)?, bad.element);
        let (command, name) = (self.command_name(bad.variant.command), &part.name.name);
        if let Shape::Text(encoding, _) = part.wire.shape {
            let (raw, encoding) = (format!("{:02X}", bad.raw), word(encoding).to_lowercase());
            return Some(text!("bad-byte"; command, at, name, raw, encoding));
        }
        let number = part.numbers.get(at)?;
        let whole = part.wire.each == 0 && number.bits.is_none();
        let name = if whole { name } else { &part.element(at) };
        let value = Value::nested(&mut once(number.physical(bad.raw)))?;
        let allowed = part.allowed(at);
        Some(text!("bad-value"; command, name, value, allowed))
    }

    fn bad_frame(&self, direction: Direction, reason: Reason, data: &[u8]) -> String {
        let frame = self.protocol.table.frame();
        let layout = frame.layout;
        let counted = layout.length.read(data);
        let length = digits(counted.unwrap_or_default(), layout.length.wide);
        match reason {
            Reason::NoHeader => text!("no-header"; header = hex(&frame.header, " ")),
            Reason::BadAddress => {
                let address = layout.address_at.and_then(|at| data.get(at..=at));
                let address = hex(address.unwrap_or_default(), "");
                text!("bad-address"; address, allowed = runs(&frame.addresses))
            }
            Reason::Truncated => {
                let Some(counted) = counted else {
                    return text!("no-len");
                };
                let size = usize::from(counted) + layout.overhead;
                let missing = size.saturating_sub(data.len());
                text!(one_or(missing, "truncated-by-one", "truncated"); length, missing)
            }
            Reason::BadLength => self.bad_length(direction, &length, data),
            Reason::UnknownId => {
                let id = digits(layout.id.read(data).unwrap_or_default(), layout.id.wide);
                text!("unknown-id"; edition = self.name, direction = direction.word(), id)
            }
            Reason::BadCheck => match &frame.check {
                Check::Footer(footer) => text!("no-footer"; footer = hex(&[*footer], "")),
                Check::Computed(check) => match check.algorithm {
                    Some(Algorithm::Crc(_)) => text!("bad-crc"),
                    Some(Algorithm::Sum) => text!("bad-sum"),
                    _ => text!("bad-check"),
                },
            },
            Reason::Trailing => text!("trailing"; length),
        }
    }

    fn bad_length(&self, direction: Direction, length: &str, data: &[u8]) -> String {
        let frame = self.protocol.table.frame();
        let (layout, has_id) = (frame.layout, frame.has_id(direction));
        let id = layout.length.read(data).and(layout.id.read(data));
        let (mut legal, mut names) = (BTreeSet::new(), Vec::new());
        for (wire, command) in self.protocol.table.commands().iter().zip(&self.commands) {
            let variants = wire.variants(direction);
            if !variants.is_empty() && id.is_some_and(|id| !has_id || wire.id == id) {
                let length = |each: &Variant| frame.length(each.size(), direction);
                legal.extend(variants.iter().map(length));
                names.push(command.name.clone());
            }
        }
        let direction = direction.word();
        if legal.is_empty() {
            return text!("no-length"; direction, edition = self.name, length);
        }
        let message = match id {
            // Commands that share an id are all named: the frame does not tell which was called.
            Some(id) if has_id => {
                let (id, names) = (digits(id, layout.id.wide), either(names.into_iter()));
                text!("identified"; direction, id, names)
            }
            _ => direction.into(),
        };
        let digits = |length| digits(length as u16, layout.length.wide);
        let allowed = either(legal.into_iter().map(digits));
        text!("bad-length"; message, length, allowed)
    }
}

impl Part<'_> {
    fn bad_value(&self, bad: &BadValue<Value>) -> String {
        let (name, each, fault) = (&self.name.name, self.wire.each, bad.fault);
        let value = bad.picked.map_or_else(|| bad.value.clone(), Value::Integer);
        let size = if each > 0 { each } else { self.numbers.len() };
        let listed = self.name.sizes.is_some() || each > 0;
        let (is_bytes, encoding) = match self.wire.shape {
            Shape::Text(encoding, _) => (false, Some(encoding)),
            shape => (shape == Shape::Bytes, None),
        };
        let count = Value::Integer(value.length(encoding) as i64);
        let length = format!("len({name})");
        let indexed = format!("{name}[{}]", bad.element.unwrap_or(0) / size.max(1));
        let (argument, value, allowed) = match (bad.element, fault) {
            (None, ValueFault::Count) if listed || is_bytes => (length, count, self.sizes()),
            (Some(_), _) if encoding.is_some() => (indexed, value, self.text(size)),
            (None, _) if encoding.is_some() && each > 0 => (name.clone(), value, text!("texts")),
            (None, _) if encoding.is_some() => (name.clone(), value, self.text(size)),
            (_, ValueFault::Choice) if self.name.counts.is_some() => {
                let counted = self.name.counts.as_deref().unwrap_or_default();
                (format!("len({counted})"), value, self.sizes())
            }
            (_, ValueFault::ElementCount | ValueFault::ElementType) => {
                (indexed, value, self.row(each))
            }
            (None, _) if is_bytes => (name.clone(), value, text!("bytes")),
            (None, _) if each > 0 => (name.clone(), value, text!("list"; sizes = self.sizes())),
            // The elements may all be legal; only their number is wrong.
            (None, ValueFault::Count) => (length, count, self.row(size)),
            (None, _) if self.wire.many => (name.clone(), value, self.row(size)),
            (None, _) => (name.clone(), value, self.allowed(0)),
            (Some(at), _) => (self.element(at), value, self.allowed(at)),
        };
        bad_argument(&argument, &value, &allowed)
    }

    pub(crate) fn named(&self, at: usize) -> Option<&Number> {
        self.name.number(self.case, at)
    }

    /// Return the full name of a number: its field's name, its index in a list, and its own name.
    pub(crate) fn element(&self, at: usize) -> String {
        let field = &self.name.name;
        let number = self.named(at).map_or("", |number| &number.name);
        match (at.checked_div(self.wire.each), number) {
            (None, "") if !self.wire.many => field.clone(),
            (None, "") => format!("{field}[{at}]"),
            (None, _) => format!("{field}.{number}"),
            (Some(index), "") => format!("{field}[{index}]"),
            (Some(index), _) => format!("{field}[{index}].{number}"),
        }
    }

    /// Return how many elements a list may have.
    fn sizes(&self) -> String {
        match self.name.sizes {
            None => (self.numbers.len() / self.wire.each.max(1)).to_string(),
            Some((low, high)) => text!("range"; low, high),
        }
    }

    /// Return which texts are allowed.
    fn text(&self, size: usize) -> String {
        let Shape::Text(encoding, padding) = self.wire.shape else {
            return String::new();
        };
        let encoding = word(encoding);
        match (self.name.sizes, padding) {
            (Some((low, high)), _) if self.wire.each == 0 => {
                text!("text-of-sizes"; encoding, sizes = text!("range"; low, high))
            }
            (_, None) => text!("text"; encoding, size),
            (_, Some(byte)) => text!("padded-text"; encoding, size, padding = hex(&[byte], "")),
        }
    }

    /// Return the words for a sequence of `count` numbers, with their names if all have one.
    fn row(&self, count: usize) -> String {
        let names = (0..count).filter_map(|at| self.named(at));
        let names: Vec<&str> = names.map(|number| &*number.name).collect();
        let all = names.iter().all(|name| !name.is_empty());
        let names = names.join(", ");
        text!(if all { "named-row" } else { "row" }; count, names)
    }

    /// Return the labels of a number's choices, and their raw values.
    pub(crate) fn labels<'a>(
        &'a self,
        number: &'a WireNumber,
        names: &'a Number,
    ) -> (&'a [String], &'a [i64]) {
        match names.labels.is_empty() {
            true => (&self.name.labels, &self.wire.choices),
            false => (&names.labels, &number.choices),
        }
    }

    /// Return the allowed values of a number of the field, in words.
    fn allowed(&self, at: usize) -> String {
        let Some((number, names)) = self.numbers.get(at).zip(self.named(at)) else {
            return String::new();
        };
        let (labels, choices) = self.labels(number, names);
        let mut all = [&self.wire.choices, &number.choices].into_iter();
        let choice = all.find(|all| !all.is_empty());
        if self.wire.flag || number.flag {
            text!("flag")
        } else if !labels.is_empty() {
            let pairs = labels.iter().zip(choices);
            join(pairs.map(|(label, raw)| text!("label"; label, raw)), ", ")
        } else if let Some(choices) = choice {
            join(choices.iter().map(i64::to_string), ", ")
        } else {
            range(number, &names.unit)
        }
    }

    /// Return a status as a person reads it: `NO_POWER (3)`, or `3 (the arm has no power)`.
    pub(crate) fn status(&self, value: WireValue) -> String {
        let shown = Value::nested(&mut once(value));
        let Some(Value::Integer(raw)) = shown else {
            return shown.iter().map(Value::to_string).collect();
        };
        let at = self.wire.choices.iter().position(|choice| *choice == raw);
        if let Some(label) = at.and_then(|at| self.name.labels.get(at)) {
            return text!("label"; label, raw);
        }
        let mut meanings = self.name.meanings.iter();
        match meanings.find(|(low, high, _)| (*low..=*high).contains(&raw)) {
            Some((_, _, meaning)) => {
                let meaning = meaning.replace("{number}", &raw.to_string());
                text!("label"; label = raw, raw = meaning)
            }
            None => raw.to_string(),
        }
    }
}

/// Return the allowed values of a number without choices, in words.
fn range(number: &WireNumber, unit: &str) -> String {
    let natural = number.natural_range();
    let kind = match number.is_float() {
        true if number.maximum > natural.1 => "any-float",
        true if (number.minimum, number.maximum) == natural => "finite",
        float if float || number.scaled() => "real",
        _ => "whole",
    };
    let unit = entry(UNITS, unit).unwrap_or(unit);
    let kind = format!("{kind}{}", if unit.is_empty() { "" } else { "-with-unit" });
    let (low, high) = (bound(number, number.minimum), bound(number, number.maximum));
    text!(&kind; low, high, width = number.width, unit)
}

fn bound(number: &WireNumber, raw: i64) -> String {
    let scaled = i128::from(raw) * i128::from(number.multiply);
    let divide = i128::from(number.divide);
    match number.physical(raw) {
        // The exact value of a float has more digits than the file states; -0.0 is shown as 0.
        WireValue::Real(real) if number.is_float() => {
            general(real + 0.0, if number.width == 4 { 6 } else { 15 })
        }
        WireValue::Real(real) if scaled.checked_rem(divide) != Some(0) => shortest(real),
        WireValue::Real(_) => (scaled / divide).to_string(),
        _ => raw.to_string(),
    }
}

fn word(encoding: Encoding) -> &'static str {
    match encoding {
        Encoding::Ascii => "ASCII",
        Encoding::Utf8 => "UTF-8",
        Encoding::Latin1 => "Latin-1",
    }
}

fn digits(number: u16, wide: bool) -> String {
    format!("{number:0width$X}", width = if wide { 4 } else { 2 })
}

/// Return numbers as text; a run of at least four consecutive ones is shown as a range.
fn runs(numbers: &[u8]) -> String {
    let runs = numbers.chunk_by(|one, next| one.checked_add(1) == Some(*next));
    let shown = runs.map(|run| match run {
        [first, _, _, .., last] => {
            text!("range"; low = hex(&[*first], ""), high = hex(&[*last], ""))
        }
        _ => hex(run, ", "),
    });
    join(shown, ", ")
}
