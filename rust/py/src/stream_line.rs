//! The requests of asyncio streams. As long as nothing else happens on a line, they are sent and their
//! replies taken here, and Python only wakes up the consumer.
//!
//! The session knows nothing of it meanwhile: it is lent. Whatever uses the session calls `give_back`
//! first, and what is under way then goes on in Python. All calls come from the thread of the loop.

use std::mem;
use std::os::fd::RawFd;
use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyTuple};
use rustix::io::read;

use crate::descriptor::{borrow, write_if_free};
use crate::framer::{NativeFramer, Taken};
use crate::session::{Held, hold};
use crate::swap::now;

/// The most bytes that one call reads: replies are far shorter.
const READ_SIZE: usize = 1024;

/// One line, which the loop watches: it calls this when the line can be read.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct StreamLine {
    framer: Py<NativeFramer>,
    transport: Py<PyAny>,
    listeners: Py<PyAny>,
    /// The `AsyncSteps` of the line.
    steps: Py<PyAny>,
    /// `(False,)`: the arguments of `acquire` that do not wait.
    at_once: Py<PyTuple>,
    state: Mutex<State>,
}

/// Never locked while code of Python's may run, which may come back here.
#[derive(Default)]
struct State {
    /// Whether the session was free, and has not been used since.
    lent: bool,
    /// The last one-way request, which the line may echo; empty: there is none.
    one_way: Vec<u8>,
    /// The last request since the session was lent, and how many bytes had been received by then.
    latest: Option<(Py<PyBytes>, u64)>,
    under_way: Option<UnderWay>,
    /// Whether a timer will look for a request without a reply.
    timed: bool,
}

/// A request that was sent, and has no reply yet.
struct UnderWay {
    slot: Py<StreamSlot>,
    plan: Plan,
    requested_at: f64,
    fed: u64,
}

/// What a slot is to send.
struct Plan {
    frame: Py<PyBytes>,
    command: Py<PyAny>,
    /// For how many seconds its reply is waited for.
    wait: f64,
    /// The future of its consumer.
    over: Py<PyAny>,
}

/// What became of a request.
enum Sent {
    /// The session must send it, step by step.
    No,
    /// Nobody wants it any longer.
    Unwanted,
    /// So many bytes of it were written, and this is when its wait ends, if that needs a timer.
    Written(usize, Option<f64>),
}

/// What has come.
enum Came<'py> {
    /// Nothing that is to be decided here.
    Unknown,
    Reply,
    /// These events; so many bytes had been received before.
    Events(Bound<'py, PyList>, u64),
}

#[pymethods]
impl StreamLine {
    #[new]
    #[pyo3(signature = (framer, transport, listeners, steps, /))]
    fn new(
        py: Python<'_>,
        framer: Py<NativeFramer>,
        transport: Py<PyAny>,
        listeners: Py<PyAny>,
        steps: Py<PyAny>,
    ) -> PyResult<Self> {
        Ok(Self {
            framer,
            transport,
            listeners,
            steps,
            at_once: PyTuple::new(py, [false])?.unbind(),
            state: Mutex::default(),
        })
    }

    /// Take what has come.
    fn __call__(&self, py: Python<'_>) -> PyResult<()> {
        let steps = self.steps.bind(py);
        match self.take(py)? {
            Came::Reply => Ok(()),
            Came::Unknown => steps.call_method0(intern!(py, "turn")).map(|_| ()),
            Came::Events(events, fed) => steps
                .call_method1(intern!(py, "received"), (events, fed))
                .map(|_| ()),
        }
    }

    /// Use the session no longer. Return None if it was not lent; otherwise the last request and how
    /// many bytes had been received before it; and the slot that waits for its reply, with its moment.
    fn give_back<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyTuple>>> {
        let (latest, under_way) = {
            let mut state = self.state();
            if !mem::take(&mut state.lent) {
                return Ok(None);
            }
            (state.latest.take(), state.under_way.take())
        };
        let waiting = under_way.map(|sent| {
            let slots = sent.slot.get().slots.clone_ref(py);
            (slots, sent.requested_at, sent.fed)
        });
        (latest, waiting).into_pyobject(py).map(Some)
    }

    /// Return until when a reply is waited for; None: for none.
    fn waits_until(&self) -> Option<f64> {
        let mut state = self.state();
        let until = state
            .under_way
            .as_ref()
            .map(|sent| sent.requested_at + sent.plan.wait);
        state.timed = until.is_some();
        until
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.transport)?;
        visit.call(&self.listeners)?;
        visit.call(&self.steps)?;
        if let Ok(state) = self.state.try_lock()
            && let Some(sent) = &state.under_way
        {
            visit.call(&sent.slot)?;
            visit.call(&sent.plan.over)?;
        }
        Ok(())
    }
}

impl StreamLine {
    fn state(&self) -> MutexGuard<'_, State> {
        // Nothing panics while it is locked.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Return the descriptor, which stays open as long as the first is held; None: it is not free.
    fn borrowed<'py>(&self, py: Python<'py>) -> PyResult<Option<(Held<'py>, RawFd)>> {
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
    fn is_free(&self, py: Python<'_>) -> PyResult<bool> {
        let silent = self.listeners.bind(py).getattr(intern!(py, "silent"))?;
        if !silent.is_truthy()? {
            return Ok(false);
        }
        {
            let state = self.state();
            if state.lent {
                return Ok(state.under_way.is_none());
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

    /// Send what a slot planned.
    fn send(&self, slot: &Bound<'_, StreamSlot>) -> PyResult<Sent> {
        let py = slot.py();
        let Some(plan) = slot.get().taken() else {
            return Ok(Sent::No);
        };
        let done = plan.over.bind(py).call_method0(intern!(py, "done"))?;
        if done.is_truthy()? {
            return Ok(Sent::Unwanted);
        }
        if !self.is_free(py)? {
            return Ok(Sent::No);
        }
        let Some((held, descriptor)) = self.borrowed(py)? else {
            return Ok(Sent::No);
        };
        let fed = self.framer.bind(py).try_borrow()?.fed();
        let requested_at = now();
        let written = write_if_free(descriptor, plan.frame.as_bytes(py))?;
        drop(held);
        if written == 0 {
            return Ok(Sent::No);
        }
        let until = requested_at + plan.wait;
        let latest = Some((plan.frame.clone_ref(py), fed));
        let under_way = Some(UnderWay {
            slot: slot.clone().unbind(),
            plan,
            requested_at,
            fed,
        });
        let mut state = self.state();
        let before = (
            mem::replace(&mut state.latest, latest),
            mem::replace(&mut state.under_way, under_way),
        );
        let timed = mem::replace(&mut state.timed, true);
        drop(state);
        drop(before);
        Ok(Sent::Written(written, (!timed).then_some(until)))
    }

    /// Read what has come for the request that is under way; end it if this is its reply alone.
    fn take<'py>(&self, py: Python<'py>) -> PyResult<Came<'py>> {
        let Some((request, command)) = self.state().under_way.as_ref().map(|sent| {
            let plan = &sent.plan;
            (plan.frame.clone_ref(py), plan.command.clone_ref(py))
        }) else {
            return Ok(Came::Unknown);
        };
        let listeners = self.listeners.bind(py).getattr(intern!(py, "listeners"))?;
        if listeners.is_truthy()? {
            return Ok(Came::Unknown);
        }
        let Some((held, descriptor)) = self.borrowed(py)? else {
            return Ok(Came::Unknown);
        };
        let mut space = [0; READ_SIZE];
        let size = read(borrow(descriptor)?, &mut space).unwrap_or(0);
        let replied_at = now();
        drop(held);
        // The end of the data, and errors, come again when it is read the next time.
        let data = space.get(..size).unwrap_or_default();
        if data.is_empty() {
            return Ok(Came::Unknown);
        }
        let mut framer = self.framer.bind(py).try_borrow_mut()?;
        let fed = framer.fed();
        let taken = framer.take_reply(py, data, request.as_bytes(py), command.bind(py))?;
        drop(framer);
        let (frame, fields) = match taken {
            Taken::Reply(frame, fields) => (frame, fields),
            Taken::Events(events) => return Ok(Came::Events(events, fed)),
        };
        let sent = {
            let mut state = self.state();
            if state.one_way == data {
                None
            } else {
                state.under_way.take()
            }
        };
        let Some(UnderWay {
            plan, requested_at, ..
        }) = sent
        else {
            return Ok(Came::Events(PyList::new(py, [frame])?, fed));
        };
        let over = plan.over.bind(py);
        if !over.call_method0(intern!(py, "done"))?.is_truthy()? {
            let answer = (fields, requested_at, replied_at);
            over.call_method1(intern!(py, "set_result"), (answer,))?;
        }
        Ok(Came::Reply)
    }
}

/// Sends the requests of one stream. The timers of the loop call it at the moment of each.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct StreamSlot {
    line: Py<StreamLine>,
    /// The `AsyncSlots` of the stream.
    slots: Py<PyAny>,
    plan: Mutex<Option<Plan>>,
}

#[pymethods]
impl StreamSlot {
    #[new]
    #[pyo3(signature = (line, slots, /))]
    fn new(line: Py<StreamLine>, slots: Py<PyAny>) -> Self {
        Self {
            line,
            slots,
            plan: Mutex::default(),
        }
    }

    /// Plan what the next call sends, for a command; set `over` to its answer when it has come.
    #[pyo3(signature = (frame, command, wait, over, /))]
    fn plan(&self, frame: Py<PyBytes>, command: Py<PyAny>, wait: f64, over: Py<PyAny>) {
        let plan = Plan {
            frame,
            command,
            wait,
            over,
        };
        let before = self.locked().replace(plan);
        drop(before);
    }

    /// Forget what was planned: the next call leaves it to the session.
    fn forget(&self) {
        drop(self.taken());
    }

    /// Send what was planned, or have the session send it.
    fn __call__(slf: &Bound<'_, Self>) -> PyResult<()> {
        let (py, this) = (slf.py(), slf.get());
        let line = this.line.get();
        match line.send(slf)? {
            Sent::Unwanted => Ok(()),
            Sent::No => this
                .slots
                .bind(py)
                .call_method0(intern!(py, "send"))
                .map(|_| ()),
            Sent::Written(written, until) => {
                let steps = line.steps.bind(py);
                if let Some(until) = until {
                    steps.call_method1(intern!(py, "watch_until"), (until,))?;
                }
                let part = line.is_part(py, written);
                if part {
                    steps.call_method1(intern!(py, "finish_write"), (written,))?;
                }
                Ok(())
            }
        }
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.line)?;
        visit.call(&self.slots)?;
        if let Ok(plan) = self.plan.try_lock()
            && let Some(plan) = &*plan
        {
            visit.call(&plan.over)?;
        }
        Ok(())
    }
}

impl StreamSlot {
    fn locked(&self) -> MutexGuard<'_, Option<Plan>> {
        self.plan.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn taken(&self) -> Option<Plan> {
        self.locked().take()
    }
}

impl StreamLine {
    /// Return whether `written` bytes are only a part of the request that is under way.
    fn is_part(&self, py: Python<'_>, written: usize) -> bool {
        let state = self.state();
        let sent = state.under_way.as_ref();
        sent.is_some_and(|sent| written < sent.plan.frame.as_bytes(py).len())
    }
}
