//! A client at the other end of a pipe: calls come in and their results go out, one JSON object a
//! line. Every write is reported with its times, by the monotonic clock of the machine.
//!
//! `tests/probe_client.py` is the other end.

use std::collections::BTreeMap;
use std::io::{self, BufRead, Read, Write};
use std::net::TcpStream;
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::thread::{sleep, spawn};
use std::time::Duration;

use cobotwire::{AsyncClient, Client, Error, Options, Port, RetryPolicy, Value, typed};
use rustix::time::{ClockId, clock_gettime};
use serde_json::{Map, Value as Json, json};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::unix::pipe;
use tokio::runtime::Runtime;
use tokio::task::AbortHandle;

use crate::values::hex;

/// How often a write that is held back looks whether it may begin.
const PERIOD: Duration = Duration::from_micros(500);

type Named = Vec<(String, Value)>;
type Outcome = Result<Named, Error>;

#[derive(Clone)]
enum Arm {
    Threads(Client),
    Tasks(AsyncClient),
}

struct Probe {
    edition: typed::Table,
    url: String,
    given: Json,
    runtime: Runtime,
    /// Whether no write may begin; locked while one is under way.
    held: Arc<Mutex<bool>>,
    arm: Option<Arm>,
    tasks: BTreeMap<u64, AbortHandle>,
}

/// Serve a client of the edition in `arguments`, on a URL, with options as JSON.
///
/// Options are those of a client in seconds, `tasks` for the asynchronous one, and `small` for the
/// smallest buffer of a socket.
pub fn serve(mut arguments: impl Iterator<Item = String>) -> io::Result<()> {
    let mut next = || arguments.next().ok_or(io::ErrorKind::InvalidInput);
    let edition = typed::Table::clone(
        &cobotwire::read_table(&std::fs::read(next()?)?).map_err(io::Error::other)?,
    );
    let (url, given) = (next()?, serde_json::from_str(&next()?)?);
    let mut probe = Probe {
        edition,
        url,
        given,
        runtime: Runtime::new()?,
        held: Arc::default(),
        arm: None,
        tasks: BTreeMap::new(),
    };
    for line in io::stdin().lock().lines() {
        probe.obey(&serde_json::from_str(&line?)?);
    }
    Ok(())
}

impl Probe {
    fn obey(&mut self, line: &Json) {
        let id = line.get("id").and_then(Json::as_u64).unwrap_or_default();
        if let Some(id) = line.get("give_up").and_then(Json::as_u64) {
            self.tasks.remove(&id).inspect(AbortHandle::abort);
        } else if let Some(name) = line.get("call").and_then(Json::as_str) {
            self.call(id, name, line);
        } else if let Some(held) = line.get("hold").and_then(Json::as_bool) {
            *lock(&self.held) = held;
            say(id, json!({}));
        } else if line.get("open").is_some() {
            say(id, self.open().map_or_else(|error| failed(&error), |()| json!({})));
        } else if let Some(arm) = self.arm.clone() {
            let runtime = self.runtime.handle().clone();
            // A write that is held back has the connection until a further line releases it.
            spawn(move || {
                match arm {
                    Arm::Threads(client) => client.close(),
                    Arm::Tasks(client) => runtime.block_on(client.close()),
                }
                say(id, json!({}));
            });
        }
    }

    fn open(&mut self) -> Result<(), Error> {
        let _entered = self.runtime.enter();
        let (edition, options) = (self.edition.clone(), self.options());
        let socket = self.url.strip_prefix("socket://");
        let tasks = self.given.get("tasks").and_then(Json::as_bool) == Some(true);
        self.arm = Some(match (socket, tasks) {
            (Some(address), false) => {
                let port = self.observed(self.connect(address).map_err(link)?);
                Arm::Threads(Client::over(edition, port, options)?)
            }
            (None, false) => {
                let port = serialport::new(&self.url, edition.baudrate).open();
                let port = self.observed(port.map_err(|error| link(error.into()))?);
                Arm::Threads(Client::over(edition, port, options)?)
            }
            (Some(address), true) => {
                let stream = self.connect(address).and_then(|stream| {
                    stream.set_nonblocking(true)?;
                    tokio::net::TcpStream::from_std(stream)
                });
                let stream = self.observed(stream.map_err(link)?);
                Arm::Tasks(AsyncClient::over(edition, stream, options)?)
            }
            (None, true) => {
                let stream = self.observed(terminal(&self.url).map_err(link)?);
                Arm::Tasks(AsyncClient::over(edition, stream, options)?)
            }
        });
        Ok(())
    }

    fn options(&self) -> Options {
        let number = |name| self.given.get(name).and_then(Json::as_f64);
        let seconds = |name| number(name).map(Duration::from_secs_f64);
        let usual = RetryPolicy::default();
        Options {
            timeout: seconds("timeout"),
            deadline: seconds("deadline"),
            retry: RetryPolicy {
                attempts: number("attempts").map_or(usual.attempts, |attempts| attempts as u8),
                shortest_attempt: seconds("shortest_attempt").unwrap_or(usual.shortest_attempt),
                grace: seconds("grace").unwrap_or(usual.grace),
            },
            port_name: Some(self.url.clone()),
            ..Options::default()
        }
    }

    fn connect(&self, address: &str) -> io::Result<TcpStream> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        if self.given.get("small").and_then(Json::as_bool) == Some(true) {
            rustix::net::sockopt::set_socket_send_buffer_size(&stream, 1024)?;
        }
        Ok(stream)
    }

    fn observed<P>(&self, port: P) -> Observed<P> {
        let held = self.held.clone();
        Observed { port, held }
    }

    fn call(&mut self, id: u64, name: &str, line: &Json) {
        let within = line.get("ack_within").and_then(Json::as_f64).map(Duration::from_secs_f64);
        let fields = line.get("fields").and_then(Json::as_object).map(named).unwrap_or_default();
        let name = name.to_owned();
        match self.arm.clone() {
            None => {}
            Some(Arm::Threads(mut client)) => {
                spawn(move || {
                    let began = now();
                    client = within.map_or(client.clone(), |within| client.acknowledged(within));
                    answer(id, began, client.call_named(&name, &borrowed(&fields)));
                });
            }
            Some(Arm::Tasks(mut client)) => {
                let task = self.runtime.spawn(async move {
                    let began = now();
                    client = within.map_or(client.clone(), |within| client.acknowledged(within));
                    answer(id, began, client.call_named(&name, &borrowed(&fields)).await);
                });
                self.tasks.insert(id, task.abort_handle());
                self.runtime.spawn(async move {
                    if let Err(error) = task.await {
                        let name = if error.is_cancelled() { "Cancelled" } else { "Panic" };
                        say(id, json!({"error": name, "text": error.to_string()}));
                    }
                });
            }
        }
    }
}

/// A terminal of which both directions are ready or not by themselves, as those of a pipe.
fn terminal(path: &str) -> io::Result<impl AsyncRead + AsyncWrite + Send + Unpin + use<>> {
    let file = std::fs::File::options().read(true).write(true).open(path)?;
    rustix::io::ioctl_fionbio(&file, true)?;
    let reader = pipe::Receiver::from_file_unchecked(file.try_clone()?)?;
    Ok(tokio::io::join(reader, pipe::Sender::from_file_unchecked(file)?))
}

/// A port whose writes are reported, and can be held back.
struct Observed<P> {
    port: P,
    held: Arc<Mutex<bool>>,
}

impl<P> Observed<P> {
    fn observe<T>(
        &mut self,
        data: &[u8],
        write: impl FnOnce(&mut P) -> T,
        size: impl FnOnce(&T) -> Option<usize>,
    ) -> T {
        let _free = loop {
            let held = lock(&self.held);
            if !*held {
                break held;
            }
            drop(held);
            sleep(PERIOD);
        };
        let handed = now();
        let outcome = write(&mut self.port);
        let size = size(&outcome).unwrap_or_default();
        print(&json!({"handed": handed, "taken": now(), "data": hex(data), "size": size}));
        outcome
    }
}

impl<P: Port> Port for Observed<P> {
    fn wait_at_most(&mut self, longest: Duration) -> io::Result<()> {
        self.port.wait_at_most(longest)
    }

    fn has_room(&mut self) -> bool {
        self.port.has_room()
    }
}

impl<P: Read> Read for Observed<P> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.port.read(buffer)
    }
}

impl<P: Write> Write for Observed<P> {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        self.observe(data, |port| port.write(data), |outcome| outcome.as_ref().ok().copied())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.port.flush()
    }
}

impl<P: AsyncRead + Unpin> AsyncRead for Observed<P> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        Pin::new(&mut self.port).poll_read(context, buffer)
    }
}

impl<P: AsyncWrite + Unpin> AsyncWrite for Observed<P> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        data: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.observe(
            data,
            |port| Pin::new(port).poll_write(context, data),
            |outcome| match outcome {
                Poll::Ready(Ok(size)) => Some(*size),
                _ => None,
            },
        )
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.port).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.port).poll_shutdown(context)
    }
}

fn lock(held: &Mutex<bool>) -> MutexGuard<'_, bool> {
    held.lock().unwrap_or_else(PoisonError::into_inner)
}

fn now() -> f64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}

fn link(error: io::Error) -> Error {
    let (message, written) = (format!("cannot be opened: {error}"), Some(0));
    Error::LinkError { message, written }
}

fn answer(id: u64, began: f64, outcome: Outcome) {
    let fields = |named: Named| named.into_iter().map(|(name, value)| (name, shown(&value)));
    let mut line = match outcome {
        Ok(named) => json!({"result": fields(named).collect::<Map<_, _>>()}),
        Err(error) => failed(&error),
    };
    line["began"] = json!(began);
    line["ended"] = json!(now());
    say(id, line);
}

fn failed(error: &Error) -> Json {
    let mut line = json!({"error": error.name(), "text": error.to_string()});
    match error {
        Error::LinkError { written, .. } => line["written"] = json!(written),
        Error::ReplyTimeout { attempts, .. } => line["attempts"] = json!(attempts),
        _ => {}
    }
    line
}

fn say(id: u64, mut line: Json) {
    line["id"] = json!(id);
    print(&line);
}

/// Print a line; when nobody reads any more, the other end of the pipe has ended this process.
fn print(line: &Json) {
    let _ = writeln!(io::stdout().lock(), "{line}");
}

fn named(fields: &Map<String, Json>) -> Named {
    fields.iter().map(|(name, value)| (name.clone(), value_of(value))).collect()
}

fn borrowed(fields: &Named) -> Vec<(&str, Value)> {
    fields.iter().map(|(name, value)| (&**name, value.clone())).collect()
}

fn value_of(json: &Json) -> Value {
    match json {
        Json::Bool(set) => Value::Flag(*set),
        Json::Number(number) => number
            .as_i64()
            .map_or_else(|| Value::Real(number.as_f64().unwrap_or(f64::NAN)), Value::Integer),
        Json::String(text) => Value::Text(text.clone()),
        Json::Array(row) => Value::Row(row.iter().map(value_of).collect()),
        Json::Null | Json::Object(_) => Value::Absent,
    }
}

fn shown(value: &Value) -> Json {
    match value {
        Value::Integer(raw) => json!(raw),
        Value::Real(real) => json!(real),
        Value::Flag(set) => json!(set),
        Value::Text(text) => json!(text),
        Value::Bytes(bytes) => json!(hex(bytes)),
        Value::Row(row) => row.iter().map(shown).collect(),
        Value::Counted | Value::Absent => Json::Null,
    }
}
