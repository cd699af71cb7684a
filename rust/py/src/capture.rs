//! `NativeCaptureReader`: reads recordings into columns with times.

use std::sync::Arc;

use cobotwire_core::{
    Advise, CaptureReader, Decoder, Decoders, Fault, Interface, Listening, Numbers, StreamBatch,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyTuple};

use crate::bulk::{Reader, columns, feed, filled};
use crate::codec::{NativeCodec, listen};
use crate::edition::Edition;
use crate::exclusive::Exclusive;
use crate::memory::Memory;

/// Reads a pcapng recording, piece by piece, into columns.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeCaptureReader {
    numbers: Numbers,
    state: Exclusive<State>,
}

struct State {
    core: CaptureReader,
    editions: Editions,
}

/// The editions of the streams.
struct Editions {
    /// Called with an interface; returns its codec.
    codec_of: Py<PyAny>,
    /// The edition of each stream, in the order of their first packets.
    all: Vec<Arc<Edition>>,
    /// The exception that stopped the reader.
    error: Option<PyErr>,
}

impl Editions {
    fn codec(&self, interface: &Interface) -> PyResult<Arc<Edition>> {
        Python::attach(|py| {
            let codec = self.codec_of.bind(py).call1(described(py, interface)?)?;
            Ok(Arc::clone(codec.cast::<NativeCodec>()?.get().edition()))
        })
    }
}

impl Decoders for Editions {
    fn decoder(&mut self, interface: &Interface, listening: Listening) -> Option<Decoder> {
        match self.codec(interface) {
            Ok(edition) => {
                let decoder = Decoder {
                    table: Arc::clone(&edition.core),
                    plans: Arc::clone(edition.plans(listening)),
                };
                self.all.push(edition);
                Some(decoder)
            }
            Err(error) => {
                self.error = Some(error);
                None
            }
        }
    }
}

impl Reader for State {
    fn feed(&mut self, chunk: &[u8]) {
        self.core.feed(chunk, &mut self.editions);
    }

    fn expect(&mut self, _: &[u8], _: Advise) {}
}

#[pymethods]
impl NativeCaptureReader {
    #[new]
    #[pyo3(signature = (codec_of, listening, raw))]
    fn new(codec_of: Py<PyAny>, listening: &Bound<'_, PyAny>, raw: bool) -> PyResult<Self> {
        let numbers = if raw { Numbers::Raw } else { Numbers::Physical };
        let state = State {
            core: CaptureReader::new(listen(Some(listening))?, numbers),
            editions: Editions {
                codec_of,
                all: Vec::new(),
                error: None,
            },
        };
        Ok(Self {
            numbers,
            state: Exclusive::new("capture reader", state),
        })
    }

    /// Feed the next bytes of the file.
    fn add(&self, data: &Bound<'_, PyAny>) -> PyResult<()> {
        let mut state = self.state.get(data.py())?;
        feed(&mut *state, data)?;
        state.editions.error.take().map_or(Ok(()), Err)
    }

    /// Report the end of the file: no more bytes follow.
    fn end(&self, py: Python<'_>) -> PyResult<()> {
        self.state.get(py)?.core.finish();
        Ok(())
    }

    /// Return what was found in each stream since the last call.
    fn streams<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut state = self.state.get(py)?;
        let all = PyList::empty(py);
        for (batch, edition) in state.core.take().into_iter().zip(&state.editions.all) {
            all.append(stream(py, edition, self.numbers, batch)?)?;
        }
        Ok(all)
    }

    /// The interfaces that the file describes so far.
    #[getter]
    fn interfaces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let state = self.state.get(py)?;
        let all = state.core.interfaces().iter();
        let all: PyResult<Vec<_>> = all.map(|interface| described(py, interface)).collect();
        PyTuple::new(py, all?)
    }

    /// The name of the program that wrote the file, the bytes read, and whether the file is
    /// complete.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let state = self.state.get(py)?;
        let core = &state.core;
        let application = PyBytes::new(py, core.application());
        let damage = core.damage().map(|damage| {
            let (kind, numbers) = words(damage.fault);
            (damage.offset, kind, numbers)
        });
        let status = (
            application,
            core.size(),
            core.finished(),
            core.truncated_at(),
            damage,
        );
        status.into_pyobject(py)
    }
}

/// Return an interface's name, description and speed.
fn described<'py>(py: Python<'py>, interface: &Interface) -> PyResult<Bound<'py, PyTuple>> {
    let Interface {
        name,
        description,
        speed,
    } = interface;
    (PyBytes::new(py, name), PyBytes::new(py, description), speed).into_pyobject(py)
}

/// Return a stream: its interface, its direction as a number, and its columns with their times.
fn stream<'py>(
    py: Python<'py>,
    edition: &Edition,
    numbers: Numbers,
    batch: StreamBatch,
) -> PyResult<Bound<'py, PyTuple>> {
    let StreamBatch {
        columns: mut found,
        times,
        ..
    } = batch;
    let rows = std::mem::take(&mut found.rows).into_iter();
    let (rows, row_times): (Vec<_>, Vec<_>) = filled(rows.zip(times.rows)).into_iter().unzip();
    found.rows = rows;
    let row_times = row_times.into_iter().map(Memory::times);
    let row_times: PyResult<Vec<_>> = row_times.map(|times| Bound::new(py, times)).collect();
    let columns = columns(py, edition, numbers, found, &batch.tally)?;
    let (rejected, noise) = (Memory::times(times.rejected), Memory::times(times.noise));
    let direction = batch.direction as u8;
    (
        batch.interface,
        direction,
        columns,
        row_times?,
        rejected,
        noise,
    )
        .into_pyobject(py)
}

/// Return the name of a fault, and the numbers of its message.
fn words(fault: Fault) -> (&'static str, Vec<u32>) {
    match fault {
        Fault::NotPcapng => ("not-pcapng", vec![]),
        Fault::BadLength(length, smallest) => ("bad-length", vec![length, smallest]),
        Fault::LengthsDiffer => ("lengths-differ", vec![]),
        Fault::TooShort => ("too-short", vec![]),
        Fault::Version(version) => ("version", vec![version.into()]),
        Fault::LongNumber => ("long-number", vec![]),
        Fault::LinkType(link_type) => ("link-type", vec![link_type.into()]),
        Fault::NoInterface(index) => ("no-interface", vec![index]),
        Fault::NoTime => ("no-time", vec![]),
        Fault::TooManyInterfaces => ("many-interfaces", vec![]),
        Fault::TimeRange => ("time-range", vec![]),
    }
}
