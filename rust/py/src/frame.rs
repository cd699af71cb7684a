//! `NativeFrame`: a frame that owns its bytes and is decoded on first use.

use std::sync::Arc;

use cobotwire_core::{Decoded, Direction, Frame, Listening, OwnedFrame, Rules};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::edition::Edition;
use crate::names::Names;
use crate::values::objects;
use crate::words::one_way;

/// The data that all frames of one framer share.
pub struct Origin {
    pub edition: Arc<Edition>,
    pub rules: Rules,
    /// The first direction that the framer listens to.
    pub direction: Direction,
}

/// A whole, legal frame.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeFrame {
    origin: Arc<Origin>,
    /// The position of its first byte in the stream.
    #[pyo3(get)]
    offset: u64,
    frame: OwnedFrame,
    /// Its values, after their first use.
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

    /// Decode it in one direction, or in those that the framer listens to. With `of`, only messages
    /// of the command with that index count.
    fn read(
        &self,
        py: Python<'_>,
        direction: Option<Direction>,
        of: Option<usize>,
    ) -> PyResult<Decoded> {
        let Origin { edition, rules, .. } = &*self.origin;
        let rules = direction.map_or(rules, |way| edition.core.rules(Listening::To(way)));
        let frame = self.frame();
        cobotwire_core::read(&edition.core, rules, frame, of).map_err(|error| {
            let direction = direction.unwrap_or(self.origin.direction);
            match Names::get(py) {
                Ok(names) => {
                    let direction = names.direction(py, direction);
                    edition.rejected(py, error, direction, frame.bytes())
                }
                Err(error) => error,
            }
        })
    }

    /// Return the fields of the reply of a command that it is; None if it is not a legal one.
    pub fn fields_of<'py>(
        &self,
        py: Python<'py>,
        of: &Bound<'py, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Edition {
            table,
            core,
            commands,
            ..
        } = &*self.origin.edition;
        let of = commands.find(table, of)?;
        let rules = core.rules(Listening::To(Direction::Reply));
        match cobotwire_core::read(core, rules, self.frame(), Some(of)) {
            Ok(decoded) => {
                let values = objects(py, &decoded.values)?;
                let edition = &self.origin.edition;
                edition.fields(decoded.variant, &values).map(Some)
            }
            Err(_) => Ok(None),
        }
    }

    /// Return the message, as Python's named tuple; `values` are those of `decoded`.
    fn message_of<'py>(
        &self,
        decoded: &Decoded,
        values: &Bound<'py, PyTuple>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let edition = &self.origin.edition;
        edition.message(values.py(), decoded.variant, values, decoded.address)
    }
}

#[pymethods]
impl NativeFrame {
    /// Its bytes, from header to check.
    #[getter]
    fn data<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, self.frame.bytes())
    }

    /// Its command id.
    #[getter]
    fn command(&self) -> u16 {
        self.frame().id()
    }

    /// Its message: the first one that allows its values.
    #[getter]
    fn message<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let decoded = self.read(py, None, None)?;
        let values = self
            .values
            .get_or_try_init(py, || objects(py, &decoded.values).map(Bound::unbind))?;
        self.message_of(&decoded, values.bind(py))
    }

    /// Return what `codec.decode(direction, frame.data, of=of)` returns, without judging it again.
    #[pyo3(signature = (direction = None, *, of = None))]
    fn decode<'py>(
        &self,
        py: Python<'py>,
        direction: Option<&Bound<'py, PyAny>>,
        of: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Edition {
            table, commands, ..
        } = &*self.origin.edition;
        let of = of.map(|name| commands.find(table, name)).transpose()?;
        let decoded = self.read(py, direction.map(one_way).transpose()?, of)?;
        self.message_of(&decoded, &objects(py, &decoded.values)?)
    }

    /// The values of its message, one for each field.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        if let Some(values) = self.values.get(py) {
            return Ok(values.bind(py).clone());
        }
        let values = objects(py, &self.read(py, None, None)?.values)?;
        // Another thread may have stored its values first; they are the same.
        let _ = self.values.set(py, values.clone().unbind());
        Ok(values)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.offset == other.offset && self.frame == other.frame
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        // Equal to the hash of Python's own class, because the frames can be equal.
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
