//! One exchange over a line: wait for its moment, write a request, wait for the reply and read it,
//! without the lock of the interpreter.
//!
//! Beside a busy thread of Python, each time that this lock is taken costs up to its switch interval of
//! 5 ms. So it is released once for all of it. `LineLock` keeps other threads from writing in between.

use std::os::fd::{BorrowedFd, RawFd};
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyRuntimeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, read, write};
use rustix::time::{ClockId, clock_gettime};

use crate::descriptor::{borrow, can_be_read};

/// How long a thread that waits for the lock sleeps between two attempts. It is rarely held for longer
/// than one system call.
const RETRY: Duration = Duration::from_micros(200);
/// The most bytes that are read: replies are far shorter.
const READ_SIZE: usize = 1024;
/// No wait is longer than this many seconds.
const LONGEST: f64 = 1e9;

/// The lock that is held while a thread writes to a line. It can be taken without the lock of the
/// interpreter. Python uses it like a `threading.Lock`.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct LineLock {
    /// Twice the number of times that it was taken and released, and 1 more while it is held.
    state: AtomicU64,
}

impl LineLock {
    /// Take it if it is as it was when `state` was read, and was free then.
    fn take_if(&self, state: u64) -> bool {
        state.is_multiple_of(2)
            && self
                .state
                .compare_exchange(state, state + 1, Ordering::Acquire, Ordering::Relaxed)
                .is_ok()
    }

    /// A number that changes whenever it is taken or freed.
    pub fn state(&self) -> u64 {
        self.state.load(Ordering::Relaxed)
    }

    fn free(&self) {
        self.state.fetch_add(1, Ordering::Release);
    }
}

#[pymethods]
impl LineLock {
    #[new]
    fn new() -> Self {
        Self {
            state: AtomicU64::new(0),
        }
    }

    /// Take it; return whether it was taken, which only `blocking=False` leaves open.
    #[pyo3(signature = (blocking = true))]
    fn acquire(&self, py: Python<'_>, blocking: bool) -> PyResult<bool> {
        while !self.take_if(self.state()) {
            if !blocking {
                return Ok(false);
            }
            py.check_signals()?;
            py.detach(|| thread::sleep(RETRY));
        }
        Ok(true)
    }

    /// Free it; any thread may.
    fn release(&self) -> PyResult<()> {
        if !self.locked() {
            return Err(PyRuntimeError::new_err("release unlocked lock"));
        }
        self.free();
        Ok(())
    }

    /// Whether it is held.
    fn locked(&self) -> bool {
        !self.state().is_multiple_of(2)
    }

    fn __enter__(&self, py: Python<'_>) -> PyResult<bool> {
        self.acquire(py, true)
    }

    #[pyo3(signature = (*_error))]
    fn __exit__(&self, _error: &Bound<'_, PyAny>) -> PyResult<()> {
        self.release()
    }

    /// How often it was taken.
    #[getter]
    fn taken(&self) -> u64 {
        self.state().div_ceil(2)
    }
}

/// A line to write a request to and to read its reply from.
pub struct Line<'a, 'py> {
    pub descriptor: RawFd,
    /// Becomes readable to end the wait.
    pub alarm: RawFd,
    pub writing: &'a LineLock,
    /// Its method `finish_write` is called with a request of which a part was taken, and the size of
    /// this part, to write the rest.
    pub caller: &'a Bound<'py, PyAny>,
}

/// What became of a request.
pub enum Swapped<T> {
    /// The line was not free: bytes had come, or a thread wrote, or the system took no bytes; or the
    /// alarm came first.
    NotSent,
    /// It was written, and no bytes came.
    Silent,
    /// What was made of the bytes that came then, the moment before it was written, and when they
    /// were read: the reply was made between the two.
    Received(T, f64, f64),
}

/// How far an exchange has come, in seconds of the monotonic clock.
enum Progress {
    /// The request is to be written.
    Waiting,
    /// It was written between these two moments. The thread may have been interrupted there.
    Sent { requested_at: f64, sent_at: f64 },
}

/// Why the lock of the interpreter is needed again.
enum Step {
    NotSent,
    /// The system took so many bytes of the request; the lock of the line is held.
    Partly(usize),
    /// That many bytes were read, at that moment.
    Read(usize, f64),
    Silent,
}

impl Line<'_, '_> {
    /// Write a request at the moment `at`, and return what `take` makes of the bytes that come
    /// within `timeout` seconds. Nothing is written if a thread has written by then.
    pub fn swap<T>(
        &self,
        py: Python<'_>,
        at: f64,
        timeout: f64,
        request: &[u8],
        take: impl FnOnce(&[u8]) -> T,
    ) -> PyResult<Swapped<T>> {
        let mut run = Run {
            descriptor: borrow(self.descriptor)?,
            alarm: borrow(self.alarm)?,
            lock: self.writing,
            seen: self.writing.state(),
            at,
            timeout,
            request,
            progress: Progress::Waiting,
        };
        let mut space = [0; READ_SIZE];
        loop {
            match (py.detach(|| run.step(&mut space)), &run.progress) {
                (Ok(Step::Partly(written)), _) => self.write_rest(py, request, written)?,
                (Ok(Step::Read(size, replied_at)), Progress::Sent { requested_at, .. }) => {
                    let data = space.get(..size).unwrap_or_default();
                    return Ok(Swapped::Received(take(data), *requested_at, replied_at));
                }
                // A signal came. Its handler runs here, and may raise KeyboardInterrupt.
                (Err(Errno::INTR), _) => py.check_signals()?,
                // If the line failed, the next use fails in the same way, and reports it.
                (_, Progress::Waiting) => return Ok(Swapped::NotSent),
                (_, Progress::Sent { .. }) => return Ok(Swapped::Silent),
            }
        }
    }

    fn write_rest(&self, py: Python<'_>, request: &[u8], written: usize) -> PyResult<()> {
        let rest = (PyBytes::new(py, request), written);
        let done = self.caller.call_method1(intern!(py, "finish_write"), rest);
        self.writing.free();
        done.map(|_| ())
    }
}

/// An exchange that is under way. It has no use for Python.
struct Run<'a> {
    descriptor: BorrowedFd<'a>,
    alarm: BorrowedFd<'a>,
    lock: &'a LineLock,
    /// The state of the lock when the exchange began.
    seen: u64,
    at: f64,
    timeout: f64,
    request: &'a [u8],
    progress: Progress,
}

impl Run<'_> {
    /// Go on until Python is needed.
    fn step(&mut self, space: &mut [u8]) -> Result<Step, Errno> {
        // Reading the clock is a hundredth of a call, so each moment is read once.
        let (sent_at, mut from) = match self.progress {
            Progress::Sent { sent_at, .. } => (sent_at, now()),
            Progress::Waiting => {
                let mut requested_at = now();
                if self.at > requested_at {
                    if wait([self.alarm], self.at - requested_at)?.is_some() {
                        return Ok(Step::NotSent);
                    }
                    requested_at = now();
                }
                let Some(written) = self.write() else {
                    return Ok(Step::NotSent);
                };
                let sent_at = now();
                self.progress = Progress::Sent {
                    requested_at,
                    sent_at,
                };
                if written < self.request.len() {
                    return Ok(Step::Partly(written));
                }
                self.lock.free();
                (sent_at, sent_at)
            }
        };
        // A terminal without data reads as if the data had ended, so it is read only if it is ready.
        // The alarm, or the end of the time, is the end of the wait.
        let until = sent_at + self.timeout;
        while wait([self.descriptor, self.alarm], until - from)? == Some(true) {
            match read(self.descriptor, &mut *space) {
                Ok(size) => return Ok(Step::Read(size, now())),
                // Another reader was faster.
                Err(Errno::AGAIN) => from = now(),
                Err(error) => return Err(error),
            }
        }
        Ok(Step::Silent)
    }

    /// Write the request with the lock of the line; return how many bytes were taken, and keep the
    /// lock. None: nothing was written, and the lock is free.
    fn write(&self) -> Option<usize> {
        if !self.lock.take_if(self.seen) {
            return None;
        }
        let written = match can_be_read(self.descriptor) {
            Ok(false) => write(self.descriptor, self.request).unwrap_or(0),
            _ => 0,
        };
        if written == 0 {
            self.lock.free();
            return None;
        }
        Some(written)
    }
}

/// Wait until one of the descriptors can be read, or is gone; return whether the first is. None: none
/// is after that many seconds.
fn wait<const N: usize>(
    descriptors: [BorrowedFd<'_>; N],
    seconds: f64,
) -> Result<Option<bool>, Errno> {
    let left = Duration::from_secs_f64(seconds.clamp(0.0, LONGEST));
    let left = Timespec::try_from(left).map_err(|_| Errno::INVAL)?;
    let mut polled = descriptors.map(|each| PollFd::from_borrowed_fd(each, PollFlags::IN));
    let count = poll(&mut polled, Some(&left))?;
    let first = polled
        .first()
        .is_some_and(|each| !each.revents().is_empty());
    Ok((count > 0).then_some(first))
}

/// Return the seconds of the monotonic clock, as Python's `time.monotonic` does.
pub fn now() -> f64 {
    Duration::try_from(clock_gettime(ClockId::Monotonic)).map_or(0.0, |time| time.as_secs_f64())
}
