//! The options of a client.

use std::time::Duration;

use cobotwire_core::exchange::{Nanos, RetryPolicy as Policy};
use cobotwire_table::{Edition, Shown, bad_argument};

use crate::{Error, Limits};

/// How a client sends requests, and what it does with the arm at its end.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// How long the arm has to reply once a request is sent; default: as the edition says.
    pub timeout: Option<Duration>,
    /// How long a call may take from its beginning, waiting for its turn included; default: any
    /// time.
    pub deadline: Option<Duration>,
    /// How often queries are sent within their timeout.
    pub retry: RetryPolicy,
    /// The device that requests go to; default: the edition's first address, if it has any.
    pub address: Option<Address>,
    /// The name of the port that is passed to `over()`. A client knows which late replies to an
    /// earlier client of this process may still come, if both were opened at a port of this name.
    pub port_name: Option<String>,
    /// The rate of a serial port in bits a second; default: that of the edition.
    pub baudrate: Option<u32>,
    /// How fast the arm may be sent, and where.
    pub limits: Limits,
    /// What happens to an arm in motion when the client is dropped without `close()`.
    pub on_drop: OnDrop,
}

/// What happens to an arm when its client is dropped without `close()`: by `?`, a panic, or the end
/// of the program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OnDrop {
    /// `stop` is sent once to each device that this client has set in motion.
    #[default]
    Stop,
    /// Nothing is sent.
    Leave,
}

/// Splits the timeout of a query into attempts. Only queries are ever sent again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RetryPolicy {
    /// How often a query is sent at most, 1..100.
    pub attempts: u8,
    /// What each attempt gets at least; a short timeout has fewer attempts.
    pub shortest_attempt: Duration,
    /// For how long after an attempt its late reply is still expected. A later request with a reply
    /// that would look the same is held until then.
    pub grace: Duration,
}

impl Default for RetryPolicy {
    fn default() -> Self {
        let usual = Policy::default();
        Self {
            attempts: usual.attempts,
            shortest_attempt: Duration::from_nanos(usual.shortest_attempt),
            grace: Duration::from_nanos(usual.grace),
        }
    }
}

impl RetryPolicy {
    fn checked(&self) -> Result<Policy, Error> {
        if !(1..=100).contains(&self.attempts) {
            let given = Shown::Integer(i64::from(self.attempts));
            let text = bad_argument("retry.attempts", &given, "a whole number 1..100");
            return Err(Error::usage(text));
        }
        Ok(Policy {
            attempts: self.attempts,
            shortest_attempt: nanos(self.shortest_attempt).max(1),
            grace: nanos(self.grace),
        })
    }
}

/// The address of a device, by its number or its name in the edition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Address {
    /// The byte.
    Number(u8),
    /// The name.
    Name(String),
}

impl From<u8> for Address {
    fn from(number: u8) -> Self {
        Self::Number(number)
    }
}

impl From<&str> for Address {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl Address {
    pub(crate) fn find(&self, edition: &Edition) -> Result<u8, Error> {
        let (found, given) = match self {
            Self::Number(number) => {
                let known = &edition.protocol.table.frame().addresses;
                (
                    known.contains(number).then_some(*number),
                    Shown::Integer((*number).into()),
                )
            }
            Self::Name(name) => {
                let mut known = edition.addresses.iter();
                let found = known.find(|known| known.name.eq_ignore_ascii_case(name));
                (found.map(|known| known.value), Shown::Text(name.clone()))
            }
        };
        found.ok_or_else(|| {
            let known = edition.addresses.iter();
            let names = known.map(|known| format!("{} ({})", known.name, known.value));
            let names = names.collect::<Vec<_>>().join(", ");
            match (self, names.is_empty()) {
                (Self::Number(number), _) => Error::usage(edition.no_address(Some(*number))),
                (_, true) => Error::usage(edition.no_address(None)),
                _ => Error::usage(bad_argument("address", &given, &names)),
            }
        })
    }
}

/// What a handle of a client sends each request with.
#[derive(Clone, Debug)]
pub(crate) struct Settings {
    pub address: Option<u8>,
    pub timeout: Option<Nanos>,
    pub deadline: Option<Nanos>,
    pub ack_within: Option<Nanos>,
    pub retry: Policy,
}

impl Settings {
    pub fn new(edition: &Edition, options: &Options) -> Result<Self, Error> {
        let address = options.address.as_ref();
        Ok(Self {
            address: address.map(|address| address.find(edition)).transpose()?,
            timeout: options.timeout.map(nanos),
            deadline: options.deadline.map(nanos),
            ack_within: None,
            retry: options.retry.checked()?,
        })
    }
}

pub(crate) fn nanos(time: Duration) -> Nanos {
    // Three hundred years are no limit.
    Nanos::try_from(time.as_nanos())
        .unwrap_or(Nanos::MAX / 2)
        .min(Nanos::MAX / 2)
}
