//! Samples of queries and events of devices, as iterators and streams; and what both clients have.

use std::marker::PhantomData;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use cobotwire_core::exchange::Safety;
use cobotwire_table::{Shown, bad_argument};

use crate::encoder::{Handle, Outcome, Prepared, result};
use crate::session::{Queue, Session};
use crate::typed::{DeviceEvent, Request};
use crate::{Client, Error, Sample, lock};

/// What an asynchronous stream waits for.
pub(crate) type Pending<T> = Option<Pin<Box<dyn Future<Output = T> + Send>>>;

/// The samples of a query; see [`Client::poll`].
pub struct Polls<R, C = Client> {
    pub(crate) client: C,
    pub(crate) polling: Polling,
    #[cfg_attr(not(feature = "tokio"), allow(dead_code))]
    pub(crate) pending: Pending<Outcome>,
    pub(crate) reply: PhantomData<fn() -> R>,
}

impl<R, C> Polls<R, C> {
    /// Return how many periods have had no sample.
    #[must_use]
    pub fn missed(&self) -> u64 {
        self.polling.missed
    }
}

/// Says when a query is to be sampled, and counts the periods without a sample.
pub(crate) struct Polling {
    pub prepared: Prepared,
    period: Duration,
    next: Option<Instant>,
    missed: u64,
    pub ended: bool,
}

impl Polling {
    pub fn new(handle: &Handle, prepared: Prepared, rate: f64) -> Result<Self, Error> {
        let command = handle
            .encoder
            .edition
            .commands
            .get(prepared.request.command);
        let command = command.filter(|command| command.safety != Safety::Query);
        if let Some(command) = command {
            let why = "is not a query; a stream can send only queries";
            return Err(Error::usage(format!("{} {why}", command.name)));
        }
        if !(0.0 < rate && rate <= 1000.0) {
            let allowed = "a number above 0 and up to 1000";
            let text = bad_argument("rate", &Shown::Real(rate), allowed);
            return Err(Error::usage(text));
        }
        Ok(Self {
            prepared,
            period: Duration::from_secs_f64((1.0 / rate).min(86_400.0)),
            next: None,
            missed: 0,
            ended: false,
        })
    }

    /// Return the sample of a period, or the error that ends the stream; a period may have neither.
    pub fn sample<R: Request>(
        &mut self,
        handle: &Handle,
        outcome: Outcome,
    ) -> Option<Result<Sample<R::Reply>, Error>> {
        let answer = outcome.as_ref().ok().and_then(Option::as_ref);
        let times = answer.map(|answer| (answer.requested_at, answer.replied_at));
        let (requested_at, replied_at) = times.unwrap_or_default();
        let value = outcome.and_then(|answer| handle.result::<R>(&self.prepared, answer));
        self.ended = matches!(value, Err(Error::LinkError { .. }));
        if value.is_err() && !self.ended {
            self.missed += 1;
            return None;
        }
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

/// Events of one type; see [`Client::events`].
pub struct Events<E, C = Client> {
    pub(crate) client: C,
    pub(crate) queue: Arc<Mutex<Queue>>,
    pub(crate) timeout: Option<Duration>,
    #[cfg_attr(not(feature = "tokio"), allow(dead_code))]
    pub(crate) pending: Pending<Option<Result<E, Error>>>,
}

impl<E, C> Events<E, C> {
    /// Return how many events were dropped because too many waited: always the oldest.
    #[must_use]
    pub fn lost(&self) -> u64 {
        lock(&self.queue).lost
    }
}

/// Return the next event that has come, or the error that ends them.
pub(crate) fn next_event<E: DeviceEvent>(
    queue: &Mutex<Queue>,
    session: &Session,
) -> Option<Result<E, Error>> {
    let event = lock(queue).events.pop_front();
    let event = event.map(|fields| result(fields, (E::FIELDS, false), &[]));
    event.or_else(|| session.fault().cloned().map(Err))
}

/// Makes the methods of a client with the fields `handle` and `shared`, and with private methods
/// `perform` and `connection`.
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
                other.handle.settings.ack_within = Some(nanos(within));
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
            ) -> Result<Vec<(String, Value)>, Error> {
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
                let mut client = self.clone();
                client.handle.settings.retry.attempts = 1;
                let polling = Polling::new(&self.handle, self.handle.prepare(request)?, rate)?;
                Ok(Polls { client, polling, pending: None, reply: PhantomData })
            }

            /// Receive the events of a type that come from now on, until none comes within
            /// `timeout`.
            pub fn events<E: DeviceEvent>(
                &self,
                timeout: Option<Duration>,
            ) -> Result<Events<E, Self>, Error> {
                let command = self.handle.encoder.command(E::COMMAND)?;
                let queue = self.connection().session.subscribe(command);
                Ok(Events { client: self.clone(), queue, timeout, pending: None })
            }
        }
    };
}
pub(crate) use client_methods;
