//! A table as the core has it, beside the Python objects that stand for its parts.

use std::sync::{Arc, OnceLock};

use cobotwire_core::{DecodeError, Direction, Form, Listening, Plans, Table};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::names::Names;
use crate::objects::Commands;
use crate::{convert, errors};

/// One edition, as everything that was made from it shares it.
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

    /// How columns are read; made when it is first asked for.
    pub fn plans(&self, listening: Listening) -> &Arc<Plans> {
        let [request, reply, both] = &self.plans;
        let place = match listening {
            Listening::To(Direction::Request) => request,
            Listening::To(Direction::Reply) => reply,
            Listening::Both => both,
        };
        place.get_or_init(|| Arc::new(Plans::new(&self.core, listening)))
    }

    /// A decoded message, as Python's named tuple.
    pub fn message<'py>(
        &self,
        py: Python<'py>,
        form: Form,
        values: &Bound<'py, PyTuple>,
        address: Option<u8>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let names = Names::get(py)?;
        let command = self.commands.get(form.command)?;
        let layout = command.layout(py, form.direction, form.layout)?;
        let direction = names.direction(py, form.direction);
        let items = (command.object.bind(py), direction, layout, values, address);
        names.make(&names.message, items.into_pyobject(py)?)
    }

    /// The error to raise for bytes that were not decoded; where the caller named no direction, it is
    /// that of the form that refused.
    pub fn refused(
        &self,
        py: Python<'_>,
        error: DecodeError,
        direction: Option<&Bound<'_, PyAny>>,
        data: &[u8],
    ) -> PyErr {
        self.refusal(py, error, direction, data)
            .unwrap_or_else(|error| error)
    }

    fn refusal(
        &self,
        py: Python<'_>,
        error: DecodeError,
        direction: Option<&Bound<'_, PyAny>>,
        data: &[u8],
    ) -> PyResult<PyErr> {
        let data = PyBytes::new(py, data);
        match error {
            DecodeError::Frame { reason, offset } => {
                let names = Names::get(py)?;
                let direction = match direction {
                    Some(given) => given,
                    None => names.direction(py, Direction::Request).as_any(),
                };
                let table = self.table.bind(py);
                Ok(errors::bad_frame(table, direction, reason, offset, &data))
            }
            DecodeError::Raw(bad) => {
                let Form {
                    direction,
                    command,
                    layout,
                } = bad.form;
                let command = self.commands.get(command)?;
                let layout = command.layout(py, direction, layout)?;
                Ok(errors::bad_raw(command.object.bind(py), layout, bad, &data))
            }
        }
    }
}
