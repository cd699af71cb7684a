//! Whole streams: `NativeColumnReader`, and the scan for offsets.
//!
//! Large input is read without the interpreter's lock.

use std::sync::Arc;

use cobotwire_core::{
    Advise, ColumnReader, Columns, Listening, Numbers, OffsetReader, Offsets, Rows, Rules, Tally,
    Workers,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyMemoryView, PySlice, PyTuple};

use crate::edition::Edition;
use crate::exclusive::Exclusive;
use crate::framer::{copied, counters};
use crate::memory::{Memory, large_pages};
use crate::names::Names;
use crate::parts::{old_columns, old_offsets, spans};

/// Input of this size and more is read without the lock. Getting the lock back from a busy thread
/// takes 5 ms; reading this many bytes takes about 1 ms on one core of an AMD EPYC.
const LARGE: usize = 1 << 20;
/// Bytes that another thread could change during the read are copied in pieces of this size, which
/// stay in a cache.
const PIECE: usize = 1 << 20;
/// The size of these pieces if several threads read each of them.
const SHARED_PIECE: usize = 1 << 23;

/// A reader of a stream.
pub trait Reader: Send {
    fn feed(&mut self, chunk: &[u8]);
    fn expect(&mut self, data: &[u8], advise: Advise);

    /// The number of threads that read large chunks.
    fn workers(&self) -> Workers {
        Workers::ONE
    }
}

impl Reader for ColumnReader {
    fn feed(&mut self, chunk: &[u8]) {
        self.feed(chunk);
    }

    fn expect(&mut self, data: &[u8], advise: Advise) {
        self.expect(data, advise);
    }

    fn workers(&self) -> Workers {
        self.workers()
    }
}

impl Reader for OffsetReader {
    fn feed(&mut self, chunk: &[u8]) {
        self.feed(chunk);
    }

    fn expect(&mut self, data: &[u8], advise: Advise) {
        self.expect(data, advise);
    }

    fn workers(&self) -> Workers {
        self.workers()
    }
}

/// Feed a whole buffer.
pub fn feed(reader: &mut impl Reader, data: &Bound<'_, PyAny>) -> PyResult<()> {
    if let Ok(bytes) = data.cast::<PyBytes>() {
        feed_bytes(reader, bytes, true);
        return Ok(());
    }
    let flat = PyMemoryView::from(data).and_then(|view| view.call_method1("cast", ("B",)));
    let Ok(flat) = flat else {
        reader.feed(&copied(data)?);
        return Ok(());
    };
    let end = isize::try_from(flat.len()?)?;
    let size = if reader.workers().are_several() {
        SHARED_PIECE
    } else {
        PIECE
    };
    for start in (0..end).step_by(size) {
        let part = PySlice::new(data.py(), start, end.min(start + size as isize), 1);
        let piece = flat.get_item(part)?.call_method0("tobytes")?;
        feed_bytes(reader, piece.cast()?, false);
    }
    Ok(())
}

/// Feed immutable bytes; large input is read without the lock.
fn feed_bytes(reader: &mut impl Reader, bytes: &Bound<'_, PyBytes>, all: bool) {
    let data = bytes.as_bytes();
    if data.len() < LARGE {
        reader.feed(data);
        return;
    }
    bytes.py().detach(|| {
        if all {
            reader.expect(data, large_pages);
        }
        reader.feed(data);
    });
}

/// Return the positions of the frames of a whole stream, as Python's `Scan`.
pub fn scan<'py>(
    rules: Rules,
    data: &Bound<'py, PyAny>,
    out: Option<&Bound<'py, PyAny>>,
    workers: Workers,
) -> PyResult<Bound<'py, PyAny>> {
    let py = data.py();
    let old = out.map(old_offsets).transpose()?;
    let mut reader = OffsetReader::new(rules, old);
    reader.set_workers(workers);
    feed(&mut reader, data)?;
    reader.flush();
    let Offsets { frames, noise } = reader.take();
    let frames = Bound::new(py, Memory::offsets(frames))?;
    let items = (frames, spans(py, noise)?, counters(py, reader.tally())?);
    Names::get(py)?.scan.bind(py).call1(items)
}

/// Decodes a stream, chunk by chunk, into columns.
#[pyclass(frozen, module = "cobotwire._native")]
pub struct NativeColumnReader {
    edition: Arc<Edition>,
    listening: Listening,
    numbers: Numbers,
    core: Exclusive<ColumnReader>,
}

impl NativeColumnReader {
    /// Return a reader; the first byte that it takes is at `offset` of the stream.
    pub fn new(edition: Arc<Edition>, listening: Listening, raw: bool, offset: u64) -> Self {
        let numbers = if raw { Numbers::Raw } else { Numbers::Physical };
        let core = Self::reader(&edition, listening, numbers, None).starting_at(offset);
        Self {
            core: Exclusive::new("column reader", core),
            edition,
            listening,
            numbers,
        }
    }

    fn reader(
        edition: &Edition,
        listening: Listening,
        numbers: Numbers,
        old: Option<Columns>,
    ) -> ColumnReader {
        let plans = Arc::clone(edition.plans(listening));
        ColumnReader::new(Arc::clone(&edition.core), plans, numbers, old)
    }

    /// Return the columns of a whole stream.
    pub fn all_of<'py>(
        &self,
        data: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyAny>>,
        workers: Workers,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut core = self.core.get(data.py())?;
        if let Some(out) = out {
            let old = old_columns(&self.edition, out)?;
            *core = Self::reader(&self.edition, self.listening, self.numbers, Some(old));
        }
        core.set_workers(workers);
        feed(&mut *core, data)?;
        core.flush();
        self.given(data.py(), &mut core)
    }

    /// Return what was found since the last call, as Python's `Columns`.
    fn given<'py>(&self, py: Python<'py>, core: &mut ColumnReader) -> PyResult<Bound<'py, PyAny>> {
        let mut found = core.take();
        let rows = std::mem::take(&mut found.rows);
        let rows = filled(rows.into_iter().map(|rows| (rows, ())));
        let rows = rows.into_iter().map(|(rows, ())| rows);
        found.rows = rows.collect();
        columns(py, &self.edition, self.numbers, found, core.tally())
    }
}

/// Return the pairs with rows that are not empty, in the order of the table, as the reference does.
pub fn filled<T>(rows: impl Iterator<Item = (Rows, T)>) -> Vec<(Rows, T)> {
    let mut all: Vec<_> = rows.filter(|(rows, _)| !rows.offsets.is_empty()).collect();
    all.sort_by_key(|(rows, _)| {
        let variant = rows.variant;
        (variant.command, variant.direction as u8, variant.variant)
    });
    all
}

/// Return columns as Python's `Columns`.
pub fn columns<'py>(
    py: Python<'py>,
    edition: &Edition,
    numbers: Numbers,
    found: Columns,
    tally: &Tally,
) -> PyResult<Bound<'py, PyAny>> {
    let names = Names::get(py)?;
    let all = PyList::empty(py);
    for found in found.rows {
        all.append(rows(py, names, edition, found)?)?;
    }
    let table = edition.table.bind(py);
    let rejected = Bound::new(py, Memory::offsets(found.rejected))?;
    let tally = counters(py, tally)?;
    let raw = numbers == Numbers::Raw;
    names
        .columns
        .bind(py)
        .call1((table, all, rejected, spans(py, found.noise)?, tally, raw))
}

fn rows<'py>(
    py: Python<'py>,
    names: &Names,
    edition: &Edition,
    rows: Rows,
) -> PyResult<Bound<'py, PyAny>> {
    let command = edition.commands.get(rows.variant.command)?;
    let variant = edition.core.variant(rows.variant);
    let fields = variant.map_or(&[][..], |variant| variant.fields());
    let mut columns = Vec::with_capacity(fields.len());
    for (field, cells) in fields.iter().zip(rows.fields) {
        columns.push(Bound::new(py, Memory::cells(cells, field))?);
    }
    let has_address = edition.core.frame().layout.address_at.is_some();
    names.rows.bind(py).call1((
        edition.table.bind(py),
        command.object.bind(py),
        names.direction(py, rows.variant.direction),
        rows.variant.variant,
        Memory::offsets(rows.offsets),
        PyTuple::new(py, columns)?,
        has_address.then(|| Memory::addresses(rows.addresses)),
    ))
}

#[pymethods]
impl NativeColumnReader {
    /// Feed bytes; return the new rows and noise that more bytes cannot change.
    fn feed<'py>(&self, data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let mut core = self.core.get(data.py())?;
        feed(&mut *core, data)?;
        self.given(data.py(), &mut core)
    }

    /// Reject the candidate that waits; return the remaining rows and noise.
    fn flush<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let mut core = self.core.get(py)?;
        core.flush();
        self.given(py, &mut core)
    }

    /// The number of bytes that may still become part of a frame.
    #[getter]
    fn pending(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.core.get(py)?.pending())
    }
}
