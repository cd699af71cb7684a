//! Samples of queries and events of devices, as iterators and streams; and the methods that both
//! clients have.

use std::time::{Duration, Instant};

use cobotwire_core::exchange::Safety;
use cobotwire_table::bad_argument;

use crate::handle::{Handle, Prepared};
use crate::{Error, Value};

/// The samples of a query, or the events of a type: an iterator of [`poll`](crate::Client::poll) or
/// [`events`](crate::Client::events), and a `Stream` if the client is asynchronous. `N` is
/// `Option<item>`, or a future of that.
pub struct Received<N> {
    pub(crate) next: Box<dyn FnMut() -> N + Send>,
    #[cfg_attr(not(feature = "tokio"), allow(dead_code))]
    pub(crate) pending: Option<N>,
    pub(crate) missed: Box<dyn Fn() -> u64 + Send>,
}

impl<N> Received<N> {
    /// Return the number of periods without a sample, or of events that were dropped, oldest first,
    /// because too many were queued.
    #[must_use]
    pub fn missed(&self) -> u64 {
        (self.missed)()
    }
}

impl<T> Iterator for Received<Option<T>> {
    type Item = T;

    fn next(&mut self) -> Option<T> {
        (self.next)()
    }
}

/// Determines when a query is sampled, and counts the periods without a sample.
pub(crate) struct Polling {
    prepared: Prepared,
    pub period: Duration,
    next: Option<Instant>,
    pub missed: u64,
    pub ended: bool,
}

impl Polling {
    pub fn new(handle: &Handle, prepared: Prepared, rate: f64) -> Result<Self, Error> {
        let command = handle.edition.commands.get(prepared.request.command);
        let command = command.filter(|command| command.safety != Safety::Query);
        if let Some(command) = command {
            let why = "is not a query; a stream can send only queries";
            return Err(Error::usage(format!("{} {why}", command.name)));
        }
        if !(0.0 < rate && rate <= 1000.0) {
            let allowed = "a number above 0 and up to 1000";
            let text = bad_argument("rate", &Value::Real(rate), allowed);
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

    /// Return the query, and how long to wait for its next period. Periods that have passed count
    /// as missed. `None`: the samples have ended.
    pub fn tick(&mut self) -> Option<(Prepared, Duration)> {
        if self.ended {
            return None;
        }
        let now = Instant::now();
        let at = self.next.unwrap_or(now);
        let late = now.saturating_duration_since(at).as_nanos() / self.period.as_nanos().max(1);
        let late = u32::try_from(late).unwrap_or(u32::MAX);
        self.missed += u64::from(late);
        self.next = Some(at + self.period * late + self.period);
        let wait = (at + self.period * late).saturating_duration_since(now);
        Some((self.prepared.clone(), wait))
    }
}

/// Makes the methods of a client with the fields `handle` and `shared`, and with private methods
/// `perform`, `until` and `connection`. The lists in brackets are empty, or hold the keywords of
/// asynchronous methods; `$next_item` is the type of the future of an item.
macro_rules! client_methods {
    (
        $client:ident $next_item:ident $sleep:path,
        [$($async:tt)*] [$($pin:tt)*] [$($move:tt)*] [$($await:tt)*]
    ) => {
        impl std::fmt::Debug for $client {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, "{}({})", stringify!($client), self.edition().name)
            }
        }

        impl $client {
            /// Return the table of the edition, within the limits of this client.
            #[must_use]
            pub fn edition(&self) -> &Table {
                &self.handle.edition
            }

            /// Return a client for another address, by its name or number; both share the
            /// connection.
            pub fn at(&self, address: &str) -> Result<Self, Error> {
                let handle = self.handle.clone().at(address)?;
                Ok(Self { handle, shared: self.shared.clone() })
            }

            /// Return a client on the same connection that waits for acknowledgements of one-way
            /// requests. A time of 0, or of an hour and more, is refused by each call.
            #[must_use]
            pub fn acknowledged(&self, within: Duration) -> Self {
                let mut other = self.clone();
                other.handle.ack_within = Some(nanos(within));
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
                Ok(self.handle.fields(&prepared, answer))
            }

            /// Sample a query `rate` times a second, above 0 and up to 1000.
            ///
            /// A request is sent only when the loop wants a sample, and not again within its
            /// period. A period without a reply has no sample; [`Received::missed`] counts such
            /// periods, and those that passed before the loop wanted a sample. If the loop stops
            /// polling for more than a period while a reply arrives, the reply counts as missed.
            pub fn poll<R: Request>(
                &self,
                request: R,
                rate: f64,
            ) -> Result<Received<$next_item<Result<Sample<R::Reply>, Error>>>, Error> {
                let mut client = self.clone();
                client.handle.options.retry.attempts = 1;
                let polling = Polling::new(&self.handle, self.handle.prepare(request)?, rate)?;
                let polling = Arc::new(Mutex::new(polling));
                let missed = { let polling = polling.clone(); move || lock(&polling).missed };
                let next = move || -> $next_item<_> {
                    let (client, polling) = (client.clone(), polling.clone());
                    $($pin)* ($($move)* { client.sample::<R>(&polling) $($await)* })
                };
                Ok(Received { next: Box::new(next), pending: None, missed: Box::new(missed) })
            }

            /// Return the next sample, or the error that ends the samples.
            $($async)* fn sample<R: Request>(
                &self,
                polling: &Mutex<Polling>,
            ) -> Option<Result<Sample<R::Reply>, Error>> {
                loop {
                    let (prepared, wait) = lock(polling).tick()?;
                    $sleep(wait) $($await)* ;
                    let (outcome, unattended) = self.attended(&prepared) $($await)* ;
                    let mut times = outcome.iter().flatten();
                    let times = times.next().map(|each| (each.requested_at, each.replied_at));
                    let (requested_at, replied_at) = times.unwrap_or_default();
                    let value = outcome.and_then(|answer| self.handle.result::<R>(&prepared, answer));
                    let mut polling = lock(polling);
                    polling.ended = matches!(value, Err(Error::LinkError { .. }));
                    // If the caller polled nothing meanwhile, the reply may have come long ago.
                    let is_old = value.is_ok() && unattended > polling.period;
                    if !is_old && (value.is_ok() || polling.ended) {
                        return Some(value.map(|value| Sample { value, requested_at, replied_at }));
                    }
                    polling.missed += 1;
                }
            }

            /// Receive the events of a type from now on, until none arrives within `timeout`.
            pub fn events<E: DeviceEvent>(
                &self,
                timeout: Option<Duration>,
            ) -> Result<Received<$next_item<Result<E, Error>>>, Error> {
                let (client, command) = (self.clone(), self.handle.command(E::COMMAND)?);
                let queue = self.connection().session.subscribe(command);
                let missed = { let queue = queue.clone(); move || lock(&queue).lost };
                let next = move || -> $next_item<_> {
                    let (client, queue) = (client.clone(), queue.clone());
                    let next = move |session: &mut Session, is_over: bool| {
                        let event = lock(&queue).events.pop_front();
                        let event = event.map(|fields| result(fields, (E::FIELDS, false), &[]));
                        let event = event.or_else(|| session.fault.clone().map(Err));
                        event.map(Some).or(is_over.then_some(None))
                    };
                    $($pin)* ($($move)* { client.until(timeout, next) $($await)* })
                };
                Ok(Received { next: Box::new(next), pending: None, missed: Box::new(missed) })
            }
        }
    };
}
pub(crate) use client_methods;
