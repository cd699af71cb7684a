//! The requests of asyncio streams. As long as nothing else happens on a line, they are sent and their
//! replies taken here, and Python only wakes up the consumer.
//!
//! The session knows nothing of it meanwhile: it is lent. Whatever uses the session calls `give_back`
//! first, and what is under way then goes on in Python. All calls come from the thread of the loop,
//! but a thread may write what is planned (`moments`).

use std::mem;
use std::os::fd::RawFd;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyTuple};
use rustix::io::read;

use crate::descriptor::{borrow, write_if_free};
use crate::framer::{NativeFramer, Taken};
use crate::moments::{Desk, MomentWriter, Written};
use crate::session::{Held, hold};
use crate::swap::now;

/// The most bytes that one call reads: replies are far shorter.
const READ_SIZE: usize = 1024;
/// A loop that is later than this many seconds has waited for a busy thread.
const LATE: f64 = 0.001;
/// For how many slots after that the thread writes.
const LATE_SLOTS: u32 = 50;

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
    /// What the thread is to write. Its lock is taken last.
    desk: Arc<Desk>,
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
    /// Whose request the thread is to write, and how many bytes had been received by then.
    planned: Option<(Py<StreamSlot>, u64)>,
    /// Whether a timer will look for a request without a reply.
    timed: bool,
}

/// A request that was sent, and has no reply yet.
struct UnderWay {
    slot: Py<StreamSlot>,
    plan: Plan,
    requested_at: f64,
    /// How many bytes of it were written.
    written: usize,
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
    /// Nobody wants it any longer, or it has its reply.
    Over,
    Written,
    /// The thread has written it, so its reply may be there.
    Before,
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
            desk: Arc::default(),
        })
    }

    /// Take what has come.
    fn __call__(&self, py: Python<'_>) -> PyResult<()> {
        if self.learn(py, self.desk.written()) {
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
        self.learn(py, self.desk.withdraw());
        self.forget_plan();
        let (latest, under_way) = {
            let mut state = self.state();
            if !mem::take(&mut state.lent) {
                return Ok(None);
            }
            (state.latest.take(), state.under_way.take())
        };
        let waiting = under_way.map(|sent| {
            let slots = sent.slot.get().slots.clone_ref(py);
            (slots, sent.requested_at, sent.fed, sent.written)
        });
        (latest, waiting).into_pyobject(py).map(Some)
    }

    /// Return for how many seconds more a reply is waited for, 0 if that time has passed; None: no reply
    /// is. If seconds are left, a timer must look again then.
    fn seconds_left(&self, py: Python<'_>) -> Option<f64> {
        self.learn(py, self.desk.written());
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
        self.desk.cancel();
    }

    /// Let go of what a forked child has a copy of.
    fn leave_to_parent(&self) {
        self.desk.leave_to_parent();
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
    fn forget_plan(&self) {
        let planned = self.state().planned.take();
        drop(planned);
    }

    /// Note that the thread has written what was planned; return whether it has.
    fn learn(&self, py: Python<'_>, written: Option<Written>) -> bool {
        let Some(Written { requested_at, size }) = written else {
            return false;
        };
        let Some((slot, fed)) = self.state().planned.take() else {
            return false;
        };
        let plan = slot.get().taken();
        if let Some(plan) = plan {
            self.begin(py, slot, plan, requested_at, size, fed);
        }
        true
    }

    /// Note a request that was written.
    fn begin(
        &self,
        py: Python<'_>,
        slot: Py<StreamSlot>,
        plan: Plan,
        requested_at: f64,
        written: usize,
        fed: u64,
    ) {
        slot.get().locked().sent = true;
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

    /// Send what a slot planned, unless the thread has.
    fn send(&self, slot: &Bound<'_, StreamSlot>) -> PyResult<Sent> {
        let py = slot.py();
        self.learn(py, self.desk.withdraw());
        self.forget_plan();
        if slot.get().locked().sent {
            return Ok(Sent::Before);
        }
        let Some(plan) = slot.get().taken() else {
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
        let fed = self.framer.bind(py).try_borrow()?.fed();
        let requested_at = now();
        let written = write_if_free(descriptor, plan.frame.as_bytes(py))?;
        drop(held);
        if written == 0 {
            return Ok(Sent::No);
        }
        self.begin(py, slot.clone().unbind(), plan, requested_at, written, fed);
        Ok(Sent::Written)
    }

    /// Have the thread write what a slot planned at that moment, if that is possible.
    fn hand_over(
        &self,
        slot: &Bound<'_, StreamSlot>,
        writer: &MomentWriter,
        at: f64,
    ) -> PyResult<()> {
        let py = slot.py();
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
        let fed = self.framer.bind(py).try_borrow()?.fed();
        let Some(frame) = slot
            .get()
            .locked()
            .plan
            .as_ref()
            .map(|plan| plan.frame.clone_ref(py))
        else {
            return Ok(());
        };
        let before = self.state().planned.replace((slot.clone().unbind(), fed));
        drop(before);
        if !writer.plan(&self.desk, at, frame.as_bytes(py), descriptor) {
            self.forget_plan();
        }
        // Only now may the transport close, which withdraws the plan.
        drop(held);
        Ok(())
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
    next: Mutex<Next>,
}

/// What a slot does next.
#[derive(Default)]
struct Next {
    plan: Option<Plan>,
    at: f64,
    /// Whether what was planned last was sent.
    sent: bool,
    /// For how many slots more the thread is to write.
    late: u32,
}

#[pymethods]
impl StreamSlot {
    #[new]
    #[pyo3(signature = (line, slots, /))]
    fn new(line: Py<StreamLine>, slots: Py<PyAny>) -> Self {
        Self {
            line,
            slots,
            next: Mutex::default(),
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
        let mut next = self.locked();
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
        let at = slf.get().locked().at;
        slf.get().line.get().hand_over(slf, writer.get(), at)
    }

    /// Forget what was planned: the next call leaves it to the session.
    fn forget(&self, py: Python<'_>) {
        let line = self.line.get();
        line.learn(py, line.desk.withdraw());
        line.forget_plan();
        drop(self.taken());
    }

    /// Send what was planned, or have the session send it.
    fn __call__(slf: &Bound<'_, Self>) -> PyResult<()> {
        let (py, this) = (slf.py(), slf.get());
        let line = this.line.get();
        this.note_lateness();
        match line.send(slf)? {
            Sent::Over => Ok(()),
            Sent::No => this
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
        visit.call(&self.slots)?;
        if let Ok(next) = self.next.try_lock()
            && let Some(plan) = &next.plan
        {
            visit.call(&plan.over)?;
        }
        Ok(())
    }
}

impl StreamSlot {
    fn locked(&self) -> MutexGuard<'_, Next> {
        self.next.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn taken(&self) -> Option<Plan> {
        self.locked().plan.take()
    }

    /// Note whether the loop was late.
    fn note_lateness(&self) {
        let mut next = self.locked();
        next.late = if now() - next.at > LATE {
            LATE_SLOTS
        } else {
            next.late.saturating_sub(1)
        };
    }
}

impl StreamLine {
    /// Let time pass for the request that is under way, and have the rest of it be written.
    fn watch(&self, py: Python<'_>) -> PyResult<()> {
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
    fn report(&self, events: Bound<'_, PyList>, fed: u64) -> PyResult<()> {
        let py = events.py();
        let received = intern!(py, "received");
        self.steps
            .bind(py)
            .call_method1(received, (events, fed))
            .map(|_| ())
    }
}
