//! Which interpreter the module may be loaded in.

#![allow(unsafe_code)] // PyO3 has no safe function for the interpreter's id

use pyo3::exceptions::PyImportError;
use pyo3::ffi;
use pyo3::prelude::*;

/// The id that CPython gives to the interpreter that starts the process.
const MAIN: i64 = 0;

/// Fail in a subinterpreter. The classes here, and the Python objects of `Names`, exist once in a
/// process: in another interpreter their errors would be of foreign classes, which no `except`
/// there catches.
pub fn check_main(_: Python<'_>) -> PyResult<()> {
    // SAFETY: this thread is attached to an interpreter, which the argument proves.
    let id = unsafe { ffi::PyInterpreterState_GetID(ffi::PyInterpreterState_Get()) };
    if id == MAIN {
        return Ok(());
    }
    let text = "cobotwire._native works only in the main interpreter";
    Err(PyImportError::new_err(text))
}
