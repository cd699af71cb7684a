//! Converts parts of the core's results to Python objects, and back to reuse their memory (`out=`).

use cobotwire_core::{Columns, Direction, Offsets, Rows, Spans, VariantId};
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
    Ok(Offsets {
        frames: offsets(memory.get().take()?),
        noise: Spans::default(),
    })
}

/// Take the memory of an earlier `Columns`, which is empty afterwards.
pub fn old_columns(edition: &Edition, out: &Bound<'_, PyAny>) -> PyResult<Columns> {
    let rows: Vec<Bound<'_, PyAny>> = out.getattr("_rows")?.extract()?;
    // Attributes are read first, since that runs Python code: another thread, or an error.
    let variants = rows.iter().map(|rows| variant(edition, rows));
    let variants = variants.collect::<PyResult<Vec<_>>>()?;
    let memories = rows.iter().map(memories).collect::<PyResult<Vec<_>>>()?;
    let all: Vec<&Memory> = memories.iter().flatten().map(Bound::get).collect();
    // Check all of them first, so that the old columns stay complete after an error.
    let mut taken = Memory::take_all(&all)?.into_iter();
    let mut old = Columns::default();
    for (variant, memories) in variants.into_iter().zip(&memories) {
        let mut columns = taken.by_ref().take(memories.len());
        let offsets = columns.next().map_or(Vec::new(), offsets);
        let fields = columns.map(Column::into_cells).collect();
        if let Some(variant) = variant {
            old.rows.push(Rows {
                variant,
                offsets,
                fields,
            });
        }
    }
    out.setattr("_rows", PyTuple::empty(out.py()))?;
    Ok(old)
}

/// Return the memories of some rows: the offsets, then the fields.
fn memories<'py>(rows: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, Memory>>> {
    let mut all: Vec<Bound<'py, Memory>> = vec![rows.getattr("_offset")?.extract()?];
    let columns: Vec<Bound<'py, Memory>> = rows.getattr("_columns")?.extract()?;
    all.extend(columns);
    Ok(all)
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

fn offsets(column: Column) -> Vec<u64> {
    match column {
        Column::Offsets(all) => all,
        Column::Cells(_) => Vec::new(),
    }
}
