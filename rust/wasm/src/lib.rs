//! The session of the crate `cobotwire` for JavaScript, which owns transports and timers.
//!
//! A message is a row of values: the name of a function, its arguments. The answer is a row, too:
//! whether it is good, then the result, or the error: its kind, its text, and what else it knows.
//! `clients/typescript/src` is the other end; times are nanoseconds of its clock.

mod client;
mod codec;
mod message;

use std::cell::RefCell;
use std::collections::HashMap;

use cobotwire::machine::PersistedState;
use cobotwire::{Error, Value, typed};

use client::Client;

thread_local! {
    static MESSAGE: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static MACHINE: RefCell<Machine> = RefCell::default();
}

/// Return where a message of that size is to be written, and where the answer is.
#[unsafe(no_mangle)]
pub extern "C" fn room(size: usize) -> *mut u8 {
    MESSAGE.with_borrow_mut(|message| {
        message.resize(size, 0);
        message.as_mut_ptr()
    })
}

/// Answer the message, and return the size of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> usize {
    MESSAGE.with_borrow_mut(|message| {
        let given = message::read(&mut &**message);
        let outcome = match given {
            Some(Value::Row(given)) => MACHINE.with_borrow_mut(|machine| machine.answer(&given)),
            _ => Err(wrong()),
        };
        let (good, result) = outcome.map_or_else(
            |error| (false, described(&error)),
            |result| (true, result),
        );
        message.clear();
        message::write(&Value::Row(vec![Value::Flag(good), result]), message);
        message.len()
    })
}

#[derive(Default)]
struct Machine {
    editions: Vec<typed::Table>,
    clients: Vec<Option<Client>>,
    /// What clients have left on their ports, for the next ones.
    left: HashMap<String, PersistedState>,
}

impl Machine {
    fn answer(&mut self, given: &[Value]) -> Result<Value, Error> {
        let [Value::Text(what), given @ ..] = given else {
            return Err(wrong());
        };
        match (&**what, given) {
            ("edition", [Value::Text(json)]) => {
                let edition = cobotwire::read_table(json.as_bytes())?;
                let baudrate = edition.baudrate;
                self.editions.push(edition);
                Ok(Value::Row(vec![
                    whole(self.editions.len() - 1),
                    Value::Integer(baudrate.into()),
                ]))
            }
            ("check", [index, options @ ..]) => {
                client::handle(self.edition(index)?, options).map(|_| Value::Absent)
            }
            ("open", [index, Value::Text(url), _, options @ ..]) => {
                let edition = self.edition(index)?;
                let left = self.left.remove(url).unwrap_or_default();
                self.clients
                    .push(Some(Client::new(edition, url, options, &left)?));
                Ok(whole(self.clients.len() - 1))
            }
            ("encode" | "decode" | "frames", [index, given @ ..]) => {
                codec::answer(&*self.edition(index)?, what, given).ok_or_else(wrong)
            }
            (_, [index, given @ ..]) => {
                let client = index_of(index).and_then(|index| self.clients.get_mut(index));
                let slot = client.ok_or_else(wrong)?;
                let client = slot.as_mut().ok_or_else(wrong)?;
                let step = client.answer(what, given)?;
                if let ("close" | "lose", [Value::Integer(now), ..]) = (&**what, given) {
                    self.left.insert(client.url.clone(), client.session.persist(*now as u64));
                    *slot = None;
                }
                Ok(step)
            }
            _ => Err(wrong()),
        }
    }

    fn edition(&self, index: &Value) -> Result<typed::Table, Error> {
        let found = index_of(index).and_then(|index| self.editions.get(index));
        found.cloned().ok_or_else(wrong)
    }
}

/// The error of a message that the JavaScript of this package never sends.
fn wrong() -> Error {
    Error::UsageError { message: "the message is wrong".into() }
}

fn index_of(value: &Value) -> Option<usize> {
    match value {
        Value::Integer(index) => usize::try_from(*index).ok(),
        _ => None,
    }
}

fn whole(number: usize) -> Value {
    Value::Integer(number as i64)
}

/// Return an error as a row: its kind, its text, and what else it knows.
fn described(error: &Error) -> Value {
    let mut row = vec![Value::Text(error.name().into()), Value::Text(error.to_string())];
    match error {
        Error::LinkError { written, .. } => row.push(written.map_or(Value::Absent, whole)),
        Error::ReplyTimeout { waited, attempts, waited_for, .. } => {
            row.push(Value::Real(waited.as_secs_f64()));
            row.push(whole(*attempts));
            row.push(Value::Text(waited_for.map_or("", |reason| reason.word()).into()));
        }
        Error::ProtocolError { data, .. } => row.push(Value::Bytes(data.clone())),
        _ => {}
    }
    Value::Row(row)
}
