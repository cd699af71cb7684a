//! `NativeSummary`: counts the messages and the noise of a stream, and writes lines of JSON.

use std::sync::Arc;

use cobotwire_core::{
    DecodeError, Described, Direction, Expected, Instruction, Kind, Names as LineNames, Operand,
    Reason, ServoBus, Sink, Summary, Texts,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyString};

use crate::codec::{NativeCodec, listen};
use crate::convert;
use crate::edition::Edition;
use crate::exclusive::Exclusive;
use crate::framer::counters;
use crate::names::Names;

/// Summarizes one stream.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeSummary {
    edition: Arc<Edition>,
    core: Exclusive<Summary>,
}

/// The texts of lines: what starts each, the names of commands, and the names of the fields of
/// requests and of replies.
type GivenTexts = (String, Vec<String>, Fields, Fields);
type Fields = Vec<Vec<Vec<String>>>;

/// The servo bus: the format and the legal LENs of its packets, and the words that describe them.
#[derive(FromPyObject)]
struct GivenBus<'py> {
    frame: Bound<'py, PyAny>,
    lengths: Vec<u16>,
    /// The id that all servos obey.
    every: u8,
    errors: Vec<(String, u8)>,
    registers: Vec<String>,
    instructions: Vec<GivenInstruction>,
}

/// An instruction: its byte, its name, its legal LENs, its operands, and the largest servo
/// id that an operand may hold.
#[derive(FromPyObject)]
struct GivenInstruction {
    code: u8,
    name: String,
    lengths: Vec<u16>,
    operands: Vec<String>,
    largest: u8,
}

#[pymethods]
impl NativeSummary {
    #[new]
    #[pyo3(signature = (codec, listening, accept_unknown, bus, texts))]
    fn new(
        codec: &NativeCodec,
        listening: &Bound<'_, PyAny>,
        accept_unknown: bool,
        bus: GivenBus<'_>,
        texts: Option<GivenTexts>,
    ) -> PyResult<Self> {
        let edition = Arc::clone(&codec.edition);
        let rules = codec.rules(Some(listening), accept_unknown)?;
        let listening = listen(Some(listening))?;
        let texts = texts.map(|(first, commands, requests, replies)| Texts {
            first,
            names: LineNames {
                commands,
                fields: [requests, replies],
            },
        });
        let summary = Summary::new(
            Arc::clone(&edition.core),
            Arc::clone(edition.plans(listening)),
            rules,
            listening,
            Arc::new(servo_bus(bus)?),
            texts,
        );
        Ok(Self {
            edition,
            core: Exclusive::new("summary", summary),
        })
    }

    /// Feed bytes; return the noise and lines to report, in the order of the stream.
    fn feed<'py>(
        &self,
        data: &Bound<'py, PyBytes>,
        rest: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyList>> {
        let mut parts = Parts::new(&self.edition, rest)?;
        self.core.get(data.py())?.feed(data.as_bytes(), &mut parts);
        parts.finish()
    }

    /// Report everything: no more bytes follow.
    fn flush<'py>(&self, rest: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
        let mut parts = Parts::new(&self.edition, rest)?;
        self.core.get(rest.py())?.flush(&mut parts);
        parts.finish()
    }

    /// The counts of the framer.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let tally = self.core.get(py)?.tally().clone();
        counters(py, &tally)
    }

    /// The messages in the order of their first frames: id, command and number of frames. The
    /// command is None if no message is legal.
    #[getter]
    fn messages<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let all = PyList::empty(py);
        for counted in self.core.get(py)?.counted() {
            let command = counted
                .command
                .map(|index| self.edition.commands.get(index));
            let command = command.transpose()?.map(|command| command.object.bind(py));
            all.append((counted.id, command, counted.count))?;
        }
        Ok(all)
    }

    /// The noise that was only counted: kind, number of findings and of bytes.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let all = PyList::empty(py);
        let core = self.core.get(py)?;
        for (kind, extent) in Kind::ALL.into_iter().zip(core.extents()) {
            if extent.bytes > 0 {
                all.append((kind.word(), extent.count, extent.bytes))?;
            }
        }
        Ok(all)
    }
}

fn servo_bus(given: GivenBus<'_>) -> PyResult<ServoBus> {
    Ok(ServoBus {
        frame: convert::format(&given.frame)?,
        lengths: given.lengths,
        every: given.every,
        errors: given.errors,
        registers: given.registers,
        instructions: given.instructions.into_iter().map(instruction).collect(),
    })
}

fn instruction(given: GivenInstruction) -> Instruction {
    let operand = |word: &String| match word.as_str() {
        "register" => Operand::Register,
        "count" => Operand::Count,
        "servos" => Operand::Servos(given.largest),
        _ => Operand::Data,
    };
    Instruction {
        operands: given.operands.iter().map(operand).collect(),
        code: given.code,
        name: given.name,
        lengths: given.lengths,
    }
}

/// Collects the parts of a call as Python objects: noise, and lines as `(offset, size, text)`.
struct Parts<'a, 'py> {
    names: &'static Names,
    edition: &'a Edition,
    /// The Python object that diagnoses the other noise: `cobotwire.diagnose.stream_summary.Rest`.
    rest: &'a Bound<'py, PyAny>,
    list: Bound<'py, PyList>,
    failed: Option<PyErr>,
}

impl<'a, 'py> Parts<'a, 'py> {
    fn new(edition: &'a Edition, rest: &'a Bound<'py, PyAny>) -> PyResult<Self> {
        Ok(Self {
            names: Names::get(rest.py())?,
            edition,
            rest,
            list: PyList::empty(rest.py()),
            failed: None,
        })
    }

    fn finish(self) -> PyResult<Bound<'py, PyList>> {
        self.failed.map_or(Ok(self.list), Err)
    }

    /// Return what was made; if that failed, remember the first error.
    fn made<T: Default>(&mut self, made: PyResult<T>) -> T {
        made.unwrap_or_else(|error| {
            self.failed.get_or_insert(error);
            T::default()
        })
    }

    fn add_noise(&self, offset: u64, data: &[u8], reason: Reason) -> PyResult<()> {
        let py = self.list.py();
        let items = (
            offset,
            PyBytes::new(py, data),
            self.names.reason(py, reason),
        );
        let items = items.into_pyobject(py)?;
        self.list.append(self.names.make(&self.names.noise, items)?)
    }

    fn diagnosed(&mut self, closed: bool, expected: &Expected) -> PyResult<Expected> {
        let parts = std::mem::replace(&mut self.list, PyList::empty(self.rest.py()));
        let found = self
            .rest
            .call_method1("diagnose", (parts, closed, expected.clone()))?;
        found.extract()
    }

    fn described(&self, noise: &Described<'_>) -> PyResult<String> {
        let py = self.rest.py();
        let data = PyBytes::new(py, noise.data);
        let reason = self.names.reason(py, noise.reason);
        let given = (noise.kind.word(), reason, data, noise.id);
        self.rest.call_method1("describe", given)?.extract()
    }

    fn detail_of(&self, direction: Direction, error: DecodeError, data: &[u8]) -> PyResult<String> {
        let py = self.rest.py();
        let direction = self.names.direction(py, direction);
        let error = self.edition.rejected(py, error, direction, data);
        error.value(py).getattr("detail")?.extract()
    }
}

impl Sink for Parts<'_, '_> {
    fn lines(&mut self, offset: u64, size: u64, lines: &[u8]) {
        let text = PyString::from_bytes(self.list.py(), lines);
        let added = text.and_then(|text| self.list.append((offset, size, text)));
        self.made(added);
    }

    fn noise(&mut self, offset: u64, data: &[u8], reason: Reason) {
        let added = self.add_noise(offset, data, reason);
        self.made(added);
    }

    fn diagnose(&mut self, closed: bool, expected: &mut Expected) {
        let found = self.diagnosed(closed, expected);
        *expected = self.made(found);
    }

    fn detail(&mut self, direction: Direction, error: DecodeError, data: &[u8]) -> String {
        let detail = self.detail_of(direction, error, data);
        self.made(detail)
    }

    fn describe(&mut self, noise: &Described<'_>) -> String {
        let described = self.described(noise);
        self.made(described)
    }
}
