//! Converts the arguments other than values and bytes: directions, variants, addresses, threads.
//!
//! Unusual types are compared as in the reference, so that `True` and `1.0` are both equal to 1.

use cobotwire_core::{Direction, Workers};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyInt, PyList, PyString};

use crate::errors;

/// The argument `workers`: the number of threads that read.
#[derive(Clone, Copy)]
pub struct WorkerCount(pub Workers);

impl<'a, 'py> FromPyObject<'a, 'py> for WorkerCount {
    type Error = PyErr;

    fn extract(given: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        match given.extract::<u16>() {
            Ok(count) if count > 0 => Ok(Self(Workers::new(count.into()))),
            _ => Err(errors::bad_workers(&given)),
        }
    }
}

pub fn word<'a>(given: &'a Bound<'_, PyAny>) -> Option<&'a str> {
    given.cast::<PyString>().ok()?.to_str().ok()
}

pub fn read_direction(given: &Bound<'_, PyAny>) -> PyResult<Direction> {
    // Literals in programs are interned, so most words need no comparison.
    if given.is(intern!(given.py(), "request")) {
        return Ok(Direction::Request);
    }
    if given.is(intern!(given.py(), "reply")) {
        return Ok(Direction::Reply);
    }
    match word(given) {
        Some("request") => Ok(Direction::Request),
        Some("reply") => Ok(Direction::Reply),
        _ => Err(errors::bad_direction(given)),
    }
}

/// Return the index of the chosen variant; `count` if the command lacks it.
pub fn variant(given: &Bound<'_, PyAny>, count: usize) -> PyResult<usize> {
    for index in 0..count {
        if given.eq(index)? {
            return Ok(index);
        }
    }
    Ok(count)
}

/// Return the chosen address byte, which the table must contain.
pub fn address(given: &Bound<'_, PyAny>, table: &Py<PyAny>, legal: &[u8]) -> PyResult<u8> {
    let py = given.py();
    if given.is_exact_instance_of::<PyInt>() {
        match given.extract() {
            Ok(address) if legal.contains(&address) => return Ok(address),
            _ => (),
        }
    }
    let addresses = table.bind(py).getattr("frame")?.getattr("addresses")?;
    if !addresses.contains(given)? {
        return Err(errors::bad_address(given, &addresses));
    }
    let byte = py
        .get_type::<PyBytes>()
        .call1((PyList::new(py, [given])?,))?;
    byte.get_item(0)?.extract()
}
