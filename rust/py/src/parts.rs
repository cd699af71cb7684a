//! The core's results in parts, as Python's objects hold them, and back again for `out=`.

use cobotwire_core::{Columns, Direction, Offsets, Rows, Spans, VariantId};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::edition::Edition;
use crate::memory::{Column, Memory};

/// Spans of noise: where they start, and their sizes.
pub fn spans<'py>(py: Python<'py>, noise: Spans) -> PyResult<Bound<'py, PyTuple>> {
    let Spans { offsets, sizes } = noise;
    (Memory::offsets(offsets), Memory::offsets(sizes)).into_pyobject(py)
}

/// The memory of an earlier `Scan`, which is empty from then on.
pub fn old_offsets(out: &Bound<'_, PyAny>) -> PyResult<Offsets> {
    let memory: Bound<'_, Memory> = out.getattr("_offset")?.extract()?;
    Ok(Offsets {
        frames: offsets(memory.get().take()?),
        noise: Spans::default(),
    })
}

/// The memory of an earlier `Columns`, which is empty from then on.
pub fn old_columns(edition: &Edition, out: &Bound<'_, PyAny>) -> PyResult<Columns> {
    let rows: Vec<Bound<'_, PyAny>> = out.getattr("_rows")?.extract()?;
    let memories = rows.iter().map(memories).collect::<PyResult<Vec<_>>>()?;
    // All or none: after an error the old columns are still complete.
    for memory in memories.iter().flatten() {
        memory.get().check_unviewed()?;
    }
    let mut old = Columns::default();
    for (rows, memories) in rows.iter().zip(memories) {
        let mut columns = memories.into_iter().map(|memory| memory.get().take());
        let offsets = columns.next().transpose()?.map_or(Vec::new(), offsets);
        let fields = columns.map(|column| column.map(Column::into_cells));
        old.rows.push(Rows {
            variant: variant(edition, rows)?,
            offsets,
            fields: fields.collect::<PyResult<_>>()?,
        });
    }
    out.setattr("_rows", PyTuple::empty(out.py()))?;
    Ok(old)
}

/// The offsets, then the fields.
fn memories<'py>(rows: &Bound<'py, PyAny>) -> PyResult<Vec<Bound<'py, Memory>>> {
    let mut all: Vec<Bound<'py, Memory>> = vec![rows.getattr("_offset")?.extract()?];
    let columns: Vec<Bound<'py, Memory>> = rows.getattr("_columns")?.extract()?;
    all.extend(columns);
    Ok(all)
}

fn variant(edition: &Edition, rows: &Bound<'_, PyAny>) -> PyResult<VariantId> {
    let name = rows.getattr("command")?.getattr("name")?;
    let direction: String = rows.getattr("direction")?.extract()?;
    Ok(VariantId {
        direction: if direction == "request" {
            Direction::Request
        } else {
            Direction::Reply
        },
        command: edition.commands.find(&edition.table, &name)?,
        variant: rows.getattr("variant_index")?.extract()?,
    })
}

fn offsets(column: Column) -> Vec<u64> {
    match column {
        Column::Offsets(all) => all,
        Column::Cells(_) => Vec::new(),
    }
}
