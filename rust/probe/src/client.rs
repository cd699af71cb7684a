//! A client that a test controls: it reads calls from standard input and prints their results, one
//! JSON object per line. It also prints each write, with start and end by the monotonic clock.
//!
//! `tests/probe_client.py` is the other end.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead, Read, Write};
use std::net::TcpStream;
use std::os::fd::OwnedFd;
use std::pin::Pin;
use std::task::{Context, Poll};
use std::time::Duration;

use cobotwire::{AsyncClient, Client, Error, Options, Port, RetryPolicy, Value, typed};
use rustix::time::{ClockId, clock_gettime};
use serde_json::{Map, Value as Json, json};
use tokio::io::AsyncWrite;
use tokio::net::unix::pipe;
use tokio::runtime::Runtime;
use tokio::task::AbortHandle;

use crate::values::{hex, shown, value_of};

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
    arm: Option<Arm>,
    tasks: BTreeMap<u64, AbortHandle>,
}

/// Serve a client. `arguments` are the file of its edition, its URL, and options as JSON: those of
/// a client, with times in seconds; `tasks` for the asynchronous client; `small` for the smallest
/// socket buffer.
pub fn serve(mut arguments: impl Iterator<Item = String>) -> io::Result<()> {
    let mut next = || arguments.next().unwrap_or_default();
    let mut probe = Probe {
        edition: cobotwire::read_table(&std::fs::read(next())?).map_err(io::Error::other)?,
        url: next(),
        given: serde_json::from_str(&next())?,
        runtime: Runtime::new()?,
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
        let id = line["id"].as_u64().unwrap_or_default();
        if let Some(id) = line["give_up"].as_u64() {
            self.tasks.remove(&id).inspect(AbortHandle::abort);
        } else if let Some(name) = line["call"].as_str() {
            self.call(id, name, line);
        } else if line["open"] == true {
            let opened = self.open().map(|arm| self.arm = Some(arm));
            let lost = |error: io::Error| json!({"error": "LinkError", "text": error.to_string()});
            say(id, opened.map_or_else(lost, |()| json!({})));
        } else {
            match &self.arm {
                Some(Arm::Threads(client)) => drop(client.close()),
                Some(Arm::Tasks(client)) => self.runtime.block_on(client.close()),
                None => {}
            }
            say(id, json!({}));
        }
    }

    fn open(&self) -> io::Result<Arm> {
        let _entered = self.runtime.enter();
        let (edition, options) = (self.edition.clone(), self.options());
        let socket = self.url.strip_prefix("socket://");
        let socket = socket.map(|address| self.connect(address)).transpose()?;
        if self.given["tasks"] == true {
            let file = match socket {
                Some(stream) => File::from(OwnedFd::from(stream)),
                None => File::options().read(true).write(true).open(&self.url)?,
            };
            // Reading and writing are ready independently of each other, as with two pipes.
            rustix::io::ioctl_fionbio(&file, true)?;
            let reader = pipe::Receiver::from_file_unchecked(file.try_clone()?)?;
            let writer = Observed(pipe::Sender::from_file_unchecked(file)?);
            let client = AsyncClient::over(edition, tokio::io::join(reader, writer), options);
            return client.map(Arm::Tasks).map_err(io::Error::other);
        }
        let port: Box<dyn Port> = match socket {
            Some(stream) => Box::new(stream),
            None => Box::new(serialport::new(&self.url, edition.baudrate).open()?),
        };
        let client = Client::over(edition, Observed(port), options);
        client.map(Arm::Threads).map_err(io::Error::other)
    }

    fn options(&self) -> Options {
        let number = |name: &str| self.given[name].as_f64();
        let seconds = |name| number(name).map(Duration::from_secs_f64);
        let nanos = |name| number(name).map(|seconds| (seconds * 1e9) as u64);
        let usual = RetryPolicy::default();
        let retry = RetryPolicy {
            attempts: number("attempts").map_or(usual.attempts, |attempts| attempts as u8),
            shortest_attempt: nanos("shortest_attempt").unwrap_or(usual.shortest_attempt),
            grace: nanos("grace").unwrap_or(usual.grace),
        };
        Options {
            timeout: seconds("timeout"),
            deadline: seconds("deadline"),
            retry,
            address: self.given["address"].as_str().map(str::to_owned),
            port_name: Some(self.url.clone()),
            ..Options::default()
        }
    }

    fn connect(&self, address: &str) -> io::Result<TcpStream> {
        let stream = TcpStream::connect(address)?;
        stream.set_nodelay(true)?;
        if self.given["small"] == true {
            rustix::net::sockopt::set_socket_send_buffer_size(&stream, 1024)?;
        }
        Ok(stream)
    }

    fn call(&mut self, id: u64, name: &str, line: &Json) {
        let within = line["ack_within"].as_f64().map(Duration::from_secs_f64);
        let (name, line) = (name.to_owned(), line.clone());
        let task = match self.arm.clone() {
            None => return,
            Some(Arm::Threads(mut client)) => self.runtime.spawn_blocking(move || {
                let (began, given) = (now(), named(&line));
                client = within.map_or(client.clone(), |within| client.acknowledged(within));
                answer(began, client.call_named(&name, &given))
            }),
            Some(Arm::Tasks(mut client)) => self.runtime.spawn(async move {
                let (began, given) = (now(), named(&line));
                client = within.map_or(client.clone(), |within| client.acknowledged(within));
                answer(began, client.call_named(&name, &given).await)
            }),
        };
        self.tasks.insert(id, task.abort_handle());
        self.runtime.spawn(async move {
            let text = |error: tokio::task::JoinError| match error.is_cancelled() {
                true => json!({"error": "Cancelled"}),
                false => json!({"error": "Panic", "text": error.to_string()}),
            };
            say(id, task.await.unwrap_or_else(text));
        });
    }
}

/// A port whose writes are reported.
struct Observed<P>(P);

impl<P> Observed<P> {
    fn observe(
        &mut self,
        data: &[u8],
        write: impl FnOnce(&mut P) -> io::Result<usize>,
    ) -> io::Result<usize> {
        let handed = now();
        let outcome = write(&mut self.0);
        let size = outcome.as_ref().copied().unwrap_or_default();
        print(&json!({"handed": handed, "taken": now(), "data": hex(data), "size": size}));
        outcome
    }
}

impl<P: Port> Port for Observed<P> {
    fn wait_at_most(&mut self, longest: Duration) -> io::Result<()> {
        self.0.wait_at_most(longest)
    }

    fn write_some(&mut self, data: &[u8]) -> io::Result<usize> {
        self.observe(data, |port| port.write_some(data))
    }

    fn finish(&mut self) -> io::Result<()> {
        self.0.finish()
    }
}

impl<P: Read> Read for Observed<P> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.0.read(buffer)
    }
}

impl<P: Write> Write for Observed<P> {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        self.observe(data, |port| port.write(data))
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl<P: AsyncWrite + Unpin> AsyncWrite for Observed<P> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        data: &[u8],
    ) -> Poll<io::Result<usize>> {
        let written = self.observe(data, |port| {
            match Pin::new(port).poll_write(context, data) {
                Poll::Ready(written) => written,
                Poll::Pending => Err(io::ErrorKind::WouldBlock.into()),
            }
        });
        match written {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Poll::Pending,
            written => Poll::Ready(written),
        }
    }

    fn poll_flush(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<io::Result<()>> {
        Poll::Ready(Ok(()))
    }
}

fn now() -> f64 {
    let now = clock_gettime(ClockId::Monotonic);
    now.tv_sec as f64 + now.tv_nsec as f64 * 1e-9
}

fn answer(began: f64, outcome: Result<Vec<(String, Value)>, Error>) -> Json {
    let ended = now();
    let mut answer = match outcome {
        Ok(fields) => {
            let shown = fields
                .iter()
                .map(|(name, value)| (name.clone(), shown(value)));
            json!({"result": shown.collect::<Map<_, _>>()})
        }
        Err(error) => json!({"error": error.name(), "text": error.to_string()}),
    };
    (answer["began"], answer["ended"]) = (json!(began), json!(ended));
    answer
}

fn say(id: u64, mut line: Json) {
    line["id"] = json!(id);
    print(&line);
}

/// Print a line; ignore the error if nobody reads the output.
fn print(line: &Json) {
    let _ = writeln!(io::stdout().lock(), "{line}");
}

fn named(line: &Json) -> Vec<(&str, Value)> {
    let fields = line.get("fields").and_then(Json::as_object);
    let named = |(name, value)| (String::as_str(name), value_of(value));
    fields.into_iter().flatten().map(named).collect()
}
