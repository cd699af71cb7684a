//! `NativeSurvey`: counts the messages and the noise of a stream, and writes lines of JSON.

use std::sync::Arc;

use cobotwire_core::{Kind, Packets, Reason, Sink, Survey, Texts};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyString};

use crate::codec::{NativeCodec, listen};
use crate::convert;
use crate::edition::Edition;
use crate::exclusive::Exclusive;
use crate::framer::counters;
use crate::names::Names;

/// Surveys one stream.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeSurvey {
    edition: Arc<Edition>,
    core: Exclusive<Survey>,
}

/// The texts of lines: what starts each, the names of commands, the names of the fields of requests
/// and of replies, and the texts of unrecognised bytes and of the firmware's error message.
type GivenTexts = (String, Vec<String>, Fields, Fields, String, String);
type Fields = Vec<Vec<Vec<String>>>;

#[pymethods]
impl NativeSurvey {
    #[new]
    #[pyo3(signature = (codec, listening, accept_unknown, bus, lengths, texts))]
    fn new(
        codec: &NativeCodec,
        listening: &Bound<'_, PyAny>,
        accept_unknown: bool,
        bus: &Bound<'_, PyAny>,
        lengths: Vec<u16>,
        texts: Option<GivenTexts>,
    ) -> PyResult<Self> {
        let edition = Arc::clone(&codec.edition);
        let rules = codec.rules(Some(listening), accept_unknown)?;
        let listening = listen(Some(listening))?;
        let texts = texts.map(
            |(first, commands, requests, replies, unrecognised, error)| Texts {
                first,
                commands,
                fields: [requests, replies],
                unrecognised,
                command_error: error,
            },
        );
        let survey = Survey::new(
            Arc::clone(&edition.core),
            Arc::clone(edition.plans(listening)),
            rules,
            listening,
            Packets::new(convert::format(bus)?, lengths),
            texts,
        );
        Ok(Self {
            edition,
            core: Exclusive::new("survey", survey),
        })
    }

    /// Feed bytes; return what is not only counted, in the order of the stream.
    fn feed<'py>(&self, data: &Bound<'py, PyBytes>) -> PyResult<Bound<'py, PyList>> {
        let mut parts = Parts::new(data.py())?;
        self.core.get(data.py())?.feed(data.as_bytes(), &mut parts);
        parts.finish()
    }

    /// Report everything: no more bytes follow.
    fn flush<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut parts = Parts::new(py)?;
        self.core.get(py)?.flush(&mut parts);
        parts.finish()
    }

    /// The counts of the framer.
    #[getter]
    fn counters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        counters(py, self.core.get(py)?.tally())
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

/// Collects the parts of a call as Python objects: a noise, lines as `(offset, size, text)`, a frame
/// as `(offset, bytes)`, and None where noise ends.
struct Parts<'py> {
    names: &'static Names,
    list: Bound<'py, PyList>,
    failed: Option<PyErr>,
}

impl<'py> Parts<'py> {
    fn new(py: Python<'py>) -> PyResult<Self> {
        Ok(Self {
            names: Names::get(py)?,
            list: PyList::empty(py),
            failed: None,
        })
    }

    fn finish(self) -> PyResult<Bound<'py, PyList>> {
        self.failed.map_or(Ok(self.list), Err)
    }

    fn add(&mut self, added: PyResult<()>) {
        if let Err(error) = added {
            self.failed.get_or_insert(error);
        }
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
}

impl Sink for Parts<'_> {
    fn lines(&mut self, offset: u64, size: u64, lines: &[u8]) {
        let text = PyString::from_bytes(self.list.py(), lines);
        let added = text.and_then(|text| self.list.append((offset, size, text)));
        self.add(added);
    }

    fn frame(&mut self, offset: u64, data: &[u8]) {
        let data = PyBytes::new(self.list.py(), data);
        let added = self.list.append((offset, data));
        self.add(added);
    }

    fn noise(&mut self, offset: u64, data: &[u8], reason: Reason) {
        let added = self.add_noise(offset, data, reason);
        self.add(added);
    }

    fn end(&mut self) {
        let added = self.list.append(self.list.py().None());
        self.add(added);
    }
}
