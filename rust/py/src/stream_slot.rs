//! The slots of a stream, each with the request that it is to send.

use std::sync::{Arc, Mutex};

use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::moments::MomentWriter;
use crate::stream_exchange::{Came, Sent};
use crate::stream_line::StreamLine;
use crate::stream_plan::{Plan, Slot};

/// Sends the requests of one stream. The timers of the loop call it at the moment of each.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct StreamSlot {
    line: Py<StreamLine>,
    slot: Arc<Slot>,
}

#[pymethods]
impl StreamSlot {
    #[new]
    #[pyo3(signature = (line, slots, /))]
    fn new(line: Py<StreamLine>, slots: Py<PyAny>) -> Self {
        Self {
            line,
            slot: Arc::new(Slot {
                slots,
                next: Mutex::default(),
            }),
        }
    }

    /// Plan what is sent at a moment, for a command; set `over` to its answer when it has come.
    /// Return whether the loop has been late, so that a thread should send it.
    #[pyo3(signature = (frame, command, wait, over, at, /))]
    fn plan(
        &self,
        frame: Py<PyBytes>,
        command: Py<PyAny>,
        wait: f64,
        over: Py<PyAny>,
        at: f64,
    ) -> bool {
        let plan = Plan {
            frame,
            command,
            wait,
            over,
        };
        let mut next = self.slot.locked();
        let before = next.plan.replace(plan);
        next.at = at;
        next.sent = false;
        let late = next.late > 0;
        drop(next);
        drop(before);
        late
    }

    /// Have a thread send what was planned, if that is possible.
    #[pyo3(signature = (writer, /))]
    fn hand_over(slf: &Bound<'_, Self>, writer: &Bound<'_, MomentWriter>) -> PyResult<()> {
        let this = slf.get();
        let at = this.slot.locked().at;
        let line = this.line.get();
        line.hand_over(slf.py(), &this.slot, writer.get(), at)
    }

    /// Forget what was planned: the next call leaves it to the session.
    fn forget(&self, py: Python<'_>) {
        let line = self.line.get();
        line.learn(py, line.scheduled.withdraw());
        line.forget_plan();
        drop(self.slot.taken());
    }

    /// Send what was planned, or have the session send it.
    fn __call__(slf: &Bound<'_, Self>) -> PyResult<()> {
        let (py, this) = (slf.py(), slf.get());
        let line = this.line.get();
        this.slot.note_lateness();
        match line.send(py, &this.slot)? {
            Sent::Over => Ok(()),
            Sent::No => this
                .slot
                .slots
                .bind(py)
                .call_method0(intern!(py, "send"))
                .map(|_| ()),
            Sent::Written => line.watch(py),
            Sent::Before => {
                line.watch(py)?;
                match line.take(py)? {
                    Came::Unknown | Came::Reply => Ok(()),
                    Came::Events(events, fed) => line.report(events, fed),
                }
            }
        }
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.line)?;
        visit.call(&self.slot.slots)?;
        if let Ok(next) = self.slot.next.try_lock()
            && let Some(plan) = &next.plan
        {
            visit.call(&plan.over)?;
        }
        Ok(())
    }
}
