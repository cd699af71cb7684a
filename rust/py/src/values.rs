//! Rows of values, between Python's tuples and the core's.

use cobotwire_core::Value;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::given::{Objects, tuple};
use crate::names::Names;

/// The values of a message, as a tuple.
pub fn row<'py>(values: &Bound<'py, PyAny>) -> PyResult<Objects<'py>> {
    if let Ok(all) = values.cast_exact::<PyTuple>() {
        return Ok(Objects(all.clone()));
    }
    if let Ok(all) = values.cast_exact::<PyList>() {
        return Ok(Objects(all.to_tuple()));
    }
    tuple(Names::get(values.py())?, values).map(Objects)
}

/// Decoded values, as the tuple that a message holds.
pub fn objects<'py>(py: Python<'py>, mut values: &[Value]) -> PyResult<Bound<'py, PyTuple>> {
    let mut all = Vec::with_capacity(values.len());
    while let Some((value, rest)) = values.split_first() {
        values = rest;
        all.push(match *value {
            Value::Whole(whole) => whole.into_pyobject(py)?.into_any(),
            Value::Real(real) => real.into_pyobject(py)?.into_any(),
            Value::Row(count) => {
                let (row, rest) = values.split_at_checked(count).unwrap_or_default();
                values = rest;
                objects(py, row)?.into_any()
            }
        });
    }
    PyTuple::new(py, all)
}
