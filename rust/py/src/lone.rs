//! One blocking call of a request that is alone on its line, with all that belongs to it.

use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyTuple};

use crate::framer::{NativeFramer, Taken};
use crate::session::{Begun, Session};
use crate::swap::{Line, LineLock, Swapped};

/// Makes the calls of one connection.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct LoneCalls {
    framer: Py<NativeFramer>,
    writing: Py<LineLock>,
    session: Session,
    /// The most seconds that a call waits; `caller` goes on then.
    longest: f64,
}

/// What came of a request that was sent.
enum Came<'py> {
    /// Its reply: its fields, and the moments before it was written and when it was read.
    Answer(Bound<'py, PyAny>),
    /// These events, perhaps none.
    Events(Bound<'py, PyAny>),
}

#[pymethods]
impl LoneCalls {
    #[new]
    #[pyo3(signature = (framer, transport, steps, alone, longest, /))]
    fn new(
        framer: Py<NativeFramer>,
        transport: Py<PyAny>,
        steps: &Bound<'_, PyAny>,
        alone: &Bound<'_, PyAny>,
        longest: f64,
    ) -> PyResult<Self> {
        Ok(Self {
            framer,
            writing: steps.getattr("writer")?.getattr("lock")?.extract()?,
            session: Session::new(transport, steps, alone)?,
            longest,
        })
    }

    /// Send a plain request at the moment `at`, and wait for what comes first; return its answer.
    /// `caller` goes on if something else comes.
    #[pyo3(signature = (caller, request, policy, wait, at, /))]
    fn call<'py>(
        &self,
        caller: &Bound<'py, PyAny>,
        request: &Bound<'py, PyTuple>,
        policy: &Bound<'py, PyAny>,
        wait: &Bound<'py, PyAny>,
        at: f64,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let py = caller.py();
        let command = request.get_item(0)?;
        let timeout = self.timeout(&command, policy, wait)?;
        let command = command.getattr(intern!(py, "name"))?;
        let frame = request.get_item(1)?.cast_into::<PyBytes>()?;
        let fed = self.framer.get().fed();
        let Some(begun) = self.session.begin(request, &frame, fed, policy, at)? else {
            return Ok(None);
        };
        let Begun {
            noted,
            thread,
            reading,
            lent,
            descriptor,
            alarm,
        } = begun;
        let writing = self.writing.get();
        let seen = writing.state();
        let line = Line {
            descriptor,
            alarm,
            writing,
            caller,
        };
        let came = self.exchange(&line, at, timeout, &frame, &command);
        drop(lent);
        let pending = match came {
            Ok(None) => {
                self.session.end(py, &thread)?;
                return Ok(None);
            }
            Ok(Some(Came::Answer(answer))) => {
                drop(reading);
                self.session.end(py, &thread)?;
                return Ok(Some(answer));
            }
            Ok(Some(Came::Events(events))) => {
                caller.call_method1(intern!(py, "resume"), (&noted, events, wait, policy))
            }
            Err(error) => Err(error),
        };
        drop(reading);
        match pending {
            Ok(pending) => caller
                .call_method1(intern!(py, "wait"), (&pending,))
                .map(Some)
                .inspect_err(|_| {
                    // Ctrl-C may have come before it could see to that itself. If it comes now
                    // again, the next request finds what is left.
                    let _ = caller.call_method1(intern!(py, "leave"), (&pending,));
                }),
            Err(error) => {
                let sent = writing.state() != seen;
                let _ = caller.call_method1(intern!(py, "abandon"), (noted, sent));
                Err(error)
            }
        }
    }
}

impl LoneCalls {
    /// Return for how many seconds a call waits: not longer than its first attempt takes, which has at
    /// least the share of all of them.
    fn timeout(
        &self,
        command: &Bound<'_, PyAny>,
        policy: &Bound<'_, PyAny>,
        wait: &Bound<'_, PyAny>,
    ) -> PyResult<f64> {
        let py = wait.py();
        let seconds = if wait.is_none() {
            let milliseconds = command.getattr(intern!(py, "deadline_ms"))?;
            milliseconds.extract::<f64>()? / 1000.0
        } else {
            wait.extract()?
        };
        let attempts: f64 = policy.getattr(intern!(py, "attempts"))?.extract()?;
        Ok(self.longest.min(seconds / attempts))
    }

    /// Exchange a request that has begun; return None if it was not sent.
    fn exchange<'py>(
        &self,
        line: &Line<'_, 'py>,
        at: f64,
        timeout: f64,
        frame: &Bound<'py, PyBytes>,
        command: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Came<'py>>> {
        let (py, request) = (frame.py(), frame.as_bytes());
        let take = |data: &[u8]| {
            let taken = self.framer.get().take_reply(py, data, request, command)?;
            // Another thread may have sent a one-way request meanwhile, and the line may echo.
            Ok::<_, PyErr>((taken, self.session.is_one_way(py, data)?))
        };
        Ok(match line.swap(py, at, timeout, request, take)? {
            Swapped::NotSent => None,
            Swapped::Silent => Some(Came::Events(PyList::empty(py).into_any())),
            Swapped::Received(taken, requested_at, replied_at) => Some(match taken? {
                (Taken::Reply(_, fields), false) => {
                    let answer = (fields, requested_at, replied_at).into_pyobject(py)?;
                    Came::Answer(answer.into_any())
                }
                (Taken::Reply(frame, _), true) => {
                    Came::Events(PyList::new(py, [frame])?.into_any())
                }
                (Taken::Events(events), _) => Came::Events(events.into_any()),
            }),
        })
    }
}
