//! The state of Python's session that a native call checks, sets and resets.
//!
//! `session/alone` and `session/echo` describe the attributes. Between the first check and the last
//! attribute that is set, no code of Python's runs and no object is made, so no other thread gets a
//! turn, and no signal is handled. Locks are taken without waiting, and are freed whatever happens.

use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyFloat, PyTuple};

use crate::swap::now;

/// The objects of one connection that have this state.
pub struct Session {
    transport: Py<PyAny>,
    /// Whether a thread is at a step of the exchange.
    state_locked: Py<PyAny>,
    /// Takes and frees the lock of reading.
    reading: (Py<PyAny>, Py<PyAny>),
    leading: Py<PyAny>,
    alone: Py<PyAny>,
    alignment: Py<PyAny>,
    echo: Py<PyAny>,
    turns: Py<PyAny>,
    outstanding: Py<PyAny>,
    acks: Py<PyAny>,
    get_ident: Py<PyAny>,
    /// `(False,)`: the arguments of `acquire` that do not wait.
    at_once: Py<PyTuple>,
}

/// A request that has begun: what `alone` knows of it, and the number of its thread.
pub struct Begun<'py> {
    pub noted: Bound<'py, PyTuple>,
    pub thread: Bound<'py, PyAny>,
    pub reading: Held<'py>,
    pub lent: Held<'py>,
    pub descriptor: i32,
    pub alarm: i32,
}

/// A lock that is held; this holds its method `release`.
pub struct Held<'py>(Bound<'py, PyAny>);

impl Drop for Held<'_> {
    fn drop(&mut self) {
        // It fails only if the lock is not held.
        let _ = self.0.call0();
    }
}

/// Take a lock unless another thread has it. `at_once` is `(False,)`.
pub fn hold<'py>(
    acquire: &Bound<'py, PyAny>,
    release: &Bound<'py, PyAny>,
    at_once: &Bound<'py, PyTuple>,
) -> PyResult<Option<Held<'py>>> {
    let taken = acquire.call1(at_once)?.is_truthy()?;
    Ok(taken.then(|| Held(release.clone())))
}

impl Session {
    /// Take the transport, `steps` of the client and `alone` of the session.
    pub fn new(
        transport: Py<PyAny>,
        steps: &Bound<'_, PyAny>,
        alone: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let py = steps.py();
        let reading = steps.getattr("reading")?;
        let of_alone = |name: &str| alone.getattr(name).map(Bound::unbind);
        Ok(Self {
            transport,
            state_locked: steps.getattr("state")?.getattr("locked")?.unbind(),
            reading: (
                reading.getattr("acquire")?.unbind(),
                reading.getattr("release")?.unbind(),
            ),
            leading: steps.getattr("leading")?.unbind(),
            alone: alone.clone().unbind(),
            alignment: of_alone("alignment")?,
            echo: of_alone("echo")?,
            turns: of_alone("turns")?,
            outstanding: of_alone("outstanding_replies")?,
            acks: of_alone("acks")?,
            get_ident: py.import("threading")?.getattr("get_ident")?.unbind(),
            at_once: PyTuple::new(py, [false])?.unbind(),
        })
    }

    /// Begin a request, when `fed` bytes have been received; return None if it is not alone on the line.
    pub fn begin<'py>(
        &self,
        request: &Bound<'py, PyTuple>,
        frame: &Bound<'py, PyBytes>,
        fed: u64,
        policy: &Bound<'py, PyAny>,
        at: f64,
    ) -> PyResult<Option<Begun<'py>>> {
        let py = request.py();
        let fed = fed.into_pyobject(py)?;
        let sent_at = PyFloat::new(py, at.max(now()));
        let grace = policy.getattr(intern!(py, "grace"))?;
        let noted = (request, sent_at, &fed, grace).into_pyobject(py)?;
        let sent = (frame, fed).into_pyobject(py)?;
        let thread = self.get_ident.bind(py).call0()?;
        let leader = intern!(py, "leader");
        let leading = self.leading.bind(py);
        let loan = self.transport.bind(py).getattr(intern!(py, "loan"))?;
        if self.state_locked.bind(py).call0()?.is_truthy()?
            || !leading.getattr(leader)?.is_none()
            || loan.is_none()
            || !self.is_free(py)?
        {
            return Ok(None);
        }
        let loan = loan.cast_into::<PyTuple>()?;
        let reading = (self.reading.0.bind(py).clone(), self.reading.1.bind(py));
        let Some(reading) = self.hold(&reading.0, reading.1)? else {
            return Ok(None);
        };
        let Some(lent) = self.hold(&loan.get_item(0)?, &loan.get_item(1)?)? else {
            return Ok(None);
        };
        let (descriptor, alarm) = (loan.get_item(2)?.extract()?, loan.get_item(3)?.extract()?);
        leading.setattr(leader, &thread)?;
        self.alone.bind(py).setattr(intern!(py, "begun"), &noted)?;
        self.echo.bind(py).setattr(intern!(py, "latest"), sent)?;
        let alignment = self.alignment.bind(py);
        alignment.setattr(intern!(py, "last_request"), frame)?;
        Ok(Some(Begun {
            noted,
            thread,
            reading,
            lent,
            descriptor,
            alarm,
        }))
    }

    /// Return whether nothing is under way, no reply is outstanding, and the line is aligned.
    fn is_free(&self, py: Python<'_>) -> PyResult<bool> {
        let last = self.turns.bind(py).getattr(intern!(py, "last"))?;
        if !last.is_none() && !last.getattr(intern!(py, "done"))?.is_truthy()? {
            return Ok(false);
        }
        for (of, name) in [
            (&self.turns, intern!(py, "queue")),
            (&self.outstanding, intern!(py, "replies")),
            (&self.acks, intern!(py, "waiting")),
            (&self.alone, intern!(py, "begun")),
            (&self.alignment, intern!(py, "align")),
        ] {
            if of.bind(py).getattr(name)?.is_truthy()? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    fn hold<'py>(
        &self,
        acquire: &Bound<'py, PyAny>,
        release: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Held<'py>>> {
        hold(acquire, release, self.at_once.bind(acquire.py()))
    }

    /// Return whether bytes are a copy of the last one-way request.
    pub fn is_one_way(&self, py: Python<'_>, data: &[u8]) -> PyResult<bool> {
        let sent = self.echo.bind(py).getattr(intern!(py, "one_way"))?;
        if sent.is_none() {
            return Ok(false);
        }
        let frame = sent.getattr(intern!(py, "frame"))?.cast_into::<PyBytes>()?;
        Ok(frame.as_bytes() == data)
    }

    /// Note that the request has ended, and that its thread no longer reads for others.
    pub fn end(&self, py: Python<'_>, thread: &Bound<'_, PyAny>) -> PyResult<()> {
        let (leading, leader) = (self.leading.bind(py), intern!(py, "leader"));
        let alone = self.alone.bind(py);
        alone.setattr(intern!(py, "begun"), py.None())?;
        if leading.getattr(leader)?.is(thread) {
            leading.setattr(leader, py.None())?;
        }
        if leading.getattr(intern!(py, "followers"))?.is_truthy()? {
            leading.call_method0(intern!(py, "wake_followers"))?;
        }
        Ok(())
    }
}
