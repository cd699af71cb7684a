//! Reads numbers for the templates of the core: only exact `int` and `float` objects, in exact
//! `tuple` and `list` objects, not those of subclasses.
//!
//! Reading them runs no code of the caller. So if it stops at another value or at a mistake, `given`
//! can read all values again.

use cobotwire_core::{Direction, Exact, LONGEST_PLAIN, Place, Table, encode_plain};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyFloat, PyInt, PyList, PyTuple};

/// Build a frame from exact numbers; return None if there are other values, or mistakes.
pub fn encode<'py>(
    table: &Table,
    (command, direction): (usize, Direction),
    values: &Bound<'py, PyAny>,
    variant: Option<&Bound<'py, PyAny>>,
) -> Option<Bound<'py, PyBytes>> {
    let variant = match variant {
        None => None,
        Some(index) if index.is_exact_instance_of::<PyInt>() => Some(index.extract().ok()?),
        Some(_) => return None,
    };
    let mut row = None;
    let number = |place| match place {
        Place::Single(index) => exact(&item(values, index)?),
        Place::First(index, count) => {
            let row = row.insert(item(values, index)?);
            (length(row)? == count).then_some(())?;
            exact(&item(row, 0)?)
        }
        Place::Next(index) => exact(&item(row.as_ref()?, index)?),
    };
    let mut space = [0; LONGEST_PLAIN];
    let fields = (length(values)?, variant);
    let frame = encode_plain(table, command, direction, fields, &mut space, number)?;
    Some(PyBytes::new(values.py(), frame))
}

#[inline]
fn exact(value: &Bound<'_, PyAny>) -> Option<Exact> {
    if value.is_exact_instance_of::<PyFloat>() {
        let float = value.cast_exact::<PyFloat>().ok()?;
        Some(Exact::Real(float.value()))
    } else if value.is_exact_instance_of::<PyInt>() {
        value.extract().ok().map(Exact::Integer)
    } else {
        None
    }
}

/// Return the number of items of an exact tuple or list; None for other objects.
fn length(items: &Bound<'_, PyAny>) -> Option<usize> {
    if items.is_exact_instance_of::<PyTuple>() {
        Some(items.cast_exact::<PyTuple>().ok()?.len())
    } else {
        Some(items.cast_exact::<PyList>().ok()?.len())
    }
}

/// Return an item of an exact tuple or list; None if it has too few, and for other objects.
#[inline]
fn item<'py>(items: &Bound<'py, PyAny>, index: usize) -> Option<Bound<'py, PyAny>> {
    if items.is_exact_instance_of::<PyTuple>() {
        items.cast_exact::<PyTuple>().ok()?.get_item(index).ok()
    } else {
        items.cast_exact::<PyList>().ok()?.get_item(index).ok()
    }
}
