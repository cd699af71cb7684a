//! `NativeFramer`: the core's framer behind `cobotwire.codec.interface.Framer`.

use cobotwire_core::Framer;
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyList};

use crate::events::Events;

/// Cuts frames out of a byte stream.
#[pyclass(module = "cobotwire._native")]
pub struct NativeFramer {
    core: Framer,
}

impl NativeFramer {
    pub fn new(core: Framer) -> Self {
        Self { core }
    }
}

#[pymethods]
impl NativeFramer {
    /// Take bytes; give what is certain by now, in the order of the stream.
    fn feed<'py>(&mut self, data: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
        let mut events = Events::new(data.py())?;
        match data.cast::<PyBytes>() {
            Ok(bytes) => self.core.feed(bytes.as_bytes(), |event| events.add(event)),
            Err(_) => self.core.feed(&copied(data)?, |event| events.add(event)),
        }
        events.finish()
    }

    /// Refute what still waits: a true frame behind it comes now.
    fn flush<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let mut events = Events::new(py)?;
        self.core.flush(|event| events.add(event));
        events.finish()
    }

    /// Bytes fed that no event covers yet.
    #[getter]
    fn pending(&self) -> usize {
        self.core.pending()
    }
}

/// The bytes of any buffer, taken as the reference takes them: refused alike, too.
fn copied(data: &Bound<'_, PyAny>) -> PyResult<Vec<u8>> {
    let all = PyByteArray::new(data.py(), &[]).call_method1("__iadd__", (data,))?;
    Ok(all.cast_into::<PyByteArray>()?.to_vec())
}
