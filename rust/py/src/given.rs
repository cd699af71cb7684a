//! Converts Python values for the core's encoder.
//!
//! Common types are converted directly. All other types go through the functions that the reference
//! uses, so that an object has the same effect in both codecs.

use cobotwire_core::{Encoding, Given, Row, Unread, ValueFault};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyUnicodeEncodeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyFloat, PyInt, PyList, PyMemoryView, PyString, PyTuple};

use crate::names::Names;

/// One value.
pub struct Object<'py>(pub Bound<'py, PyAny>);

/// A row of values.
pub struct Objects<'py>(pub Bound<'py, PyTuple>);

impl<'py> Given for Object<'py> {
    type Error = PyErr;
    type Row = Objects<'py>;

    fn integer(&self, flag: bool) -> Result<i64, Unread<PyErr>> {
        if self.0.is_exact_instance_of::<PyInt>() {
            return self.small();
        }
        let names = self.names()?;
        if !flag && self.is(&names.bool)? {
            return Err(Unread::Fault(ValueFault::Type));
        }
        match names.index.bind(self.0.py()).call1((&self.0,)) {
            Ok(integer) => Self(integer).small(),
            Err(error) => Err(self.sorted(error, None)),
        }
    }

    fn real(&self) -> Result<f64, Unread<PyErr>> {
        if let Ok(float) = self.0.cast_exact::<PyFloat>() {
            return Ok(float.value());
        }
        let float = if self.0.is_exact_instance_of::<PyInt>() {
            self.0.extract()
        } else {
            let names = self.names()?;
            if !self.is_number(names)? {
                return Err(Unread::Fault(ValueFault::Type));
            }
            let float = names.float.bind(self.0.py()).call1((&self.0,));
            float.and_then(|float| float.extract())
        };
        match float {
            Ok(real) => Ok(real),
            Err(error) => Err(self.sorted(error, Some(ValueFault::Range))),
        }
    }

    fn row(&self) -> Result<Objects<'py>, Unread<PyErr>> {
        if let Ok(tuple) = self.0.cast_exact::<PyTuple>() {
            return Ok(Objects(tuple.clone()));
        }
        if let Ok(list) = self.0.cast_exact::<PyList>() {
            return Ok(Objects(list.to_tuple()));
        }
        let names = self.names()?;
        if self.is(names.not_sequences.as_any())? {
            return Err(Unread::Fault(ValueFault::Type));
        }
        match tuple(names, &self.0) {
            Ok(tuple) => Ok(Objects(tuple)),
            Err(error) => Err(self.sorted(error, None)),
        }
    }

    fn counted(&self) -> bool {
        self.0.is(self.0.py().Ellipsis())
    }

    fn bytes(&self) -> Result<Option<Vec<u8>>, Unread<PyErr>> {
        let object = &self.0;
        let like = object.is_instance_of::<PyBytes>()
            || object.is_instance_of::<PyByteArray>()
            || object.is_instance_of::<PyMemoryView>();
        if !like {
            return Ok(None);
        }
        // Python's `bytes` converts, as in the reference; it accepts a memoryview of any items.
        let class = object.py().get_type::<PyBytes>();
        let bytes = class.call1((object,)).map_err(Unread::Foreign)?;
        bytes.extract().map(Some).map_err(Unread::Foreign)
    }

    fn text(&self, encoding: Encoding) -> Result<Vec<u8>, Unread<PyErr>> {
        if !self.0.is_instance_of::<PyString>() {
            return Err(Unread::Fault(ValueFault::Type));
        }
        let bytes = self.0.call_method1("encode", (codec(encoding),));
        match bytes.and_then(|bytes| bytes.extract()) {
            Ok(bytes) => Ok(bytes),
            Err(error) if error.is_instance_of::<PyUnicodeEncodeError>(self.0.py()) => {
                Err(Unread::Fault(ValueFault::Text))
            }
            Err(error) => Err(Unread::Foreign(error)),
        }
    }
}

/// Return Python's name of an encoding.
pub fn codec(encoding: Encoding) -> &'static str {
    match encoding {
        Encoding::Ascii => "ascii",
        Encoding::Utf8 => "utf-8",
        Encoding::Latin1 => "latin-1",
    }
}

impl Object<'_> {
    fn names(&self) -> Result<&'static Names, Unread<PyErr>> {
        Names::get(self.0.py()).map_err(Unread::Foreign)
    }

    /// Return the result of `isinstance`, which also reads the object's `__class__`.
    fn is(&self, class: &Py<PyAny>) -> Result<bool, Unread<PyErr>> {
        self.0
            .is_instance(class.bind(self.0.py()))
            .map_err(Unread::Foreign)
    }

    fn is_number(&self, names: &Names) -> Result<bool, Unread<PyErr>> {
        // A subclass of float, such as NumPy's, needs no slow check of its attributes.
        let float = self.0.is_instance_of::<PyFloat>();
        if self.is(&names.bool)? {
            return Ok(false);
        }
        Ok(float || (self.is(names.float_like.as_any())? && !self.is_numpy_bool()?))
    }

    /// Return whether this is a boolean of NumPy, which has a float value, but is no `bool`.
    fn is_numpy_bool(&self) -> Result<bool, Unread<PyErr>> {
        let kind_of = || -> PyResult<bool> {
            let Some(dtype) = self.0.getattr_opt("dtype")? else {
                return Ok(false);
            };
            let kind = dtype.getattr_opt("kind")?;
            kind.map_or(Ok(false), |kind| kind.eq("b"))
        };
        kind_of().map_err(Unread::Foreign)
    }

    /// Convert an exact `int`, if it fits.
    fn small(&self) -> Result<i64, Unread<PyErr>> {
        // The only possible error is that the integer is too large.
        self.0.extract().map_err(|_: PyErr| Unread::Beyond)
    }

    /// Return the fault that the error of a conversion stands for.
    fn sorted(&self, error: PyErr, overflow: Option<ValueFault>) -> Unread<PyErr> {
        let py = self.0.py();
        match overflow {
            Some(fault) if error.is_instance_of::<PyOverflowError>(py) => Unread::Fault(fault),
            Some(_) if error.is_instance_of::<PyValueError>(py) => Unread::Fault(ValueFault::Type),
            _ if error.is_instance_of::<PyTypeError>(py) => Unread::Fault(ValueFault::Type),
            _ => Unread::Foreign(error),
        }
    }
}

impl<'py> Row for Objects<'py> {
    type Item = Object<'py>;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn at(&self, index: usize) -> Option<Object<'py>> {
        self.0.get_item(index).ok().map(Object)
    }

    fn into_value(self) -> Object<'py> {
        Object(self.0.into_any())
    }
}

/// Return `tuple(iterable)`.
pub fn tuple<'py>(names: &Names, iterable: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyTuple>> {
    let made = names.tuple.bind(iterable.py()).call1((iterable,))?;
    Ok(made.cast_into()?)
}
