//! Send the requests of streams, and take their replies, without the session.

use std::mem;
use std::sync::{Arc, Mutex};

use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};
use rustix::io::read;

use crate::descriptor::{borrow, write_if_free};
use crate::framer::{NativeFramer, Taken};
use crate::moments::MomentWriter;
use crate::stream_line::{StreamLine, UnderWay};
use crate::stream_plan::Slot;
use crate::swap::now;

/// The most bytes that one call reads: replies are far shorter.
const READ_SIZE: usize = 1024;

/// What became of a request.
pub enum Sent {
    /// The session must send it, step by step.
    No,
    /// Nobody wants it any longer, or it has its reply.
    Over,
    Written,
    /// The thread has written it, so its reply may be there.
    Before,
}

/// What has come.
pub enum Came<'py> {
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
            scheduled: Arc::default(),
        })
    }

    /// Take what has come.
    fn __call__(&self, py: Python<'_>) -> PyResult<()> {
        if self.learn(py, self.scheduled.written()) {
            self.watch(py)?;
        }
        let steps = self.steps.bind(py);
        match self.take(py)? {
            Came::Reply => Ok(()),
            Came::Unknown => steps.call_method0(intern!(py, "turn")).map(|_| ()),
            Came::Events(events, fed) => self.report(events, fed),
        }
    }

    /// Use the session no longer. Return None if it was not lent; otherwise the last request and how
    /// many bytes had been received before it; and the slot that waits for its reply, with its moment,
    /// and how many bytes of it were written.
    fn give_back<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyTuple>>> {
        self.learn(py, self.scheduled.withdraw());
        self.forget_plan();
        let (latest, under_way) = {
            let mut state = self.state();
            if !mem::take(&mut state.lent) {
                return Ok(None);
            }
            (state.latest.take(), state.under_way.take())
        };
        let waiting = under_way.map(|sent| {
            let slots = sent.slot.slots.clone_ref(py);
            (slots, sent.requested_at, sent.fed, sent.written)
        });
        (latest, waiting).into_pyobject(py).map(Some)
    }

    /// Return for how many seconds more a reply is waited for, 0 if that time has passed; None: no reply
    /// is. If seconds are left, a timer must look again then.
    fn seconds_left(&self, py: Python<'_>) -> Option<f64> {
        self.learn(py, self.scheduled.written());
        let mut state = self.state();
        let left = state
            .under_way
            .as_ref()
            .map(|sent| (sent.requested_at + sent.plan.wait - now()).max(0.0));
        state.timed = left.is_some_and(|left| left > 0.0);
        left
    }

    /// Withdraw what the thread is to write: the transport closes. Any thread may call it.
    fn withdraw(&self) {
        self.scheduled.cancel();
    }

    /// Let go of what a forked child has a copy of.
    fn leave_to_parent(&self) {
        self.scheduled.leave_to_parent();
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.transport)?;
        visit.call(&self.listeners)?;
        visit.call(&self.steps)?;
        if let Ok(state) = self.state.try_lock()
            && let Some(sent) = &state.under_way
        {
            visit.call(&sent.plan.over)?;
        }
        Ok(())
    }
}

impl StreamLine {
    /// Send what a slot planned, unless the thread has.
    pub fn send(&self, py: Python<'_>, slot: &Arc<Slot>) -> PyResult<Sent> {
        self.learn(py, self.scheduled.withdraw());
        self.forget_plan();
        if slot.locked().sent {
            return Ok(Sent::Before);
        }
        let Some(plan) = slot.taken() else {
            return Ok(Sent::No);
        };
        let done = plan.over.bind(py).call_method0(intern!(py, "done"))?;
        if done.is_truthy()? {
            return Ok(Sent::Over);
        }
        if !self.is_free(py)? {
            return Ok(Sent::No);
        }
        let Some((held, descriptor)) = self.borrowed(py)? else {
            return Ok(Sent::No);
        };
        let fed = self.framer.get().fed();
        let requested_at = now();
        let written = write_if_free(descriptor, plan.frame.as_bytes(py))?;
        drop(held);
        if written == 0 {
            return Ok(Sent::No);
        }
        self.begin(py, Arc::clone(slot), plan, requested_at, written, fed);
        Ok(Sent::Written)
    }

    /// Have the thread write what a slot planned at that moment, if that is possible.
    pub fn hand_over(
        &self,
        py: Python<'_>,
        slot: &Arc<Slot>,
        writer: &MomentWriter,
        at: f64,
    ) -> PyResult<()> {
        if !self.is_free(py)? {
            return Ok(());
        }
        let Some((held, descriptor)) = self.borrowed(py)? else {
            return Ok(());
        };
        let Ok(descriptor) = borrow(descriptor)?.try_clone_to_owned() else {
            // The process has too many.
            return Ok(());
        };
        let fed = self.framer.get().fed();
        let Some(frame) = slot
            .locked()
            .plan
            .as_ref()
            .map(|plan| plan.frame.clone_ref(py))
        else {
            return Ok(());
        };
        let before = self.state().planned.replace((Arc::clone(slot), fed));
        drop(before);
        if !writer.plan(&self.scheduled, at, frame.as_bytes(py), descriptor) {
            self.forget_plan();
        }
        // Only now may the transport close, which withdraws the plan.
        drop(held);
        Ok(())
    }

    /// Read what has come for the request that is under way; end it if this is its reply alone.
    pub fn take<'py>(&self, py: Python<'py>) -> PyResult<Came<'py>> {
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
        let framer = self.framer.get();
        let fed = framer.fed();
        let taken = framer.take_reply(py, data, request.as_bytes(py), command.bind(py))?;
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

    /// Let time pass for the request that is under way, and have the rest of it be written.
    pub fn watch(&self, py: Python<'_>) -> PyResult<()> {
        let (until, part) = {
            let mut state = self.state();
            let Some(sent) = &state.under_way else {
                return Ok(());
            };
            let until = sent.requested_at + sent.plan.wait;
            let part = sent.written < sent.plan.frame.as_bytes(py).len();
            (
                (!mem::replace(&mut state.timed, true)).then_some(until),
                part,
            )
        };
        let steps = self.steps.bind(py);
        if let Some(until) = until {
            steps.call_method1(intern!(py, "watch_until"), (until,))?;
        }
        if part {
            steps.call_method0(intern!(py, "take_back"))?;
        }
        Ok(())
    }

    /// Have the session go on with what has come.
    pub fn report(&self, events: Bound<'_, PyList>, fed: u64) -> PyResult<()> {
        let py = events.py();
        let received = intern!(py, "received");
        self.steps
            .bind(py)
            .call_method1(received, (events, fed))
            .map(|_| ())
    }
}
