//! Requests by the names of their commands and arguments, and replies by the names of their fields.

use std::collections::HashMap;

use cobotwire_core::exchange::{Answer, Failure, Request};
use cobotwire_core::{Direction, decode};
use cobotwire_table::{Field, Quote, Shown, as_call};

use crate::Error;
use crate::limits::{Limits, Workspace, refusals};
use crate::options::nanos;
use crate::typed::{FromValue, Table, plain};
use crate::value::{Value, nested};

/// The values of a message with their names.
pub(crate) type Named = Vec<(String, Value)>;

/// A request that is validated and encoded, not yet sent.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    pub request: Request,
    /// Whether a call waits for its reply.
    pub awaits_reply: bool,
    pub address: Option<u8>,
}

/// Encodes the requests of an edition, within limits.
#[derive(Debug)]
pub(crate) struct Encoder {
    pub edition: Table,
    commands: HashMap<String, usize>,
    /// The commands that could exceed the limits whatever their arguments are, and why.
    refused: HashMap<usize, String>,
    workspace: Option<Workspace>,
}

impl Encoder {
    pub fn new(edition: Table, limits: &Limits) -> Result<Self, Error> {
        let edition = limits.applied(edition)?;
        let names = edition.commands.iter().enumerate();
        Ok(Self {
            commands: names
                .map(|(index, each)| (each.name.clone(), index))
                .collect(),
            refused: refusals(&edition, limits),
            workspace: limits.workspace_of(&edition),
            edition,
        })
    }

    /// Return the index of a command.
    pub fn command(&self, name: &str) -> Result<usize, Error> {
        let unknown = || {
            Error::usage(format!(
                "edition {} has no command {name}",
                self.edition.name
            ))
        };
        self.commands.get(name).copied().ok_or_else(unknown)
    }

    /// Validate and encode a request.
    pub fn prepare(
        &self,
        name: &str,
        given: &[(&str, Value)],
        address: Option<u8>,
    ) -> Result<Prepared, Error> {
        let command = self.command(name)?;
        if let Some(why) = self.refused.get(&command) {
            return Err(Error::usage(why));
        }
        let protocol = &self.edition.protocol;
        let facts = protocol.facts.get(command);
        let form = facts.and_then(|facts| facts.request_text.as_ref());
        let text = |name: &str| given.iter().find(|(each, _)| plain(each) == name);
        let texts: Vec<&str> = form
            .iter()
            .flat_map(|form| &form.fields)
            .map(|field| match text(field) {
                Some((_, Value::Text(text))) => &**text,
                _ => "",
            })
            .collect();
        let others = given.iter().filter(|(name, value)| {
            let is_text =
                form.is_some_and(|form| form.fields.iter().any(|each| **each == *plain(name)));
            !is_text && *value != Value::Absent
        });
        let (row, variant) = self.arrange(command, &others.collect::<Vec<_>>())?;
        let count = row.len();
        let encoded = Request::encode::<Value>(
            protocol,
            command,
            &Value::Row(row),
            &texts,
            address,
            variant,
        );
        let request = encoded.map_err(|error| {
            Error::usage(
                self.edition
                    .request_error(command, &error, (count, &texts, address)),
            )
        })?;
        if let Some(workspace) = &self.workspace {
            workspace.check(self, &request)?;
        }
        let awaits_reply =
            facts.is_some_and(|facts| facts.requires_reply() || facts.text.is_some());
        Ok(Prepared {
            request,
            awaits_reply,
            address,
        })
    }

    /// Return the values of the variant that takes exactly the given arguments, in its order; and
    /// its index, unless the values must decide.
    fn arrange(
        &self,
        command: usize,
        given: &[&(&str, Value)],
    ) -> Result<(Vec<Value>, Option<usize>), Error> {
        let Some(record) = self.edition.commands.get(command) else {
            return Ok((Vec::new(), None));
        };
        let (mut fitting, mut missing) = (Vec::new(), None);
        for (index, variant) in record.request.iter().enumerate() {
            let named = |name: &str| variant.iter().any(|field| field.name == name);
            match given.iter().find(|(name, _)| !named(plain(name))) {
                Some((name, _)) => {
                    let what = format!(
                        "{}() does not take its argument {} together with the others",
                        record.name,
                        plain(name)
                    );
                    missing = missing.or(Some(what));
                }
                None => match self.row(command, index, variant, given) {
                    Ok(row) => fitting.push((index, row)),
                    Err(name) => {
                        let what = format!("{}() is missing its argument {name}", record.name);
                        missing = missing.or(Some(what));
                    }
                },
            }
        }
        let sure = fitting.len() == 1;
        match fitting.into_iter().next() {
            Some((index, row)) => Ok((row, sure.then_some(index))),
            None => Err(Error::usage(missing.unwrap_or_default())),
        }
    }

    /// Return the values of one variant; the error is the name of an argument that is missing.
    fn row<'a>(
        &self,
        command: usize,
        index: usize,
        variant: &'a [Field],
        given: &[&(&str, Value)],
    ) -> Result<Vec<Value>, &'a str> {
        let value = |(at, field): (usize, &'a Field)| {
            if field.counts.is_some() {
                return Ok(Value::Counted);
            }
            if let Some(raw) = field.constant {
                return Ok(self.constant(command, index, at, raw));
            }
            if let Some((_, value)) = given.iter().find(|(name, _)| plain(name) == field.name) {
                return Ok(value.clone());
            }
            let default = field.default.as_ref().ok_or(&*field.name)?;
            let mut reals = default.iter().copied().map(Value::Real);
            match (reals.len(), reals.next()) {
                (1, Some(real)) => Ok(real),
                (_, first) => Ok(Value::Row(first.into_iter().chain(reals).collect())),
            }
        };
        variant.iter().enumerate().map(value).collect()
    }

    /// Return a constant in its unit.
    fn constant(&self, command: usize, variant: usize, field: usize, raw: i64) -> Value {
        let commands = self.edition.protocol.table.commands();
        let variant = commands
            .get(command)
            .and_then(|each| each.request.get(variant));
        let field = variant.and_then(|variant| variant.fields().get(field));
        let number = field.and_then(|field| field.cases.first()?.numbers.first());
        match number {
            Some(number) if number.scaled() => {
                Value::Real(raw as f64 * number.multiply as f64 / number.divide as f64)
            }
            _ => Value::Integer(raw),
        }
    }

    /// Return the fields of a reply by name.
    pub fn fields(&self, request: &Request, answer: Answer) -> Named {
        let facts = self.edition.protocol.facts.get(request.command);
        let Some(decoded) = answer.decoded else {
            let names = facts
                .and_then(|facts| facts.text.as_ref())
                .map(|text| &text.fields);
            let names = names.into_iter().flatten().map(|name| name.to_string());
            return names
                .zip(answer.texts.into_iter().map(Value::Text))
                .collect();
        };
        self.named(decoded)
    }

    /// Return the fields of a message by name.
    pub fn named(&self, decoded: cobotwire_core::Decoded) -> Named {
        let facts = self.edition.protocol.facts.get(decoded.variant.command);
        let variants = facts.map(|facts| match decoded.variant.direction {
            Direction::Request => &facts.request,
            Direction::Reply => &facts.reply,
        });
        let variant = variants.and_then(|variants| variants.get(decoded.variant.variant));
        let mut values = decoded.values.into_iter();
        let fields = variant.into_iter().flatten();
        fields
            .map_while(|field| Some((field.name.to_string(), nested(&mut values)?)))
            .collect()
    }

    /// Return a request as a person writes it.
    fn call(&self, request: &Request) -> String {
        let table = &self.edition.protocol.table;
        let own = decode(
            table,
            Direction::Request,
            &request.frame,
            Some(request.command),
        );
        let address = own.as_ref().ok().and_then(|own| own.address);
        let address = address.map(|address| self.edition.address_name(address));
        let fields = own.map(|own| self.named(own)).unwrap_or_default();
        let shown = fields.iter().map(|(name, value)| match value.quote() {
            Shown::List(row) => (&**name, Shown::Tuple(row)),
            other => (&**name, other),
        });
        let command = self.edition.commands.get(request.command);
        as_call(
            command.map_or("", |command| &command.name),
            shown,
            address.as_deref(),
        )
    }

    /// Return why a request has no answer; `fault` is what the transport reported.
    pub fn failure(&self, request: &Request, failure: &Failure, fault: &Error) -> Error {
        let call = self.call(request);
        let Some(message) = self.edition.failure(&call, request, failure) else {
            return fault.clone();
        };
        match failure {
            Failure::Link => fault.clone(),
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
                waited: std::time::Duration::from_nanos(*waited),
                attempts: *attempts,
                waited_for: *waited_for,
            },
        }
    }
}

/// Return the result of a call: one field, or a row of them.
pub(crate) fn result<T: FromValue>(
    mut fields: Named,
    results: &[&str],
    radians: &[&str],
) -> Result<T, Error> {
    let mut take = |name: &&str| {
        let found = fields.iter_mut().find(|(each, _)| each == plain(name));
        let value = found.map_or(Value::Absent, |(_, value)| {
            std::mem::replace(value, Value::Absent)
        });
        if radians.contains(name) {
            value.map(f64::to_radians)
        } else {
            value
        }
    };
    let value = match results {
        [one] => take(one),
        several => Value::Row(several.iter().map(take).collect()),
    };
    T::from_value(value)
        .ok_or_else(|| Error::usage("the generated module is not that of its table"))
}

/// Return the arguments as the wire carries them: angles in degrees.
pub(crate) fn in_degrees(
    arguments: Vec<(&'static str, Value)>,
    radians: &[&str],
) -> Vec<(&'static str, Value)> {
    let convert = |(name, value): (&'static str, Value)| {
        let value = if radians.contains(&name) {
            value.map(f64::to_degrees)
        } else {
            value
        };
        (name, value)
    };
    arguments.into_iter().map(convert).collect()
}

/// Return seconds as a time; `None`: they are not above 0, or more than a day.
pub(crate) fn period(rate: f64) -> Option<u64> {
    let legal = rate > 0.0 && rate <= 1000.0;
    legal.then(|| {
        nanos(std::time::Duration::from_secs_f64(
            (1.0 / rate).min(86_400.0),
        ))
    })
}
