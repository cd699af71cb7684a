//! `NativeFramer`: implements `cobotwire.codec.interface.Framer` with the core.

use cobotwire_core::{Frame, Framer, Reason, Tally};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyList};

#[cfg(unix)]
use crate::descriptor::{read_now, write_if_free};
use crate::events::Events;
use crate::frame::{NativeFrame, Origin};
use crate::frame_class;
use crate::names::Names;

/// Cuts frames out of a byte stream.
#[pyclass(module = "cobotwire._native")]
pub struct NativeFramer {
    core: Framer,
    origin: Py<Origin>,
}

impl NativeFramer {
    pub fn new(py: Python<'_>, origin: Origin) -> PyResult<Self> {
        Ok(Self {
            core: Framer::new(origin.rules.clone()),
            origin: Py::new(py, origin)?,
        })
    }

    fn object<'py>(
        &self,
        py: Python<'py>,
        offset: u64,
        frame: Frame<'_>,
    ) -> PyResult<Bound<'py, PyAny>> {
        frame_class::object(frame_class::class(py)?, || {
            NativeFrame::new(self.origin.clone_ref(py), offset, frame)
        })
    }
}

#[pymethods]
impl NativeFramer {
    /// Feed bytes; return the events that are certain, in the order of the stream.
    fn feed<'py>(&mut self, data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
        let py = data.py();
        if let Ok(bytes) = data.cast_exact::<PyBytes>()
            && let Some((offset, frame)) = self.core.feed_frame(bytes.as_bytes())
        {
            return PyList::new(py, [self.object(py, offset, frame)?]);
        }
        let mut events = Events::new(py, &self.origin)?;
        match data.cast::<PyBytes>() {
            Ok(bytes) => self.core.feed(bytes.as_bytes(), |event| events.add(event)),
            Err(_) => self.core.feed(&copied(data)?, |event| events.add(event)),
        }
        events.finish()
    }

    /// Refute the candidate that waits; return the events of all remaining bytes.
    fn flush<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut events = Events::new(py, &self.origin)?;
        self.core.flush(|event| events.add(event));
        events.finish()
    }

    /// Send a request if nothing has come, and read what has come then, without waiting. Return
    /// None if nothing was sent, or how many bytes were taken if these are not all.
    #[cfg(unix)]
    #[pyo3(signature = (descriptor, alarm, request, of, /))]
    fn send<'py>(
        slf: &Bound<'py, Self>,
        descriptor: i32,
        alarm: i32,
        request: &[u8],
        of: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let py = slf.py();
        let written = write_if_free(descriptor, request)?;
        if written == 0 {
            return Ok(None);
        }
        if written < request.len() {
            return Ok(Some(written.into_pyobject(py)?.into_any()));
        }
        let found = Self::read_reply(slf, descriptor, alarm, request, of)?;
        Ok(Some(found.unwrap_or_else(|| PyList::empty(py).into_any())))
    }

    /// Read what has come to a line, and feed it, in one call.
    /// Return None if nothing has come, or the data has ended, which the next read reports.
    #[cfg(unix)]
    #[pyo3(signature = (descriptor, alarm, request, of, /))]
    fn read_reply<'py>(
        slf: &Bound<'py, Self>,
        descriptor: i32,
        alarm: i32,
        request: &[u8],
        of: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let _ = alarm;
        let py = slf.py();
        let take = |data: &[u8]| match data {
            [] => Ok(None),
            _ => slf
                .try_borrow_mut()?
                .take_reply(py, data, request, of)?
                .into_pyobject(py)
                .map(Some),
        };
        read_now(py, descriptor, take)?.unwrap_or(Ok(None))
    }

    /// The number of bytes fed that no event covers yet.
    #[getter]
    fn pending(&self) -> usize {
        self.core.pending()
    }

    /// The number of bytes fed since the start of the stream.
    #[getter]
    pub fn fed(&self) -> u64 {
        self.core.tally().bytes
    }

    /// The counts since the start of the stream.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        counters(py, self.core.tally())
    }
}

impl NativeFramer {
    /// Feed what came after a request. Return the frame and its fields if all of it is one frame
    /// that replies to the command `of` and is no copy of the request; otherwise the events.
    pub fn take_reply<'py>(
        &mut self,
        py: Python<'py>,
        data: &[u8],
        request: &[u8],
        of: &Bound<'py, PyAny>,
    ) -> PyResult<Taken<'py>> {
        let mut events = Events::new(py, &self.origin)?;
        let whole = self.core.pending() == 0 && data != request;
        self.core.feed(data, |event| events.add(event));
        let events = events.finish()?;
        if whole && self.core.pending() == 0 && events.len() == 1 {
            let event = events.get_item(0)?;
            if let Some(frame) = frame_class::frame(&event)
                && let Some(fields) = frame.fields_of(py, of)?
            {
                return Ok(Taken::Reply(event, fields.into_any()));
            }
        }
        Ok(Taken::Events(events))
    }
}

/// What came after a request.
pub enum Taken<'py> {
    /// The reply alone, and its fields.
    Reply(Bound<'py, PyAny>, Bound<'py, PyAny>),
    Events(Bound<'py, PyList>),
}

impl<'py> Taken<'py> {
    fn into_pyobject(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self {
            Self::Reply(frame, fields) => (frame, fields).into_pyobject(py)?.into_any(),
            Self::Events(events) => events.into_any(),
        })
    }
}

/// Return a tally as Python's `Counters`.
pub fn counters<'py>(py: Python<'py>, tally: &Tally) -> PyResult<Bound<'py, PyAny>> {
    let names = Names::get(py)?;
    let (frames, noise) = (PyDict::new(py), PyDict::new(py));
    for (id, count) in tally
        .frames
        .iter()
        .enumerate()
        .filter(|(_, count)| **count > 0)
    {
        frames.set_item(id, count)?;
    }
    for (id, count) in &tally.wide {
        frames.set_item(id, count)?;
    }
    for (reason, bytes) in Reason::ALL.into_iter().zip(tally.noise) {
        if bytes > 0 {
            noise.set_item(names.reason(py, reason), bytes)?;
        }
    }
    let items = (tally.bytes, frames, noise, tally.resyncs);
    names.make(&names.counters, items.into_pyobject(py)?)
}

/// Return the bytes of any object that the reference accepts as a buffer.
pub fn copied(data: &Bound<'_, PyAny>) -> PyResult<Vec<u8>> {
    let all = PyByteArray::new(data.py(), &[]).call_method1("__iadd__", (data,))?;
    Ok(all.cast_into::<PyByteArray>()?.to_vec())
}
