//! `NativeCodec`: implements `cobotwire.codec.interface.Codec` with the core.

use std::sync::Arc;

use cobotwire_core::{Choice, Direction, EncodeError, Listening, Rules, Workers};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::bulk::{self, NativeColumnReader};
use crate::edition::Edition;
use crate::frame::Origin;
use crate::framer::NativeFramer;
use crate::given::Object;
use crate::plain;
use crate::values::{objects, row};
use crate::words::{WorkerCount, read_direction, word};
use crate::{errors, words};

/// One edition's encoder, decoder and framer.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeCodec {
    pub edition: Arc<Edition>,
}

#[pymethods]
impl NativeCodec {
    #[new]
    fn new(table: Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self {
            edition: Arc::new(Edition::new(table)?),
        })
    }

    /// The edition that it interprets.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        self.edition.table.bind(py).clone()
    }

    /// The name of this codec.
    #[getter]
    fn name(&self) -> &'static str {
        "native"
    }

    /// Return the core's table as Rust's debug output, for tests.
    fn _core_table(&self) -> String {
        let core = &self.edition.core;
        format!("{:?} {:?}", core.frame(), core.commands())
    }

    /// Build one frame: the first variant that has as many fields as `values` and allows them.
    #[pyo3(signature = (command, direction, values, *, variant = None, address = None))]
    fn encode<'py>(
        &self,
        command: &Bound<'py, PyAny>,
        direction: &Bound<'py, PyAny>,
        values: &Bound<'py, PyAny>,
        variant: Option<&Bound<'py, PyAny>>,
        address: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let py = command.py();
        let Edition {
            table,
            core,
            commands,
            ..
        } = &*self.edition;
        let index = commands.find(table, command)?;
        let parsed = read_direction(direction)?;
        let objects = commands.get(index)?;
        if address.is_none()
            && let Some(frame) = plain::encode(core, (index, parsed), values, variant)
        {
            return Ok(frame);
        }
        let values = row(values)?;
        let format = core.frame();
        let address = address.map(|given| words::address(given, table, &format.addresses));
        let variant = variant.map(|given| words::variant(given, objects.variants(parsed).len()));
        let choice = Choice {
            address: address.transpose()?,
            variant: variant.transpose()?,
        };
        let record = core.commands().get(index);
        let encoded = record.map_or(Err(EncodeError::VariantId), |record| {
            cobotwire_core::encode::<Object<'_>>(format, record, parsed, &values, choice)
        });
        match encoded {
            Ok(frame) => Ok(PyBytes::new(py, &frame)),
            Err(EncodeError::Foreign(error)) => Err(error),
            // The address was checked above.
            Err(EncodeError::VariantId | EncodeError::Address) => Err(errors::bad_variant(
                objects.object.bind(py),
                direction,
                values.0.len(),
            )),
            Err(EncodeError::Value(bad)) => Err(errors::bad_value(
                objects.variant(py, parsed, bad.variant)?,
                bad,
            )),
        }
    }

    /// Decode `data`, which must be one whole frame and nothing else.
    #[pyo3(signature = (direction, data, *, of = None))]
    fn decode<'py>(
        &self,
        direction: &Bound<'py, PyAny>,
        data: &Bound<'py, PyAny>,
        of: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Edition {
            table,
            core,
            commands,
            ..
        } = &*self.edition;
        let of = of.map(|name| commands.find(table, name));
        let of = of.transpose()?;
        let parsed = read_direction(direction)?;
        let copy;
        let data = match data.cast_exact::<PyBytes>() {
            Ok(bytes) => bytes,
            Err(_) => {
                let bytes = data.py().get_type::<PyBytes>();
                copy = bytes.call1((data,))?.cast_into::<PyBytes>()?;
                &copy
            }
        };
        let py = direction.py();
        match cobotwire_core::decode(core, parsed, data.as_bytes(), of) {
            Ok(decoded) => {
                let values = objects(py, &decoded.values)?;
                let address = decoded.address;
                self.edition.message(py, decoded.variant, &values, address)
            }
            Err(error) => {
                let data = data.as_bytes();
                Err(self.edition.rejected(py, error, direction, data))
            }
        }
    }

    /// Return a new framer; with `accept_unknown`, frames with ids that the edition lacks are
    /// legal.
    #[pyo3(signature = (listening, *, accept_unknown = false))]
    fn framer(&self, listening: &Bound<'_, PyAny>, accept_unknown: bool) -> PyResult<NativeFramer> {
        let rules = self.rules(Some(listening), accept_unknown)?;
        let direction = match listen(Some(listening))? {
            Listening::To(direction) => direction,
            Listening::Both => Direction::Request,
        };
        let origin = Origin {
            edition: Arc::clone(&self.edition),
            rules,
            direction,
        };
        Ok(NativeFramer::new(origin))
    }

    /// Return the positions of the frames of a whole stream.
    #[pyo3(
        signature = (data, listening = None, *, accept_unknown = false, out = None, workers = WorkerCount(Workers::ONE)),
        text_signature = "($self, data, listening='both', *, accept_unknown=False, out=None, workers=1)"
    )]
    fn scan<'py>(
        &self,
        data: &Bound<'py, PyAny>,
        listening: Option<&Bound<'py, PyAny>>,
        accept_unknown: bool,
        out: Option<&Bound<'py, PyAny>>,
        workers: WorkerCount,
    ) -> PyResult<Bound<'py, PyAny>> {
        let rules = self.rules(listening, accept_unknown)?;
        bulk::scan(rules, data, out, workers.0)
    }

    /// Return the values of a whole stream, as columns.
    #[pyo3(
        signature = (data, listening = None, *, raw = false, out = None, workers = WorkerCount(Workers::ONE)),
        text_signature = "($self, data, listening='both', *, raw=False, out=None, workers=1)"
    )]
    fn decode_columns<'py>(
        &self,
        data: &Bound<'py, PyAny>,
        listening: Option<&Bound<'py, PyAny>>,
        raw: bool,
        out: Option<&Bound<'py, PyAny>>,
        workers: WorkerCount,
    ) -> PyResult<Bound<'py, PyAny>> {
        let reader = NativeColumnReader::new(Arc::clone(&self.edition), listen(listening)?, raw, 0);
        reader.all_of(data, out, workers.0)
    }

    /// Return a reader for a stream that arrives in chunks, or is larger than memory.
    #[pyo3(
        signature = (listening = None, *, raw = false, offset = None),
        text_signature = "($self, listening='both', *, raw=False, offset=0)"
    )]
    fn column_reader(
        &self,
        listening: Option<&Bound<'_, PyAny>>,
        raw: bool,
        offset: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<NativeColumnReader> {
        let edition = Arc::clone(&self.edition);
        let listening = listen(listening)?;
        let offset = offset.map_or(Ok(0), start)?;
        Ok(NativeColumnReader::new(edition, listening, raw, offset))
    }
}

/// Return an offset; the largest one leaves room for a stream of any length after it.
fn start(offset: &Bound<'_, PyAny>) -> PyResult<u64> {
    let start = offset.extract::<i64>().ok();
    let start = start.and_then(|start| u64::try_from(start).ok());
    start.ok_or_else(|| errors::bad_offset(offset))
}

impl NativeCodec {
    /// Return the edition that it interprets.
    pub fn edition(&self) -> &Arc<Edition> {
        &self.edition
    }

    /// Return the rules of a framer.
    pub fn rules(
        &self,
        listening: Option<&Bound<'_, PyAny>>,
        accept_unknown: bool,
    ) -> PyResult<Rules> {
        let rules = self.edition.core.rules(listen(listening)?).clone();
        Ok(if accept_unknown {
            rules.accepting_unknown()
        } else {
            rules
        })
    }
}

/// Return the directions to listen to; both by default.
pub fn listen(given: Option<&Bound<'_, PyAny>>) -> PyResult<Listening> {
    match given {
        None => Ok(Listening::Both),
        Some(given) if word(given) == Some("both") => Ok(Listening::Both),
        Some(given) => Ok(Listening::To(read_direction(given)?)),
    }
}
