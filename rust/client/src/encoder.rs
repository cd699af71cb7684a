//! Requests by the names of their commands and arguments, and replies by the names of their fields.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use cobotwire_core::exchange::{Answer, Failure, Replier, Request as Encoded, Safety};
use cobotwire_core::{Decoded, Direction};
use cobotwire_table::{Shown, bad_argument};

use crate::limits::{Limits, refusals};
use crate::options::{Settings, find_address};
use crate::typed::{Request, Table, Typed, plain};
use crate::{Error, Options, Sample, Value};

/// The values of a message with their names.
pub(crate) type Named = Vec<(String, Value)>;
/// The reply that a call has waited for; `None`: it did not.
pub(crate) type Outcome = Result<Option<Answer>, Error>;

/// A request that is validated and encoded, not yet sent.
#[derive(Clone, Debug)]
pub(crate) struct Prepared {
    pub request: Encoded,
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
}

impl Encoder {
    fn new(edition: Table, limits: &Limits) -> Result<Self, Error> {
        let edition = limits.applied(edition)?;
        let commands = edition.commands.iter().enumerate();
        Ok(Self {
            commands: commands
                .map(|(index, each)| (each.name.clone(), index))
                .collect(),
            refused: refusals(&edition, limits),
            edition,
        })
    }

    /// Return the index of a command.
    pub fn command(&self, name: &str) -> Result<usize, Error> {
        let found = self.commands.get(name).copied();
        found.ok_or_else(|| {
            Error::usage(format!(
                "edition {} has no command {name}",
                self.edition.name
            ))
        })
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
        let mut texts = vec![None; form.map_or(0, |form| form.fields.len())];
        let mut others = Vec::with_capacity(given.len());
        let given = given.iter().filter(|(_, value)| *value != Value::Absent);
        for (at, (argument, _)) in given.clone().enumerate() {
            if given.clone().take(at).any(|(other, _)| other == argument) {
                let text = format!("{name}() is given its argument {argument} twice");
                return Err(Error::usage(text));
            }
        }
        for (name, value) in given {
            let at =
                form.and_then(|form| form.fields.iter().position(|each| **each == *plain(name)));
            match (at.and_then(|at| texts.get_mut(at)), value) {
                (Some(place), Value::Text(text)) => *place = Some(&**text),
                _ => others.push((plain(name), value.clone())),
            }
        }
        let arranged = self.edition.arrange(command, &others, Value::from);
        let (row, variant) = arranged.map_err(Error::usage)?;
        let missing = form
            .into_iter()
            .flat_map(|form| form.fields.iter().zip(&texts))
            .find(|(_, text)| text.is_none());
        if let Some((field, _)) = missing {
            let places: [(&str, &dyn std::fmt::Display); 3] =
                [("call", &name), ("name", field), ("allowed", field)];
            let text = cobotwire_table::error_text("missing-argument", &places);
            return Err(Error::usage(text));
        }
        let texts: Vec<&str> = texts.into_iter().flatten().collect();
        let (count, row) = (row.len(), Value::Row(row));
        let request = Encoded::encode::<Value>(protocol, command, &row, &texts, address, variant)
            .map_err(|error| {
            let given = (count, &*texts, address);
            Error::usage(self.edition.request_error(command, &error, given))
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
        if let Some(decoded) = answer.decoded {
            return self.named(decoded);
        }
        let facts = self.edition.protocol.facts.get(prepared.request.command);
        let form = facts.and_then(|facts| facts.text.as_ref());
        let names = form.into_iter().flat_map(|form| &form.fields);
        let texts = answer.texts.into_iter().map(Value::Text);
        names.map(|name| name.to_string()).zip(texts).collect()
    }

    /// Return the fields of a message by name.
    pub fn named(&self, decoded: Decoded) -> Named {
        let id = decoded.variant;
        let facts = self.edition.protocol.facts.get(id.command);
        let variants = facts.map(|facts| match id.direction {
            Direction::Request => &facts.request,
            Direction::Reply => &facts.reply,
        });
        let fields = variants
            .and_then(|variants| variants.get(id.variant))
            .into_iter()
            .flatten();
        let mut values = decoded.values.into_iter();
        let named =
            fields.map_while(|field| Some((field.name.to_string(), Value::nested(&mut values)?)));
        named.collect()
    }

    /// Return why a request has no answer; `fault` is what the transport reported.
    pub fn failure(&self, request: &Encoded, failure: &Failure, fault: &Error) -> Error {
        let Some(message) = self.edition.failure(request, failure) else {
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
                waited: Duration::from_nanos(*waited),
                attempts: *attempts,
                waited_for: *waited_for,
            },
        }
    }
}

/// Return the fields of these names as a value: a row, unless there is one field and `single`.
pub(crate) fn result<T: Typed>(
    mut fields: Named,
    (names, single): (&[&str], bool),
    radians: &[&str],
) -> Result<T, Error> {
    let mut take = |name: &&str| {
        let found = fields.iter_mut().find(|(each, _)| each == plain(name));
        let value = found
            .map(|(_, value)| std::mem::take(value))
            .unwrap_or_default();
        if radians.contains(name) {
            value.map(f64::to_radians)
        } else {
            value
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
pub(crate) struct Handle {
    pub encoder: Arc<Encoder>,
    pub settings: Settings,
}

impl Handle {
    pub fn new(edition: Table, options: &Options) -> Result<Self, Error> {
        let settings = Settings::new(&edition, options)?;
        let encoder = Arc::new(Encoder::new(edition, &options.limits)?);
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
            let text = cobotwire_table::error_text("unacknowledged", &[("command", &name)]);
            return Err(Error::usage(text));
        }
        Ok(prepared)
    }

    pub fn result<R: Request>(
        &self,
        prepared: &Prepared,
        answer: Option<Answer>,
    ) -> Result<R::Reply, Error> {
        result(
            self.encoder.fields(prepared, answer),
            (R::RESULTS, true),
            R::RADIANS,
        )
    }

    /// Return what samples a query.
    pub fn polling<R: Request>(&self, request: R, rate: f64) -> Result<Polling, Error> {
        let prepared = self.prepare(request)?;
        let command = self.encoder.edition.commands.get(prepared.request.command);
        if !prepared.awaits_reply || command.is_none_or(|each| each.safety != Safety::Query) {
            let why = "is not a query; a stream can send only queries";
            return Err(Error::usage(format!("{} {why}", R::COMMAND)));
        }
        if !(0.0 < rate && rate <= 1000.0) {
            let allowed = "a number above 0 and up to 1000";
            return Err(Error::usage(bad_argument(
                "rate",
                &Shown::Real(rate),
                allowed,
            )));
        }
        let period = Duration::from_secs_f64((1.0 / rate).min(86_400.0));
        Ok(Polling {
            prepared,
            period,
            next: None,
            missed: 0,
            ended: false,
        })
    }
}

/// Says when a query is to be sampled, and counts the periods without a sample.
pub(crate) struct Polling {
    pub prepared: Prepared,
    period: Duration,
    next: Option<Instant>,
    pub missed: u64,
    pub ended: bool,
}

impl Polling {
    /// Return the sample of a period, or the error that ends the stream; a period may have neither.
    pub fn sample<R: Request>(
        &mut self,
        handle: &Handle,
        answer: Outcome,
    ) -> Option<Result<Sample<R::Reply>, Error>> {
        let times = answer.as_ref().ok().and_then(Option::as_ref);
        let times = times.map_or((0, 0), |answer| (answer.requested_at, answer.replied_at));
        let value = answer.and_then(|answer| handle.result::<R>(&self.prepared, answer));
        self.ended = matches!(value, Err(Error::LinkError { .. }));
        if value.is_err() && !self.ended {
            self.missed += 1;
            return None;
        }
        let (requested_at, replied_at) = times;
        Some(value.map(|value| Sample {
            value,
            requested_at,
            replied_at,
        }))
    }

    /// Return when the next period begins; those that have passed are missed.
    pub fn tick(&mut self) -> Instant {
        let now = Instant::now();
        let at = self.next.unwrap_or(now);
        let late = now.saturating_duration_since(at).as_nanos() / self.period.as_nanos().max(1);
        let late = u32::try_from(late).unwrap_or(u32::MAX);
        self.missed += u64::from(late);
        self.next = Some(at + self.period * late + self.period);
        at + self.period * late
    }
}

/// Makes the methods of a client with the fields `handle` and `shared`, and with private methods
/// `perform` and `subscribe`.
macro_rules! client_methods {
    ($client:ident [$($async:tt)*] [$($await:tt)*]) => {
        impl std::fmt::Debug for $client {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}({})", stringify!($client), self.edition().name)
            }
        }

        impl $client {
            /// Return the table of the edition, within the limits of this client.
            #[must_use]
            pub fn edition(&self) -> &Table {
                &self.handle.encoder.edition
            }

            /// Return this client for another address, by its name or number.
            pub fn at(&self, address: &str) -> Result<Self, Error> {
                let handle = self.handle.clone().at(address)?;
                Ok(Self { handle, shared: self.shared.clone() })
            }

            /// Return this client so that requests without a reply wait for their acknowledgement.
            #[must_use]
            pub fn acknowledged(&self, within: Duration) -> Self {
                let mut other = self.clone();
                other.handle.settings.ack_within = Some(crate::options::nanos(within));
                other
            }

            /// Send a request; return the result of its reply, if it has one.
            pub $($async)* fn call<R: Request>(&self, request: R) -> Result<R::Reply, Error> {
                let prepared = self.handle.prepare(request)?;
                let answer = self.perform(&prepared) $($await)* ?;
                self.handle.result::<R>(&prepared, answer)
            }

            /// Send a request by the name of its command; return the fields of its reply.
            pub $($async)* fn call_named(
                &self,
                command: &str,
                arguments: &[(&str, Value)],
            ) -> Result<Named, Error> {
                let prepared = self.handle.prepare_named(command, arguments)?;
                let answer = self.perform(&prepared) $($await)* ?;
                Ok(self.handle.encoder.fields(&prepared, answer))
            }

            /// Sample a query `rate` times a second, above 0 and up to 1000.
            ///
            /// A request is sent only when the loop wants a sample, and not again within its period.
            /// A period without a reply has no sample; [`Polls::missed`] counts such periods, and
            /// those for which the loop came too late.
            pub fn poll<R: Request>(&self, request: R, rate: f64) -> Result<Polls<R, Self>, Error> {
                let polling = self.handle.polling(request, rate)?;
                let mut client = self.clone();
                client.handle.settings.retry.attempts = 1;
                Ok(Polls { client, polling, reply: PhantomData })
            }

            /// Receive the events of a type that come from now on, until none comes within
            /// `timeout`.
            pub fn events<E: DeviceEvent>(
                &self,
                timeout: Option<Duration>,
            ) -> Result<Events<E, Self>, Error> {
                let queue = Queue::new(self.handle.encoder.command(E::COMMAND)?);
                self.subscribe(&queue);
                Ok(Events { client: self.clone(), queue, timeout, event: PhantomData })
            }
        }
    };
}
pub(crate) use client_methods;
