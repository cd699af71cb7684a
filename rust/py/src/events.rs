//! Converts the core's events to Python's `Frame` and `Noise`.

use cobotwire_core::{Event, Frame, Reason};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyType};

use crate::frame::{NativeFrame, Origin};
use crate::frame_class::{class, object};
use crate::names::Names;

/// Collects the events of one call.
///
/// The framer is locked while they come, so `add` runs no code of Python's. A frame is an object
/// without a header for the garbage collector, and is made at once. Noise is a tuple: to make one can
/// start a collection, which may run any code. So `finish` makes it.
pub struct Events<'py, 'a> {
    names: &'static Names,
    origin: &'a Py<Origin>,
    frames: &'py Bound<'py, PyType>,
    list: Bound<'py, PyList>,
    noise: Vec<Noise<'py>>,
    failed: Option<PyErr>,
}

/// Noise that `finish` puts into the list.
struct Noise<'py> {
    place: usize,
    offset: u64,
    reason: Reason,
    bytes: Bound<'py, PyBytes>,
}

impl<'py, 'a> Events<'py, 'a> {
    pub fn new(py: Python<'py>, origin: &'a Py<Origin>) -> PyResult<Self> {
        Ok(Self {
            names: Names::get(py)?,
            origin,
            frames: class(py)?,
            list: PyList::empty(py),
            noise: Vec::new(),
            failed: None,
        })
    }

    /// Add an event. `finish` returns a failure, so that the framer always completes its call.
    pub fn add(&mut self, event: Event<'_>) {
        let added = match event {
            Event::Frame { offset, frame } => self.add_frame(offset, frame),
            Event::Noise {
                offset,
                reason,
                data,
            } => self.add_noise(offset, reason, data),
        };
        if let Err(error) = added {
            self.failed.get_or_insert(error);
        }
    }

    /// Return all events, or the first failure.
    pub fn finish(self) -> PyResult<Bound<'py, PyList>> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        let py = self.list.py();
        for noise in self.noise {
            let reason = self.names.reason(py, noise.reason);
            let items = (noise.offset, noise.bytes, reason).into_pyobject(py)?;
            let event = self.names.make(&self.names.noise, items)?;
            self.list.set_item(noise.place, event)?;
        }
        Ok(self.list)
    }

    fn add_frame(&self, offset: u64, frame: Frame<'_>) -> PyResult<()> {
        let origin = || self.origin.clone_ref(self.list.py());
        let frame = object(self.frames, || NativeFrame::new(origin(), offset, frame))?;
        self.list.append(frame)
    }

    fn add_noise(&mut self, offset: u64, reason: Reason, data: [&[u8]; 2]) -> PyResult<()> {
        let py = self.list.py();
        let bytes = match data {
            [all, []] | [[], all] => PyBytes::new(py, all),
            pieces => PyBytes::new(py, &pieces.concat()),
        };
        self.noise.push(Noise {
            place: self.list.len(),
            offset,
            reason,
            bytes,
        });
        self.list.append(py.None())
    }
}
