//! `NativeFrame`: a frame that carries its bytes and is decoded when it is first asked.

use std::sync::Arc;

use cobotwire_core::{Decoded, Frame, OwnedFrame, Rules};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyTuple};

use crate::edition::Edition;
use crate::values::objects;

/// What the frames of one framer have in common.
pub struct Origin {
    pub edition: Arc<Edition>,
    pub rules: Rules,
}

/// A whole, legal frame.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeFrame {
    origin: Arc<Origin>,
    /// Where its first byte stands in the stream.
    #[pyo3(get)]
    offset: u64,
    frame: OwnedFrame,
    /// Its values, once it was asked for them.
    values: PyOnceLock<Py<PyTuple>>,
}

impl NativeFrame {
    pub fn new(origin: Arc<Origin>, offset: u64, frame: Frame<'_>) -> Self {
        Self {
            origin,
            offset,
            frame: frame.into(),
            values: PyOnceLock::new(),
        }
    }

    fn frame(&self) -> Frame<'_> {
        self.frame.get(self.origin.edition.core.frame())
    }

    fn decoded(&self, py: Python<'_>) -> PyResult<Decoded> {
        let Origin { edition, rules } = &*self.origin;
        let frame = self.frame();
        cobotwire_core::read(&edition.core, rules, frame)
            .map_err(|error| edition.refused(py, error, None, frame.bytes()))
    }
}

#[pymethods]
impl NativeFrame {
    /// All of it, from header to check.
    #[getter]
    fn data<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.frame.bytes())
    }

    /// Its command id.
    #[getter]
    fn command(&self) -> u8 {
        self.frame().id()
    }

    /// What it says, as the first message that allows its values.
    #[getter]
    fn message<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let decoded = self.decoded(py)?;
        let values = self
            .values
            .get_or_try_init(py, || objects(py, &decoded.values).map(Bound::unbind))?;
        let edition = &self.origin.edition;
        edition.message(py, decoded.form, values.bind(py), decoded.address)
    }

    /// The values of its message, one a field.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        if let Some(values) = self.values.get(py) {
            return Ok(values.bind(py).clone());
        }
        let values = objects(py, &self.decoded(py)?.values)?;
        // Another thread may have been faster; then both have the same.
        let _ = self.values.set(py, values.clone().unbind());
        Ok(values)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.offset == other.offset && self.frame == other.frame
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        // As Python's own class has it, since they can be equal.
        (self.offset, self.command(), self.data(py))
            .into_pyobject(py)?
            .hash()
    }

    fn __repr__(&self) -> String {
        let data: Vec<String> = self
            .frame
            .bytes()
            .iter()
            .map(|byte| format!("{byte:02X}"))
            .collect();
        format!("<Frame {} at {}>", data.join(" "), self.offset)
    }
}
