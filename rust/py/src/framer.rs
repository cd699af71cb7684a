//! `NativeFramer`: the core's framer behind `cobotwire.codec.interface.Framer`.

use std::sync::Arc;

use cobotwire_core::{Framer, Reason, Tally};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyList};

use crate::events::Events;
use crate::frame::Origin;
use crate::names::Names;

/// Cuts frames out of a byte stream.
#[pyclass(module = "cobotwire._native")]
pub struct NativeFramer {
    core: Framer,
    origin: Arc<Origin>,
}

impl NativeFramer {
    pub fn new(origin: Origin) -> Self {
        Self {
            core: Framer::new(origin.rules.clone()),
            origin: Arc::new(origin),
        }
    }
}

#[pymethods]
impl NativeFramer {
    /// Take bytes; return what is certain by now, in the order of the stream.
    fn feed<'py>(&mut self, data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
        let mut events = Events::new(data.py(), &self.origin)?;
        match data.cast::<PyBytes>() {
            Ok(bytes) => self.core.feed(bytes.as_bytes(), |event| events.add(event)),
            Err(_) => self.core.feed(&copied(data)?, |event| events.add(event)),
        }
        events.finish()
    }

    /// Refute what still waits; return it and what follows it.
    fn flush<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut events = Events::new(py, &self.origin)?;
        self.core.flush(|event| events.add(event));
        events.finish()
    }

    /// Bytes fed that no event covers yet.
    #[getter]
    fn pending(&self) -> usize {
        self.core.pending()
    }

    /// How many bytes were fed since the framer was made.
    #[getter]
    fn fed(&self) -> u64 {
        self.core.tally().bytes
    }

    /// The counts since the framer was made.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        counters(py, self.core.tally())
    }
}

/// A tally as Python's `Counters`.
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
    for (reason, bytes) in Reason::ALL.into_iter().zip(tally.noise) {
        if bytes > 0 {
            noise.set_item(names.reason(py, reason), bytes)?;
        }
    }
    let items = (tally.bytes, frames, noise, tally.resyncs);
    names.make(&names.counters, items.into_pyobject(py)?)
}

/// The bytes of any buffer, accepted or rejected as by the reference.
pub fn copied(data: &Bound<'_, PyAny>) -> PyResult<Vec<u8>> {
    let all = PyByteArray::new(data.py(), &[]).call_method1("__iadd__", (data,))?;
    Ok(all.cast_into::<PyByteArray>()?.to_vec())
}
