//! Converts rows of values between Python's tuples and the core's.

use std::cell::Cell;

use cobotwire_core::{PlainNumbers, Value};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyList, PyTuple};

use crate::given::{Objects, codec, tuple};
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
        // A message of one field, a row; most messages are like this.
        [Value::Row(count), row @ ..] if row.len() == *count => {
            let all = PyTuple::new(py, [numbers(py, row)?])?;
            untrack(&all);
            Ok(all)
        }
        _ if values.iter().any(compound) => mixed(py, values),
        _ => numbers(py, values),
    }
}

/// Return the tuple of a message that a template reads; `None` if a number is not allowed.
#[inline]
pub fn plain_objects<'py>(
    py: Python<'py>,
    values: PlainNumbers<'_>,
) -> PyResult<Option<Bound<'py, PyTuple>>> {
    let allowed = Cell::new(true);
    let fields = values.fields().map(|(many, numbers)| PlainField {
        many,
        numbers: numbers.map(|number| {
            Number(number.unwrap_or_else(|| {
                allowed.set(false);
                Value::Integer(0)
            }))
        }),
    });
    let all = PyTuple::new(py, fields)?;
    untrack(&all);
    Ok(allowed.get().then_some(all))
}

/// The value of a field.
struct PlainField<I> {
    /// Whether it is a row.
    many: bool,
    numbers: I,
}

impl<'py, I: ExactSizeIterator<Item = Number>> IntoPyObject<'py> for PlainField<I> {
    type Target = PyAny;
    type Output = Bound<'py, PyAny>;
    type Error = PyErr;

    #[inline]
    fn into_pyobject(mut self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if self.many {
            let row = PyTuple::new(py, self.numbers)?;
            untrack(&row);
            return Ok(row.into_any());
        }
        let number = self.numbers.next();
        number
            .unwrap_or(Number(Value::Integer(0)))
            .into_pyobject(py)
    }
}

/// Return whether a value is not a single number.
fn compound(value: &Value) -> bool {
    !matches!(value, Value::Integer(_) | Value::Real(_))
}

/// Return a tuple of numbers; the values contain no row.
fn numbers<'py>(py: Python<'py>, values: &[Value]) -> PyResult<Bound<'py, PyTuple>> {
    let all = PyTuple::new(py, values.iter().map(|value| Number(*value)))?;
    // Numbers refer to no other object. The collector would untrack the tuple itself, but later.
    untrack(&all);
    Ok(all)
}

/// Return a tuple of numbers and rows.
fn mixed<'py>(py: Python<'py>, mut values: &[Value]) -> PyResult<Bound<'py, PyTuple>> {
    let mut all = Vec::with_capacity(values.len());
    while let Some((value, rest)) = values.split_first() {
        values = rest;
        all.push(one(py, *value, &mut values)?);
    }
    PyTuple::new(py, all)
}

/// Return one value; its elements, if any, are taken from `rest`.
fn one<'py>(py: Python<'py>, value: Value, rest: &mut &[Value]) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Row(count) => numbers(py, take(rest, count))?.into_any(),
        Value::Rows(count) => {
            let mut all = Vec::with_capacity(count);
            for _ in 0..count {
                let Some((value, more)) = rest.split_first() else {
                    break;
                };
                *rest = more;
                all.push(one(py, *value, rest)?);
            }
            PyTuple::new(py, all)?.into_any()
        }
        Value::Bytes(count) => PyBytes::new(py, &bytes(take(rest, count))).into_any(),
        Value::Text(count, encoding) => {
            let data = PyBytes::new(py, &bytes(take(rest, count)));
            data.call_method1("decode", (codec(encoding),))?
        }
        number => Number(number).into_pyobject(py)?,
    })
}

fn take<'a>(rest: &mut &'a [Value], count: usize) -> &'a [Value] {
    let (taken, left) = rest.split_at_checked(count).unwrap_or_default();
    *rest = left;
    taken
}

fn bytes(values: &[Value]) -> Vec<u8> {
    let byte = |value: &Value| match value {
        Value::Integer(raw) => u8::try_from(*raw).unwrap_or_default(),
        _ => 0,
    };
    values.iter().map(byte).collect()
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
            Value::Row(count)
            | Value::Rows(count)
            | Value::Bytes(count)
            | Value::Text(count, _) => count.into_pyobject(py)?.into_any(),
        })
    }
}
