//! The clients over a port in memory. `tests/attack` drives both over transports that lose, double
//! and cut bytes; `tests/session` compares the exchange with that of Python.
#![allow(clippy::unwrap_used, clippy::panic)] // a test fails by a panic

use std::collections::VecDeque;
use std::future::poll_fn;
use std::io::{ErrorKind, Read, Write};
use std::pin::pin;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::Poll;
use std::time::{Duration, Instant};

use cobotwire::editions::mycobot280::{
    AsyncMyCobot280, FreshMode, MyCobot280, messages::GetAngles,
};
use cobotwire::editions::pro630::{self, Pro630};
use cobotwire::{Error, Limits, OnDrop, Options, Port, Value};
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::sync::Notify;
use tokio::time::timeout;

const ANGLES: [u8; 17] = [
    0xFE, 0xFE, 0x0E, 0x20, 0, 0x8C, 0, 0x3D, 0xFF, 0xE6, 0xFF, 0x3F, 0, 0xAF, 0xFF, 0x51, 0xFA,
];
const STOP: [u8; 5] = [0xFE, 0xFE, 0x02, 0x29, 0xFA];
const ENDED: [u8; 7] = [0xFE, 0xFE, 0x04, 0x5B, 0x00, 0xCD, 0x46];
const SHORT: Duration = Duration::from_millis(20);

#[derive(Default)]
struct Line {
    written: Vec<u8>,
    incoming: VecDeque<u8>,
    /// How many bytes the line takes before it is stuck.
    room: Option<usize>,
}

/// A port in memory that replies to `get_angles` only.
#[derive(Clone, Default)]
struct Memory(Arc<Mutex<Line>>);

impl Memory {
    fn line(&self) -> MutexGuard<'_, Line> {
        self.0.lock().unwrap()
    }

    fn written(&self) -> Vec<u8> {
        self.line().written.clone()
    }
}

impl Read for Memory {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        std::thread::sleep(Duration::from_micros(200));
        match self.line().incoming.read(buffer)? {
            0 => Err(ErrorKind::WouldBlock.into()),
            size => Ok(size),
        }
    }
}

impl Write for Memory {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        let mut line = self.line();
        let room = line
            .room
            .map_or(usize::MAX, |room| room - line.written.len());
        line.written.extend(data.iter().take(room));
        if data.get(3) == ANGLES.get(3) {
            line.incoming.extend(ANGLES);
        }
        Ok(data.len().min(room))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Port for Memory {
    fn wait_at_most(&mut self, _: Duration) -> std::io::Result<()> {
        Ok(())
    }
}

fn options(set: impl FnOnce(&mut Options)) -> Options {
    let mut options = Options::default();
    set(&mut options);
    options
}

fn over(port: &Memory, set: impl FnOnce(&mut Options)) -> MyCobot280 {
    MyCobot280::over(port.clone(), options(set)).unwrap()
}

/// Return a runtime of the asynchronous tests.
fn runtime() -> tokio::runtime::Runtime {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    builder.enable_all().build().unwrap()
}

/// Await two futures at once. `tokio::join!` would add a procedural macro, which takes as long to
/// compile as tokio.
async fn both<A: Future, B: Future>(first: A, second: B) -> (A::Output, B::Output) {
    let (mut first, mut second) = (pin!(first), pin!(second));
    let (mut one, mut two) = (None, None);
    poll_fn(|context| {
        one = one.take().or_else(|| ready(first.as_mut().poll(context)));
        two = two.take().or_else(|| ready(second.as_mut().poll(context)));
        match one.is_some() && two.is_some() {
            true => Poll::Ready((one.take().unwrap(), two.take().unwrap())),
            false => Poll::Pending,
        }
    })
    .await
}

fn ready<T>(polled: Poll<T>) -> Option<T> {
    match polled {
        Poll::Ready(value) => Some(value),
        Poll::Pending => None,
    }
}

/// Return the message of a `LinkError`, and how many bytes of the request were written.
fn lost<T: std::fmt::Debug>(outcome: Result<T, Error>) -> (String, Option<usize>) {
    match outcome.unwrap_err() {
        Error::LinkError { message, written } => (message, written),
        other => panic!("{other:?}"),
    }
}

#[test]
fn query_returns_typed_result() {
    let arm = over(&Memory::default(), |_| {});
    assert_eq!(arm.get_angles(), Ok([1.4, 0.61, -0.26, -1.93, 1.75, -1.75]));
    let named = arm.call_named("get_angles", &[]).unwrap();
    assert!(matches!(&*named, [(name, Value::Row(row))] if name == "angles" && row.len() == 6));
    let radians = arm.get_radians().unwrap();
    assert!((radians[0] - 1.4_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn wrong_argument_and_exceeded_limit_are_refused_before_a_byte_is_sent() {
    let port = Memory::default();
    let arm = over(&port, |_| {});
    let limited = over(&port, |options| {
        options.limits = Limits {
            speed: Some(50.0),
            workspace: Some([None, None, Some((200.0, 500.0))]),
        };
    });
    let (home, up) = ([0.0; 6], [0.0, 90.0, 0.0, 0.0, 0.0, 0.0]);
    let place = |z| [100.0, 0.0, z, 0.0, 0.0, 0.0];
    let missing = arm.call_named("get_encoder", &[]).map(drop);
    #[rustfmt::skip] // a row is one line
    let refused = [
        (arm.send_angles(home, 140), "speed is 140; allowed: a whole number 1..100 percent"),
        (missing, "get_encoder() is missing its argument joint; it takes joint"),
        (limited.send_coords(place(300.0), 51, None), "speed is 51; allowed: a whole number 1..50 percent"),
        (limited.send_coords(place(50.0), 50, None), "coords.z is 50.0; allowed: a number 200.."),
        (limited.send_angles(up, 50), "it is unknown where the end of the arm would go"),
        (limited.set_servo_calibration(1), "its effect is permanent, and limits.speed"),
        (limited.set_tool_reference(home), "it changes what coordinates mean"),
    ];
    for (outcome, text) in refused {
        let message = outcome.unwrap_err().to_string();
        assert!(message.contains(text), "{message}");
    }
    assert!(port.written().is_empty());
    limited.stop().unwrap();
}

#[test]
fn highest_speed_is_not_set_within_a_speed() {
    let port = Memory::default();
    let slow = options(|options| options.limits.speed = Some(1.0));
    let outcome = Pro630::over(port.clone(), slow)
        .unwrap()
        .call_named("set_max_speed", &[]);
    let message = outcome.unwrap_err().to_string();
    assert!(
        message.contains("it changes what a percentage means"),
        "{message}"
    );
    assert!(port.written().is_empty());
}

#[test]
fn time_of_zero_or_an_hour_is_refused_before_a_byte_is_sent() {
    let (port, hour) = (Memory::default(), Duration::from_secs(3600));
    let arm = over(&port, |_| {});
    for (time, given) in [(Duration::ZERO, "0.0"), (hour, "3600.0")] {
        let text = format!("is {given}; allowed: seconds above 0 and below 3600");
        let options = options(|options| options.deadline = Some(time));
        let error = MyCobot280::over(port.clone(), options).unwrap_err();
        assert_eq!(error.to_string(), format!("deadline {text}"));
        let error = arm.acknowledged(time).stop().unwrap_err();
        assert_eq!(error.to_string(), format!("ack_within {text}"));
    }
    assert!(port.written().is_empty());
}

#[test]
fn dropped_client_stops_moving_arm_once_unless_it_was_closed() {
    for (on_drop, closed, stops) in [
        (OnDrop::Stop, false, true),
        (OnDrop::Stop, true, false),
        (OnDrop::Leave, false, false),
    ] {
        let port = Memory::default();
        let arm = over(&port, |options| options.on_drop = on_drop);
        arm.set_fresh_mode(FreshMode::Refresh).unwrap();
        arm.send_angles([0.0; 6], 50).unwrap();
        if closed {
            arm.close().unwrap();
        }
        let second = arm.clone();
        drop(arm);
        assert!(!port.written().ends_with(&STOP));
        drop(second);
        assert_eq!(port.written().ends_with(&STOP), stops);
    }
}

#[test]
fn cut_request_is_ended_before_the_next_one() {
    let port = Memory::default();
    port.line().room = Some(7);
    let arm = over(&port, |options| options.deadline = Some(10 * SHORT));
    assert_eq!(lost(arm.send_angles([0.0; 6], 50)).1, Some(7));
    port.line().room = None;
    arm.stop().unwrap();
    let sent = port.written();
    // The incomplete frame is filled up, so that the stop is a frame of its own.
    assert!(sent.len() >= 18 + STOP.len() && sent.ends_with(&STOP));
}

#[test]
fn samples_and_events_are_iterators() {
    let port = Memory::default();
    let arm = over(&port, |_| {});
    let mut samples = arm.poll(GetAngles {}, 200.0).unwrap().take(3);
    assert!(samples.all(|sample| sample.unwrap().value[0] == 1.4));
    assert!(arm.poll(GetAngles {}, 0.0).is_err());
    let mut samples = arm.poll(GetAngles {}, 100.0).unwrap();
    arm.close().unwrap();
    assert!(matches!(samples.next(), Some(Err(_))));
    std::thread::sleep(2 * SHORT);
    assert_eq!((samples.next(), samples.missed()), (None, 0));
    let arm = Pro630::over(port.clone(), Options::default()).unwrap();
    let mut events = arm.events(Some(10 * SHORT)).unwrap();
    port.line().incoming.extend(ENDED);
    assert_eq!(events.next(), Some(Ok(pro630::MotionEnded { status: 0 })));
    assert_eq!(events.next(), None);
}

#[test]
fn samples_and_events_are_streams() {
    async fn next<S: futures_core::Stream + Unpin>(mut stream: S) -> Option<S::Item> {
        std::future::poll_fn(|context| std::pin::Pin::new(&mut stream).poll_next(context)).await
    }
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(1000);
        let arm = pro630::AsyncPro630::over(near, Options::default()).unwrap();
        let events = arm.events(Some(25 * SHORT)).unwrap();
        let samples = arm.poll(pro630::messages::IsMoving {}, 100.0).unwrap();
        let (event, sent) = both(next(events), far.write_all(&ENDED)).await;
        sent.unwrap();
        assert_eq!(event, Some(Ok(pro630::MotionEnded { status: 0 })));
        drop(far);
        let ended = next(samples).await;
        assert!(matches!(ended, Some(Err(Error::LinkError { .. }))));
    });
}

#[test]
fn reply_that_came_while_nobody_polled_the_samples_is_not_a_sample() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(1000);
        let (requests, held) = (Arc::new(AtomicU8::new(0)), Arc::new(Notify::new()));
        let (received, replies) = (requests.clone(), held.clone());
        // Each reply is the number of its request. The first comes late, the second when the caller
        // has turned away, the others at once.
        tokio::spawn(async move {
            while far.read_exact(&mut [0; 5]).await.is_ok() {
                let number = received.fetch_add(1, Ordering::SeqCst) + 1;
                match number {
                    1 => tokio::time::sleep(6 * SHORT).await,
                    2 => replies.notified().await,
                    _ => {}
                }
                let raw = (100 * i16::from(number)).to_be_bytes();
                let reply = [&ANGLES[..4], &raw.repeat(6), &ANGLES[16..]].concat();
                far.write_all(&reply).await.unwrap();
            }
        });
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        let mut samples = arm.poll(GetAngles {}, 10.0).unwrap();
        let first = samples.next().await.unwrap().unwrap();
        assert_eq!(first.value[0], 1.0);
        while requests.load(Ordering::SeqCst) < 2 {
            assert!(timeout(SHORT / 10, samples.next()).await.is_err());
        }
        held.notify_one();
        tokio::time::sleep(10 * SHORT).await;
        let missed = samples.missed();
        let second = samples.next().await.unwrap().unwrap();
        assert!(second.value[0] >= 3.0, "{second:?}");
        assert!(samples.missed() > missed);
    });
}

#[test]
fn stop_and_close_return_by_their_deadline_while_the_transport_is_full() {
    runtime().block_on(async {
        let (near, far) = tokio::io::duplex(10);
        let options = options(|options| options.deadline = Some(10 * SHORT));
        let arm = AsyncMyCobot280::over(near, options).unwrap();
        let begun = Instant::now();
        let (moved, stopped) = both(arm.send_angles([0.0; 6], 50), arm.stop()).await;
        assert!(begun.elapsed() < Duration::from_secs(1));
        assert_eq!(lost(moved).1, Some(10));
        let error = stopped.unwrap_err();
        assert!(matches!(error, Error::ReplyTimeout { attempts: 0, .. }));
        let message = error.to_string();
        assert!(message.starts_with("stop() was not sent: its deadline passed"));
        assert!(message.ends_with("while the line took no bytes"));
        // The rest of the cut request cannot be written; close() ends the stop() that waits for
        // that.
        let closed = async {
            tokio::time::sleep(SHORT).await;
            arm.close().await;
        };
        let (stopped, ()) = both(arm.stop(), closed).await;
        let text = "port: cannot be written: the client was closed";
        assert_eq!(lost(stopped), (text.to_owned(), Some(0)));
        drop(far);
    });
}

#[test]
fn request_given_up_while_the_transport_is_full_is_not_sent() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(10);
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        let moved = timeout(SHORT, arm.send_angles([0.0; 6], 50)).await;
        assert!(moved.is_err());
        assert!(timeout(SHORT, arm.power_off()).await.is_err());
        // The request that was partly written is completed, so that the stop is a frame of its own.
        let mut sent = [0; 24];
        let read = timeout(10 * SHORT, far.read_exact(&mut sent));
        let (stopped, read) = both(arm.stop(), read).await;
        assert_eq!(stopped, Ok(()));
        assert!(read.is_err() && sent[18..23] == STOP && sent[23] == 0);
    });
}

#[test]
fn stop_is_sent_when_a_full_transport_takes_bytes_again() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(10);
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        let mut sent = [0; 23];
        let read = async {
            tokio::time::sleep(SHORT).await;
            far.read_exact(&mut sent).await
        };
        let calls = both(arm.send_angles([0.0; 6], 50), arm.stop());
        let ((moved, stopped), read) = both(calls, read).await;
        assert_eq!((moved, stopped, read.unwrap()), (Ok(()), Ok(()), 23));
        assert!(sent.ends_with(&STOP));
    });
}

#[test]
fn dropped_future_is_given_up_and_its_reply_is_late() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(1000);
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        assert!(timeout(SHORT, arm.get_angles()).await.is_err());
        far.read_exact(&mut [0; 5]).await.unwrap();
        // A second request that looks the same is held, since the late reply may still come.
        assert!(timeout(SHORT, arm.get_angles()).await.is_err());
        assert!(timeout(SHORT, far.read_u8()).await.is_err());
    });
}

#[test]
fn stop_does_not_wait_for_the_replies_that_other_threads_wait_for() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let arm = MyCobot280::open(&format!("socket://{}", listener.local_addr().unwrap())).unwrap();
    let mut far = listener.accept().unwrap().0;
    let waiting = [(); 8].map(|()| {
        let waiting = arm.clone();
        std::thread::spawn(move || waiting.get_angles())
    });
    far.read_exact(&mut [0; 5]).unwrap();
    let mut stops: Vec<_> = (0..9)
        .map(|_| {
            let begun = Instant::now();
            arm.stop().unwrap();
            begun.elapsed()
        })
        .collect();
    stops.sort();
    assert!(stops.get(4) < Some(&Duration::from_millis(10)), "{stops:?}");
    arm.close().unwrap();
    let written: Vec<_> = waiting.map(|each| lost(each.join().unwrap()).1).into();
    assert_eq!(written.iter().filter(|size| **size == Some(5)).count(), 1);
}

#[test]
fn error_says_how_much_of_a_request_was_written() {
    let port = Memory::default();
    let arm = over(&port, |_| {});
    let waiting = arm.clone();
    let waiting = std::thread::spawn(move || waiting.get_coords());
    while port.written().is_empty() {
        std::thread::yield_now();
    }
    arm.close().unwrap();
    // One request was completely written; the two after it were not sent.
    assert_eq!(lost(waiting.join().unwrap()).1, Some(5));
    let closed = ("port: is closed".to_owned(), Some(0));
    assert_eq!(lost(arm.get_coords()), closed);
    assert_eq!(lost(arm.acknowledged(SHORT).stop()), closed);
    assert_eq!(port.written().len(), 5);
}

#[cfg(all(unix, feature = "serial"))]
#[test]
fn serial_port_of_the_caller_never_waits_longer_than_the_deadline() {
    let (near, far) = serialport::TTYPort::pair().unwrap();
    let near: Box<dyn serialport::SerialPort> = Box::new(near);
    let options = options(|options| {
        options.deadline = Some(5 * SHORT);
        options.on_drop = OnDrop::Leave;
    });
    let arm = MyCobot280::over(near, options).unwrap();
    // Nobody reads from `far`, so the port fills up.
    let mut last = Instant::now();
    let refused = (0..10_000).find_map(|_| {
        last = Instant::now();
        arm.stop().err()
    });
    assert!(last.elapsed() < Duration::from_secs(1));
    assert!(refused.is_some(), "10,000 stops did not fill the port");
    drop(far);
}

#[test]
fn end_of_runtime_stops_moving_arm() {
    let runtime = runtime();
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let url = format!("socket://{}", listener.local_addr().unwrap());
    runtime.block_on(async {
        let arm = AsyncMyCobot280::open(&url).await.unwrap();
        arm.send_angles([0.0; 6], 50).await.unwrap();
    });
    drop(runtime);
    let (mut far, mut received) = (listener.accept().unwrap().0, Vec::new());
    far.read_to_end(&mut received).unwrap();
    assert!(received.ends_with(&STOP));
}
