//! `NativeFrame`: a frame that owns its bytes and is decoded on first use.

use std::sync::Arc;

use cobotwire_core::{DecodeError, Direction, Frame, Listening, OwnedFrame, Rules, VariantId};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::edition::Edition;
use crate::memory::untrack;
use crate::names::Names;
use crate::values::{objects, plain_objects};
use crate::words::read_direction;

/// The data that all frames of one framer share.
pub struct Origin {
    pub edition: Arc<Edition>,
    pub rules: Rules,
    /// The first direction that the framer listens to.
    pub direction: Direction,
}

/// A whole, legal frame. It is decoded anew at each use: most programs use a frame once, and
/// keeping its values takes longer than decoding them.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeFrame {
    origin: Arc<Origin>,
    /// The position of its first byte in the stream.
    #[pyo3(get)]
    offset: u64,
    frame: OwnedFrame,
}

/// The decoded message of a frame.
struct Message<'py> {
    variant: VariantId,
    values: Bound<'py, PyTuple>,
    address: Option<u8>,
}

impl NativeFrame {
    #[inline]
    pub fn new(origin: Arc<Origin>, offset: u64, frame: OwnedFrame) -> Self {
        Self {
            origin,
            offset,
            frame,
        }
    }

    /// Return it as a Python object that the garbage collector does not visit. A visit would find
    /// nothing, since the class does not report what a frame refers to.
    pub fn into_object(self, py: Python<'_>) -> PyResult<Bound<'_, Self>> {
        let object = Bound::new(py, self)?;
        untrack(&object);
        Ok(object)
    }

    fn frame(&self) -> Frame<'_> {
        self.frame.get(self.origin.edition.core.frame())
    }

    /// Decode it in one direction, or in those that the framer listens to. `of` restricts the
    /// search to messages of the command with that index.
    fn read<'py>(
        &self,
        py: Python<'py>,
        direction: Option<Direction>,
        of: Option<usize>,
    ) -> PyResult<Message<'py>> {
        let Origin { edition, rules, .. } = &*self.origin;
        let rules = direction.map_or(rules, |way| edition.core.rules(Listening::To(way)));
        self.decoded(py, rules, of)?.map_err(|error| {
            let direction = direction.unwrap_or(self.origin.direction);
            match Names::get(py) {
                Ok(names) => {
                    let direction = names.direction(py, direction);
                    edition.rejected(py, error, direction, self.frame.bytes())
                }
                Err(error) => error,
            }
        })
    }

    /// Decode it by a template. None if its message has no template, or has a number that is not
    /// allowed.
    #[inline(always)]
    fn plain<'py>(
        &self,
        py: Python<'py>,
        rules: &Rules,
        of: Option<usize>,
    ) -> PyResult<Option<Message<'py>>> {
        let core = &self.origin.edition.core;
        let Some(plain) = cobotwire_core::read_plain(core, rules, self.frame(), of) else {
            return Ok(None);
        };
        let values = plain_objects(py, plain.numbers)?;
        Ok(values.map(|values| Message {
            variant: plain.variant,
            values,
            address: plain.address,
        }))
    }

    fn decoded<'py>(
        &self,
        py: Python<'py>,
        rules: &Rules,
        of: Option<usize>,
    ) -> PyResult<Result<Message<'py>, DecodeError>> {
        if let Some(message) = self.plain(py, rules, of)? {
            return Ok(Ok(message));
        }
        let (core, frame) = (&self.origin.edition.core, self.frame());
        let decoded = match cobotwire_core::read(core, rules, frame, of) {
            Ok(decoded) => decoded,
            Err(error) => return Ok(Err(error)),
        };
        Ok(Ok(Message {
            variant: decoded.variant,
            values: objects(py, &decoded.values)?,
            address: decoded.address,
        }))
    }

    /// Return the message, as Python's named tuple.
    fn tuple_of<'py>(&self, message: &Message<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Message {
            variant,
            values,
            address,
        } = message;
        let edition = &self.origin.edition;
        edition.message(values.py(), *variant, values, *address)
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
        self.tuple_of(&self.read(py, None, None)?)
    }

    /// The values of its message, one for each field.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        // `read` alone would do, but takes 7 % longer.
        match self.plain(py, &self.origin.rules, None)? {
            Some(message) => Ok(message.values),
            None => Ok(self.read(py, None, None)?.values),
        }
    }

    /// Return what `codec.decode(direction, frame.data, of=of)` returns, without validating it
    /// again.
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
        self.tuple_of(&self.read(py, direction.map(read_direction).transpose()?, of)?)
    }

    fn __eq__(&self, other: &Self) -> bool {
        self.offset == other.offset && self.frame == other.frame
    }

    /// Return the hash of Python's own class of frames, because the two can be equal.
    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        (self.offset, self.command(), self.data(py))
            .into_pyobject(py)?
            .hash()
    }

    fn __repr__(&self) -> String {
        let bytes = self.frame.bytes().iter();
        let data: Vec<String> = bytes.map(|byte| format!("{byte:02X}")).collect();
        format!("<Frame {} at {}>", data.join(" "), self.offset)
    }
}
