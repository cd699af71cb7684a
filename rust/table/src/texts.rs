//! The texts of errors: those of the Python package, from the same file of templates.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use alloc::{format, vec};
use core::fmt::Display;

use cobotwire_core::exchange::{
    Failure, Kind, Received, ReplyError, Request, RequestError, TextError, TextFault, TextForm,
    WaitedFor,
};
use cobotwire_core::{
    Algorithm, BadRaw, BadValue, Case, Check, DecodeError, Direction, Encoding, EncodeError, Given,
    Reason, Shape, Value, ValueFault, decode,
};

use crate::shown::{printable, quoted, shortest};
use crate::{Command, Edition, Field, Number, Quote, Shown, general};

// Links to files of the Python package, which a package of this crate contains as files.
const TEMPLATES: &str = include_str!("../error_texts.json");
const UNITS: &str = include_str!("../units.json");

/// Return what a file says of a key. Each entry has its own line, and no escapes.
fn entry(file: &'static str, key: &str) -> Option<&'static str> {
    let found = |line: &'static str| {
        let rest = line.strip_prefix('"')?.strip_prefix(key)?;
        rest.strip_prefix("\": \"")
    };
    let text = file.lines().find_map(found)?;
    text.strip_suffix("\",").or(text.strip_suffix('"'))
}

/// Return the text of a kind, with a value in each of its places.
#[must_use]
pub fn error_text(kind: &str, values: &[(&str, &dyn Display)]) -> String {
    let mut text = String::new();
    for (index, part) in entry(TEMPLATES, kind).unwrap_or(kind).split('{').enumerate() {
        let (place, rest) = part.split_once('}').filter(|_| index > 0).unwrap_or(("", part));
        if let Some((_, value)) = values.iter().find(|(name, _)| *name == place) {
            text += &value.to_string();
        }
        text += rest;
    }
    text
}

macro_rules! text {
    ($kind:expr $(, $place:ident = $value:expr)*) => {
        error_text($kind, &[$((stringify!($place), &$value)),*])
    };
}

/// Return the text of an error of a value of the caller.
#[must_use]
pub fn bad_argument(argument: &str, value: &Shown, allowed: &str) -> String {
    let value = value.short();
    printable(&text!("value", argument = argument, value = value, allowed = allowed))
}

/// Return the text of an error of the transport.
#[must_use]
pub fn link_error(url: &str, detail: &str) -> String {
    printable(&text!("link", url = url, detail = detail))
}

fn protocol_error(detail: &str, offset: usize, data: &[u8]) -> String {
    let data = if data.is_empty() { text!("no-bytes") } else { hex(data, " ") };
    printable(&text!("protocol", detail = detail, offset = offset, data = data))
}

/// A field with its names, in one of its cases.
struct Part<'a> {
    name: &'a Field,
    field: &'a cobotwire_core::Field,
    case: usize,
}

impl Edition {
    /// Return the text of the error of a request that was not encoded. `count`, `texts` and
    /// `address` are what the caller gave.
    pub fn request_error<V: Given<Error: Display> + Quote>(
        &self,
        command: usize,
        error: &RequestError<EncodeError<V>>,
        (count, texts, address): (usize, &[&str], Option<u8>),
    ) -> String {
        let record = self.commands.get(command);
        let called = record.map_or("", |command| &command.name);
        let known = self.addresses.iter().find(|known| Some(known.value) == address);
        let name = match (known, address) {
            (Some(known), _) => known.name.clone(),
            (None, address) => address.unwrap_or_default().to_string(),
        };
        printable(&match error {
            RequestError::Values(error) => {
                return self.encode_error((command, Direction::Request), error, count, address);
            }
            RequestError::Command => text!("no-command", name = command, edition = self.name),
            RequestError::Address => return self.no_address(address),
            RequestError::Unanswered => text!("unanswered", command = called, name = name),
            RequestError::LacksJoints => {
                let joints = known.map_or(0, |known| known.joints);
                let kind = if joints == 1 { "lacks-joints-but-one" } else { "lacks-joints" };
                let why = text!(kind, count = self.joints, name = name, joints = joints);
                format!("{called}() {why}")
            }
            RequestError::Text(fault) => {
                let facts = self.protocol.facts.get(command);
                let form = facts.and_then(|facts| facts.request_text.as_ref());
                return form.map_or(String::new(), |form| bad_text(form, *fault, texts));
            }
        })
    }

    /// Return the text of the error that an edition has no such address.
    #[must_use]
    pub fn no_address(&self, given: Option<u8>) -> String {
        let addresses = &self.protocol.table.frame().addresses;
        if addresses.is_empty() {
            return text!("no-addresses", edition = self.name);
        }
        let allowed = addresses.iter().map(|value| {
            let known = self.addresses.iter().find(|known| known.value == *value);
            let name = known.map_or(value.to_string(), |known| known.name.clone());
            text!("label", label = name, raw = value)
        });
        let allowed = allowed.collect::<Vec<_>>().join(", ");
        bad_argument("address", &Shown::of(given), &allowed)
    }

    /// Return the text of the error of values that were not encoded; `count` is their number.
    pub fn encode_error<V: Given<Error: Display> + Quote>(
        &self,
        (command, direction): (usize, Direction),
        error: &EncodeError<V>,
        count: usize,
        address: Option<u8>,
    ) -> String {
        match error {
            EncodeError::Address => {
                let runs = runs(&self.protocol.table.frame().addresses, |byte| byte.to_string());
                let none = runs.is_empty();
                let allowed = if none { text!("no-address") } else { runs };
                bad_argument("address", &Shown::of(address), &allowed)
            }
            EncodeError::VariantId => self.bad_variant(command, direction, count),
            EncodeError::Value(bad) => {
                let place = (command, direction, bad.variant);
                let part = self.part(place, bad.field, bad.case);
                part.map_or(String::new(), |part| part.bad_value(bad))
            }
            EncodeError::Foreign(error) => printable(&error.to_string()),
        }
    }

    /// Return the text of the error of bytes that were not decoded.
    #[must_use]
    pub fn decode_error(&self, direction: Direction, error: DecodeError, data: &[u8]) -> String {
        match error {
            DecodeError::Frame { reason, offset } => {
                protocol_error(&self.bad_frame(direction, reason, data), offset, data)
            }
            DecodeError::Raw(bad) => {
                protocol_error(&self.bad_raw(&bad).unwrap_or_default(), bad.offset, data)
            }
        }
    }

    /// Return the text of the error that ended a request; `None`: that of the transport did, which
    /// has a text of its own.
    #[must_use]
    pub fn failure(&self, request: &Request, failure: &Failure) -> Option<String> {
        let call = self.as_call(request);
        Some(match failure {
            Failure::Link => return None,
            Failure::Timeout { waited, attempts, waited_for, received } => {
                let received: Vec<String> = received.iter().map(|each| self.line(each)).collect();
                printable(&timeout(&call, (*waited, *attempts), *waited_for, &received))
            }
            Failure::Reply { error: ReplyError::Frame(error), data } => {
                self.decode_error(Direction::Reply, *error, data)
            }
            Failure::Reply { error: ReplyError::Text(error), data } => {
                let facts = self.protocol.facts.get(request.command)?;
                received_text(facts.text.as_ref()?, *error, data)
            }
            Failure::Refused { variant, field, value } => {
                let place = (variant.command, variant.direction, variant.variant);
                let part = self.part(place, *field, 0)?;
                let (status, field) = (part.status(*value), &part.name.name);
                let detail = text!("refused", request = call, field = field, status = status);
                protocol_error(&detail, 0, &request.frame)
            }
        })
    }

    /// Return a request as a person writes it: `get_encoder(joint=1)`, `stop() to LEFT`.
    #[must_use]
    pub fn as_call(&self, request: &Request) -> String {
        let Some(command) = self.commands.get(request.command) else {
            return String::new();
        };
        let frame = (&self.protocol.table, Direction::Request, &request.frame);
        let Ok(decoded) = decode(frame.0, frame.1, frame.2, Some(request.command)) else {
            return command.name.clone();
        };
        let (mut arguments, mut values) = (Vec::new(), decoded.values.as_slice());
        for field in command.request.get(decoded.variant.variant).into_iter().flatten() {
            let Some((value, size)) = Shown::decoded(values) else { break };
            values = values.get(size..).unwrap_or_default();
            arguments.push(format!("{}={}", field.name, value.plain()));
        }
        let call = format!("{}({})", command.name, arguments.join(", "));
        let Some(address) = decoded.address else { return call };
        let known = self.addresses.iter().find(|known| known.value == address);
        let name = known.map_or(address.to_string(), |known| known.name.clone());
        format!("{call} to {name}")
    }

    /// Return the line of something that was received while a reply was waited for.
    fn line(&self, received: &Received) -> String {
        let shown = hex(&received.shown, " ");
        let cut = received.size > received.shown.len();
        let data = if cut { text!("cut-data", data = shown, size = received.size) } else { shown };
        let of = |kind, command: usize| {
            let name = self.commands.get(command).map_or("", |command| &command.name);
            text!(kind, command = name, data = data)
        };
        match received.kind {
            Kind::Noise(reason) => text!("noise", reason = reason.word(), data = data),
            Kind::Late { command } => of("late-reply", command),
            Kind::DeviceEvent { command } => of("event", command),
            Kind::Ack { command, perhaps_earlier: true } => of("doubtful-ack", command),
            Kind::Ack { command, .. } => of("ack", command),
            Kind::Echo => text!("echo", data = data),
            Kind::Unexpected => text!("frame", data = data),
            Kind::Unread => text!("too-much"),
        }
    }

    fn part(
        &self,
        (command, direction, variant): (usize, Direction, usize),
        field: usize,
        case: usize,
    ) -> Option<Part<'_>> {
        let core = self.protocol.table.commands().get(command)?.variants(direction);
        let names = self.commands.get(command)?.variants(direction);
        let (name, core) = (names.get(variant)?.get(field)?, core.get(variant)?.fields());
        let field = core.get(field)?;
        Some(Part { name, field, case })
    }

    fn bad_variant(&self, command: usize, direction: Direction, count: usize) -> String {
        let Some(record) = self.commands.get(command) else {
            return text!("no-command", name = command, edition = self.name);
        };
        let (direction, variants) = (word(direction), record.variants(direction));
        if variants.is_empty() {
            return text!("no-message", command = record.name, direction = direction);
        }
        let legal = variants.iter().map(|fields| {
            let names: Vec<&str> = fields.iter().map(|field| &*field.name).collect();
            format!("({})", names.join(", "))
        });
        let allowed = either(legal);
        let message = format!("{} {direction}", record.name);
        let kind = if count == 1 { "value-count" } else { "values-count" };
        printable(&text!(kind, count = count, message = message, allowed = allowed))
    }

    fn bad_raw(&self, bad: &BadRaw) -> Option<String> {
        let (id, at) = (bad.variant, bad.element);
        let part = self.part((id.command, id.direction, id.variant), bad.field, bad.case)?;
        let (command, name) = (&self.commands.get(id.command)?.name, &part.name.name);
        if let Shape::Text(encoding, _) = part.field.shape {
            let (raw, encoding) = (format!("{:02X}", bad.raw), words(encoding).1);
            let (name, command) = (name.as_str(), command.as_str());
            return Some(text!("bad-byte", command = command, at = at, name = name, raw = raw, encoding = encoding));
        }
        let number = part.number(at)?.0;
        let whole = part.field.each == 0 && number.bits.is_none();
        let name = if whole { name.clone() } else { part.element(at) };
        let value = Shown::physical(number.physical(bad.raw));
        let allowed = part.allowed(at);
        Some(text!("bad-value", command = command, name = name, value = value, allowed = allowed))
    }

    fn bad_frame(&self, direction: Direction, reason: Reason, data: &[u8]) -> String {
        let frame = self.protocol.table.frame();
        let layout = frame.layout;
        let length = digits(layout.length.read(data).unwrap_or_default(), layout.length.wide);
        match reason {
            Reason::NoHeader => text!("no-header", header = hex(&frame.header, " ")),
            Reason::BadAddress => {
                let at = layout.address_at.and_then(|at| data.get(at)).copied();
                let allowed = runs(&frame.addresses, |byte| format!("{byte:02X}"));
                let address = digits(at.unwrap_or_default().into(), false);
                text!("bad-address", address = address, allowed = allowed)
            }
            Reason::Truncated => match layout.length.read(data) {
                None => text!("no-len"),
                Some(counted) => {
                    let size = usize::from(counted) + layout.overhead;
                    let missing = size.saturating_sub(data.len());
                    let kind = if missing == 1 { "truncated-by-one" } else { "truncated" };
                    text!(kind, length = length, missing = missing)
                }
            },
            Reason::BadLength => self.bad_length(direction, &length, data),
            Reason::UnknownId => {
                let id = digits(layout.id.read(data).unwrap_or_default(), layout.id.wide);
                let direction = word(direction);
                text!("unknown-id", edition = self.name, direction = direction, id = id)
            }
            Reason::BadCheck => match &frame.check {
                Check::Footer(footer) => text!("no-footer", footer = hex(&[*footer], "")),
                Check::Computed(check) => match check.algorithm {
                    None => text!("no-footer", footer = hex(&check.footer, "")),
                    Some(Algorithm::Crc(_)) => text!("bad-crc"),
                    Some(Algorithm::Sum) => text!("bad-sum"),
                    Some(_) => text!("bad-check"),
                },
            },
            Reason::Trailing => text!("trailing", length = length),
        }
    }

    fn bad_length(&self, direction: Direction, length: &str, data: &[u8]) -> String {
        let frame = self.protocol.table.frame();
        let (layout, has_id) = (frame.layout, frame.has_id(direction));
        // LEN may follow the id.
        let come = layout.length.read(data).and(layout.id.read(data));
        let commands = self.protocol.table.commands().iter().zip(&self.commands);
        let of_id = commands.filter(|(core, _)| come.is_some() && (!has_id || Some(core.id) == come));
        let of_id = of_id.filter(|(core, _)| !core.variants(direction).is_empty());
        let (mut legal, mut names) = (vec![], vec![]);
        for (core, named) in of_id {
            let variants = core.variants(direction).iter();
            legal.extend(variants.map(|variant| frame.length(variant.size(), direction)));
            names.push(named.name.clone());
        }
        legal.sort_unstable();
        legal.dedup();
        let word = word(direction);
        if legal.is_empty() {
            return text!("no-length", direction = word, edition = self.name, length = length);
        }
        let message = match come {
            // Commands that share an id are all named: the frame does not tell which was called.
            Some(id) if has_id => {
                let id = digits(id, layout.id.wide);
                text!("identified", direction = word, id = id, names = either(names.into_iter()))
            }
            _ => word.into(),
        };
        let wide = layout.length.wide;
        let sizes = legal.into_iter().map(|size| digits(size as u16, wide));
        text!("bad-length", message = message, length = length, allowed = either(sizes))
    }
}

impl Command {
    fn variants(&self, direction: Direction) -> &[Vec<Field>] {
        match direction {
            Direction::Request => &self.request,
            Direction::Reply => &self.reply,
        }
    }
}

impl Part<'_> {
    fn numbers(&self) -> &[cobotwire_core::Number] {
        self.field.cases.get(self.case).map_or(&[], |Case { numbers, .. }| numbers)
    }

    fn number(&self, at: usize) -> Option<(&cobotwire_core::Number, &Number)> {
        let names = self.name.cases.get(self.case)?;
        self.numbers().get(at).zip(names.get(at))
    }

    fn bad_value<V: Quote>(&self, bad: &BadValue<V>) -> String {
        let (name, each) = (&self.name.name, self.field.each);
        let value = bad.picked.map_or_else(|| bad.value.quote(), Shown::Integer);
        let size = if each > 0 { each } else { self.numbers().len() };
        let listed = self.name.sizes.is_some() || each > 0 || self.field.shape == Shape::Bytes;
        let encoding = match self.field.shape {
            Shape::Text(encoding, _) => Some(encoding),
            _ => None,
        };
        let length = |allowed: &str| {
            let count = Shown::of(Some(value.count(encoding)));
            bad_argument(&format!("len({name})"), &count, allowed)
        };
        let indexed = |at: usize| format!("{name}[{}]", at / size.max(1));
        match (bad.element, bad.fault) {
            (None, ValueFault::Count) if encoding.is_some() && listed => length(&self.sizes()),
            (Some(at), _) if encoding.is_some() => {
                bad_argument(&indexed(at), &value, &self.text(size))
            }
            (None, _) if encoding.is_some() => {
                let texts = if each > 0 { text!("texts") } else { self.text(size) };
                bad_argument(name, &value, &texts)
            }
            (_, ValueFault::Choice) if self.name.counts.is_some() => {
                let counted = self.name.counts.as_deref().unwrap_or_default();
                bad_argument(&format!("len({counted})"), &value, &self.sizes())
            }
            (_, ValueFault::Count) if listed => length(&self.sizes()),
            (at, ValueFault::ElementCount) => {
                let row = value.into_tuple();
                bad_argument(&indexed(at.unwrap_or_default()), &row, &self.row(each))
            }
            (at, ValueFault::ElementType) => {
                bad_argument(&indexed(at.unwrap_or_default()), &value, &self.row(each))
            }
            (None, _) if self.field.shape == Shape::Bytes => {
                bad_argument(name, &value, &text!("bytes"))
            }
            (None, _) if each > 0 => {
                bad_argument(name, &value, &text!("list", sizes = self.sizes()))
            }
            // The elements may all be legal; only their number is wrong.
            (None, ValueFault::Count) => length(&self.row(size)),
            (None, _) if self.field.many => bad_argument(name, &value, &self.row(size)),
            (None, _) => bad_argument(name, &value, &self.allowed(0)),
            (Some(at), _) => bad_argument(&self.element(at), &value, &self.allowed(at)),
        }
    }

    /// Return the name of a number of the field.
    fn element(&self, at: usize) -> String {
        let (field, each) = (&self.name.name, self.field.each);
        let number = self.number(at).map_or("", |(_, number)| &number.name);
        match at.checked_div(each) {
            _ if !self.field.many => field.clone(),
            Some(index) => format!("{field}[{index}].{number}"),
            None if number.is_empty() => format!("{field}[{at}]"),
            None => format!("{field}.{number}"),
        }
    }

    /// Return how many elements a list may have.
    fn sizes(&self) -> String {
        match self.name.sizes {
            None => (self.numbers().len() / self.field.each.max(1)).to_string(),
            Some((least, most)) if least < most => text!("range", low = least, high = most),
            Some((_, most)) => most.to_string(),
        }
    }

    /// Return what a text may be.
    fn text(&self, size: usize) -> String {
        let Shape::Text(encoding, padding) = self.field.shape else {
            return String::new();
        };
        let encoding = words(encoding).0;
        match padding {
            _ if self.name.sizes.is_some() && self.field.each == 0 => {
                let (low, high) = self.name.sizes.unwrap_or_default();
                let sizes = text!("range", low = low, high = high);
                text!("text-of-sizes", encoding = encoding, sizes = sizes)
            }
            None => text!("text", encoding = encoding, size = size),
            Some(byte) => {
                let padding = hex(&[byte], "");
                text!("padded-text", encoding = encoding, size = size, padding = padding)
            }
        }
    }

    /// Return what a row of the first numbers is.
    fn row(&self, count: usize) -> String {
        let names = self.name.cases.get(self.case).into_iter().flatten().take(count);
        let names: Vec<&str> = names.map(|number| &*number.name).collect();
        let named = names.iter().all(|name| !name.is_empty());
        let kind = if named { "named-row" } else { "row" };
        text!(kind, count = count, names = names.join(", "))
    }

    /// Return what a number of the field may be.
    fn allowed(&self, at: usize) -> String {
        let Some((number, names)) = self.number(at) else {
            return String::new();
        };
        if self.field.flag || number.flag {
            return text!("flag");
        }
        let (labels, choices) = match names.labels.as_slice() {
            [] => (&self.name.labels, &self.field.choices),
            _ => (&names.labels, &number.choices),
        };
        if !labels.is_empty() {
            let pairs = labels.iter().zip(choices);
            let all = pairs.map(|(label, raw)| text!("label", label = label, raw = raw));
            return all.collect::<Vec<_>>().join(", ");
        }
        let own = [&self.field.choices, &number.choices];
        if let Some(choices) = own.into_iter().find(|choices| !choices.is_empty()) {
            let all: Vec<String> = choices.iter().map(i64::to_string).collect();
            return all.join(", ");
        }
        let infinity = if number.width == 4 { 0x7F80_0000 } else { 0x7FF0_0000_0000_0000 };
        let kind = match number.float {
            true if number.maximum >= infinity => "any-float",
            true if (number.minimum, number.maximum) == (-infinity, infinity - 1) => "finite",
            _ if number.float || number.scaled() => "real",
            _ => "whole",
        };
        let unit = entry(UNITS, &names.unit).unwrap_or(&names.unit);
        let kind = if unit.is_empty() { kind.into() } else { format!("{kind}-with-unit") };
        let (low, high) = (bound(number, number.minimum), bound(number, number.maximum));
        text!(&kind, low = low, high = high, width = number.width, unit = unit)
    }

    /// Return a status as a person reads it: `NO_POWER (3)`, or `3 (the arm has no power)`.
    fn status(&self, value: Value) -> String {
        let Value::Integer(raw) = value else {
            return Shown::physical(value).to_string();
        };
        let at = self.field.choices.iter().position(|choice| *choice == raw);
        if let Some(label) = at.and_then(|at| self.name.labels.get(at)) {
            return text!("label", label = label, raw = raw);
        }
        let mut meanings = self.name.meanings.iter();
        let meaning = meanings.find(|(low, high, _)| (*low..=*high).contains(&raw));
        match meaning.map(|(_, _, text)| text.replace("{number}", &raw.to_string())) {
            Some(meaning) => text!("label", label = raw, raw = meaning),
            None => raw.to_string(),
        }
    }
}

fn bound(number: &cobotwire_core::Number, raw: i64) -> String {
    match number.physical(raw) {
        // The nearest float to a decimal has more digits than anyone wrote; -0.0 is written as 0.
        Value::Real(real) if number.float => {
            general(real + 0.0, if number.width == 4 { 6 } else { 15 })
        }
        Value::Real(real) => {
            let scaled = i128::from(raw) * i128::from(number.multiply);
            match (scaled.checked_rem(number.divide.into()), number.divide) {
                (Some(0), divide) => (scaled / i128::from(divide)).to_string(),
                _ => shortest(real),
            }
        }
        _ => raw.to_string(),
    }
}

/// Return the text of a request without an answer.
fn timeout(
    call: &str,
    (waited, attempts): (u64, usize),
    waited_for: Option<WaitedFor>,
    received: &[String],
) -> String {
    let sent = if attempts > 0 { "no-reply" } else { "not-sent" };
    let late = if waited_for.is_some() { "-by-deadline" } else { "" };
    let meanwhile = match waited_for {
        None => "nothing",
        Some(WaitedFor::Turn) => "turn",
        Some(WaitedFor::Hold) => "hold",
        Some(WaitedFor::Line) => "line",
        Some(WaitedFor::Reply) => "reply",
    };
    let what = text!(
        &format!("{sent}{late}"),
        request = call,
        waited = format!("{:.3}", waited as f64 / 1e9),
        attempts = text!(if attempts == 1 { "attempt" } else { "attempts" }, count = attempts),
        meanwhile = text!(meanwhile)
    );
    if waited_for.is_some() && attempts == 0 {
        return what;
    }
    let none = received.is_empty();
    let received = if none { text!("nothing") } else { received.join("; ") };
    text!("meanwhile", what = what, received = received)
}

/// Return the text of the error of a text that was received.
fn received_text(form: &TextForm, error: TextError, data: &[u8]) -> String {
    let prefix = |index: usize| quoted(form.prefixes.get(index).map_or("", |prefix| prefix));
    let (detail, offset) = match error {
        TextError::NotAscii { offset } => (text!("text-not-ascii"), offset),
        TextError::Start => (text!("text-start", prefix = prefix(0)), 0),
        TextError::End => (text!("text-end", suffix = quoted(&form.suffix)), data.len()),
        TextError::Prefix { index, times, offset } => {
            (text!("text-prefix", prefix = prefix(index), count = times), offset)
        }
        TextError::TooLong => (text!("text-length", most = 4096), 4096),
    };
    protocol_error(&detail, offset, data)
}

/// Return the text of the error of texts that cannot be sent.
fn bad_text(form: &TextForm, fault: TextFault, given: &[&str]) -> String {
    let text = |index: usize| Shown::Text((*given.get(index).unwrap_or(&"")).into());
    match fault {
        TextFault::NotPrintable(index) => {
            let name = form.fields.get(index).map_or("", |name| name);
            bad_argument(name, &text(index), &text!("printable"))
        }
        TextFault::Ambiguous => {
            let words = form.prefixes.iter().skip(1).chain([&form.suffix]);
            let words = either(words.filter(|word| !word.is_empty()).map(|word| quoted(word)));
            let given = Shown::Tuple((0..form.fields.len()).map(text).collect());
            bad_argument(&form.fields.join(", "), &given, &text!("unambiguous", words = words))
        }
    }
}

fn either(words: impl Iterator<Item = String>) -> String {
    words.collect::<Vec<_>>().join(&text!("or"))
}

fn word(direction: Direction) -> &'static str {
    match direction {
        Direction::Request => "request",
        Direction::Reply => "reply",
    }
}

/// Return the name of an encoding in a sentence, and in the table.
fn words(encoding: Encoding) -> (&'static str, &'static str) {
    match encoding {
        Encoding::Ascii => ("ASCII", "ascii"),
        Encoding::Utf8 => ("UTF-8", "utf-8"),
        Encoding::Latin1 => ("Latin-1", "latin-1"),
    }
}

fn hex(bytes: &[u8], between: &str) -> String {
    let pairs: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    pairs.join(between)
}

fn digits(number: u16, wide: bool) -> String {
    let width = if wide { 4 } else { 2 };
    format!("{number:0width$X}")
}

/// Return runs of consecutive numbers as their ends; short runs stay apart.
fn runs(numbers: &[u8], digits: impl Fn(u8) -> String) -> String {
    let mut found = Vec::new();
    let follows = |one: &u8, next: &u8| one.checked_add(1) == Some(*next);
    for run in numbers.chunk_by(follows) {
        match run {
            [first, _, _, .., last] => {
                found.push(text!("range", low = digits(*first), high = digits(*last)));
            }
            _ => found.extend(run.iter().map(|number| digits(*number))),
        }
    }
    found.join(", ")
}
