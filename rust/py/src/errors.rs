//! Converts the core's errors to Python's; `cobotwire.protocol.rejection` creates them.

use cobotwire_core::{BadRaw, BadValue, Reason};
use pyo3::prelude::*;
use pyo3::types::{PyAny, PyString};

use crate::given::Object;
use crate::names::Names;

/// Return the error for a value that its field does not allow.
pub fn bad_value(variant: &Bound<'_, PyAny>, bad: BadValue<Object<'_>>) -> PyErr {
    let make = || {
        let (field, case) = field_and_case(variant, bad.field, bad.case)?;
        let element = bad
            .element
            .and_then(|index| isize::try_from(index).ok())
            .unwrap_or(-1);
        let reject = Names::get(variant.py())?.reject_value.bind(variant.py());
        // If a selector picks no case, the reference shows its raw value.
        let value = match bad.picked {
            Some(picked) => picked.into_pyobject(variant.py())?.into_any(),
            None => bad.value.0,
        };
        reject.call1((field, case, element, bad.fault.word(), value))
    };
    raised(make())
}

/// Return the error for a number of values that no variant takes.
pub fn bad_variant(
    command: &Bound<'_, PyAny>,
    direction: &Bound<'_, PyAny>,
    given: usize,
) -> PyErr {
    let py = command.py();
    raised(Names::get(py).and_then(|names| {
        names
            .reject_variant
            .bind(py)
            .call1((command, direction, given))
    }))
}

/// Return the error for a word that is not a direction.
pub fn bad_direction(given: &Bound<'_, PyAny>) -> PyErr {
    let py = given.py();
    raised(Names::get(py).and_then(|names| names.reject_direction.bind(py).call1((given,))))
}

/// Return the error for an object that another thread uses.
pub fn shared(py: Python<'_>, name: &str) -> PyErr {
    raised(Names::get(py).and_then(|names| names.reject_shared.bind(py).call1((name,))))
}

/// Return the error for an offset at which no stream can start.
pub fn bad_offset(given: &Bound<'_, PyAny>) -> PyErr {
    let py = given.py();
    raised(Names::get(py).and_then(|names| names.reject_offset.bind(py).call1((given,))))
}

/// Return the error for a number of threads that cannot read.
pub fn bad_workers(given: &Bound<'_, PyAny>) -> PyErr {
    let py = given.py();
    raised(Names::get(py).and_then(|names| names.reject_workers.bind(py).call1((given,))))
}

/// Return the error for an address that the frame format does not have.
pub fn bad_address(given: &Bound<'_, PyAny>, addresses: &Bound<'_, PyAny>) -> PyErr {
    let py = given.py();
    raised(Names::get(py).and_then(|names| names.reject_address.bind(py).call1((given, addresses))))
}

/// Return the error for a raw value that its field does not allow.
pub fn bad_raw(
    command: &Bound<'_, PyAny>,
    variant: &Bound<'_, PyAny>,
    bad: BadRaw,
    data: &Bound<'_, PyAny>,
) -> PyErr {
    let make = || {
        let (field, case) = field_and_case(variant, bad.field, bad.case)?;
        let reject = Names::get(variant.py())?.reject_raw.bind(variant.py());
        reject.call1((command, field, case, bad.element, bad.raw, bad.offset, data))
    };
    raised(make())
}

/// Return the error for bytes that are not one whole legal frame.
pub fn bad_frame(
    table: &Bound<'_, PyAny>,
    direction: &Bound<'_, PyAny>,
    reason: Reason,
    offset: usize,
    data: &Bound<'_, PyAny>,
) -> PyErr {
    let py = table.py();
    raised(Names::get(py).and_then(|names| {
        let word = PyString::new(py, reason.word());
        names
            .reject_frame
            .bind(py)
            .call1((table, direction, word, offset, data))
    }))
}

fn field_and_case<'py>(
    variant: &Bound<'py, PyAny>,
    field: usize,
    case: usize,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>)> {
    let field = variant.getattr("fields")?.get_item(field)?;
    let case = field.getattr("cases")?.get_item(case)?;
    Ok((field, case))
}

/// Return the error that was created, or the error that prevented its creation.
fn raised(made: PyResult<Bound<'_, PyAny>>) -> PyErr {
    made.map_or_else(|error| error, PyErr::from_value)
}
