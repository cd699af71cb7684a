//! The texts of errors, made as in the Python package from the same file of templates.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt::Display;

use cobotwire_core::exchange::{
    Event, Failure, Received, ReplyError, Request, RequestError, TextError, TextFault, TextForm,
    TextMistake, WaitedFor,
};
use cobotwire_core::{Decoded, Direction, EncodeError, decode};

use crate::value::{is_printable, join, printable, quoted};
use crate::{Edition, Field, Value};

// Here a symbolic link to a file of the Python package; a published crate contains the file.
const TEMPLATES: &str = include_str!("../error_texts.json");
/// An error shows at most this many characters of a value.
const MOST: usize = 80;
/// An error shows at most this many bytes of what was received meanwhile.
const SHOWN: usize = 24;

/// Return the text of a key in a file. Each entry is on a line of its own, without escapes.
pub(crate) fn entry(file: &'static str, key: &str) -> Option<&'static str> {
    let text = file.lines().find_map(|line| {
        let rest = line.strip_prefix('"')?.strip_prefix(key)?;
        rest.strip_prefix("\": \"")
    })?;
    text.strip_suffix("\",").or(text.strip_suffix('"'))
}

/// Return the text of a kind, with a value for each of its placeholders.
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

/// `text!(kind; name, name = value)`: a text whose placeholders have these values; `name` alone
/// stands for the variable of that name.
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

/// Return the error text for a caller's value that is not allowed.
#[must_use]
pub fn bad_argument(argument: &str, value: &Value, allowed: &str) -> String {
    let mut value = value.to_string();
    if value.chars().nth(MOST).is_some() {
        value = value.chars().take(MOST - 3).chain("...".chars()).collect();
    }
    printable(&text!("value"; argument, value, allowed))
}

/// Return the text of an error of the transport.
#[must_use]
pub fn link_error(url: &str, detail: &str) -> String {
    printable(&text!("link"; url, detail))
}

pub(crate) fn protocol_error(detail: &str, offset: usize, data: &[u8]) -> String {
    let data = match data {
        [] => text!("no-bytes"),
        data => hex(data, " "),
    };
    printable(&text!("protocol"; detail, offset, data))
}

/// Return the first word if the count is 1, or else the second.
pub(crate) fn one_or(count: usize, one: &'static str, other: &'static str) -> &'static str {
    if count == 1 { one } else { other }
}

impl Edition {
    /// Return the text of the error of a request that was not encoded. `count`, `texts` and
    /// `address` are what the caller gave.
    pub fn request_error(
        &self,
        command: usize,
        error: &RequestError<EncodeError<Value>>,
        (count, texts, address): (usize, &[&str], Option<u8>),
    ) -> String {
        let (name, protocol) = (self.command_name(command), &self.protocol);
        let to = self.address_name(address.unwrap_or_default());
        let text = match error {
            RequestError::Values(error) => {
                return self.encode_error((command, Direction::Request), error, count, address);
            }
            RequestError::Unanswered => text!("unanswered"; command = name, name = to),
            RequestError::LacksJoints(joints) => {
                let kind = one_or(*joints, "lacks-joints-but-one", "lacks-joints");
                let lacks = text!(kind; count = protocol.joints, name = to, joints);
                format!("{name}() {lacks}")
            }
            RequestError::Text(fault) => {
                let facts = protocol.facts.get(command);
                let form = facts.and_then(|facts| facts.request_text.as_ref());
                form.map_or(String::new(), |form| unsent_text(form, *fault, texts))
            }
        };
        printable(&text)
    }

    /// Return the name of a command.
    pub(crate) fn command_name(&self, command: usize) -> &str {
        let command = self.commands.get(command);
        command.map_or("", |command| &command.name)
    }

    /// Return the error text for an address that the edition does not have.
    #[must_use]
    pub fn no_address(&self, given: &Value) -> String {
        let addresses = self.protocol.table.frame().addresses.iter();
        let allowed = addresses.map(|raw| text!("label"; label = self.address_name(*raw), raw));
        let allowed = join(allowed, ", ");
        if allowed.is_empty() {
            return text!("no-addresses"; edition = self.name);
        }
        bad_argument("address", given, &allowed)
    }

    /// Return the name of an address; its number, if it has none.
    #[must_use]
    pub fn address_name(&self, value: u8) -> String {
        let mut known = self.protocol.addresses.iter();
        let known = known.find(|known| known.value == value);
        known.map_or(value.to_string(), |known| known.name.clone().into())
    }

    /// Return the fields of a message as texts show them.
    #[must_use]
    pub fn fields(&self, message: &Decoded) -> String {
        let shown = |(name, value)| match value {
            Value::Text(text) => format!("{name}={text}"),
            value => format!("{name}={value}"),
        };
        join(self.named(message).into_iter().map(shown), ", ")
    }

    /// Return the fields of a message with their names.
    #[must_use]
    pub fn named(&self, message: &Decoded) -> Vec<(String, Value)> {
        let id = message.variant;
        let command = self.commands.get(id.command);
        let fields = command.and_then(|command| command.variants(id.direction).get(id.variant));
        let mut values = message.values.iter().copied();
        let named = |field: &Field| Some((field.name.clone(), Value::nested(&mut values)?));
        fields.into_iter().flatten().map_while(named).collect()
    }

    /// Return a message as a person writes it: `get_encoder(joint=1)`, `stop() to LEFT`.
    #[must_use]
    pub fn message(&self, message: &Decoded) -> String {
        let name = self.command_name(message.variant.command);
        let to = |address| format!(" to {}", self.address_name(address));
        let to = message.address.map_or(String::new(), to);
        format!("{name}({}){to}", self.fields(message))
    }

    /// Return the text of the error that ended a request; `None` for an error of the transport,
    /// which has a text of its own.
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
                let lines = received.iter().map(|each| self.line(each, command));
                let times = (*waited, *attempts);
                printable(&timeout(call, times, *waited_for, join(lines, "; ")))
            }
            Failure::Reply { error, data } => match error {
                ReplyError::Frame(error) => self.decode_error(Direction::Reply, *error, data),
                ReplyError::Text(error) => {
                    let form = self.protocol.facts.get(command)?.text.as_ref()?;
                    received_text(form, *error, data)
                }
            },
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

    /// Describe something that was received while the client waited for a reply to the command
    /// `of`.
    fn line(&self, received: &Received, of: usize) -> String {
        let (bytes, size) = (received.event.data(), received.size);
        let mut data = hex(bytes.get(..SHOWN).unwrap_or(bytes), " ");
        if size > SHOWN {
            data = text!("cut-data"; data, size);
        }
        let commands = self.protocol.table.commands();
        let id = |command: usize| commands.get(command).map(|own| own.id);
        let (kind, command) = match &received.event {
            Event::Noise { reason, .. } => return text!("noise"; reason = reason.word(), data),
            Event::Late { command, .. } => ("late-reply", *command),
            Event::DeviceEvent { command, .. } => ("event", *command),
            // An acknowledgement has only the command's id, so an earlier request may have caused
            // it.
            Event::Ack { command, .. } if id(*command) == id(of) => ("doubtful-ack", *command),
            Event::Ack { command, .. } => ("ack", *command),
            Event::Echo { .. } => ("echo", 0),
            _ => ("frame", 0),
        };
        text!(kind; command = self.command_name(command), data)
    }
}

/// Return the error text for a request without a reply.
fn timeout(
    request: &str,
    (waited, attempts): (u64, usize),
    waited_for: Option<WaitedFor>,
    received: String,
) -> String {
    let waits = |each| text!(&format!("{each:?}").to_lowercase());
    let meanwhile = waited_for.map_or(String::new(), waits);
    let kind = match (attempts, waited_for) {
        (0, None) => "not-sent",
        (0, _) => "not-sent-by-deadline",
        (_, None) => "no-reply",
        (_, _) => "no-reply-by-deadline",
    };
    let waited = format!("{:.3}", waited as f64 / 1e9);
    let times = text!(one_or(attempts, "attempt", "attempts"); count = attempts);
    let what = text!(kind; request, waited, attempts = times, meanwhile);
    let received = match kind {
        "not-sent-by-deadline" => return what,
        "not-sent" => text!("too-much"),
        _ if received.is_empty() => text!("nothing"),
        _ => received,
    };
    text!("meanwhile"; what, received)
}

/// Return the error text for a text reply that is malformed.
fn received_text(form: &TextForm, error: TextError, data: &[u8]) -> String {
    let prefix = |index: usize| form.prefixes.get(index).map_or("", |prefix| prefix);
    let prefix = |index: usize| quoted(prefix(index), is_printable);
    let detail = match error.mistake {
        TextMistake::NotAscii => text!("text-not-ascii"),
        TextMistake::Start => text!("text-start"; prefix = prefix(0)),
        TextMistake::End => text!("text-end"; suffix = quoted(&form.suffix, is_printable)),
        TextMistake::Prefix(index, count) => text!("text-prefix"; prefix = prefix(index), count),
        TextMistake::TooLong => text!("text-length"; most = error.offset),
    };
    protocol_error(&detail, error.offset, data)
}

/// Return the error text for text arguments that cannot be sent.
fn unsent_text(form: &TextForm, fault: TextFault, given: &[&str]) -> String {
    let text = |index: usize| Value::Text((*given.get(index).unwrap_or(&"")).into());
    if let TextFault::NotPrintable(index) = fault {
        let name = form.fields.get(index).map_or("", |name| name);
        return bad_argument(name, &text(index), &text!("printable"));
    }
    let words = form.prefixes.iter().skip(1).chain([&form.suffix]);
    let words = words.filter(|word| !word.is_empty());
    let words = either(words.map(|word| quoted(word, is_printable)));
    let given = Value::Row((0..form.fields.len()).map(text).collect());
    bad_argument(
        &form.fields.join(", "),
        &given,
        &text!("unambiguous"; words),
    )
}

pub(crate) fn either(words: impl Iterator<Item = String>) -> String {
    join(words, &text!("or"))
}

pub(crate) fn hex(bytes: &[u8], between: &str) -> String {
    join(bytes.iter().map(|byte| format!("{byte:02X}")), between)
}
