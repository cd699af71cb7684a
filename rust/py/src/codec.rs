//! `NativeCodec`: the core behind `cobotwire.codec.interface.Codec`.

use std::collections::HashMap;

use cobotwire_core::{DecodeError, Direction, EncodeError, Form, Framer, Listening, Table, Value};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};

use crate::framer::{NativeFramer, copied};
use crate::given::Object;
use crate::names::Names;
use crate::values::{objects, row};
use crate::{convert, errors};

/// One edition's encoder, decoder and framer.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeCodec {
    /// The edition that it interprets.
    #[pyo3(get)]
    table: Py<PyAny>,
    core: Table,
    by_name: HashMap<String, usize>,
    /// The Python objects of the table's commands, for messages and errors.
    commands: Vec<Command>,
}

struct Command {
    object: Py<PyAny>,
    request: Vec<Py<PyAny>>,
    reply: Vec<Py<PyAny>>,
}

#[pymethods]
impl NativeCodec {
    #[new]
    fn new(table: Bound<'_, PyAny>) -> PyResult<Self> {
        let (core, names) = convert::table(&table)?;
        let mut by_name = HashMap::new();
        for (index, name) in names.into_iter().enumerate() {
            by_name.entry(name).or_insert(index);
        }
        let commands = table.getattr("commands")?.try_iter()?;
        let commands = commands
            .map(|command| Command::new(command?))
            .collect::<PyResult<_>>()?;
        Ok(Self {
            table: table.unbind(),
            core,
            by_name,
            commands,
        })
    }

    /// Which of the two codecs it is.
    #[getter]
    fn name(&self) -> &'static str {
        "native"
    }

    /// Build one whole frame; the number of `values` picks the form of the message.
    fn encode<'py>(
        &self,
        command: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
        values: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let py = command.py();
        let index = self.find(command)?;
        let way = one_way(direction)?;
        let (Some(objects), Some(record)) =
            (self.commands.get(index), self.core.commands().get(index))
        else {
            return Err(PyKeyError::new_err(index));
        };
        let values = row(values)?;
        match cobotwire_core::encode::<Object<'_>>(self.core.frame(), record, way, &values) {
            Ok(frame) => Ok(PyBytes::new(py, &frame)),
            Err(EncodeError::Foreign(error)) => Err(error),
            Err(EncodeError::Form) => Err(errors::bad_form(
                objects.object.bind(py),
                direction,
                values.0.len(),
            )),
            Err(EncodeError::Value(bad)) => {
                Err(errors::bad_value(objects.layout(py, way, bad.layout)?, bad))
            }
        }
    }

    /// Read `data`, which must be one whole frame and nothing else.
    fn decode<'py>(
        &self,
        direction: &Bound<'py, PyAny>,
        data: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let way = one_way(direction)?;
        let decoded = match data.cast::<PyBytes>() {
            Ok(bytes) => cobotwire_core::decode(&self.core, way, bytes.as_bytes()),
            Err(_) => cobotwire_core::decode(&self.core, way, &copied(data)?),
        };
        match decoded {
            Ok(decoded) => self.message(decoded.form, direction, &decoded.values),
            Err(error) => Err(self.refused(way, error, direction, data)?),
        }
    }

    /// A new framer; `accept_unknown` also takes ids that the edition lacks as frames.
    #[pyo3(signature = (listening, *, accept_unknown = false))]
    fn framer(&self, listening: &Bound<'_, PyAny>, accept_unknown: bool) -> PyResult<NativeFramer> {
        let listening = match word(listening) {
            Some("both") => Listening::Both,
            _ => Listening::To(one_way(listening)?),
        };
        let rules = self.core.rules(listening).clone();
        let rules = if accept_unknown {
            rules.accepting_unknown()
        } else {
            rules
        };
        Ok(NativeFramer::new(Framer::new(rules)))
    }
}

impl NativeCodec {
    /// The index of the command with that name.
    fn find(&self, name: &Bound<'_, PyAny>) -> PyResult<usize> {
        if let Some(index) = word(name).and_then(|name| self.by_name.get(name)) {
            return Ok(*index);
        }
        // The table says that there is none, and which name is nearest.
        let found = self
            .table
            .bind(name.py())
            .call_method1("command", (name,))?;
        let place = self
            .commands
            .iter()
            .position(|command| command.object.is(&found));
        place.ok_or_else(|| PyKeyError::new_err((name.clone().unbind(),)))
    }

    fn message<'py>(
        &self,
        form: Form,
        direction: &Bound<'py, PyAny>,
        values: &[Value],
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = direction.py();
        let command = self.command(form.command)?;
        let layout = command.layout(py, form.direction, form.layout)?;
        let items = (
            command.object.bind(py),
            direction,
            layout,
            objects(py, values)?,
        );
        let names = Names::get(py)?;
        names.make(&names.message, items.into_pyobject(py)?)
    }

    /// The error to raise; failing to make it is another.
    fn refused(
        &self,
        way: Direction,
        error: DecodeError,
        direction: &Bound<'_, PyAny>,
        data: &Bound<'_, PyAny>,
    ) -> PyResult<PyErr> {
        let py = data.py();
        match error {
            DecodeError::Frame { reason, offset } => Ok(errors::bad_frame(
                self.table.bind(py),
                direction,
                reason,
                offset,
                data,
            )),
            DecodeError::Raw(bad) => {
                let command = self.command(bad.command)?;
                let layout = command.layout(py, way, bad.layout)?;
                Ok(errors::bad_raw(command.object.bind(py), layout, bad, data))
            }
        }
    }

    fn command(&self, index: usize) -> PyResult<&Command> {
        self.commands
            .get(index)
            .ok_or_else(|| PyKeyError::new_err(index))
    }
}

impl Command {
    fn new(object: Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self {
            request: object.getattr("request")?.extract()?,
            reply: object.getattr("reply")?.extract()?,
            object: object.unbind(),
        })
    }

    fn layout<'py>(
        &self,
        py: Python<'py>,
        direction: Direction,
        index: usize,
    ) -> PyResult<&Bound<'py, PyAny>> {
        let layouts = match direction {
            Direction::Request => &self.request,
            Direction::Reply => &self.reply,
        };
        let layout = layouts
            .get(index)
            .ok_or_else(|| PyKeyError::new_err(index))?;
        Ok(layout.bind(py))
    }
}

fn word<'a>(given: &'a Bound<'_, PyAny>) -> Option<&'a str> {
    given.cast::<PyString>().ok()?.to_str().ok()
}

fn one_way(given: &Bound<'_, PyAny>) -> PyResult<Direction> {
    match word(given) {
        Some("request") => Ok(Direction::Request),
        Some("reply") => Ok(Direction::Reply),
        _ => Err(errors::bad_direction(given)),
    }
}
