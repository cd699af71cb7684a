//! The asynchronous client: a task serves the stream, and calls send it their requests.

use std::marker::PhantomData;
use std::pin::Pin;
use std::sync::{Arc, Mutex};
use std::task::{Context, Waker};
use std::time::{Duration, Instant};

use cobotwire_core::exchange::Ticket;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt, ReadHalf, WriteHalf};
use tokio::net::TcpStream;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::sync::{Notify, oneshot};

use crate::encoder::{Handle, Named, Outcome, Prepared, client_methods, result};
use crate::options::{Settings, nanos};
use crate::port::{CONNECT, socket_of};
use crate::session::{Outgoing, Queue, Session};
use crate::typed::{DeviceEvent, Request, Table};
use crate::{Error, Events, Options, Polls, Sample, Value, lock};

/// A stream of bytes to a device.
pub trait ByteStream: AsyncRead + AsyncWrite + Send + Unpin + 'static {}

impl<T: AsyncRead + AsyncWrite + Send + Unpin + 'static> ByteStream for T {}

/// How long the task sleeps if nothing is to be done.
const LONGEST: Duration = Duration::from_secs(3600);

/// What callers want of the task.
enum Order {
    Call(Prepared, Settings, u64, oneshot::Sender<Outcome>),
    /// A caller waits no longer.
    GivenUp,
    Subscribe(Arc<Mutex<Queue>>),
    Close(oneshot::Sender<()>),
}

/// An arm at the other end of a stream; clients of editions add a method for each command.
///
/// A clone is a second handle of the same connection. If the future of a call is dropped, its
/// request is given up: it is not sent if it was not yet, and never twice.
#[derive(Clone)]
pub struct AsyncClient {
    handle: Handle,
    shared: Arc<Shared>,
}

struct Shared {
    orders: UnboundedSender<Order>,
    /// Tells consumers of events that something has come.
    arrived: Arc<Notify>,
    closed: Error,
    begun: Instant,
}

client_methods!(AsyncClient [async] [.await]);

impl AsyncClient {
    /// Connect to `socket://host:port`.
    pub async fn open(edition: Table, port: &str, options: Options) -> Result<Self, Error> {
        let Some(address) = socket_of(port) else {
            let text = format!("{port} is not socket://host:port; pass other streams to over()");
            return Err(Error::usage(text));
        };
        let connected = tokio::time::timeout(CONNECT, TcpStream::connect(address)).await;
        let stream = connected.unwrap_or_else(|late| Err(late.into()));
        let ready = stream.and_then(|stream| stream.set_nodelay(true).map(|()| stream));
        let stream = ready
            .map_err(|error| Error::link(port, &format!("cannot be opened: {error}"), Some(0)))?;
        Self::with(edition, stream, Some(port), options)
    }

    /// Drive an arm over an open stream of bytes; a task of the present runtime serves it.
    pub fn over(edition: Table, stream: impl ByteStream, options: Options) -> Result<Self, Error> {
        let name = options.port_name.clone();
        Self::with(edition, stream, name.as_deref(), options)
    }

    fn with(
        edition: Table,
        stream: impl ByteStream,
        url: Option<&str>,
        options: Options,
    ) -> Result<Self, Error> {
        let handle = Handle::new(edition, &options)?;
        let runtime = tokio::runtime::Handle::try_current();
        let runtime =
            runtime.map_err(|_| Error::usage("an AsyncClient needs a runtime of tokio"))?;
        let (orders, received) = unbounded_channel();
        let arrived = Arc::new(Notify::new());
        let (reader, writer) = tokio::io::split(stream);
        let server = Server {
            session: Session::new(handle.encoder.clone(), url, options.on_drop),
            reader,
            writer,
            arrived: arrived.clone(),
            callers: Vec::new(),
            writing: None,
            taken: 0,
            buffer: vec![0; 4096],
            open: true,
        };
        let (closed, begun) = (
            Error::link(url.unwrap_or("port"), "is closed", Some(0)),
            server.session.begun,
        );
        runtime.spawn(server.run(received));
        Ok(Self {
            handle,
            shared: Arc::new(Shared {
                orders,
                arrived,
                closed,
                begun,
            }),
        })
    }

    /// Close the stream. Nothing is sent to the arm; other calls end with a `LinkError`.
    pub async fn close(&self) {
        let (done, closed) = oneshot::channel();
        let _ = self.shared.orders.send(Order::Close(done));
        let _ = closed.await;
    }

    fn subscribe(&self, queue: &Arc<Mutex<Queue>>) {
        let _ = self.shared.orders.send(Order::Subscribe(queue.clone()));
    }

    async fn perform(&self, prepared: &Prepared) -> Outcome {
        let (sender, receiver) = oneshot::channel();
        let called_at = nanos(self.shared.begun.elapsed());
        let settings = self.handle.settings.clone();
        let order = Order::Call(prepared.clone(), settings, called_at, sender);
        if self.shared.orders.send(order).is_err() {
            return Err(self.shared.closed.clone());
        }
        let mut call = Call {
            orders: &self.shared.orders,
            receiver,
        };
        let outcome = (&mut call.receiver).await;
        outcome.unwrap_or_else(|_| {
            let mut closed = self.shared.closed.clone();
            if let Error::LinkError { written, .. } = &mut closed {
                // The task had the request, and may have written it.
                *written = None;
            }
            Err(closed)
        })
    }
}

/// A call that tells the task when it is dropped.
struct Call<'a> {
    orders: &'a UnboundedSender<Order>,
    receiver: oneshot::Receiver<Outcome>,
}

impl Drop for Call<'_> {
    fn drop(&mut self) {
        if !self.receiver.is_terminated() {
            self.receiver.close();
            let _ = self.orders.send(Order::GivenUp);
        }
    }
}

impl<R: Request> Polls<R, AsyncClient> {
    /// Wait for the next sample; the samples end with an error.
    pub async fn next(&mut self) -> Option<Result<Sample<R::Reply>, Error>> {
        while !self.polling.ended {
            let at = self.polling.tick();
            tokio::time::sleep_until(at.into()).await;
            let answer = self.client.perform(&self.polling.prepared).await;
            let sample = self.polling.sample::<R>(&self.client.handle, answer);
            if sample.is_some() {
                return sample;
            }
        }
        None
    }
}

impl<E: DeviceEvent> Events<E, AsyncClient> {
    /// Wait for the next event; return `None` if the time is over.
    pub async fn next(&mut self) -> Option<Result<E, Error>> {
        let longest = self.timeout.unwrap_or(crate::FOREVER);
        tokio::time::timeout(longest, self.received()).await.ok()
    }

    async fn received(&self) -> Result<E, Error> {
        loop {
            // Before the queue is read, so that no event is overlooked.
            let arrived = self.client.shared.arrived.notified();
            let event = lock(&self.queue).events.pop_front();
            if let Some(fields) = event {
                return result(fields, (E::FIELDS, false), &[]);
            }
            if self.client.shared.orders.is_closed() {
                return Err(self.client.shared.closed.clone());
            }
            arrived.await;
        }
    }
}

/// The task that serves a stream.
struct Server<S: ByteStream> {
    session: Session,
    reader: ReadHalf<S>,
    writer: WriteHalf<S>,
    arrived: Arc<Notify>,
    callers: Vec<(Ticket, Prepared, oneshot::Sender<Outcome>)>,
    /// What is being written, and how much of it was taken.
    writing: Option<Outgoing>,
    taken: usize,
    buffer: Vec<u8>,
    open: bool,
}

impl<S: ByteStream> Server<S> {
    async fn run(mut self, mut orders: UnboundedReceiver<Order>) {
        while self.open {
            let idle = self.session.idle().unwrap_or(LONGEST);
            tokio::select! {
                order = orders.recv() => match order {
                    Some(order) => self.obey(order).await,
                    None => break,
                },
                size = self.reader.read(&mut self.buffer) => self.take(size),
                () = tokio::time::sleep(idle) => {}
            }
            // Requests that were given up must not be sent.
            self.finish();
            self.step().await;
            self.finish();
        }
        let bytes = self.session.stops();
        if self.open && !bytes.is_empty() {
            let writer = &mut self.writer;
            let stopped = async {
                writer.write_all(&bytes).await?;
                writer.flush().await
            };
            // Nobody is left who could handle an error.
            let _ = tokio::time::timeout(Duration::from_secs(1), stopped).await;
        }
        // Events wake their consumers, which find the channel closed.
        orders.close();
        self.finish();
        self.arrived.notify_waiters();
    }

    async fn obey(&mut self, order: Order) {
        match order {
            Order::Subscribe(queue) => self.session.subscribe(&queue),
            Order::GivenUp => {}
            Order::Close(done) => {
                self.session.close();
                self.open = false;
                let _ = done.send(());
            }
            // Its caller has given it up before it was sent.
            Order::Call(_, _, _, caller) if caller.is_closed() => {}
            Order::Call(prepared, settings, called_at, caller) if prepared.awaits_reply => {
                let ticket = self.session.enqueue(&prepared, &settings, called_at);
                self.callers.push((ticket, prepared, caller));
            }
            Order::Call(prepared, settings, called_at, caller) => {
                match self.session.one_way(&prepared, &settings, called_at) {
                    Err(error) => drop(caller.send(Err(error))),
                    Ok((outgoing, ticket)) => match (self.write(outgoing).await, ticket) {
                        (Err(error), ticket) => {
                            ticket
                                .into_iter()
                                .for_each(|ticket| self.session.give_up(ticket));
                            drop(caller.send(Err(error)));
                        }
                        (Ok(()), Some(ticket)) => self.callers.push((ticket, prepared, caller)),
                        (Ok(()), None) => drop(caller.send(Ok(None))),
                    },
                }
            }
        }
    }

    /// Take what was read.
    fn take(&mut self, size: std::io::Result<usize>) {
        match size {
            Ok(0) => self.lose("the peer has closed the connection"),
            Ok(size) => {
                let data = self.buffer.get(..size).unwrap_or_default();
                self.session.advance(data);
                self.arrived.notify_waiters();
            }
            Err(error) => self.lose(&format!("cannot be read: {error}")),
        }
    }

    /// Read what has come, let time pass, and send the request that is next.
    async fn step(&mut self) {
        while self.open {
            if self.session.exchange.has_next(self.session.now()) {
                // The runtime notices only now that bytes have come.
                tokio::task::yield_now().await;
            }
            let size = tokio::select! {
                biased;
                size = self.reader.read(&mut self.buffer) => Some(size),
                () = std::future::ready(()) => None,
            };
            let drained = size.is_none();
            size.into_iter().for_each(|size| self.take(size));
            if !self.open || !self.session.advance(&[]) {
                return;
            }
            self.session.exchange.note_full(false);
            match self.session.next(drained) {
                Some(outgoing) => drop(self.write(outgoing).await),
                None => return,
            }
        }
    }

    /// Write a request whole, within its time.
    async fn write(&mut self, outgoing: Outgoing) -> Result<(), Error> {
        let (bytes, until, mut fault) = (outgoing.bytes(), outgoing.until, None);
        (self.writing, self.taken) = (Some(outgoing), 0);
        while let Some(rest) = bytes
            .get(self.taken..)
            .filter(|rest| !rest.is_empty() && self.open)
        {
            let idle = self.session.idle().unwrap_or(LONGEST);
            tokio::select! {
                biased;
                size = self.writer.write(rest) => match size {
                    Ok(size) if size > 0 => self.taken += size,
                    Ok(_) => break,
                    Err(error) => {
                        fault = Some(error);
                        break;
                    }
                },
                () = tokio::time::sleep_until(until.into()) => break,
                // A full line must not delay the calls that wait for something else.
                size = self.reader.read(&mut self.buffer) => self.take(size),
                () = tokio::time::sleep(idle) => drop(self.session.advance(&[])),
            }
            if self.taken < bytes.len() {
                self.finish();
            }
        }
        if self.taken == bytes.len() {
            // A stream with a buffer keeps the bytes until then.
            let until = Instant::now().max(until).into();
            if let Ok(Err(error)) = tokio::time::timeout_at(until, self.writer.flush()).await {
                fault = Some(error);
            }
        }
        let written = self.writing.take();
        written.map_or(Ok(()), |outgoing| {
            self.session.wrote(&outgoing, self.taken, fault.as_ref())
        })
    }

    fn lose(&mut self, detail: &str) {
        self.session.lose(detail);
        self.open = false;
    }

    /// Report the requests that have ended, and give up those without a caller.
    fn finish(&mut self) {
        let (session, open) = (&mut self.session, self.open);
        let waiting = std::mem::take(&mut self.callers).into_iter();
        let left = waiting.filter_map(|(ticket, prepared, caller)| {
            if let Some(outcome) = session.take(ticket, &prepared) {
                drop(caller.send(outcome.map(Some)));
                return None;
            }
            if caller.is_closed() || !open {
                session.give_up(ticket);
                return None;
            }
            Some((ticket, prepared, caller))
        });
        self.callers = left.collect();
    }
}

impl<S: ByteStream> Drop for Server<S> {
    fn drop(&mut self) {
        // The stop must follow what ends a request that was cut.
        if let Some(outgoing) = self.writing.take() {
            let _ = self.session.wrote(&outgoing, self.taken, None);
        }
        let bytes = self.session.stops();
        if self.open && !bytes.is_empty() {
            // The runtime may be at its end, so nothing can be waited for.
            let mut context = Context::from_waker(Waker::noop());
            let _ = Pin::new(&mut self.writer).poll_write(&mut context, &bytes);
        }
    }
}
