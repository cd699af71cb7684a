//! A client: its session, the calls that wait, and the queues of its events.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use cobotwire::machine::{CallId, Handle, PersistedState, Prepared, Queue, Session};
use cobotwire::{Error, Limits, OnDrop, Options, RetryPolicy, Value, typed};
use cobotwire_core::exchange::{Answer, Safety};

use crate::{described, index_of, whole, wrong};

/// A call that waits.
struct Caller {
    call: CallId,
    number: i64,
    prepared: Prepared,
    radians: Vec<String>,
}

/// A session that JavaScript drives.
pub struct Client {
    pub url: String,
    pub session: Session,
    handle: Handle,
    callers: Vec<Caller>,
    queues: Vec<Arc<Mutex<Queue>>>,
    calls: i64,
    writing: bool,
}

/// Return the handle of a client with these options.
pub fn handle(edition: typed::Table, given: &[Value]) -> Result<Handle, Error> {
    Handle::new(edition, &options(given)?)
}

impl Client {
    pub fn new(
        edition: typed::Table,
        url: &str,
        given: &[Value],
        left: &PersistedState,
    ) -> Result<Self, Error> {
        let handle = handle(edition, given)?;
        Ok(Self {
            session: Session::new(&handle, Some(url), options(given)?.on_drop, left),
            url: url.into(),
            handle,
            callers: Vec::new(),
            queues: Vec::new(),
            calls: 0,
            writing: false,
        })
    }

    pub fn answer(&mut self, what: &str, given: &[Value]) -> Result<Value, Error> {
        match (what, given) {
            ("address", [Value::Text(address)]) => {
                let found = self.handle.clone().at(address)?.settings.address;
                return Ok(Value::Integer(found.unwrap_or_default().into()));
            }
            ("subscribe", [Value::Text(command)]) => {
                let queue = Queue::new(self.handle.encoder.command(command)?);
                self.session.subscribe(&queue);
                self.queues.push(queue);
                return Ok(whole(self.queues.len() - 1));
            }
            ("event" | "lost", [index]) => {
                let queue = index_of(index).and_then(|index| self.queues.get(index));
                let mut queue = queue.ok_or_else(wrong)?.lock().map_err(|_| wrong())?;
                if what == "lost" {
                    return Ok(Value::Integer(queue.lost as i64));
                }
                let (command, event) = (queue.command, queue.events.pop_front());
                return Ok(event.map_or(Value::Absent, |event| self.fields(command, event, &[])));
            }
            _ => {}
        }
        let [Value::Integer(now), given @ ..] = given else {
            return Err(wrong());
        };
        let now = *now as u64;
        let mut drained = false;
        match (what, given) {
            ("call", given) => return self.call(given, now),
            ("stops", []) => return Ok(Value::Bytes(self.session.stops(now))),
            ("receive", [Value::Bytes(data)]) => self.session.receive(data, now),
            ("wrote", [size]) => {
                self.writing = false;
                self.session.wrote(index_of(size).ok_or_else(wrong)?, now);
            }
            ("give up", [Value::Integer(number)]) => self.give_up(*number, now),
            ("lose", [Value::Text(detail)]) => {
                self.session.fail_write(detail, now);
                self.session.lose(detail, now);
            }
            ("close", []) => drop(self.session.close(now)),
            ("send", []) => drained = true,
            ("step", []) => self.session.receive(&[], now),
            _ => return Err(wrong()),
        }
        Ok(self.step(now, drained))
    }

    /// Queue a request; return its number, under which a step will report how it ended.
    fn call(&mut self, given: &[Value], now: u64) -> Result<Value, Error> {
        let [Value::Text(command), Value::Row(named), Value::Row(radians), address, ack_within, sampled] =
            given
        else {
            return Err(wrong());
        };
        let radians: Vec<String> = radians.iter().filter_map(text_of).map(str::to_owned).collect();
        let mut handle = self.handle.clone();
        if let Some(address) = index_of(address) {
            handle.settings.address = u8::try_from(address).ok();
        }
        handle.settings.ack_within = seconds("acknowledged()", ack_within)?.map(nanos);
        let mut arguments = Vec::new();
        for pair in named.chunks_exact(2) {
            let [Value::Text(name), value] = pair else { return Err(wrong()) };
            let value = value.clone();
            let degrees = radians.contains(name).then(|| value.clone().map(f64::to_degrees));
            arguments.push((&**name, degrees.unwrap_or(value)));
        }
        let prepared = handle.prepare_named(command, &arguments)?;
        if *sampled == Value::Flag(true) {
            let record = handle.encoder.edition.commands.get(prepared.request.command);
            if !prepared.awaits_reply || record.is_none_or(|each| each.safety != Safety::Query) {
                let message = format!("{command} is not a query; a stream can send only queries");
                return Err(Error::UsageError { message });
            }
            handle.settings.retry.attempts = 1;
        }
        let call = self.session.submit(&prepared, &handle.settings, now, now);
        self.calls += 1;
        let number = self.calls;
        self.callers.push(Caller { call, number, prepared, radians });
        Ok(Value::Integer(number))
    }

    fn give_up(&mut self, number: i64, now: u64) {
        if let Some(at) = self.callers.iter().position(|caller| caller.number == number) {
            self.session.give_up(self.callers.swap_remove(at).call, now);
        }
    }

    /// Return the bytes to write, the calls that have ended, and when to go on.
    fn step(&mut self, now: u64, drained: bool) -> Value {
        let mut bytes = Value::Absent;
        if !self.writing {
            let outgoing = self.session.outgoing(now, drained);
            self.writing = !outgoing.is_empty();
            if self.writing {
                bytes = Value::Bytes(outgoing.to_vec());
            }
        }
        let mut ended = Vec::new();
        let waiting = std::mem::take(&mut self.callers);
        for caller in waiting {
            let Some(outcome) = self.session.take(caller.call) else {
                self.callers.push(caller);
                continue;
            };
            let (good, shown) = match outcome {
                Ok(answer) => (true, self.answered(&caller, answer)),
                Err(error) => (false, described(&error)),
            };
            ended.push(Value::Row(vec![Value::Integer(caller.number), Value::Flag(good), shown]));
        }
        let idle = self.session.idle(now).map_or(Value::Absent, |idle| Value::Integer(idle as i64));
        let more = !drained && !self.writing && self.session.has_outgoing(now);
        Value::Row(vec![bytes, Value::Row(ended), idle, Value::Flag(more)])
    }

    fn answered(&self, caller: &Caller, answer: Option<Answer>) -> Value {
        let times = answer.as_ref().map_or((0, 0), |each| (each.requested_at, each.replied_at));
        let fields = self.handle.encoder.fields(&caller.prepared, answer);
        Value::Row(vec![
            self.fields(caller.prepared.request.command, fields, &caller.radians),
            Value::Integer(times.0 as i64),
            Value::Integer(times.1 as i64),
        ])
    }

    /// Return names and values in turn, as JavaScript has them: flags are truth values.
    fn fields(&self, command: usize, fields: Vec<(String, Value)>, radians: &[String]) -> Value {
        let record = self.handle.encoder.edition.commands.get(command);
        let known = || record.into_iter().flat_map(|each| each.reply.iter().flatten());
        let mut row = Vec::new();
        for (name, mut value) in fields {
            if radians.contains(&name) {
                value = value.map(f64::to_radians);
            }
            if known().any(|field| field.name == name && field.kind == "flag") {
                value = flags(value);
            }
            row.extend([Value::Text(name), value]);
        }
        Value::Row(row)
    }
}

fn flags(value: Value) -> Value {
    match value {
        Value::Integer(raw) => Value::Flag(raw != 0),
        Value::Row(row) => Value::Row(row.into_iter().map(flags).collect()),
        other => other,
    }
}

fn options(given: &[Value]) -> Result<Options, Error> {
    let [timeout, deadline, attempts, shortest, grace, address, speed, workspace, leaves] = given else {
        return Err(wrong());
    };
    let usual = RetryPolicy::default();
    let retry = RetryPolicy {
        // Too many attempts are reported as 255.
        attempts: real_of(attempts).map_or(usual.attempts, |attempts| attempts as u8),
        shortest_attempt: seconds("retry.shortestAttempt", shortest)?
            .map_or(usual.shortest_attempt, nanos),
        grace: seconds("retry.grace", grace)?.map_or(usual.grace, nanos),
    };
    let range = |value: Option<&Value>| match value {
        Some(Value::Row(ends)) => Some((real_of(ends.first()?)?, real_of(ends.get(1)?)?)),
        _ => None,
    };
    let workspace = match workspace {
        Value::Row(all) => Some([0, 1, 2].map(|axis| range(all.get(axis)))),
        _ => None,
    };
    Ok(Options {
        timeout: seconds("timeout", timeout)?,
        deadline: seconds("deadline", deadline)?,
        retry,
        address: text_of(address).map(str::to_owned),
        limits: Limits { speed: real_of(speed), workspace },
        on_drop: if *leaves == Value::Flag(true) { OnDrop::Leave } else { OnDrop::Stop },
        ..Options::default()
    })
}

/// Return an argument in seconds as a duration.
fn seconds(argument: &str, value: &Value) -> Result<Option<Duration>, Error> {
    let Some(given) = real_of(value) else { return Ok(None) };
    Duration::try_from_secs_f64(given).map(Some).map_err(|_| {
        let shown = cobotwire_table::Shown::Real(given);
        let allowed = "seconds above 0 and below 3600";
        let message = cobotwire_table::bad_argument(argument, &shown, allowed);
        Error::UsageError { message }
    })
}

fn nanos(time: Duration) -> u64 {
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX / 2)
}

fn real_of(value: &Value) -> Option<f64> {
    match value {
        Value::Integer(whole) => Some(*whole as f64),
        Value::Real(real) => Some(*real),
        _ => None,
    }
}

fn text_of(value: &Value) -> Option<&str> {
    match value {
        Value::Text(text) => Some(text),
        _ => None,
    }
}
