//! Encodes requests from the names of commands and arguments, and names the fields of replies.

use std::time::Duration;

use cobotwire_core::exchange::{Answer, Failure, Nanos, Replier, Request as Encoded};
use cobotwire_table::error_text;

use crate::options::{check_ack_within, check_times};
use crate::typed::{Request, Table, Typed};
use crate::{Error, Options, Value};

/// The values of a message with their names.
pub type Named = Vec<(String, Value)>;
/// The reply that a call has waited for; `None` if it did not wait for one.
pub type Outcome = Result<Option<Answer>, Error>;

/// A request that is validated and encoded, not yet sent.
#[derive(Clone, Debug)]
pub struct Prepared {
    pub request: Encoded,
    /// Whether a call waits for its reply.
    pub awaits_reply: bool,
    pub address: Option<u8>,
}

/// A handle of a client: the table, options and address with which it encodes and sends requests.
#[derive(Clone, Debug)]
pub struct Handle {
    /// The table, with its ranges narrowed to the limits.
    pub edition: Table,
    pub options: Options,
    pub address: Option<u8>,
    pub ack_within: Option<Nanos>,
}

impl Handle {
    pub fn new(edition: Table, mut options: Options) -> Result<Self, Error> {
        check_times(&options)?;
        let address = options.address.take();
        let handle = Self {
            edition: options.limits.applied(edition)?,
            options,
            address: None,
            ack_within: None,
        };
        address.map_or(Ok(handle.clone()), |address| handle.at(&address))
    }

    /// Change the address, given as a name or number, and return the handle.
    pub fn at(mut self, address: &str) -> Result<Self, Error> {
        let (edition, number) = (&self.edition, address.parse());
        let given = number.map_or_else(|_| Value::Text(address.to_owned()), Value::Integer);
        let all = || edition.protocol.table.frame().addresses.iter().copied();
        let has_name = |raw: &u8| edition.address_name(*raw).eq_ignore_ascii_case(address);
        let has_number = |raw: &u8| given == Value::Integer((*raw).into());
        let found = all().find(has_name).or_else(|| all().find(has_number));
        self.address = Some(found.ok_or_else(|| Error::usage(edition.no_address(&given)))?);
        Ok(self)
    }

    /// Return the index of a command.
    pub fn command(&self, name: &str) -> Result<usize, Error> {
        let mut commands = self.edition.commands.iter();
        let unknown = || format!("edition {} has no command {name}", self.edition.name);
        let found = commands.position(|command| command.name == name);
        found.ok_or_else(|| Error::usage(unknown()))
    }

    pub fn prepare<R: Request>(&self, request: R) -> Result<Prepared, Error> {
        let mut arguments = request.arguments();
        let all = arguments.iter_mut();
        let radians = all.filter(|(name, _)| R::RADIANS.contains(name));
        radians.for_each(|(_, value)| convert(value, f64::to_degrees));
        self.prepare_named(R::COMMAND, &arguments)
    }

    /// Validate and encode a request.
    pub fn prepare_named(&self, name: &str, given: &[(&str, Value)]) -> Result<Prepared, Error> {
        let within = self.ack_within.map(Duration::from_nanos);
        within.map_or(Ok(()), check_ack_within)?;
        let (edition, command) = (&self.edition, self.command(name)?);
        let record = edition.commands.get(command);
        let refusal = record.and_then(|record| self.options.limits.refusal(edition, record));
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
        let arranged = edition.arrange(command, &others);
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
        let (protocol, address) = (&edition.protocol, self.address);
        let encoded = Encoded::encode::<Value>(protocol, command, &row, &texts, address, variant);
        let request = encoded.map_err(|error| {
            let given = (row.len(), &*texts, address);
            Error::usage(edition.request_error(command, &error, given))
        })?;
        if self.ack_within.is_some() && request.replier == Replier::Nobody {
            let text = error_text("unacknowledged", &[("command", &name)]);
            return Err(Error::usage(text));
        }
        let awaits_reply = facts.is_some_and(|each| each.requires_reply() || each.text.is_some());
        Ok(Prepared {
            request,
            awaits_reply,
            address,
        })
    }

    /// Return the fields of a reply by name.
    pub fn fields(&self, prepared: &Prepared, answer: Option<Answer>) -> Named {
        let answer = answer.map(|answer| (answer.decoded, answer.texts));
        let (decoded, texts) = answer.unwrap_or_default();
        if let Some(decoded) = decoded {
            return self.edition.named(&decoded);
        }
        let facts = self.edition.protocol.facts.get(prepared.request.command);
        let form = facts.and_then(|facts| facts.text.as_ref());
        let names = form.into_iter().flat_map(|form| &form.fields);
        let texts = texts.into_iter().map(Value::Text);
        names.map(|name| name.to_string()).zip(texts).collect()
    }

    pub fn result<R: Request>(
        &self,
        of: &Prepared,
        answer: Option<Answer>,
    ) -> Result<R::Reply, Error> {
        result(self.fields(of, answer), (R::RESULTS, true), R::RADIANS)
    }

    /// Return a `LinkError` that names the port.
    pub fn link(&self, detail: &str, written: Option<usize>) -> Error {
        let url = self.options.port_name.as_deref();
        Error::link(url.unwrap_or("port"), detail, written)
    }

    /// Return the error of a request that failed; `None` if the transport failed, which has its own
    /// error.
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
        let found = found.map(|(_, value)| std::mem::take(value));
        let mut value = found.unwrap_or_default();
        if radians.contains(name) {
            convert(&mut value, f64::to_radians);
        }
        value
    };
    let value = match names {
        [one] if single => take(one),
        several => Value::Row(several.iter().map(take).collect()),
    };
    let mismatch = || Error::usage("the generated module does not match its table");
    T::from_value(value).ok_or_else(mismatch)
}

/// Change each number of a value, in rows too.
fn convert(value: &mut Value, change: fn(f64) -> f64) {
    match value {
        Value::Real(real) => *real = change(*real),
        Value::Integer(raw) => *value = Value::Real(change(*raw as f64)),
        Value::Row(row) => row.iter_mut().for_each(|each| convert(each, change)),
        _ => {}
    }
}
