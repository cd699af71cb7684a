//! `NativeFramer`: implements `cobotwire.codec.interface.Framer` with the core.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use cobotwire_core::{Framer, Reason, Tally};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyList};

use crate::events::Events;
use crate::frame::{NativeFrame, Origin};
use crate::names::Names;

/// Cuts frames out of a byte stream.
///
/// Any thread may read its counts at any time, also while another thread feeds it. So `core` is
/// never locked while Python code may run: calls into Python happen before or after.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeFramer {
    core: Mutex<Framer>,
    origin: Arc<Origin>,
}

impl NativeFramer {
    pub fn new(origin: Origin) -> Self {
        Self {
            core: Mutex::new(Framer::new(origin.rules.clone())),
            origin: Arc::new(origin),
        }
    }

    fn core(&self) -> MutexGuard<'_, Framer> {
        // Nothing panics while it is locked.
        self.core.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Feed bytes that are exactly one frame while no bytes are pending; return the frame.
    fn feed_frame(&self, data: &Bound<'_, PyBytes>) -> Option<NativeFrame> {
        let origin = Arc::clone(&self.origin);
        let mut core = self.core();
        let (offset, frame) = core.feed_frame(data.as_bytes())?;
        Some(NativeFrame::new(origin, offset, frame.into()))
    }
}

#[pymethods]
impl NativeFramer {
    /// Feed bytes; return the events that more bytes cannot change, in the order of the stream.
    fn feed<'py>(&self, data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
        let py = data.py();
        if let Ok(bytes) = data.cast_exact::<PyBytes>()
            && let Some(frame) = self.feed_frame(bytes)
        {
            return PyList::new(py, [frame.into_object(py)?]);
        }
        let copy;
        let chunk = match data.cast::<PyBytes>() {
            Ok(bytes) => bytes.as_bytes(),
            Err(_) => {
                copy = copied(data)?;
                &copy
            }
        };
        let mut events = Events::default();
        self.core().feed(chunk, |event| events.add(event));
        events.into_list(py, &self.origin)
    }

    /// Reject the pending candidate; return the events of all remaining bytes.
    fn flush<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut events = Events::default();
        self.core().flush(|event| events.add(event));
        events.into_list(py, &self.origin)
    }

    /// The number of bytes fed that no event covers yet.
    #[getter]
    fn pending(&self) -> usize {
        self.core().pending()
    }

    /// The number of bytes fed since the start of the stream.
    #[getter]
    fn fed(&self) -> u64 {
        self.core().tally().bytes
    }

    /// The counts since the start of the stream.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let tally = self.core().tally().clone();
        counters(py, &tally)
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

/// Return the bytes of any object that the reference codec accepts as a buffer.
pub fn copied(data: &Bound<'_, PyAny>) -> PyResult<Vec<u8>> {
    let all = PyByteArray::new(data.py(), &[]).call_method1("__iadd__", (data,))?;
    Ok(all.cast_into::<PyByteArray>()?.to_vec())
}
