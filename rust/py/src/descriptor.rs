//! Reads, writes and waits for descriptors that never block: serial ports and sockets.
//!
//! `cobotwire.transport.descriptor` does the same in Python and is the specification. A call here
//! releases the interpreter's lock only while it waits, so a busy thread delays it only then.

#![allow(unsafe_code)] // Python passes descriptors as numbers

use std::mem::MaybeUninit;
use std::os::fd::{BorrowedFd, RawFd};
use std::time::{Duration, Instant};

use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::io::{Errno, read, write};

/// The most bytes that one call reads.
const READ_SIZE: usize = 4096;
/// No wait takes longer than this many seconds, which can be added to every clock's time.
const LONGEST: f64 = 1e9;
const AT_ONCE: Timespec = Timespec {
    tv_sec: 0,
    tv_nsec: 0,
};

/// Add the functions of this file to the module.
pub fn add_to(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_function(wrap_pyfunction!(write_now, module)?)?;
    module.add_function(wrap_pyfunction!(read_within, module)?)
}

/// Write what the system takes at once; return how many bytes that was.
#[pyfunction]
#[pyo3(signature = (descriptor, data, /))]
fn write_now(py: Python<'_>, descriptor: RawFd, data: &[u8]) -> PyResult<usize> {
    let descriptor = borrow(descriptor)?;
    loop {
        match write(descriptor, data) {
            Ok(count) => return Ok(count),
            Err(Errno::AGAIN) => return Ok(0),
            Err(Errno::INTR) => py.check_signals()?,
            Err(error) => return Err(failed(error)),
        }
    }
}

/// Read the received bytes, as soon as there are any; `b""` is the end of the data. Return None if
/// nothing arrived within `timeout` seconds, or before `alarm` became readable.
#[pyfunction]
#[pyo3(signature = (descriptor, timeout, alarm, /))]
fn read_within<'py>(
    py: Python<'py>,
    descriptor: RawFd,
    timeout: f64,
    alarm: RawFd,
) -> PyResult<Option<Bound<'py, PyBytes>>> {
    let wait = Wait::new(timeout, alarm)?;
    Ok(receive(py, borrow(descriptor)?, wait.as_ref())?)
}

/// Return the received bytes, as soon as there are any.
fn receive<'py>(
    py: Python<'py>,
    descriptor: BorrowedFd<'_>,
    wait: Option<&Wait<'_>>,
) -> Result<Option<Bound<'py, PyBytes>>, Fault> {
    let mut space = [MaybeUninit::uninit(); READ_SIZE];
    // A terminal without data reads as if the data had ended, so it is read only when it is ready.
    while is_ready(py, descriptor, wait)? {
        match read(descriptor, &mut space) {
            Ok((data, _)) => return Ok(Some(PyBytes::new(py, data))),
            // Another reader was faster.
            Err(Errno::AGAIN) if wait.is_some() => (),
            Err(Errno::AGAIN) => break,
            Err(Errno::INTR) => py.check_signals().map_err(Fault::Handler)?,
            Err(error) => return Err(Fault::System(error)),
        }
    }
    Ok(None)
}

/// A wait that takes time.
struct Wait<'fd> {
    until: Instant,
    /// Ends the wait when it becomes readable.
    alarm: BorrowedFd<'fd>,
}

impl Wait<'_> {
    /// Return a wait of `timeout` seconds; None if it takes no time.
    fn new(timeout: f64, alarm: RawFd) -> PyResult<Option<Self>> {
        Ok(if timeout > 0.0 {
            Some(Self {
                until: Instant::now() + Duration::from_secs_f64(timeout.min(LONGEST)),
                alarm: borrow(alarm)?,
            })
        } else {
            None
        })
    }
}

/// Return whether a descriptor can be read or has hung up; with `wait`, wait for that.
fn is_ready(
    py: Python<'_>,
    descriptor: BorrowedFd<'_>,
    wait: Option<&Wait<'_>>,
) -> Result<bool, Fault> {
    let Some(Wait { until, alarm }) = wait else {
        return can_be_read(descriptor).map_err(Fault::System);
    };
    let mut polled = [descriptor, *alarm].map(|each| PollFd::from_borrowed_fd(each, PollFlags::IN));
    loop {
        let left = until.saturating_duration_since(Instant::now());
        let left = Timespec::try_from(left).unwrap_or(AT_ONCE);
        match py.detach(|| poll(&mut polled, Some(&left))) {
            Ok(0) => return Ok(false),
            Ok(_) => {
                let [_, alarm] = &polled;
                return Ok(alarm.revents().is_empty());
            }
            // A signal arrived. Its handler runs here, and may raise KeyboardInterrupt.
            Err(Errno::INTR) => py.check_signals().map_err(Fault::Handler)?,
            Err(error) => return Err(Fault::System(error)),
        }
    }
}

/// Return whether a descriptor can be read now or has hung up.
fn can_be_read(descriptor: BorrowedFd<'_>) -> Result<bool, Errno> {
    let mut polled = [PollFd::from_borrowed_fd(descriptor, PollFlags::IN)];
    poll(&mut polled, Some(&AT_ONCE)).map(|count| count > 0)
}

/// Return the descriptor with that number.
fn borrow<'fd>(number: RawFd) -> PyResult<BorrowedFd<'fd>> {
    if number < 0 {
        return Err(failed(Errno::BADF));
    }
    // SAFETY: the number is not -1. `DescriptorTransport` holds a lock during the call, and takes it
    // before it closes the descriptor. Any other number is as harmless as in Python's `os.read`:
    // the descriptor is used only during the call and only by system calls, which reject closed
    // descriptors.
    Ok(unsafe { BorrowedFd::borrow_raw(number) })
}

/// Why a wait or a read failed.
enum Fault {
    System(Errno),
    /// The handler of a signal raised it.
    Handler(PyErr),
}

impl From<Fault> for PyErr {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::System(error) => failed(error),
            Fault::Handler(error) => error,
        }
    }
}

/// Return an error of the system as Python's `OSError`, of the class that fits its number.
pub fn failed(error: Errno) -> PyErr {
    let text = std::io::Error::from(error).to_string();
    PyOSError::new_err((error.raw_os_error(), text))
}
