//! Requests by the names of their commands and arguments, and replies by the names of their fields.

use std::sync::Arc;
use std::time::Duration;

use cobotwire_core::Decoded;
use cobotwire_core::exchange::{Answer, Failure, Replier, Request as Encoded};
use cobotwire_table::error_text;

use crate::options::find_address;
use crate::session::Settings;
use crate::typed::{Request, Table, Typed};
use crate::{Error, Limits, Options, Value};

/// The values of a message with their names.
pub type Named = Vec<(String, Value)>;
/// The reply that a call has waited for; `None`: it did not.
pub type Outcome = Result<Option<Answer>, Error>;

/// A request that is validated and encoded, not yet sent.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub request: Encoded,
    /// Whether a call waits for its reply.
    pub awaits_reply: bool,
    pub address: Option<u8>,
}

/// Encodes the requests of an edition, within limits.
#[derive(Debug)]
pub struct Encoder {
    pub edition: Table,
    limits: Limits,
}

impl Encoder {
    /// Return the index of a command.
    pub fn command(&self, name: &str) -> Result<usize, Error> {
        let mut commands = self.edition.commands.iter();
        let unknown = || format!("edition {} has no command {name}", self.edition.name);
        let found = commands.position(|command| command.name == name);
        found.ok_or_else(|| Error::usage(unknown()))
    }

    /// Validate and encode a request.
    pub fn prepare(
        &self,
        name: &str,
        given: &[(&str, Value)],
        address: Option<u8>,
    ) -> Result<Prepared, Error> {
        let (edition, command) = (&self.edition, self.command(name)?);
        let record = edition.commands.get(command);
        let refusal = record.and_then(|record| self.limits.refusal(edition, record));
        refusal.map_or(Ok(()), |why| Err(Error::usage(why)))?;
        let facts = edition.protocol.facts.get(command);
        let form = facts.and_then(|facts| facts.request_text.as_ref());
        let text_fields = form.map_or(&[][..], |form| &form.fields);
        let (mut texts, mut others) = (vec![None; text_fields.len()], Vec::new());
        for (at, (argument, value)) in given.iter().enumerate() {
            if given.iter().take(at).any(|(other, _)| other == argument) {
                let text = format!("{name}() is given its argument {argument} twice");
                return Err(Error::usage(text));
            }
            let text_at = text_fields.iter().position(|field| **field == **argument);
            match (text_at.and_then(|at| texts.get_mut(at)), value) {
                (_, Value::Absent) => {}
                (Some(place), Value::Text(text)) => *place = Some(&**text),
                _ => others.push((*argument, value.clone())),
            }
        }
        let filled = |value: Option<_>| value.map_or(Value::Counted, Value::from);
        let arranged = edition.arrange(command, &others, filled);
        let (row, variant) = arranged.map_err(Error::usage)?;
        let mut missing = text_fields.iter().zip(&texts);
        if let Some((field, _)) = missing.find(|(_, text)| text.is_none()) {
            let all = text_fields.join(", ");
            let text = error_text(
                "missing-argument",
                &[("call", &name), ("name", field), ("allowed", &all)],
            );
            return Err(Error::usage(text));
        }
        let texts: Vec<&str> = texts.into_iter().flatten().collect();
        let (count, row) = (row.len(), Value::Row(row));
        let protocol = &edition.protocol;
        let encoded = Encoded::encode::<Value>(protocol, command, &row, &texts, address, variant);
        let request = encoded.map_err(|error| {
            let given = (count, &*texts, address);
            Error::usage(edition.request_error(command, &error, given))
        })?;
        let awaits_reply = facts.is_some_and(|each| each.requires_reply() || each.text.is_some());
        Ok(Prepared {
            request,
            awaits_reply,
            address,
        })
    }

    /// Return the fields of a reply by name.
    pub fn fields(&self, prepared: &Prepared, answer: Option<Answer>) -> Named {
        let Some(answer) = answer else {
            return Vec::new();
        };
        if let Some(decoded) = &answer.decoded {
            return self.named(decoded);
        }
        let facts = self.edition.protocol.facts.get(prepared.request.command);
        let form = facts.and_then(|facts| facts.text.as_ref());
        let names = form.into_iter().flat_map(|form| &form.fields);
        let texts = answer.texts.into_iter().map(Value::Text);
        names.map(|name| name.to_string()).zip(texts).collect()
    }

    /// Return the fields of a message by name.
    pub fn named(&self, decoded: &Decoded) -> Named {
        let named = self.edition.named(decoded).into_iter();
        named
            .map(|(name, value)| (name.to_owned(), value.into()))
            .collect()
    }

    /// Return the error of a request that failed; `None`: the transport has the error.
    pub fn failure(&self, request: &Encoded, failure: &Failure) -> Option<Error> {
        let message = self.edition.failure(request, failure)?;
        Some(match failure {
            Failure::Link => return None,
            Failure::Refused { .. } => Error::RequestRefused { message },
            Failure::Reply { data, .. } => Error::ProtocolError {
                message,
                data: data.clone(),
            },
            Failure::Timeout {
                waited,
                attempts,
                waited_for,
                ..
            } => Error::ReplyTimeout {
                message,
                waited: Duration::from_nanos(*waited),
                attempts: *attempts,
                waited_for: *waited_for,
            },
        })
    }
}

/// Return the fields of these names as a value: a row, unless there is one field and `single`.
pub(crate) fn result<T: Typed>(
    mut fields: Named,
    (names, single): (&[&str], bool),
    radians: &[&str],
) -> Result<T, Error> {
    let mut take = |name: &&str| {
        let found = fields.iter_mut().find(|(each, _)| each == name);
        let value = found.map(|(_, value)| std::mem::take(value));
        let value = value.unwrap_or_default();
        match radians.contains(name) {
            true => value.map(f64::to_radians),
            false => value,
        }
    };
    let value = match names {
        [one] if single => take(one),
        several => Value::Row(several.iter().map(take).collect()),
    };
    let mismatch = || Error::usage("the generated module is not that of its table");
    T::from_value(value).ok_or_else(mismatch)
}

/// A handle of a client: how it encodes requests, and with what it sends them.
#[derive(Clone, Debug)]
pub struct Handle {
    pub encoder: Arc<Encoder>,
    pub settings: Settings,
}

impl Handle {
    pub fn new(edition: Table, options: &Options) -> Result<Self, Error> {
        let (settings, limits) = (options.settings(&edition)?, options.limits.clone());
        let edition = limits.applied(edition)?;
        let encoder = Arc::new(Encoder { edition, limits });
        Ok(Self { encoder, settings })
    }

    pub fn at(mut self, address: &str) -> Result<Self, Error> {
        self.settings.address = Some(find_address(&self.encoder.edition, address)?);
        Ok(self)
    }

    pub fn prepare<R: Request>(&self, request: R) -> Result<Prepared, Error> {
        let mut arguments = request.arguments();
        for (name, value) in &mut arguments {
            if R::RADIANS.contains(name) {
                *value = std::mem::take(value).map(f64::to_degrees);
            }
        }
        self.prepare_named(R::COMMAND, &arguments)
    }

    pub fn prepare_named(&self, name: &str, given: &[(&str, Value)]) -> Result<Prepared, Error> {
        let prepared = self.encoder.prepare(name, given, self.settings.address)?;
        if self.settings.ack_within.is_some() && prepared.request.replier == Replier::Nobody {
            let text = error_text("unacknowledged", &[("command", &name)]);
            return Err(Error::usage(text));
        }
        Ok(prepared)
    }

    pub fn result<R: Request>(
        &self,
        prepared: &Prepared,
        answer: Option<Answer>,
    ) -> Result<R::Reply, Error> {
        let fields = self.encoder.fields(prepared, answer);
        result(fields, (R::RESULTS, true), R::RADIANS)
    }
}
