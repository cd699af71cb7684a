//! The options of a client.

use std::time::Duration;

use cobotwire_core::exchange::{Nanos, RetryPolicy};
use cobotwire_table::bad_argument;

use crate::{Error, Limits, Value};

/// How a client sends requests, and what it does with the arm at its end.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// How long the arm has to reply once a request is sent; default: the timeout of the edition.
    pub timeout: Option<Duration>,
    /// How long a call may take from its beginning, waiting for its turn included; default:
    /// no limit.
    pub deadline: Option<Duration>,
    /// How often queries are sent within their timeout; its times are in nanoseconds.
    pub retry: RetryPolicy,
    /// The device that requests go to, by its name or number; default: the edition's first address,
    /// if it has any.
    pub address: Option<String>,
    /// The name of the port that is passed to `over()`. A client knows which late replies to an
    /// earlier client of this process may still come, if both were opened at a port of this name.
    pub port_name: Option<String>,
    /// The rate of a serial port in bits a second; default: that of the edition.
    pub baudrate: Option<u32>,
    /// The highest speed of the arm, and where its end may go.
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

const SECONDS: &str = "seconds above 0 and below 3600";

/// Return a time in seconds, and whether it is above 0 and below 3600 seconds.
fn seconds(time: Duration) -> (Value, bool) {
    let fits = !time.is_zero() && time.as_secs() < 3600;
    (Value::Real(time.as_secs_f64()), fits)
}

/// Check how long a call waits for an acknowledgement.
pub(crate) fn check_ack_within(time: Duration) -> Result<(), Error> {
    match seconds(time) {
        (_, true) => Ok(()),
        (given, false) => Err(Error::usage(bad_argument("ack_within", &given, SECONDS))),
    }
}

/// Check what Python checks, with the same error messages.
pub(crate) fn check_times(options: &Options) -> Result<(), Error> {
    let (retry, least, time) = (options.retry, Duration::from_nanos(1), Duration::from_nanos);
    let timeout = seconds(options.timeout.unwrap_or(least));
    let deadline = seconds(options.deadline.unwrap_or(least));
    let shortest = seconds(time(retry.shortest_attempt));
    let grace = seconds(time(retry.grace).max(least));
    let fits = (1..=100).contains(&retry.attempts);
    let attempts = (Value::Integer(retry.attempts.into()), fits);
    let all = [
        ("timeout", timeout, SECONDS),
        ("deadline", deadline, SECONDS),
        ("retry.shortest_attempt", shortest, SECONDS),
        ("retry.grace", grace, "seconds from 0 to below 3600"),
        ("retry.attempts", attempts, "a whole number 1..100"),
    ];
    match all.into_iter().find(|(_, (_, fits), _)| !fits) {
        None => Ok(()),
        Some((name, (given, _), allowed)) => Err(Error::usage(bad_argument(name, &given, allowed))),
    }
}

pub(crate) fn nanos(time: Duration) -> Nanos {
    // The largest time is 292 years, which limits nothing.
    time.as_nanos().min(u128::from(Nanos::MAX / 2)) as Nanos
}
