//! Converts rows of values between Python's tuples and the core's.

use cobotwire_core::Value;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

use crate::given::{Objects, tuple};
use crate::memory::untrack;
use crate::names::Names;

/// Return the values of a message, as a tuple.
pub fn row<'py>(values: &Bound<'py, PyAny>) -> PyResult<Objects<'py>> {
    if let Ok(all) = values.cast_exact::<PyTuple>() {
        return Ok(Objects(all.clone()));
    }
    if let Ok(all) = values.cast_exact::<PyList>() {
        return Ok(Objects(all.to_tuple()));
    }
    tuple(Names::get(values.py())?, values).map(Objects)
}

/// Return decoded values, as the tuple that a message holds.
pub fn objects<'py>(py: Python<'py>, values: &[Value]) -> PyResult<Bound<'py, PyTuple>> {
    match values {
        // A message of one field, as most are.
        [Value::Row(count), row @ ..] if row.len() == *count => {
            let all = PyTuple::new(py, [numbers(py, row)?])?;
            untrack(&all);
            Ok(all)
        }
        _ if values.iter().any(|value| matches!(value, Value::Row(_))) => mixed(py, values),
        _ => numbers(py, values),
    }
}

/// Return a tuple of numbers; the values contain no row.
fn numbers<'py>(py: Python<'py>, values: &[Value]) -> PyResult<Bound<'py, PyTuple>> {
    let all = PyTuple::new(py, values.iter().map(|value| Number(*value)))?;
    // Numbers refer to nothing; the collector would untrack the tuple itself, but later.
    untrack(&all);
    Ok(all)
}

/// Return a tuple of numbers and rows.
fn mixed<'py>(py: Python<'py>, mut values: &[Value]) -> PyResult<Bound<'py, PyTuple>> {
    let mut all = Vec::with_capacity(values.len());
    while let Some((value, rest)) = values.split_first() {
        values = rest;
        all.push(match *value {
            Value::Row(count) => {
                let (row, rest) = values.split_at_checked(count).unwrap_or_default();
                values = rest;
                numbers(py, row)?.into_any()
            }
            number => Number(number).into_pyobject(py)?,
        });
    }
    PyTuple::new(py, all)
}

struct Number(Value);

impl<'py> IntoPyObject<'py> for Number {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    fn into_pyobject(self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        Ok(match self.0 {
            Value::Integer(integer) => integer.into_pyobject(py)?.into_any(),
            Value::Real(real) => real.into_pyobject(py)?.into_any(),
            Value::Row(count) => count.into_pyobject(py)?.into_any(),
        })
    }
}
