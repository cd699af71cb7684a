//! The asynchronous client: the future that is polled reads and writes for all futures.

use std::future::poll_fn;
use std::io::{self, Read, Write};
use std::pin::{Pin, pin};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock};
use std::task::{Context, Poll, Wake, Waker, ready};
use std::time::{Duration, Instant};

use futures_core::Stream;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::sync::Notify;

use crate::connection::{Connection, Shared};
use crate::handle::{Handle, Outcome, Prepared, result};
use crate::options::nanos;
use crate::port::{CONNECT, SOCKET, not_opened};
use crate::session::{CallId, Session};
use crate::streams::{Polling, Received, client_methods};
use crate::typed::{DeviceEvent, Request, Table};
use crate::{Error, Options, Port, Sample, Value, lock};

/// A stream of bytes to a device.
pub trait ByteStream: AsyncRead + AsyncWrite + Send + Unpin + 'static {}

impl<T: AsyncRead + AsyncWrite + Send + Unpin + 'static> ByteStream for T {}

/// The longest that a future sleeps if there is nothing to do.
const LONGEST: Duration = Duration::from_secs(3600);

/// An arm at the other end of a stream; clients of editions add a method for each command.
///
/// A clone is a second handle of the same connection. If the future of a call is dropped, its
/// request is given up: it is not sent if it has not been sent yet, and it is not sent again.
#[derive(Clone)]
pub struct AsyncClient {
    handle: Handle,
    shared: Arc<Shared<Arc<Arrived>>>,
}

/// Wakes every future that waits. The stream itself would wake only the task that polled it last.
#[derive(Default)]
struct Arrived(Notify);

impl Wake for Arrived {
    fn wake(self: Arc<Self>) {
        self.0.notify_waiters();
    }
}

/// Wakes a task, and notes when it was first woken.
struct Alarm {
    task: Waker,
    at: OnceLock<Instant>,
}

impl Wake for Alarm {
    fn wake(self: Arc<Self>) {
        self.at.get_or_init(Instant::now);
        self.task.wake_by_ref();
    }
}

/// The future of the next item of a stream.
type NextItem<T> = Pin<Box<dyn Future<Output = Option<T>> + Send>>;

client_methods!(
    AsyncClient NextItem tokio::time::sleep, [async] [Box::pin] [async move] [.await]
);

impl AsyncClient {
    /// Connect to `socket://host:port`.
    pub async fn open(edition: Table, port: &str, mut options: Options) -> Result<Self, Error> {
        let Some(address) = port.strip_prefix(SOCKET) else {
            let text = format!("{port} is not socket://host:port; pass other streams to over()");
            return Err(Error::usage(text));
        };
        let connected = tokio::time::timeout(CONNECT, TcpStream::connect(address)).await;
        let stream = connected.unwrap_or_else(|late| Err(late.into()));
        let ready = stream.and_then(|stream| stream.set_nodelay(true).map(|()| stream));
        let stream = ready.map_err(|error| not_opened(port, error))?;
        options.port_name = Some(port.to_owned());
        Self::over(edition, stream, options)
    }

    /// Drive an arm over an open stream of bytes. Its methods need a runtime of tokio with timers.
    pub fn over(edition: Table, stream: impl ByteStream, options: Options) -> Result<Self, Error> {
        let arrived = Arc::<Arrived>::default();
        let port = Box::new(Polled {
            stream,
            waker: arrived.clone().into(),
        });
        let turns = (Duration::ZERO, arrived);
        let (handle, shared) = Connection::open(edition, port, options, turns)?;
        Ok(Self { handle, shared })
    }

    /// Close the stream. Nothing more is sent to the arm; other calls end with a `LinkError`.
    pub async fn close(&self) {
        // If the stream was not flushed in time, nothing else can be done.
        let _ = self.connection().close();
        self.shared.turns.0.notify_waiters();
    }

    fn connection(&self) -> MutexGuard<'_, Connection> {
        lock(&self.shared.connection)
    }

    async fn perform(&self, prepared: &Prepared) -> Outcome {
        let called = Instant::now();
        if prepared.awaits_reply {
            // The runtime notices bytes that have already come only after a yield.
            tokio::task::yield_now().await;
        }
        let id = self.connection().submit(prepared, &self.handle, called);
        let call = Call { client: self, id };
        self.until(None, |session, _| session.take(call.id)).await
    }

    /// Perform a request, and return the longest time from a wake to the poll that followed it.
    async fn attended(&self, prepared: &Prepared) -> (Outcome, Duration) {
        let mut call = pin!(self.perform(prepared));
        let (mut alarm, mut longest) = (None::<Arc<Alarm>>, Duration::ZERO);
        poll_fn(move |context| {
            let woken = alarm.as_ref().and_then(|alarm| alarm.at.get());
            longest = longest.max(woken.map_or(Duration::ZERO, Instant::elapsed));
            let next = Arc::new(Alarm {
                task: context.waker().clone(),
                at: OnceLock::new(),
            });
            alarm = Some(next.clone());
            let polled = call.as_mut().poll(&mut Context::from_waker(&next.into()));
            polled.map(|outcome| (outcome, longest))
        })
        .await
    }

    /// Read and write for all futures until `done` returns something. Its second argument is
    /// whether `longest` has passed.
    async fn until<T>(
        &self,
        longest: Option<Duration>,
        mut done: impl FnMut(&mut Session, bool) -> Option<T>,
    ) -> T {
        let began = Instant::now();
        loop {
            // Register before the stream is polled, so that no wake-up is missed.
            let arrived = self.shared.turns.0.notified();
            let left = longest.map_or(LONGEST, |longest| longest.saturating_sub(began.elapsed()));
            let idle = {
                let mut connection = self.connection();
                let came = connection.step(Duration::ZERO);
                if let Some(found) = done(&mut connection.session, left.is_zero()) {
                    self.shared.turns.0.notify_waiters();
                    return found;
                }
                (!came).then(|| connection.idle(left))
            };
            match idle {
                Some(idle) => drop(tokio::time::timeout(idle, arrived).await),
                None => {
                    // Wake the others: what was read may be for them.
                    self.shared.turns.0.notify_waiters();
                    tokio::task::yield_now().await;
                }
            }
        }
    }
}

/// A call that is given up when it is dropped.
struct Call<'a> {
    client: &'a AsyncClient,
    id: CallId,
}

impl Drop for Call<'_> {
    fn drop(&mut self) {
        self.client.connection().session.give_up(self.id);
        // Another future must continue to read and write for all.
        self.client.shared.turns.0.notify_waiters();
    }
}

impl<T> Stream for Received<NextItem<T>> {
    type Item = T;

    fn poll_next(self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<T>> {
        let this = self.get_mut();
        let future = this.pending.get_or_insert_with(&mut this.next);
        let item = ready!(future.as_mut().poll(context));
        this.pending = None;
        Poll::Ready(item)
    }
}

impl<T> Received<NextItem<T>> {
    /// Wait for the next sample or event. Samples end with an error, events when their timeout has
    /// passed.
    pub async fn next(&mut self) -> Option<T> {
        poll_fn(|context| Pin::new(&mut *self).poll_next(context)).await
    }
}

/// A stream as a port: it never blocks, and wakes the tasks that wait for it.
struct Polled<S> {
    stream: S,
    waker: Waker,
}

impl<S: ByteStream> Polled<S> {
    fn poll<T>(
        &mut self,
        poll: impl FnOnce(Pin<&mut S>, &mut Context<'_>) -> Poll<io::Result<T>>,
    ) -> io::Result<T> {
        let mut context = Context::from_waker(&self.waker);
        match poll(Pin::new(&mut self.stream), &mut context) {
            Poll::Ready(done) => done,
            Poll::Pending => Err(io::ErrorKind::WouldBlock.into()),
        }
    }
}

impl<S: ByteStream> Read for Polled<S> {
    fn read(&mut self, data: &mut [u8]) -> io::Result<usize> {
        // The stream may keep written bytes in a buffer until it is flushed.
        let _ = self.flush();
        let mut buffer = ReadBuf::new(data);
        self.poll(|stream, context| stream.poll_read(context, &mut buffer))?;
        Ok(buffer.filled().len())
    }
}

impl<S: ByteStream> Write for Polled<S> {
    fn write(&mut self, data: &[u8]) -> io::Result<usize> {
        let size = self.poll(|stream, context| stream.poll_write(context, data))?;
        let _ = self.flush();
        Ok(size)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.poll(|stream, context| stream.poll_flush(context))
    }
}

impl<S: ByteStream> Port for Polled<S> {
    fn wait_at_most(&mut self, _: Duration) -> io::Result<()> {
        Ok(())
    }
}
