//! Converts parts of the core's results to Python objects, and back to reuse their memory (`out=`).

use cobotwire_core::{Cells, Columns, Direction, Offsets, Rows, Spans, VariantId};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::column::Column;
use crate::edition::Edition;
use crate::memory::Memory;

/// Return spans of noise: their positions, and their sizes.
pub fn spans<'py>(py: Python<'py>, noise: Spans) -> PyResult<Bound<'py, PyTuple>> {
    let Spans { offsets, sizes } = noise;
    (Memory::offsets(offsets), Memory::offsets(sizes)).into_pyobject(py)
}

/// Take the memory of an earlier `Scan`, which is empty afterwards.
pub fn old_offsets(out: &Bound<'_, PyAny>) -> PyResult<Offsets> {
    let memory: Bound<'_, Memory> = out.getattr("_offset")?.extract()?;
    let [starts, sizes] = noise_of(out)?;
    let mut taken = Memory::take_all(&[memory.get(), starts.get(), sizes.get()])?.into_iter();
    let mut next = || taken.next().map_or(Vec::new(), offsets);
    Ok(Offsets {
        frames: next(),
        noise: Spans {
            offsets: next(),
            sizes: next(),
        },
    })
}

/// Return the `Memory` objects of the noise of an earlier result: offsets and sizes of its spans.
fn noise_of<'py>(out: &Bound<'py, PyAny>) -> PyResult<[Bound<'py, Memory>; 2]> {
    let (offsets, sizes) = out.getattr("_noise")?.extract()?;
    Ok([offsets, sizes])
}

/// Take the memory of an earlier `Columns`, which is empty afterwards.
pub fn old_columns(edition: &Edition, out: &Bound<'_, PyAny>) -> PyResult<Columns> {
    let rows: Vec<Bound<'_, PyAny>> = out.getattr("_rows")?.extract()?;
    // Attributes are read before memory is taken: this runs Python code, which may raise an error
    // or let another thread run.
    let variants = rows.iter().map(|rows| variant(edition, rows));
    let variants = variants.collect::<PyResult<Vec<_>>>()?;
    let memories = rows
        .iter()
        .map(Memories::of)
        .collect::<PyResult<Vec<_>>>()?;
    let noise = noise_of(out)?;
    let rows = memories.iter().flat_map(Memories::all);
    let all: Vec<&Memory> = noise.iter().map(Bound::get).chain(rows).collect();
    // Check all of them first, so that the old columns stay complete after an error.
    let mut taken = Memory::take_all(&all)?.into_iter();
    let mut next = || taken.next().map_or(Vec::new(), offsets);
    let mut old = Columns {
        noise: Spans {
            offsets: next(),
            sizes: next(),
        },
        ..Columns::default()
    };
    for (variant, memories) in variants.into_iter().zip(&memories) {
        let mut columns = taken.by_ref().take(memories.all().count());
        let offsets = columns.next().map_or(Vec::new(), offsets);
        let address = memories.address.as_ref().and_then(|_| columns.next());
        let addresses = address.map_or(Vec::new(), addresses);
        let fields = columns.map(Column::into_cells).collect();
        if let Some(variant) = variant {
            old.rows.push(Rows {
                variant,
                offsets,
                addresses,
                fields,
            });
        }
    }
    out.setattr("_rows", PyTuple::empty(out.py()))?;
    Ok(old)
}

/// The `Memory` objects of the rows of one variant.
struct Memories<'py> {
    offset: Bound<'py, Memory>,
    address: Option<Bound<'py, Memory>>,
    fields: Vec<Bound<'py, Memory>>,
}

impl<'py> Memories<'py> {
    fn of(rows: &Bound<'py, PyAny>) -> PyResult<Self> {
        Ok(Self {
            offset: rows.getattr("_offset")?.extract()?,
            address: rows.getattr("_address")?.extract()?,
            fields: rows.getattr("_columns")?.extract()?,
        })
    }

    /// Return all of them: the offsets, the addresses if there are any, then the fields.
    fn all(&self) -> impl Iterator<Item = &Memory> {
        let first = std::iter::once(&self.offset).chain(&self.address);
        first.chain(&self.fields).map(Bound::get)
    }
}

/// The variant of old rows; `None`: the edition has no command of that name.
fn variant(edition: &Edition, rows: &Bound<'_, PyAny>) -> PyResult<Option<VariantId>> {
    let name = rows.getattr("command")?.getattr("name")?;
    let direction: String = rows.getattr("direction")?.extract()?;
    let variant = rows.getattr("variant_index")?.extract()?;
    Ok(edition.commands.known(&name).map(|command| VariantId {
        direction: if direction == "request" {
            Direction::Request
        } else {
            Direction::Reply
        },
        command,
        variant,
    }))
}

fn addresses(column: Column) -> Vec<u8> {
    match column {
        Column::Cells(Cells::U8(all)) => all,
        _ => Vec::new(),
    }
}

fn offsets(column: Column) -> Vec<u64> {
    match column {
        Column::Offsets(all) => all,
        Column::Cells(_) => Vec::new(),
    }
}
