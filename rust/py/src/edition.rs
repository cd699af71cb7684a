//! An edition: the core's table, and the Python objects of its commands.

use std::sync::{Arc, OnceLock};

use cobotwire_core::{DecodeError, Direction, Listening, Plans, Table, VariantId};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyTuple};

use crate::names::Names;
use crate::objects::Commands;
use crate::{convert, errors};

/// One edition, which its codec, framers and frames share.
pub struct Edition {
    pub table: Py<PyAny>,
    pub core: Arc<Table>,
    pub commands: Commands,
    plans: [OnceLock<Arc<Plans>>; 3],
}

impl Edition {
    pub fn new(table: Bound<'_, PyAny>) -> PyResult<Self> {
        let (core, names) = convert::table(&table)?;
        Ok(Self {
            commands: Commands::new(&table, names)?,
            table: table.unbind(),
            core: Arc::new(core),
            plans: Default::default(),
        })
    }

    /// Return the plans for reading columns; they are made on first use.
    pub fn plans(&self, listening: Listening) -> &Arc<Plans> {
        let [request, reply, both] = &self.plans;
        let place = match listening {
            Listening::To(Direction::Request) => request,
            Listening::To(Direction::Reply) => reply,
            Listening::Both => both,
        };
        place.get_or_init(|| Arc::new(Plans::new(&self.core, listening)))
    }

    /// Return a decoded message, as Python's named tuple.
    pub fn message<'py>(
        &self,
        py: Python<'py>,
        id: VariantId,
        values: &Bound<'py, PyTuple>,
        address: Option<u8>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let names = Names::get(py)?;
        let command = self.commands.get(id.command)?;
        let variant = command.variant(py, id.direction, id.variant)?;
        let direction = names.direction(py, id.direction);
        let items = (command.object.bind(py), direction, variant, values, address);
        names.make(&names.message, items.into_pyobject(py)?)
    }

    /// Return the values of a message by the names of their fields.
    pub fn fields<'py>(
        &self,
        id: VariantId,
        values: &Bound<'py, PyTuple>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let py = values.py();
        let command = self.commands.get(id.command)?;
        let variant = command.variant(py, id.direction, id.variant)?;
        let names = variant.getattr(intern!(py, "names"))?;
        let fields = PyDict::new(py);
        for (name, value) in names.cast::<PyTuple>()?.iter().zip(values) {
            fields.set_item(name, value)?;
        }
        Ok(fields)
    }

    /// Return the error to raise for bytes that were not decoded.
    pub fn rejected(
        &self,
        py: Python<'_>,
        error: DecodeError,
        direction: &Bound<'_, PyAny>,
        data: &[u8],
    ) -> PyErr {
        self.rejection(py, error, direction, data)
            .unwrap_or_else(|error| error)
    }

    fn rejection(
        &self,
        py: Python<'_>,
        error: DecodeError,
        direction: &Bound<'_, PyAny>,
        data: &[u8],
    ) -> PyResult<PyErr> {
        let data = PyBytes::new(py, data);
        match error {
            DecodeError::Frame { reason, offset } => {
                let table = self.table.bind(py);
                Ok(errors::bad_frame(table, direction, reason, offset, &data))
            }
            DecodeError::Raw(bad) => {
                let VariantId {
                    direction,
                    command,
                    variant,
                } = bad.variant;
                let command = self.commands.get(command)?;
                let variant = command.variant(py, direction, variant)?;
                Ok(errors::bad_raw(
                    command.object.bind(py),
                    variant,
                    bad,
                    &data,
                ))
            }
        }
    }
}
