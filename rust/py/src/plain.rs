//! Reads exact numbers, in exact tuples and lists, for the templates of the core.
//!
//! Reading these runs no code of the caller's. So it may stop anywhere, and `given` may read the
//! same values again, to convert others or to name the mistake.

#![allow(unsafe_code)] // the items of a list are borrowed, which saves half of the calls

use cobotwire_core::{Direction, Exact, LONGEST_PLAIN, Place, Table, encode_plain};
use pyo3::ffi;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyFloat, PyInt, PyList, PyTuple};

/// Build a frame from exact numbers; return None if there are other values, or mistakes.
pub fn encode<'py>(
    table: &Table,
    (command, direction): (usize, Direction),
    values: &Bound<'py, PyAny>,
    variant: Option<&Bound<'py, PyAny>>,
) -> Option<Bound<'py, PyBytes>> {
    let variant = match variant {
        None => None,
        Some(index) if index.is_exact_instance_of::<PyInt>() => Some(index.extract().ok()?),
        Some(_) => return None,
    };
    let values = Items::of(values.as_borrowed())?;
    let mut row = values;
    let number = |place| match place {
        Place::Alone(index) => exact(values.get(index)?),
        Place::First(index, count) => {
            row = Items::of(values.get(index)?)?;
            if row.count == count {
                exact(row.get(0)?)
            } else {
                None
            }
        }
        Place::Next(index) => exact(row.get(index)?),
    };
    let mut space = [0; LONGEST_PLAIN];
    let fields = (values.count, variant);
    let frame = encode_plain(table, command, direction, fields, &mut space, number)?;
    Some(PyBytes::new(values.owner.py(), frame))
}

#[inline]
fn exact(value: Borrowed<'_, '_, PyAny>) -> Option<Exact> {
    if value.is_exact_instance_of::<PyFloat>() {
        let float = value.cast_exact::<PyFloat>().ok()?;
        Some(Exact::Real(float.value()))
    } else if value.is_exact_instance_of::<PyInt>() {
        value.extract().ok().map(Exact::Integer)
    } else {
        None
    }
}

/// The items of an exact tuple or list.
#[derive(Clone, Copy)]
struct Items<'a, 'py> {
    owner: Borrowed<'a, 'py, PyAny>,
    count: usize,
    get: unsafe extern "C" fn(*mut ffi::PyObject, ffi::Py_ssize_t) -> *mut ffi::PyObject,
}

impl<'a, 'py> Items<'a, 'py> {
    #[inline]
    fn of(owner: Borrowed<'a, 'py, PyAny>) -> Option<Self> {
        // SAFETY: each function is called with an object of its class.
        let (size, get) = if owner.is_exact_instance_of::<PyList>() {
            let size = unsafe { ffi::PyList_Size(owner.as_ptr()) };
            (size, ffi::PyList_GetItem as _)
        } else if owner.is_exact_instance_of::<PyTuple>() {
            let size = unsafe { ffi::PyTuple_Size(owner.as_ptr()) };
            (size, ffi::PyTuple_GetItem as _)
        } else {
            return None;
        };
        let count = usize::try_from(size).ok()?;
        Some(Self { owner, count, get })
    }

    /// Return an item; None if there are fewer.
    #[inline]
    fn get(&self, index: usize) -> Option<Borrowed<'a, 'py, PyAny>> {
        if index >= self.count {
            return None; // without Python's error
        }
        // SAFETY: `get` is the function of the owner's class, and the index is within the size. The
        // owner keeps the item alive as long as it does not change, and nothing changes it: the
        // interpreter's lock is held, and `encode` runs no code of Python's, not even a destructor,
        // before it has used all items.
        unsafe {
            let item = (self.get)(self.owner.as_ptr(), index as ffi::Py_ssize_t);
            Borrowed::from_ptr_or_opt(self.owner.py(), item)
        }
    }
}
