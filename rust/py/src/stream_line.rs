//! A line with asyncio streams. As long as nothing else happens on it, requests are sent and replies taken
//! in native code (`stream_exchange`), and Python only wakes up the consumer.
//!
//! The session knows nothing of it meanwhile: it is lent. Whatever uses the session calls `give_back`
//! first, and what is under way then goes on in Python. All calls come from the thread of the loop,
//! but a thread may write what is planned (`moments`).

use std::mem;
use std::os::fd::RawFd;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::framer::NativeFramer;
use crate::moments::{ScheduledWrite, Written};
use crate::session::{Held, hold};
use crate::stream_plan::{Plan, Slot};

/// One line, which the loop watches: it calls this when the line can be read.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct StreamLine {
    pub framer: Py<NativeFramer>,
    pub transport: Py<PyAny>,
    pub listeners: Py<PyAny>,
    /// The `AsyncSteps` of the line.
    pub steps: Py<PyAny>,
    /// `(False,)`: the arguments of `acquire` that do not wait.
    pub at_once: Py<PyTuple>,
    pub state: Mutex<State>,
    /// What the thread is to write. Its lock is taken last.
    pub scheduled: Arc<ScheduledWrite>,
}

/// Never locked while code of Python's may run, which may come back here.
#[derive(Default)]
pub struct State {
    /// Whether the session was free, and has not been used since.
    pub lent: bool,
    /// The last one-way request, which the line may echo; empty: there is none.
    pub one_way: Vec<u8>,
    /// The last request since the session was lent, and how many bytes had been received by then.
    pub latest: Option<(Py<PyBytes>, u64)>,
    pub under_way: Option<UnderWay>,
    /// Whose request the thread is to write, and how many bytes had been received by then.
    pub planned: Option<(Arc<Slot>, u64)>,
    /// Whether a timer will look for a request without a reply.
    pub timed: bool,
}

/// A request that was sent, and has no reply yet.
pub struct UnderWay {
    pub slot: Arc<Slot>,
    pub plan: Plan,
    pub requested_at: f64,
    /// How many bytes of it were written.
    pub written: usize,
    pub fed: u64,
}

impl StreamLine {
    pub fn state(&self) -> MutexGuard<'_, State> {
        // Nothing panics while it is locked.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Return the descriptor, which stays open as long as the first is held; None: it is not free.
    pub fn borrowed<'py>(&self, py: Python<'py>) -> PyResult<Option<(Held<'py>, RawFd)>> {
        let loan = self.transport.bind(py).getattr(intern!(py, "loan"))?;
        if loan.is_none() {
            return Ok(None);
        }
        let loan = loan.cast_into::<PyTuple>()?;
        let at_once = self.at_once.bind(py);
        let Some(held) = hold(&loan.get_item(0)?, &loan.get_item(1)?, at_once)? else {
            return Ok(None);
        };
        Ok(Some((held, loan.get_item(2)?.extract()?)))
    }

    /// Return whether the session is lent, or can be.
    pub fn is_free(&self, py: Python<'_>) -> PyResult<bool> {
        let silent = self.listeners.bind(py).getattr(intern!(py, "silent"))?;
        if !silent.is_truthy()? {
            return Ok(false);
        }
        {
            let state = self.state();
            if state.lent {
                return Ok(state.under_way.is_none() && state.planned.is_none());
            }
        }
        let lent = self
            .steps
            .bind(py)
            .call_method0(intern!(py, "lend_session"))?;
        let Ok(one_way) = lent.cast_into::<PyBytes>() else {
            return Ok(false);
        };
        let mut state = self.state();
        state.lent = true;
        state.one_way = one_way.as_bytes().to_vec();
        Ok(true)
    }

    /// Forget whose request the thread was to write.
    pub fn forget_plan(&self) {
        let planned = self.state().planned.take();
        drop(planned);
    }

    /// Note that the thread has written what was planned; return whether it has.
    pub fn learn(&self, py: Python<'_>, written: Option<Written>) -> bool {
        let Some(Written { requested_at, size }) = written else {
            return false;
        };
        let Some((slot, fed)) = self.state().planned.take() else {
            return false;
        };
        let plan = slot.taken();
        if let Some(plan) = plan {
            self.begin(py, slot, plan, requested_at, size, fed);
        }
        true
    }

    /// Note a request that was written.
    pub fn begin(
        &self,
        py: Python<'_>,
        slot: Arc<Slot>,
        plan: Plan,
        requested_at: f64,
        written: usize,
        fed: u64,
    ) {
        slot.locked().sent = true;
        let latest = Some((plan.frame.clone_ref(py), fed));
        let under_way = Some(UnderWay {
            slot,
            plan,
            requested_at,
            written,
            fed,
        });
        let mut state = self.state();
        let before = (
            mem::replace(&mut state.latest, latest),
            mem::replace(&mut state.under_way, under_way),
        );
        drop(state);
        drop(before);
    }
}
