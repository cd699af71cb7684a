//! Which interpreter the module may be loaded in.

use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;

/// Fail in a subinterpreter. The classes here, and the Python objects of `Names`, exist once in a
/// process. In another interpreter their errors would have classes that no `except` of that
/// interpreter catches. PyO3 itself accepts the first interpreter that loads the module, whichever
/// it is.
pub fn check_main(py: Python<'_>) -> PyResult<()> {
    if is_main(py)? {
        return Ok(());
    }
    let text = "cobotwire._native works only in the main interpreter";
    Err(PyImportError::new_err(text))
}

fn is_main(py: Python<'_>) -> PyResult<bool> {
    let module = py.import("_interpreters");
    // The module's name before CPython 3.13.
    let module = module.or_else(|_| py.import("_xxsubinterpreters"));
    let Ok(interpreters) = module else {
        // This Python has no function that makes subinterpreters.
        return Ok(true);
    };
    let [main, current] = ["get_main", "get_current"].map(|name| interpreters.call_method0(name));
    main?.eq(current?)
}
