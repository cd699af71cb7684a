//! `NativeCodec`: the core behind `cobotwire.codec.interface.Codec`.

use cobotwire_core::{
    Choice, DecodeError, Decoded, Direction, EncodeError, Framer, Listening, Table,
};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::framer::NativeFramer;
use crate::given::Object;
use crate::names::Names;
use crate::objects::Commands;
use crate::values::{objects, row};
use crate::words::{one_way, word};
use crate::{convert, errors, words};

/// One edition's encoder, decoder and framer.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeCodec {
    /// The edition that it interprets.
    #[pyo3(get)]
    table: Py<PyAny>,
    core: Table,
    commands: Commands,
}

#[pymethods]
impl NativeCodec {
    #[new]
    fn new(table: Bound<'_, PyAny>) -> PyResult<Self> {
        let (core, names) = convert::table(&table)?;
        Ok(Self {
            commands: Commands::new(&table, names)?,
            table: table.unbind(),
            core,
        })
    }

    /// Which of the two codecs it is.
    #[getter]
    fn name(&self) -> &'static str {
        "native"
    }

    /// Build one whole frame, of the first form with that number of fields that takes `values`.
    #[pyo3(signature = (command, direction, values, *, form = None, address = None))]
    fn encode<'py>(
        &self,
        command: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
        values: &Bound<'py, PyAny>,
        form: Option<&Bound<'py, PyAny>>,
        address: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let py = command.py();
        let index = self.commands.find(&self.table, command)?;
        let way = one_way(direction)?;
        let objects = self.commands.get(index)?;
        let values = row(values)?;
        let format = self.core.frame();
        let address = address.map(|given| words::address(given, &self.table, &format.addresses));
        let form = form.map(|given| words::form(given, objects.layouts(way).len()));
        let choice = Choice {
            address: address.transpose()?,
            form: form.transpose()?,
        };
        let record = self.core.commands().get(index);
        let encoded = record.map_or(Err(EncodeError::Form), |record| {
            cobotwire_core::encode::<Object<'_>>(format, record, way, &values, choice)
        });
        match encoded {
            Ok(frame) => Ok(PyBytes::new(py, &frame)),
            Err(EncodeError::Foreign(error)) => Err(error),
            // The address was looked at above.
            Err(EncodeError::Form | EncodeError::Address) => Err(errors::bad_form(
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
    #[pyo3(signature = (direction, data, *, of = None))]
    fn decode<'py>(
        &self,
        direction: &Bound<'py, PyAny>,
        data: &Bound<'py, PyAny>,
        of: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let of = of.map(|name| self.commands.find(&self.table, name));
        let of = of.transpose()?;
        let way = one_way(direction)?;
        let copy;
        let data = match data.cast_exact::<PyBytes>() {
            Ok(bytes) => bytes,
            Err(_) => {
                let bytes = data.py().get_type::<PyBytes>();
                copy = bytes.call1((data,))?.cast_into::<PyBytes>()?;
                &copy
            }
        };
        match cobotwire_core::decode(&self.core, way, data.as_bytes(), of) {
            Ok(decoded) => self.message(direction, &decoded),
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
    fn message<'py>(
        &self,
        direction: &Bound<'py, PyAny>,
        decoded: &Decoded,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = direction.py();
        let form = decoded.form;
        let command = self.commands.get(form.command)?;
        let layout = command.layout(py, form.direction, form.layout)?;
        let items = (
            command.object.bind(py),
            direction,
            layout,
            objects(py, &decoded.values)?,
            decoded.address,
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
        data: &Bound<'_, PyBytes>,
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
                let command = self.commands.get(bad.command)?;
                let layout = command.layout(py, way, bad.layout)?;
                Ok(errors::bad_raw(command.object.bind(py), layout, bad, data))
            }
        }
    }
}
