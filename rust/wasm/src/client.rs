//! A client: its session, its calls that have not ended, and the queues of its events.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use cobotwire::machine::{CallId, Handle, Named, PersistedState, Prepared, Queue, Session};
use cobotwire::{Error, Limits, OnDrop, Options, RetryPolicy, Value, typed};
use cobotwire_core::exchange::{Answer, Safety};

use crate::{described, number, whole, wrong};

/// A call that has not ended.
struct Caller {
    call: CallId,
    number: i64,
    prepared: Prepared,
}

/// A session that JavaScript drives.
pub struct Client {
    pub url: String,
    /// Once this client is closed: the state for the next client on the port, and the error of
    /// further calls. `None`: it is open.
    pub ended: Option<(PersistedState, Error)>,
    session: Session,
    handle: Handle,
    callers: Vec<Caller>,
    queues: Vec<Arc<Mutex<Queue>>>,
    calls: i64,
}

impl Client {
    pub fn new(
        edition: typed::Table,
        url: &str,
        given: &[Value],
        left: &PersistedState,
    ) -> Result<Self, Error> {
        let handle = Handle::new(edition, options(given, url)?)?;
        Ok(Self {
            url: url.to_owned(),
            ended: None,
            session: Session::new(&handle, left),
            handle,
            callers: Vec::new(),
            queues: Vec::new(),
            calls: 0,
        })
    }

    pub fn answer(&mut self, what: &str, given: &[Value]) -> Result<Value, Error> {
        match (what, given) {
            ("address", [Value::Text(address)]) => {
                let address = self.handle.clone().at(address)?.address;
                Ok(Value::Integer(address.unwrap_or_default().into()))
            }
            ("prepare", given) => {
                let encoded = self.prepare(given)?.1.request;
                Ok(Value::Bytes([encoded.frame, encoded.text].concat()))
            }
            ("subscribe", [Value::Text(command)]) => {
                let command = self.handle.command(command)?;
                self.queues.push(self.session.subscribe(command));
                Ok(whole(self.queues.len() - 1))
            }
            ("event" | "lost", [index]) => {
                let queue = number(index).and_then(|index| self.queues.get(index));
                let mut queue = queue.ok_or_else(wrong)?.lock().map_err(|_| wrong())?;
                Ok(match what {
                    "event" => queue.events.pop_front().map_or(Value::Absent, flat),
                    _ => Value::Integer(queue.lost as i64),
                })
            }
            (
                _,
                [
                    Value::Integer(now),
                    Value::Flag(free),
                    Value::Flag(drained),
                    given @ ..,
                ],
            ) => self.step(*now as u64, free.then_some(*drained), what, given),
            _ => Err(wrong()),
        }
    }

    /// Handle an event at the time `now`; return the bytes to write, the calls that have ended, the
    /// time until the next deadline, and the number of a new call. `drained`: whether all bytes
    /// that have arrived were received, or `None` if the transport cannot take bytes now.
    fn step(
        &mut self,
        now: u64,
        drained: Option<bool>,
        what: &str,
        given: &[Value],
    ) -> Result<Value, Error> {
        let mut call = Value::Absent;
        match (what, given) {
            ("call", given) => call = self.call(given, now)?,
            ("stops", []) => return Ok(Value::Bytes(self.session.stops(now))),
            ("receive", [Value::Bytes(data)]) => self.session.receive(data, now),
            ("give up", [Value::Integer(number)]) => {
                let mut callers = self.callers.iter();
                if let Some(at) = callers.position(|caller| caller.number == *number) {
                    self.session.give_up(self.callers.swap_remove(at).call);
                }
            }
            ("lose", [Value::Text(detail)]) => {
                let fault = self.session.lose(detail, now);
                self.ended = Some((self.session.persist(now), fault));
            }
            ("close", []) => {
                let state = self.session.close(now);
                self.ended = self.session.fault.clone().map(|fault| (state, fault));
            }
            ("step", []) => self.session.receive(&[], now),
            _ => return Err(wrong()),
        }
        let mut bytes = Value::Absent;
        if let Some(drained) = drained {
            let outgoing = self.session.outgoing(now, drained).to_vec();
            // JavaScript either writes all of these bytes, or reports that the transport is lost.
            self.session.wrote(outgoing.len(), now);
            bytes = Some(outgoing)
                .filter(|outgoing| !outgoing.is_empty())
                .map_or(bytes, Value::Bytes);
        }
        let cut = what == "lose" && drained.is_none();
        let ended = self.ended_calls(cut);
        let idle = self.session.idle(now);
        let idle = idle.map_or(Value::Absent, |idle| Value::Integer(idle as i64));
        Ok(Value::Row(vec![bytes, Value::Row(ended), idle, call]))
    }

    /// Check and encode a request; return it with the settings of its call.
    fn prepare(&self, given: &[Value]) -> Result<(Handle, Prepared), Error> {
        let [Value::Text(command), Value::Row(named), address, within, ..] = given else {
            return Err(wrong());
        };
        let mut handle = self.handle.clone();
        if let Some(address) = number(address) {
            handle.address = u8::try_from(address).ok();
        }
        handle.ack_within = positive("seconds", within)?.map(nanos);
        let pairs = named.chunks_exact(2).filter_map(|pair| match pair {
            [Value::Text(name), value] => Some((&**name, value.clone())),
            _ => None,
        });
        let arguments: Vec<_> = pairs.collect();
        let prepared = handle.prepare_named(command, &arguments)?;
        Ok((handle, prepared))
    }

    /// Submit a request. Return its number: a later step reports under it how the call ended.
    fn call(&mut self, given: &[Value], now: u64) -> Result<Value, Error> {
        let (mut handle, prepared) = self.prepare(given)?;
        let [Value::Text(command), .., sampled] = given else {
            return Err(wrong());
        };
        if *sampled == Value::Flag(true) {
            let commands = &handle.edition.commands;
            let safety = commands
                .get(prepared.request.command)
                .map(|each| each.safety);
            if !prepared.awaits_reply || safety != Some(Safety::Query) {
                let message = format!("{command} is not a query; a stream can send only queries");
                return Err(Error::UsageError { message });
            }
            handle.options.retry.attempts = 1;
        }
        self.calls += 1;
        self.callers.push(Caller {
            call: self.session.submit(&prepared, &handle, now, now),
            number: self.calls,
            prepared,
        });
        Ok(Value::Integer(self.calls))
    }

    /// Return the calls that have ended: the number of each, whether it succeeded, and its answer
    /// or error. `cut`: the transport was lost during a write, so it is unknown how many bytes were
    /// written.
    fn ended_calls(&mut self, cut: bool) -> Vec<Value> {
        let mut ended = Vec::new();
        for caller in std::mem::take(&mut self.callers) {
            match self.session.take(caller.call) {
                None => self.callers.push(caller),
                Some(mut outcome) => {
                    if let Err(Error::LinkError { written, .. }) = &mut outcome {
                        *written = written.filter(|written| !cut || *written == 0);
                    }
                    let good = Value::Flag(outcome.is_ok());
                    let answer = outcome.map(|answer| self.answered(&caller, answer));
                    let answer = answer.unwrap_or_else(|error| described(&error));
                    ended.push(Value::Row(vec![
                        Value::Integer(caller.number),
                        good,
                        answer,
                    ]));
                }
            }
        }
        ended
    }

    /// Return the fields of a reply, and the times of request and reply.
    fn answered(&self, caller: &Caller, answer: Option<Answer>) -> Value {
        let times = answer
            .as_ref()
            .map(|each| [each.requested_at, each.replied_at]);
        let fields = self.handle.fields(&caller.prepared, answer);
        let mut row = vec![flat(fields)];
        row.extend(
            times
                .into_iter()
                .flatten()
                .map(|time| Value::Integer(time as i64)),
        );
        Value::Row(row)
    }
}

/// Return a row in which names and values alternate.
pub fn flat(fields: Named) -> Value {
    let each = fields.into_iter();
    Value::Row(
        each.flat_map(|(name, value)| [Value::Text(name), value])
            .collect(),
    )
}

fn options(given: &[Value], url: &str) -> Result<Options, Error> {
    let [
        timeout,
        deadline,
        attempts,
        shortest,
        grace,
        address,
        speed,
        workspace,
        on_error,
    ] = given
    else {
        return Err(wrong());
    };
    let usual = RetryPolicy::default();
    let count = |given: &Value| u8::try_from(number(given)?).ok();
    let attempts = read("retry.attempts", attempts, "a whole number 1..100", count)?;
    let leaves = |given: &Value| match given {
        Value::Text(word) if word == "stop" => Some(OnDrop::Stop),
        Value::Text(word) if word == "leave" => Some(OnDrop::Leave),
        _ => None,
    };
    let ranges = "three ranges for x, y and z: each [lowest, highest], or undefined";
    Ok(Options {
        timeout: positive("timeout", timeout)?,
        deadline: positive("deadline", deadline)?,
        retry: RetryPolicy {
            attempts: attempts.unwrap_or(usual.attempts),
            shortest_attempt: positive("retry.shortestAttempt", shortest)?
                .map_or(usual.shortest_attempt, nanos),
            grace: seconds("retry.grace", grace, "seconds from 0 to below 3600")?
                .map_or(usual.grace, nanos),
        },
        address: match address {
            Value::Text(address) => Some(address.clone()),
            _ => None,
        },
        limits: Limits {
            speed: read("limits.speed", speed, "a number 1..100", real)?,
            workspace: read("limits.workspace", workspace, ranges, box_of)?,
        },
        on_drop: read("onError", on_error, "stop or leave", leaves)?.unwrap_or_default(),
        port_name: Some(url.to_owned()),
        ..Options::default()
    })
}

/// Convert an option; `None`: it was omitted. A value that cannot be converted is an error.
fn read<T>(
    argument: &str,
    value: &Value,
    allowed: &str,
    meaning: impl Fn(&Value) -> Option<T>,
) -> Result<Option<T>, Error> {
    let given = Some(value).filter(|value| **value != Value::Absent);
    let meant = given.map(|value| meaning(value).ok_or(value)).transpose();
    meant.map_err(|value| Error::UsageError {
        message: cobotwire_table::bad_argument(argument, value, allowed),
    })
}

fn box_of(value: &Value) -> Option<[Option<(f64, f64)>; 3]> {
    let range = |value: &Value| match value {
        Value::Absent => Some(None),
        Value::Row(ends) => match &**ends {
            [low, high] => Some(Some((real(low)?, real(high)?))),
            _ => None,
        },
        _ => None,
    };
    match value {
        Value::Row(axes) => match &**axes {
            [x, y, z] => Some([range(x)?, range(y)?, range(z)?]),
            _ => None,
        },
        _ => None,
    }
}

/// Return an argument in seconds as a duration, which may be 0.
fn seconds(argument: &str, value: &Value, allowed: &str) -> Result<Option<Duration>, Error> {
    read(argument, value, allowed, |given| {
        let time = Duration::try_from_secs_f64(real(given)?).ok();
        time.filter(|time| time.as_secs() < 3600)
    })
}

fn positive(argument: &str, value: &Value) -> Result<Option<Duration>, Error> {
    let allowed = "seconds above 0 and below 3600";
    let time = seconds(argument, value, allowed)?;
    read(argument, value, allowed, |_| {
        time.filter(|time| !time.is_zero())
    })
}

fn nanos(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX / 2)
}

fn real(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(whole) => Some(*whole as f64),
        Value::Real(real) => Some(*real),
        _ => None,
    }
}
