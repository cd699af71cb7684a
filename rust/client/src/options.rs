//! The options of a client.

use std::time::Duration;

use cobotwire_core::exchange::{Nanos, RetryPolicy};
use cobotwire_table::{Edition, bad_argument};

use crate::{Error, Limits, Value};

/// How a client sends requests, and what it does with the arm at its end.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// How long the arm has to reply once a request is sent; default: as the edition says.
    pub timeout: Option<Duration>,
    /// How long a call may take from its beginning, waiting for its turn included; default: any
    /// time.
    pub deadline: Option<Duration>,
    /// How often queries are sent within their timeout; its times are in nanoseconds.
    pub retry: RetryPolicy,
    /// The device that requests go to, by its name or number; default: the edition's first address, if it has any.
    pub address: Option<String>,
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

/// Return the byte of an address, given by its name or number.
pub(crate) fn find_address(edition: &Edition, given: &str) -> Result<u8, Error> {
    let mut known = edition.protocol.addresses.iter();
    let named = known.find(|known| known.name.eq_ignore_ascii_case(given));
    let number: Result<i64, _> = given.parse();
    let all = &edition.protocol.table.frame().addresses;
    let mut numbered = all.iter().copied();
    let numbered = numbered.find(|raw| number == Ok(i64::from(*raw)));
    let found = named.map(|known| known.value).or(numbered);
    let shown = number.map_or_else(|_| Value::Text(given.to_owned()), Value::Integer);
    found.ok_or_else(|| Error::usage(edition.no_address(&shown)))
}

impl Options {
    /// Return the options of a client that opens this port itself.
    pub(crate) fn named(self, port: &str) -> Self {
        let port_name = Some(port.to_owned());
        Self { port_name, ..self }
    }
}

/// Check what Python checks, with the same texts.
pub(crate) fn check_times(options: &Options) -> Result<(), Error> {
    let (retry, above) = (options.retry, "seconds above 0 and below 3600");
    let (least, time) = (Duration::from_nanos(1), Duration::from_nanos);
    let (from, shortest) = ("seconds from 0 to below 3600", time(retry.shortest_attempt));
    for (argument, time, allowed) in [
        ("timeout", options.timeout.unwrap_or(least), above),
        ("retry.shortest_attempt", shortest, above),
        ("retry.grace", time(retry.grace).max(least), from),
    ] {
        if time.is_zero() || time.as_secs() >= 3600 {
            let given = Value::Real(time.as_secs_f64());
            return Err(Error::usage(bad_argument(argument, &given, allowed)));
        }
    }
    if !(1..=100).contains(&retry.attempts) {
        let given = Value::Integer(retry.attempts.into());
        let text = bad_argument("retry.attempts", &given, "a whole number 1..100");
        return Err(Error::usage(text));
    }
    Ok(())
}

pub(crate) fn nanos(time: Duration) -> Nanos {
    // Three hundred years are no limit.
    Nanos::try_from(time.as_nanos())
        .unwrap_or(Nanos::MAX / 2)
        .min(Nanos::MAX / 2)
}
