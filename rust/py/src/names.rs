//! The Python objects that the binding uses, looked up once.

use cobotwire_core::{Direction, Reason};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBool, PyByteArray, PyBytes, PyDict, PyFrozenSet, PySet, PyString, PyTuple};

// There is one instance for the process: `interpreter` ensures that no other interpreter loads
// this module.
static NAMES: PyOnceLock<Names> = PyOnceLock::new();

pub struct Names {
    pub noise: Py<PyAny>,
    pub message: Py<PyAny>,
    pub counters: Py<PyAny>,
    pub rows: Py<PyAny>,
    pub columns: Py<PyAny>,
    pub scan: Py<PyAny>,
    pub reject_direction: Py<PyAny>,
    pub reject_variant: Py<PyAny>,
    pub reject_address: Py<PyAny>,
    pub reject_value: Py<PyAny>,
    pub reject_raw: Py<PyAny>,
    pub reject_frame: Py<PyAny>,
    pub reject_shared: Py<PyAny>,
    pub reject_offset: Py<PyAny>,
    pub reject_workers: Py<PyAny>,
    /// `operator.index`
    pub index: Py<PyAny>,
    pub float: Py<PyAny>,
    pub bool: Py<PyAny>,
    pub tuple: Py<PyAny>,
    /// The types that `float()` accepts; values are checked with `isinstance` first.
    pub float_like: Py<PyTuple>,
    /// Types that are iterable, but never a row of numbers.
    pub not_sequences: Py<PyTuple>,
    new_tuple: Py<PyAny>,
    reasons: Vec<Py<PyString>>,
    request: Py<PyString>,
    reply: Py<PyString>,
}

impl Names {
    /// Return the names; they are loaded on first use.
    pub fn get(py: Python<'_>) -> PyResult<&'static Self> {
        NAMES.get_or_try_init(py, || Self::load(py))
    }

    fn load(py: Python<'_>) -> PyResult<Self> {
        let from = |module: &str, name: &str| {
            py.import(module)
                .and_then(|found| found.getattr(name))
                .map(Bound::unbind)
        };
        let float_like = [
            from("typing", "SupportsFloat")?,
            from("typing", "SupportsIndex")?,
        ];
        let not_sequences = [
            py.get_type::<PyString>(),
            py.get_type::<PyBytes>(),
            py.get_type::<PyByteArray>(),
            py.get_type::<PyDict>(),
            py.get_type::<PySet>(),
            py.get_type::<PyFrozenSet>(),
        ];
        let word = |reason: Reason| PyString::intern(py, reason.word()).unbind();
        Ok(Self {
            noise: from("cobotwire.codec.events", "Noise")?,
            message: from("cobotwire.codec.events", "DecodedMessage")?,
            counters: from("cobotwire.codec.events", "Counters")?,
            rows: from("cobotwire.codec.columns", "Rows")?,
            columns: from("cobotwire.codec.columns", "Columns")?,
            scan: from("cobotwire.codec.columns", "Scan")?,
            reject_direction: from("cobotwire.protocol.rejection", "reject_direction")?,
            reject_variant: from("cobotwire.protocol.rejection", "reject_variant")?,
            reject_address: from("cobotwire.protocol.rejection", "reject_address")?,
            reject_value: from("cobotwire.protocol.rejection", "reject_value")?,
            reject_raw: from("cobotwire.protocol.rejection", "reject_raw")?,
            reject_frame: from("cobotwire.protocol.rejection", "reject_frame")?,
            reject_shared: from("cobotwire.protocol.rejection", "reject_shared")?,
            reject_offset: from("cobotwire.protocol.rejection", "reject_offset")?,
            reject_workers: from("cobotwire.protocol.rejection", "reject_workers")?,
            index: from("operator", "index")?,
            float: from("builtins", "float")?,
            bool: py.get_type::<PyBool>().into_any().unbind(),
            tuple: py.get_type::<PyTuple>().into_any().unbind(),
            float_like: PyTuple::new(py, float_like)?.unbind(),
            not_sequences: PyTuple::new(py, not_sequences)?.unbind(),
            new_tuple: py.get_type::<PyTuple>().getattr("__new__")?.unbind(),
            reasons: Reason::ALL.into_iter().map(word).collect(),
            request: PyString::intern(py, "request").unbind(),
            reply: PyString::intern(py, "reply").unbind(),
        })
    }

    /// Create an instance of a named tuple class, as `_make` does, but several times faster.
    pub fn make<'py>(
        &self,
        class: &Py<PyAny>,
        items: Bound<'py, PyTuple>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = items.py();
        self.new_tuple.bind(py).call1((class.bind(py), items))
    }

    /// Return the word for a direction.
    pub fn direction<'py>(&self, py: Python<'py>, direction: Direction) -> &Bound<'py, PyString> {
        match direction {
            Direction::Request => self.request.bind(py),
            Direction::Reply => self.reply.bind(py),
        }
    }

    /// Return the word for a reason.
    pub fn reason<'py>(&self, py: Python<'py>, reason: Reason) -> Option<&Bound<'py, PyString>> {
        self.reasons.get(reason as usize).map(|word| word.bind(py))
    }
}
