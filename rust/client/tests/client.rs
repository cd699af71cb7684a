//! The clients over a port in memory.
#![allow(clippy::unwrap_used, clippy::panic)] // a test fails by a panic

use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Write};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use cobotwire::editions::mycobot280::{
    AsyncMyCobot280, FreshMode, MyCobot280, messages::GetAngles,
};
use cobotwire::editions::pro630::{self, Pro630};
use cobotwire::{Error, Limits, OnDrop, Options, Port, Value};

const ANGLES: [u8; 17] = [
    0xFE, 0xFE, 0x0E, 0x20, 0, 0x8C, 0, 0x3D, 0xFF, 0xE6, 0xFF, 0x3F, 0, 0xAF, 0xFF, 0x51, 0xFA,
];
const STOP: [u8; 5] = [0xFE, 0xFE, 0x02, 0x29, 0xFA];

/// A port in memory: each request with a command id gets the reply of that id.
#[derive(Clone, Default)]
struct Memory {
    written: Arc<Mutex<Vec<u8>>>,
    incoming: Arc<Mutex<VecDeque<u8>>>,
    replies: Vec<(u8, Vec<u8>)>,
    /// How many bytes the line takes before it is stuck.
    room: Arc<Mutex<Option<usize>>>,
}

impl Memory {
    fn replying(id: u8, reply: &[u8]) -> Self {
        Self {
            replies: vec![(id, reply.to_vec())],
            ..Self::default()
        }
    }

    fn written(&self) -> Vec<u8> {
        self.written.lock().unwrap().clone()
    }
}

impl Read for Memory {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let mut incoming = self.incoming.lock().unwrap();
        if incoming.is_empty() {
            drop(incoming);
            std::thread::sleep(Duration::from_micros(200));
            return Err(ErrorKind::WouldBlock.into());
        }
        incoming.read(buffer)
    }
}

impl Write for Memory {
    fn write(&mut self, data: &[u8]) -> std::io::Result<usize> {
        let mut written = self.written.lock().unwrap();
        let taken = self
            .room
            .lock()
            .unwrap()
            .map_or(data.len(), |room| data.len().min(room - written.len()));
        written.extend(data.iter().take(taken));
        let id = data.get(3);
        let replies = self.replies.iter().filter(|(each, _)| Some(each) == id);
        self.incoming
            .lock()
            .unwrap()
            .extend(replies.flat_map(|(_, reply)| reply));
        Ok(taken)
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

fn over(port: &Memory, options: Options) -> MyCobot280 {
    MyCobot280::over(port.clone(), options).unwrap()
}

#[test]
fn query_returns_typed_result() {
    let port = Memory::replying(0x20, &ANGLES);
    let arm = over(&port, Options::default());
    assert_eq!(arm.get_angles(), Ok([1.4, 0.61, -0.26, -1.93, 1.75, -1.75]));
    let named = arm.call_named("get_angles", &[]).unwrap();
    assert!(matches!(&*named, [(name, Value::Row(row))] if name == "angles" && row.len() == 6));
    let radians = arm.get_radians().unwrap();
    assert!((radians[0] - 1.4_f64.to_radians()).abs() < 1e-12);
}

#[test]
fn wrong_argument_is_refused_before_a_byte_is_sent() {
    let port = Memory::default();
    let arm = over(&port, Options::default());
    let Err(Error::UsageError { message }) = arm.send_angles([0.0; 6], 140) else {
        panic!("it was sent");
    };
    assert_eq!(
        message,
        "speed is 140; allowed: a whole number 1..100 percent"
    );
    let missing = arm.call_named("get_encoder", &[]).unwrap_err();
    assert_eq!(
        missing.to_string(),
        "get_encoder() is missing its argument joint; it takes joint"
    );
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
        let arm = over(
            &port,
            Options {
                on_drop,
                ..Options::default()
            },
        );
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
fn silent_arm_gives_timeout_after_all_attempts() {
    let port = Memory::default();
    let timeout = Some(Duration::from_millis(300));
    let arm = over(
        &port,
        Options {
            timeout,
            ..Options::default()
        },
    );
    let Err(Error::ReplyTimeout {
        message, attempts, ..
    }) = arm.get_angles()
    else {
        panic!("it had a reply");
    };
    assert!(
        message.starts_with("no reply to get_angles() within 0.3"),
        "{message}"
    );
    assert_eq!((attempts, port.written().len()), (3, 15));
}

#[test]
fn cut_request_is_ended_before_the_next_one() {
    let port = Memory::default();
    *port.room.lock().unwrap() = Some(7);
    let arm = over(
        &port,
        Options {
            deadline: Some(Duration::from_millis(300)),
            ..Options::default()
        },
    );
    let Err(Error::LinkError { written, .. }) = arm.send_angles([0.0; 6], 50) else {
        panic!("it was written");
    };
    assert_eq!(written, Some(7));
    *port.room.lock().unwrap() = None;
    arm.stop().unwrap();
    let sent = port.written();
    // The rest of the frame that was begun is filled up, so that the stop stands alone.
    assert!(sent.len() >= 18 + STOP.len() && sent.ends_with(&STOP));
}

#[test]
fn limits_refuse_speed_place_and_lasting_writes() {
    let workspace = Some([None, None, Some((200.0, 500.0))]);
    let limits = Limits {
        speed: Some(50.0),
        workspace,
    };
    let port = Memory::default();
    let arm = over(
        &port,
        Options {
            limits,
            ..Options::default()
        },
    );
    let texts = [
        (
            arm.send_coords([100.0, 0.0, 300.0, 0.0, 0.0, 0.0], 51, None),
            "speed is 51; allowed: a whole number 1..50 percent",
        ),
        (
            arm.send_angles([0.0, 90.0, 0.0, 0.0, 0.0, 0.0], 50),
            "where the end would go is not known before",
        ),
        (
            arm.send_coords([100.0, 0.0, 50.0, 0.0, 0.0, 0.0], 50, None),
            "coords.z is 50.0; allowed: a number 200..",
        ),
        (
            arm.set_servo_calibration(1),
            "its effect stays, and limits.speed",
        ),
        (
            arm.set_tool_reference([0.0; 6]),
            "it changes what coordinates mean",
        ),
    ];
    for (outcome, text) in texts {
        let Err(error) = outcome else {
            panic!("not refused: {text}")
        };
        let message = error.to_string();
        assert!(message.contains(text), "{message}");
    }
    assert!(port.written().is_empty());
    arm.stop().unwrap();
}

#[test]
fn poll_skips_periods_without_reply() {
    let port = Memory::replying(0x20, &ANGLES);
    let arm = over(&port, Options::default());
    let samples: Vec<_> = arm.poll(GetAngles {}, 200.0).unwrap().take(3).collect();
    assert!(
        samples
            .iter()
            .all(|sample| sample.as_ref().unwrap().value[0] == 1.4)
    );
    assert!(arm.poll(GetAngles {}, 0.0).is_err());
}

#[test]
fn event_of_device_is_received() {
    let port = Memory::default();
    let arm = Pro630::over(port.clone(), Options::default()).unwrap();
    let mut events = arm.events(Some(Duration::from_millis(200))).unwrap();
    let frame = [0xFE, 0xFE, 0x04, 0x5B, 0x00, 0xCD, 0x46];
    port.incoming.lock().unwrap().extend(frame);
    assert_eq!(events.next(), Some(Ok(pro630::MotionEnded { status: 0 })));
    assert_eq!(events.next(), None);
}

#[test]
fn dropped_future_is_given_up_and_its_reply_is_late() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(1000);
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        let short = Duration::from_millis(50);
        assert!(tokio::time::timeout(short, arm.get_angles()).await.is_err());
        let mut sent = [0; 100];
        let size = tokio::io::AsyncReadExt::read(&mut far, &mut sent)
            .await
            .unwrap();
        assert_eq!(size, 5);
        // A second request that looks the same is held, since the late reply may still come.
        assert!(tokio::time::timeout(short, arm.get_angles()).await.is_err());
        let more = tokio::io::AsyncReadExt::read(&mut far, &mut sent);
        assert!(tokio::time::timeout(short, more).await.is_err());
    });
}

/// Return a runtime of the asynchronous tests.
fn runtime() -> tokio::runtime::Runtime {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    builder.enable_all().build().unwrap()
}

/// Return an error and how much of the request it says was written.
fn lost<T: std::fmt::Debug>(outcome: Result<T, Error>) -> (String, Option<usize>) {
    match outcome.unwrap_err() {
        Error::LinkError { message, written } => (message, written),
        other => panic!("{other:?}"),
    }
}

#[test]
fn full_line_delays_neither_the_refusal_of_a_stop_nor_a_close() {
    runtime().block_on(async {
        let (near, far) = tokio::io::duplex(10);
        let deadline = Some(Duration::from_millis(200));
        let options = Options {
            deadline,
            ..Options::default()
        };
        let arm = AsyncMyCobot280::over(near, options).unwrap();
        let begun = Instant::now();
        let (moved, stopped) = tokio::join!(arm.send_angles([0.0; 6], 50), arm.stop());
        assert!(begun.elapsed() < Duration::from_secs(1));
        assert_eq!(lost(moved).1, Some(10));
        let Err(Error::ReplyTimeout {
            message, attempts, ..
        }) = stopped
        else {
            panic!("{stopped:?}");
        };
        assert!(message.starts_with("stop() was not sent: its deadline passed"));
        assert!(message.ends_with("while the line took no bytes"));
        assert_eq!(attempts, 0);
        // The rest of the cut request is stuck, and then nobody waits any more.
        let closed = async {
            tokio::time::sleep(Duration::from_millis(20)).await;
            arm.close().await;
        };
        let (stopped, ()) = tokio::join!(arm.stop(), closed);
        let text = "port: cannot be written: the client was closed";
        assert_eq!(lost(stopped), (text.to_owned(), Some(0)));
        drop(far);
    });
}

#[test]
fn stop_is_sent_when_a_full_line_takes_bytes_again() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(10);
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        let mut sent = [0; 23];
        let read = async {
            tokio::time::sleep(Duration::from_millis(20)).await;
            tokio::io::AsyncReadExt::read_exact(&mut far, &mut sent).await
        };
        let calls = async { tokio::join!(arm.send_angles([0.0; 6], 50), arm.stop()) };
        let ((moved, stopped), read) = tokio::join!(calls, read);
        assert_eq!((moved, stopped, read.unwrap()), (Ok(()), Ok(()), 23));
        assert!(sent.ends_with(&STOP));
    });
}

#[test]
fn request_that_was_given_up_at_a_full_line_is_not_sent() {
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(10);
        let arm = AsyncMyCobot280::over(near, Options::default()).unwrap();
        let short = Duration::from_millis(20);
        let moved = arm.send_angles([0.0; 6], 50);
        assert!(tokio::time::timeout(short, moved).await.is_err());
        let powered = arm.power_off();
        assert!(tokio::time::timeout(short, powered).await.is_err());
        // The request that was begun is written to its end, so that the stop is a frame of its own.
        let mut sent = [0; 24];
        let read = tokio::io::AsyncReadExt::read_exact(&mut far, &mut sent);
        let (stopped, read) = tokio::join!(arm.stop(), tokio::time::timeout(10 * short, read));
        assert_eq!(stopped, Ok(()));
        assert!(read.is_err() && sent[18..23] == STOP && sent[23] == 0);
    });
}

#[test]
fn error_says_how_much_of_a_request_was_written() {
    let port = Memory::default();
    let arm = over(&port, Options::default());
    let waiting = arm.clone();
    let waiting = std::thread::spawn(move || waiting.get_angles());
    while port.written().is_empty() {
        std::thread::yield_now();
    }
    arm.close().unwrap();
    // A request that was written whole, and two that were not sent.
    assert_eq!(lost(waiting.join().unwrap()).1, Some(5));
    assert_eq!(
        lost(arm.get_angles()),
        ("port: is closed".to_owned(), Some(0))
    );
    let acknowledged = arm.acknowledged(Duration::from_secs(1));
    assert_eq!(lost(acknowledged.stop()).1, Some(0));
    assert_eq!(port.written().len(), 5);
}

#[test]
fn stop_does_not_wait_for_the_reply_that_another_thread_waits_for() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let arm = MyCobot280::open(&format!("socket://{}", listener.local_addr().unwrap())).unwrap();
    let mut far = listener.accept().unwrap().0;
    let waiting = arm.clone();
    let waiting = std::thread::spawn(move || waiting.get_angles());
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
    assert_eq!(lost(waiting.join().unwrap()).1, Some(5));
}

#[cfg(all(unix, feature = "serial"))]
#[test]
fn serial_port_of_the_caller_never_waits_longer_than_the_deadline() {
    let (near, far) = serialport::TTYPort::pair().unwrap();
    let near: Box<dyn serialport::SerialPort> = Box::new(near);
    let deadline = Some(Duration::from_millis(100));
    let options = Options {
        deadline,
        on_drop: OnDrop::Leave,
        ..Options::default()
    };
    let arm = MyCobot280::over(near, options).unwrap();
    // Nobody reads what the other end of the line receives.
    let mut last = Instant::now();
    let refused = (0..10_000).find_map(|_| {
        last = Instant::now();
        arm.stop().err()
    });
    assert!(last.elapsed() < Duration::from_secs(1));
    assert!(refused.is_some(), "the line is never full");
    drop(far);
}

#[test]
fn events_and_samples_are_streams() {
    async fn next<S: futures_core::Stream + Unpin>(mut stream: S) -> Option<S::Item> {
        std::future::poll_fn(|context| std::pin::Pin::new(&mut stream).poll_next(context)).await
    }
    runtime().block_on(async {
        let (near, mut far) = tokio::io::duplex(1000);
        let arm = pro630::AsyncPro630::over(near, Options::default()).unwrap();
        let events = arm.events(Some(Duration::from_millis(500))).unwrap();
        let samples = arm.poll(pro630::messages::IsMoving {}, 100.0).unwrap();
        let frame = [0xFE, 0xFE, 0x04, 0x5B, 0x00, 0xCD, 0x46];
        let sent = tokio::io::AsyncWriteExt::write_all(&mut far, &frame);
        let (event, sent) = tokio::join!(next(events), sent);
        sent.unwrap();
        assert_eq!(event, Some(Ok(pro630::MotionEnded { status: 0 })));
        drop(far);
        assert!(matches!(
            next(samples).await,
            Some(Err(Error::LinkError { .. }))
        ));
    });
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
    let mut received = Vec::new();
    listener
        .accept()
        .unwrap()
        .0
        .read_to_end(&mut received)
        .unwrap();
    assert!(received.ends_with(&STOP));
}
