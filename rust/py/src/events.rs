//! Converts the core's events to Python's `Frame` and `Noise`.

use cobotwire_core::{Event, Frame, Reason};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyType};

use crate::frame::{NativeFrame, Origin};
use crate::frame_class::{class, object};
use crate::names::Names;

/// Collects the events of one call.
pub struct Events<'py, 'a> {
    names: &'static Names,
    origin: &'a Py<Origin>,
    frames: &'py Bound<'py, PyType>,
    list: Bound<'py, PyList>,
    failed: Option<PyErr>,
}

impl<'py, 'a> Events<'py, 'a> {
    pub fn new(py: Python<'py>, origin: &'a Py<Origin>) -> PyResult<Self> {
        Ok(Self {
            names: Names::get(py)?,
            origin,
            frames: class(py)?,
            list: PyList::empty(py),
            failed: None,
        })
    }

    /// Add an event. `finish` returns a failure, so that the framer always completes its call.
    pub fn add(&mut self, event: Event<'_>) {
        if let Err(error) = self.try_add(event) {
            self.failed.get_or_insert(error);
        }
    }

    /// Return all events, or the first failure.
    pub fn finish(self) -> PyResult<Bound<'py, PyList>> {
        self.failed.map_or(Ok(self.list), Err)
    }

    fn try_add(&self, event: Event<'_>) -> PyResult<()> {
        self.list.append(match event {
            Event::Frame { offset, frame } => self.frame(offset, frame)?,
            Event::Noise {
                offset,
                reason,
                data,
            } => self.noise(offset, reason, data)?,
        })
    }

    fn frame(&self, offset: u64, frame: Frame<'_>) -> PyResult<Bound<'py, PyAny>> {
        let origin = || self.origin.clone_ref(self.list.py());
        object(self.frames, || NativeFrame::new(origin(), offset, frame))
    }

    fn noise(&self, offset: u64, reason: Reason, data: [&[u8]; 2]) -> PyResult<Bound<'py, PyAny>> {
        let py = self.list.py();
        let bytes = match data {
            [all, []] | [[], all] => PyBytes::new(py, all),
            pieces => PyBytes::new(py, &pieces.concat()),
        };
        let items = (offset, bytes, self.names.reason(py, reason)).into_pyobject(py)?;
        self.names.make(&self.names.noise, items)
    }
}
