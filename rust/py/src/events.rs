//! Converts the core's events to Python's `Frame` and `Noise`.

use std::sync::Arc;

use cobotwire_core::{Event, OwnedFrame, Reason};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList};

use crate::frame::{NativeFrame, Origin};
use crate::names::Names;

/// Events that are not yet Python's objects.
///
/// The framer is locked while it reports events. Making a Python object can start a garbage
/// collection, which may run any Python code, so the objects are made afterwards.
#[derive(Default)]
pub struct Events(Vec<Found>);

enum Found {
    Frame(u64, OwnedFrame),
    Noise(u64, Reason, Vec<u8>),
}

impl Events {
    #[inline]
    pub fn add(&mut self, event: Event<'_>) {
        self.0.push(match event {
            Event::Frame { offset, frame } => Found::Frame(offset, frame.into()),
            Event::Noise {
                offset,
                reason,
                data,
            } => Found::Noise(offset, reason, data.concat()),
        });
    }

    /// Return a list of all events, as Python's objects.
    pub fn into_list<'py>(
        self,
        py: Python<'py>,
        origin: &Arc<Origin>,
    ) -> PyResult<Bound<'py, PyList>> {
        let list = PyList::empty(py);
        for event in self.0 {
            match event {
                Found::Frame(offset, frame) => {
                    let frame = NativeFrame::new(Arc::clone(origin), offset, frame);
                    list.append(frame.into_object(py)?)?;
                }
                Found::Noise(offset, reason, data) => {
                    let names = Names::get(py)?;
                    let items = (offset, PyBytes::new(py, &data), names.reason(py, reason));
                    list.append(names.make(&names.noise, items.into_pyobject(py)?)?)?;
                }
            }
        }
        Ok(list)
    }
}
