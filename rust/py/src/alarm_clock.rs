//! A descriptor that becomes readable at a given time.
//! Event loops need it, because they round their waits to milliseconds.

use std::os::fd::{AsRawFd, OwnedFd, RawFd};
use std::time::Duration;

use pyo3::prelude::*;
use rustix::time::{
    Itimerspec, TimerfdClockId, TimerfdFlags, TimerfdTimerFlags, Timespec, timerfd_create,
    timerfd_settime,
};

use crate::descriptor::failed;

const NEVER: Timespec = Timespec {
    tv_sec: 0,
    tv_nsec: 0,
};

/// A descriptor that becomes readable at a given time.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct AlarmClock(OwnedFd);

#[pymethods]
impl AlarmClock {
    #[new]
    fn new() -> PyResult<Self> {
        let flags = TimerfdFlags::NONBLOCK | TimerfdFlags::CLOEXEC;
        timerfd_create(TimerfdClockId::Monotonic, flags)
            .map(Self)
            .map_err(failed)
    }

    /// Return the descriptor.
    fn fileno(&self) -> RawFd {
        self.0.as_raw_fd()
    }

    /// Make the descriptor readable from the time `due` on, in seconds of `time.monotonic`; None:
    /// never.
    #[pyo3(signature = (due, /))]
    fn set(&self, due: Option<f64>) -> PyResult<()> {
        let wakes_at = due.map_or(NEVER, |due| {
            // A time of 0 would switch it off.
            Duration::try_from_secs_f64(due.max(1e-9))
                .ok()
                .and_then(|due| Timespec::try_from(due).ok())
                .unwrap_or(NEVER)
        });
        let timer = Itimerspec {
            it_interval: NEVER,
            it_value: wakes_at,
        };
        timerfd_settime(&self.0, TimerfdTimerFlags::ABSTIME, &timer)
            .map(|_| ())
            .map_err(failed)
    }
}
