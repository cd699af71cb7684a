//! The session of the crate `cobotwire` for JavaScript, which owns transports and timers.
//!
//! JavaScript calls a function by a message, a serialized row of values: the function's name and
//! its arguments. The answer is also a row: whether the call succeeded, then the result or the
//! error (its kind, its text, and further values of that kind). `clients/typescript/src` is the
//! other end; times are nanoseconds of its clock.

mod client;
mod codec;
mod message;

use std::cell::RefCell;
use std::collections::HashMap;

use cobotwire::machine::{Handle, PersistedState};
use cobotwire::{Error, Options, Value};

use client::Client;

thread_local! {
    static MESSAGE: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static ANSWER: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static MACHINE: RefCell<Machine> = RefCell::default();
}

/// Return the address at which JavaScript can write a message of this size.
#[unsafe(no_mangle)]
pub extern "C" fn room(size: usize) -> *mut u8 {
    MESSAGE.with_borrow_mut(|message| {
        message.resize(size.max(message.len()), 0);
        message.as_mut_ptr()
    })
}

/// Run the message of this size that JavaScript wrote; return the address of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer(size: usize) -> *const u8 {
    let given = MESSAGE.with_borrow(|message| message::read(&mut message.get(..size)?));
    let outcome = MACHINE.with_borrow_mut(|machine| machine.answer(&row(given)?));
    let good = Value::Flag(outcome.is_ok());
    let result = outcome.unwrap_or_else(|error| described(&error));
    ANSWER.with_borrow_mut(|answer| {
        answer.clear();
        message::write(&Value::Row(vec![good, result]), answer);
        answer.as_ptr()
    })
}

#[derive(Default)]
struct Machine {
    editions: Vec<Handle>,
    /// Each client, or why it has ended.
    clients: Vec<Result<Client, Error>>,
    /// For each port, the state for its next client.
    left: HashMap<String, PersistedState>,
}

impl Machine {
    fn answer(&mut self, given: &[Value]) -> Result<Value, Error> {
        match given {
            [Value::Text(what), Value::Text(json)] if what == "edition" => {
                let edition = cobotwire::read_table(json.as_bytes())?;
                let baudrate = Value::Integer(edition.baudrate.into());
                self.editions
                    .push(Handle::new(edition, Options::default())?);
                Ok(Value::Row(vec![whole(self.editions.len() - 1), baudrate]))
            }
            [Value::Text(what), index, Value::Text(url), given @ ..] if what == "open" => {
                let edition = self.edition(index)?.edition.clone();
                let (left, none) = (self.left.get(url), PersistedState::default());
                let client = Client::new(edition, url, given, left.unwrap_or(&none))?;
                self.left.remove(url);
                self.clients.push(Ok(client));
                Ok(whole(self.clients.len() - 1))
            }
            [Value::Text(what), index, given @ ..] if codec::FUNCTIONS.contains(&&**what) => {
                codec::answer(self.edition(index)?, what, given).ok_or_else(wrong)
            }
            [Value::Text(what), index, given @ ..] => {
                let slot = number(index).and_then(|index| self.clients.get_mut(index));
                let slot = slot.ok_or_else(wrong)?;
                let client = slot.as_mut().map_err(|error| error.clone())?;
                let answer = client.answer(what, given)?;
                if let Some((state, fault)) = client.ended.take() {
                    self.left.insert(client.url.clone(), state);
                    *slot = Err(fault);
                }
                Ok(answer)
            }
            _ => Err(wrong()),
        }
    }

    fn edition(&self, index: &Value) -> Result<&Handle, Error> {
        let found = number(index).and_then(|index| self.editions.get(index));
        found.ok_or_else(wrong)
    }
}

/// Return the error of a message that the JavaScript of the package never sends.
fn wrong() -> Error {
    let message = "the message is wrong".to_owned();
    Error::UsageError { message }
}

fn row(value: Option<Value>) -> Result<Vec<Value>, Error> {
    match value {
        Some(Value::Row(row)) => Ok(row),
        _ => Err(wrong()),
    }
}

fn number(value: &Value) -> Option<usize> {
    match value {
        Value::Integer(number) => usize::try_from(*number).ok(),
        _ => None,
    }
}

fn whole(number: usize) -> Value {
    Value::Integer(number as i64)
}

/// Return an error as a row: its kind, its text, and further values of that kind.
fn described(error: &Error) -> Value {
    let mut row = vec![
        Value::Text(error.name().to_owned()),
        Value::Text(error.to_string()),
    ];
    match error {
        Error::LinkError { written, .. } => row.push(written.map_or(Value::Absent, whole)),
        Error::ReplyTimeout {
            waited,
            attempts,
            waited_for,
            ..
        } => {
            let waited_for = waited_for.map_or(String::new(), |each| format!("{each:?}"));
            row.push(Value::Real(waited.as_secs_f64()));
            row.push(whole(*attempts));
            row.push(Value::Text(waited_for.to_lowercase()));
        }
        Error::ProtocolError { data, .. } => row.push(Value::Bytes(data.clone())),
        _ => {}
    }
    Value::Row(row)
}
