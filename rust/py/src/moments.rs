//! Writes requests at their moments, in a thread that needs no lock of the interpreter.
//!
//! Beside a busy thread of Python, an event loop gets its turn up to 5 ms late. A request that is planned
//! here is written at its moment all the same. Whatever else happens on its line withdraws it first.

use std::collections::BTreeMap;
use std::os::fd::{AsFd, OwnedFd};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;
use rustix::io::write;

use crate::descriptor::can_be_read;
use crate::swap::now;

/// Requests of more lines than these are left to the loop: a thread gains nothing then.
const MOST_WAITING: usize = 64;
/// How often, and after which pause, the end of the thread is tried again.
const ATTEMPTS: u32 = 100;
const RETRY: Duration = Duration::from_micros(100);
const NANOSECONDS: f64 = 1e9;

/// The request that one line is to send next.
#[derive(Default)]
pub struct ScheduledWrite(Mutex<WriteState>);

/// At most one of the two is there.
#[derive(Default)]
struct WriteState {
    planned: Option<Planned>,
    written: Option<Written>,
}

struct Planned {
    at: u64,
    frame: Vec<u8>,
    /// A descriptor of its own for the line: this number means no other file, whoever closes what.
    descriptor: OwnedFd,
}

/// A request that was written.
pub struct Written {
    pub requested_at: f64,
    /// How many bytes of it the system took.
    pub size: usize,
}

impl ScheduledWrite {
    fn state(&self) -> MutexGuard<'_, WriteState> {
        // Nothing panics while it is locked.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Return what was written since the plan; withdraw the plan if nothing was.
    pub fn withdraw(&self) -> Option<Written> {
        let (planned, written) = {
            let mut state = self.state();
            (state.planned.take(), state.written.take())
        };
        drop(planned);
        written
    }

    /// Return what was written since the plan, which stays if nothing was.
    pub fn written(&self) -> Option<Written> {
        self.state().written.take()
    }

    /// Withdraw the plan; what was written is returned later.
    pub fn cancel(&self) {
        let planned = self.state().planned.take();
        drop(planned);
    }

    /// Close what a forked child has a copy of. The thread may have held the lock, and is not there.
    pub fn leave_to_parent(&self) {
        if let Ok(mut state) = self.0.try_lock() {
            state.planned = None;
        }
    }

    /// Write what is planned for that moment, unless bytes have come that could pass for its reply.
    fn write(&self, at: u64) {
        let mut state = self.state();
        let Some(planned) = state.planned.take_if(|planned| planned.at == at) else {
            return;
        };
        let line = planned.descriptor.as_fd();
        if can_be_read(line) == Ok(false) {
            let requested_at = now();
            let size = write(line, &planned.frame).unwrap_or(0);
            state.written = (size > 0).then_some(Written { requested_at, size });
        }
        drop(state);
        drop(planned);
    }
}

#[derive(Default)]
struct Queue {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Lines that may have a plan, by the moment and a number that decides between equal moments.
    waiting: BTreeMap<(u64, u64), Weak<ScheduledWrite>>,
    planned: u64,
    ended: bool,
}

impl Queue {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Write at each moment, until the writer is gone.
    fn run(&self) {
        let mut state = self.state();
        while !state.ended {
            let Some((&(at, _), _)) = state.waiting.first_key_value() else {
                state = self
                    .changed
                    .wait(state)
                    .unwrap_or_else(PoisonError::into_inner);
                continue;
            };
            let left = at.saturating_sub(nanoseconds(now()));
            if left > 0 {
                let left = Duration::from_nanos(left);
                state = self
                    .changed
                    .wait_timeout(state, left)
                    .unwrap_or_else(PoisonError::into_inner)
                    .0;
                continue;
            }
            let due = state.waiting.pop_first();
            drop(state);
            if let Some(((at, _), scheduled)) = due
                && let Some(scheduled) = scheduled.upgrade()
            {
                scheduled.write(at);
            }
            state = self.state();
        }
    }
}

/// The thread of one event loop. It ends with this object.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct MomentWriter(Arc<Queue>);

#[pymethods]
impl MomentWriter {
    #[new]
    fn new() -> PyResult<Self> {
        let queue = Arc::new(Queue::default());
        let worked = Arc::clone(&queue);
        thread::Builder::new()
            .name("cobotwire".to_owned())
            .spawn(move || worked.run())?;
        Ok(Self(queue))
    }
}

impl MomentWriter {
    /// Have a request written to a line at a moment; return whether it is planned now.
    pub fn plan(
        &self,
        scheduled: &Arc<ScheduledWrite>,
        at: f64,
        frame: &[u8],
        descriptor: OwnedFd,
    ) -> bool {
        let at = nanoseconds(at);
        if self.0.state().waiting.len() >= MOST_WAITING {
            return false;
        }
        let planned = Planned {
            at,
            frame: frame.to_vec(),
            descriptor,
        };
        *scheduled.state() = WriteState {
            planned: Some(planned),
            written: None,
        };
        let mut state = self.0.state();
        state.planned += 1;
        let key = (at, state.planned);
        state.waiting.insert(key, Arc::downgrade(scheduled));
        drop(state);
        self.0.changed.notify_one();
        true
    }
}

impl Drop for MomentWriter {
    fn drop(&mut self) {
        // In a forked child the thread may have held the lock. It is not there.
        for _ in 0..ATTEMPTS {
            if let Ok(mut state) = self.0.state.try_lock() {
                state.ended = true;
                break;
            }
            thread::sleep(RETRY);
        }
        self.0.changed.notify_one();
    }
}

/// Return seconds of the monotonic clock as whole nanoseconds.
fn nanoseconds(seconds: f64) -> u64 {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the conversion saturates"
    )]
    let whole = (seconds * NANOSECONDS) as u64;
    whole
}
