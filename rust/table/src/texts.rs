//! The texts of errors: those of the Python package, from the same file of templates.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Display;

use cobotwire_core::exchange::{
    Failure, Kind, Received, ReplyError, Request, RequestError, TextError, TextFault, TextForm,
    WaitedFor,
};
use cobotwire_core::{Decoded, Direction, EncodeError, Given, decode};

use crate::rejection::variants;
use crate::shown::{is_printable, join, printable, quoted};
use crate::{Edition, Quote, Shown};

// A link to a file of the Python package; a package of this crate contains the file.
const TEMPLATES: &str = include_str!("../error_texts.json");

/// Return what a file says of a key. Each entry has its own line, and no escapes.
pub(crate) fn entry(file: &'static str, key: &str) -> Option<&'static str> {
    let text = file.lines().find_map(|line| {
        let rest = line.strip_prefix('"')?.strip_prefix(key)?;
        rest.strip_prefix("\": \"")
    })?;
    text.strip_suffix("\",").or(text.strip_suffix('"'))
}

/// Return the text of a kind, with a value in each of its places.
#[must_use]
pub fn error_text(kind: &str, values: &[(&str, &dyn Display)]) -> String {
    let mut parts = entry(TEMPLATES, kind).unwrap_or(kind).split('{');
    let mut text = String::from(parts.next().unwrap_or_default());
    for (place, rest) in parts.filter_map(|part| part.split_once('}')) {
        if let Some((_, value)) = values.iter().find(|(name, _)| *name == place) {
            text += &value.to_string();
        }
        text += rest;
    }
    text
}

/// `text!(kind; place, place = value)`: a text with the variables of these names, or these values.
macro_rules! text {
    (@ $place:ident) => { $place };
    (@ $place:ident $value:expr) => { $value };
    ($kind:expr $(; $($place:ident $(= $value:expr)?),*)?) => {
        $crate::texts::error_text(
            $kind,
            &[$($((stringify!($place), &$crate::texts::text!(@ $place $($value)?))),*)?],
        )
    };
}
pub(crate) use text;

/// Return the text of an error of a value of the caller.
#[must_use]
pub fn bad_argument(argument: &str, value: &Shown, allowed: &str) -> String {
    let value = value.short();
    printable(&text!("value"; argument, value, allowed))
}

/// Return the text of an error of the transport.
#[must_use]
pub fn link_error(url: &str, detail: &str) -> String {
    printable(&text!("link"; url, detail))
}

pub(crate) fn protocol_error(detail: &str, offset: usize, data: &[u8]) -> String {
    let data = if data.is_empty() {
        text!("no-bytes")
    } else {
        hex(data, " ")
    };
    printable(&text!("protocol"; detail, offset, data))
}

impl Edition {
    /// Return the text of the error of a request that was not encoded. `count`, `texts` and
    /// `address` are what the caller gave.
    pub fn request_error<V: Given + Quote>(
        &self,
        command: usize,
        error: &RequestError<EncodeError<V>>,
        (count, texts, address): (usize, &[&str], Option<u8>),
    ) -> String {
        let record = self.commands.get(command);
        let command_name = record.map_or("", |command| &command.name);
        let known = self
            .addresses
            .iter()
            .find(|known| Some(known.value) == address);
        let name = self.address_name(address.unwrap_or_default());
        let text = match error {
            RequestError::Values(error) => {
                return self.encode_error((command, Direction::Request), error, count, address);
            }
            RequestError::Command => String::new(),
            RequestError::Address => return self.no_raw_address(address),
            RequestError::Unanswered => text!("unanswered"; command = command_name, name),
            RequestError::LacksJoints => {
                let joints = known.map_or(0, |known| known.joints);
                let kind = if joints == 1 {
                    "lacks-joints-but-one"
                } else {
                    "lacks-joints"
                };
                format!(
                    "{command_name}() {}",
                    text!(kind; count = self.joints, name, joints)
                )
            }
            RequestError::Text(fault) => {
                let facts = self.protocol.facts.get(command);
                let form = facts.and_then(|facts| facts.request_text.as_ref());
                form.map_or(String::new(), |form| unsent_text(form, *fault, texts))
            }
        };
        printable(&text)
    }

    /// Return the text of the error that an edition has no such address.
    #[must_use]
    pub fn no_address(&self, given: &Shown) -> String {
        let addresses = self.protocol.table.frame().addresses.iter();
        let allowed = addresses.map(|raw| text!("label"; label = self.address_name(*raw), raw));
        match join(allowed, ", ") {
            none if none.is_empty() => text!("no-addresses"; edition = self.name),
            allowed => bad_argument("address", given, &allowed),
        }
    }

    /// The same for a number.
    pub(crate) fn no_raw_address(&self, given: Option<u8>) -> String {
        self.no_address(&Shown::Integer(given.unwrap_or(0).into()))
    }

    /// Return the name of an address; its number, if it has none.
    #[must_use]
    pub fn address_name(&self, value: u8) -> String {
        let known = self.addresses.iter().find(|known| known.value == value);
        known.map_or(value.to_string(), |known| known.name.clone())
    }

    /// Return the fields of a message as texts show them.
    #[must_use]
    pub fn fields(&self, message: &Decoded) -> String {
        let shown = self.named(message).into_iter().map(|(name, value)| {
            let value = match value {
                Shown::Text(text) => text,
                value => value.to_string(),
            };
            format!("{name}={value}")
        });
        join(shown, ", ")
    }

    /// Return the fields of a message with their names.
    #[must_use]
    pub fn named(&self, message: &Decoded) -> Vec<(&str, Shown)> {
        let id = message.variant;
        let command = self.commands.get(id.command);
        let variants = command.map(|command| variants(command, id.direction));
        let fields = variants.and_then(|variants| variants.get(id.variant));
        let mut values = message.values.iter().copied();
        let named = fields
            .into_iter()
            .flatten()
            .map_while(|field| Some((&*field.name, Shown::nested(&mut values)?)));
        named.collect()
    }

    /// Return a message as a person writes it: `get_encoder(joint=1)`, `stop() to LEFT`.
    #[must_use]
    pub fn message(&self, message: &Decoded) -> String {
        let command = self.commands.get(message.variant.command);
        let name = command.map_or("", |command| &command.name);
        let to = message
            .address
            .map(|address| format!(" to {}", self.address_name(address)));
        format!("{name}({}){}", self.fields(message), to.unwrap_or_default())
    }

    /// Return the text of the error that ended a request. `None`: that of the transport did, which
    /// has a text of its own.
    #[must_use]
    pub fn failure(&self, request: &Request, failure: &Failure) -> Option<String> {
        let (table, command) = (&self.protocol.table, request.command);
        let own = decode(table, Direction::Request, &request.frame, Some(command));
        let call = &own.map_or_else(|_| String::new(), |own| self.message(&own));
        Some(match failure {
            Failure::Link => return None,
            Failure::Timeout {
                waited,
                attempts,
                waited_for,
                received,
            } => {
                let lines = join(received.iter().map(|each| self.line(each)), "; ");
                printable(&timeout(call, (*waited, *attempts), *waited_for, lines))
            }
            Failure::Reply {
                error: ReplyError::Frame(error),
                data,
            } => self.decode_error(Direction::Reply, *error, data),
            Failure::Reply {
                error: ReplyError::Text(error),
                data,
            } => {
                let facts = self.protocol.facts.get(request.command)?;
                received_text(facts.text.as_ref()?, *error, data)
            }
            Failure::Refused {
                variant,
                field,
                value,
            } => {
                let part = self.part(*variant, *field, 0)?;
                let (field, status) = (&part.name.name, part.status(*value));
                let detail = text!("refused"; request = call, field, status);
                protocol_error(&detail, 0, &request.frame)
            }
        })
    }

    /// Return the line of something that was received while a reply was waited for.
    fn line(&self, received: &Received) -> String {
        let (data, size) = (hex(&received.shown, " "), received.size);
        let cut = size > received.shown.len();
        let data = if cut {
            text!("cut-data"; data, size)
        } else {
            data
        };
        let (kind, command) = match received.kind {
            Kind::Noise(reason) => return text!("noise"; reason = reason.word(), data),
            Kind::Late { command } => ("late-reply", command),
            Kind::DeviceEvent { command } => ("event", command),
            Kind::Ack {
                command,
                perhaps_earlier: true,
            } => ("doubtful-ack", command),
            Kind::Ack { command, .. } => ("ack", command),
            Kind::Echo => ("echo", 0),
            Kind::Unexpected => ("frame", 0),
            Kind::Unread => ("too-much", 0),
        };
        let command = self
            .commands
            .get(command)
            .map_or("", |command| &command.name);
        text!(kind; command, data)
    }
}

/// Return the text of a request without an answer.
fn timeout(
    request: &str,
    (waited, attempts): (u64, usize),
    waited_for: Option<WaitedFor>,
    received: String,
) -> String {
    let meanwhile = match waited_for {
        None => "nothing",
        Some(WaitedFor::Turn) => "turn",
        Some(WaitedFor::Hold) => "hold",
        Some(WaitedFor::Line) => "line",
        Some(WaitedFor::Reply) => "reply",
    };
    let kind = match (attempts, waited_for) {
        (0, None) => "not-sent",
        (0, _) => "not-sent-by-deadline",
        (_, None) => "no-reply",
        (_, _) => "no-reply-by-deadline",
    };
    let waited = format!("{:.3}", waited as f64 / 1e9);
    let times = text!(if attempts == 1 { "attempt" } else { "attempts" }; count = attempts);
    let what = text!(kind; request, waited, attempts = times, meanwhile = text!(meanwhile));
    if kind == "not-sent-by-deadline" {
        return what;
    }
    let received = if received.is_empty() {
        text!("nothing")
    } else {
        received
    };
    text!("meanwhile"; what, received)
}

/// Return the text of the error of a text that was received.
fn received_text(form: &TextForm, error: TextError, data: &[u8]) -> String {
    let prefix = |index: usize| form.prefixes.get(index).map_or("", |prefix| prefix);
    let prefix = |index: usize| quoted(prefix(index), is_printable);
    let (detail, offset) = match error {
        TextError::NotAscii { offset } => (text!("text-not-ascii"), offset),
        TextError::Start => (text!("text-start"; prefix = prefix(0)), 0),
        TextError::End => {
            let suffix = quoted(&form.suffix, is_printable);
            (text!("text-end"; suffix), data.len())
        }
        TextError::Prefix {
            index,
            times,
            offset,
        } => (
            text!("text-prefix"; prefix = prefix(index), count = times),
            offset,
        ),
        TextError::TooLong => (text!("text-length"; most = 4096), 4096),
    };
    protocol_error(&detail, offset, data)
}

/// Return the text of the error of texts that cannot be sent.
fn unsent_text(form: &TextForm, fault: TextFault, given: &[&str]) -> String {
    let text = |index: usize| Shown::Text((*given.get(index).unwrap_or(&"")).into());
    match fault {
        TextFault::NotPrintable(index) => {
            let name = form.fields.get(index).map_or("", |name| name);
            bad_argument(name, &text(index), &text!("printable"))
        }
        TextFault::Ambiguous => {
            let words = form.prefixes.iter().skip(1).chain([&form.suffix]);
            let words = words.filter(|word| !word.is_empty());
            let words = either(words.map(|word| quoted(word, is_printable)));
            let given = Shown::Tuple((0..form.fields.len()).map(text).collect());
            bad_argument(
                &form.fields.join(", "),
                &given,
                &text!("unambiguous"; words),
            )
        }
    }
}

pub(crate) fn either(words: impl Iterator<Item = String>) -> String {
    join(words, &text!("or"))
}

pub(crate) fn hex(bytes: &[u8], between: &str) -> String {
    join(bytes.iter().map(|byte| format!("{byte:02X}")), between)
}
