//! The Python class of `NativeFrame`.
//!
//! A feed can make millions of frames, so their class has no header for the garbage collector, which
//! all classes of PyO3 have. Without it a list of a million frames is made 1.6 times as fast. A frame
//! cannot be part of a cycle: it refers to its values, which are numbers, bytes, texts and tuples of
//! them, and to its `Origin`, which does not refer to frames.

#![allow(unsafe_code)] // PyO3 makes no such class

use std::ffi::{CStr, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

use pyo3::exceptions::PyTypeError;
use pyo3::ffi;
use pyo3::panic::PanicException;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyString, PyTuple, PyType};

use crate::frame::NativeFrame;

// One for the process: `interpreter` sees to it that no other interpreter loads this module.
static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();

/// The interned name of the attribute that is read most. It is kept alive for ever.
static VALUES: AtomicPtr<ffi::PyObject> = AtomicPtr::new(ptr::null_mut());

/// A frame in Python's memory. Only `object` makes these, so each has a frame.
#[repr(C)]
struct Object {
    base: ffi::PyObject,
    frame: NativeFrame,
}

type Read = for<'py> fn(&NativeFrame, Python<'py>) -> PyResult<Bound<'py, PyAny>>;

/// The attributes: name, doc, and what returns the value.
static ATTRIBUTES: [(&CStr, &CStr, Read); 5] = [
    (
        c"offset",
        c"The position of its first byte in the stream.",
        |frame, py| Ok(frame.offset.into_pyobject(py)?.into_any()),
    ),
    (c"data", c"Its bytes, from header to check.", |frame, py| {
        Ok(frame.data(py).into_any())
    }),
    (c"command", c"Its command id.", |frame, py| {
        Ok(frame.command().into_pyobject(py)?.into_any())
    }),
    (
        c"message",
        c"Its message: the first one that allows its values.",
        NativeFrame::message,
    ),
    (
        c"values",
        c"The values of its message, one for each field.",
        |frame, py| Ok(frame.values(py)?.into_any()),
    ),
];

const DECODE: &CStr = c"decode($self, /, direction=None, *, of=None)\n--\n\n\
    Return what `codec.decode(direction, frame.data, of=of)` returns, without judging it again.";

/// Return the class.
pub fn class(py: Python<'_>) -> PyResult<&Bound<'_, PyType>> {
    let class = CLASS.get_or_try_init(py, || make(py))?;
    Ok(class.bind(py))
}

/// Return what `make` returns as Python's object; it is made where it stays.
#[inline]
pub fn object<'py>(
    class: &Bound<'py, PyType>,
    make: impl FnOnce() -> NativeFrame,
) -> PyResult<Bound<'py, PyAny>> {
    let py = class.py();
    // SAFETY: the class is that of `make`, whose objects have the size of `Object`. The memory is new,
    // so the frame is written into it without dropping another one.
    unsafe {
        let object = ffi::PyObject_New::<Object>(class.as_type_ptr());
        if object.is_null() {
            return Err(PyErr::fetch(py));
        }
        (&raw mut (*object).frame).write(make());
        Ok(Bound::from_owned_ptr(py, object.cast()))
    }
}

/// Return the frame that an object is; None if it is something else.
#[inline]
fn frame<'a>(object: &'a Bound<'_, PyAny>) -> Option<&'a NativeFrame> {
    let class = CLASS.get(object.py())?;
    // The class has no subclasses.
    if !object
        .get_type_ptr()
        .cast::<ffi::PyObject>()
        .eq(&class.as_ptr())
    {
        return None;
    }
    // SAFETY: an object of this class is an `Object`, and keeps its frame while it lives, which it
    // does as long as it is borrowed. A frame changes only through shared references.
    Some(unsafe { &(*object.as_ptr().cast::<Object>()).frame })
}

fn make(py: Python<'_>) -> PyResult<Py<PyType>> {
    let mut attributes: Vec<_> = ATTRIBUTES.iter().map(attribute).collect();
    attributes.push(ffi::PyGetSetDef::default());
    let methods = vec![
        ffi::PyMethodDef {
            ml_name: c"decode".as_ptr(),
            ml_meth: ffi::PyMethodDefPointer {
                PyCFunctionFastWithKeywords: decode,
            },
            ml_flags: ffi::METH_FASTCALL | ffi::METH_KEYWORDS,
            ml_doc: DECODE.as_ptr(),
        },
        ffi::PyMethodDef::zeroed(),
    ];
    // The class, which is never freed, refers to both.
    let (attributes, methods) = (attributes.leak().as_mut_ptr(), methods.leak().as_mut_ptr());
    let slot = |slot, pfunc| ffi::PyType_Slot { slot, pfunc };
    let mut slots = [
        slot(
            ffi::Py_tp_doc,
            c"A whole, legal frame.".as_ptr().cast_mut().cast(),
        ),
        slot(ffi::Py_tp_dealloc, dealloc as *mut c_void),
        slot(ffi::Py_tp_getattro, attribute_of as *mut c_void),
        slot(ffi::Py_tp_getset, attributes.cast()),
        slot(ffi::Py_tp_methods, methods.cast()),
        slot(ffi::Py_tp_richcompare, compare as *mut c_void),
        slot(ffi::Py_tp_hash, hash as *mut c_void),
        slot(ffi::Py_tp_repr, repr as *mut c_void),
        slot(0, ptr::null_mut()),
    ];
    let flags = ffi::Py_TPFLAGS_DEFAULT
        | ffi::Py_TPFLAGS_IMMUTABLETYPE
        | ffi::Py_TPFLAGS_DISALLOW_INSTANTIATION;
    let mut spec = ffi::PyType_Spec {
        name: c"cobotwire._native.NativeFrame".as_ptr(),
        basicsize: size_of::<Object>() as c_int,
        itemsize: 0,
        flags: flags as _,
        slots: slots.as_mut_ptr(),
    };
    let values = PyString::intern(py, "values").into_ptr();
    VALUES.store(values, Ordering::Relaxed);
    // SAFETY: the spec and its slots are complete, and end with an empty one. Each function has the
    // type that its slot needs.
    let class = unsafe { Bound::from_owned_ptr_or_err(py, ffi::PyType_FromSpec(&raw mut spec))? };
    Ok(class.cast_into::<PyType>()?.unbind())
}

fn attribute((name, doc, read): &'static (&CStr, &CStr, Read)) -> ffi::PyGetSetDef {
    ffi::PyGetSetDef {
        name: name.as_ptr(),
        get: Some(get),
        set: None,
        doc: doc.as_ptr(),
        closure: ptr::from_ref(read).cast_mut().cast(),
    }
}

/// Do work that C asks for, with the frame; on a failure, set Python's error and return `failed`.
///
/// # Safety
/// `object` must be a live object of the class, and the thread must be attached.
#[inline]
unsafe fn with<T>(
    object: *mut ffi::PyObject,
    failed: T,
    work: impl for<'py> FnOnce(&NativeFrame, Python<'py>) -> PyResult<T>,
) -> T {
    // SAFETY: as the caller promises; C keeps the object alive during the call.
    let (py, frame) = unsafe {
        let frame = &(*object.cast::<Object>()).frame;
        (Python::assume_attached(), frame)
    };
    // No panic may cross into C.
    let done = catch_unwind(AssertUnwindSafe(|| work(frame, py)));
    let error = match done {
        Ok(Ok(value)) => return value,
        Ok(Err(error)) => error,
        Err(_) => PanicException::new_err("a frame of cobotwire._native"),
    };
    error.restore(py);
    failed
}

unsafe extern "C" fn get(object: *mut ffi::PyObject, read: *mut c_void) -> *mut ffi::PyObject {
    // SAFETY: C passes an object of the class, and the pointer of `attribute`.
    unsafe {
        let read = *read.cast::<Read>();
        with(object, ptr::null_mut(), |frame, py| {
            read(frame, py).map(Bound::into_ptr)
        })
    }
}

/// Return an attribute. `values` is found without a look-up in the class, which would find it too.
unsafe extern "C" fn attribute_of(
    object: *mut ffi::PyObject,
    name: *mut ffi::PyObject,
) -> *mut ffi::PyObject {
    // SAFETY: C passes an object of the class, and a name.
    unsafe {
        if name != VALUES.load(Ordering::Relaxed) {
            return ffi::PyObject_GenericGetAttr(object, name);
        }
        with(object, ptr::null_mut(), |frame, py| {
            frame.values(py).map(|values| values.into_ptr())
        })
    }
}

unsafe extern "C" fn decode(
    object: *mut ffi::PyObject,
    given: *const *mut ffi::PyObject,
    positional: ffi::Py_ssize_t,
    names: *mut ffi::PyObject,
) -> *mut ffi::PyObject {
    // SAFETY: C passes an object of the class, and a tuple of names or null. The values of the names
    // follow the `positional` others, and all live as long as the call.
    unsafe {
        with(object, ptr::null_mut(), |frame, py| {
            let names = Bound::from_borrowed_ptr_or_opt(py, names);
            let names = names
                .map(|names| names.cast_into::<PyTuple>())
                .transpose()?;
            let mut arguments = Arguments::default();
            for place in 0..positional {
                arguments.place(Bound::from_borrowed_ptr(py, *given.offset(place)))?;
            }
            for (place, name) in (positional..).zip(names.iter().flatten()) {
                arguments.name(&name, Bound::from_borrowed_ptr(py, *given.offset(place)))?;
            }
            let Arguments { direction, of } = arguments;
            let message = frame.decode(py, direction.as_ref(), of.as_ref())?;
            Ok(message.into_ptr())
        })
    }
}

/// The arguments of `decode`; None stands for one that was not given.
#[derive(Default)]
struct Arguments<'py> {
    direction: Option<Bound<'py, PyAny>>,
    of: Option<Bound<'py, PyAny>>,
}

impl<'py> Arguments<'py> {
    /// Take an argument without a name.
    fn place(&mut self, value: Bound<'py, PyAny>) -> PyResult<()> {
        match self.direction.replace(value) {
            None => Ok(()),
            Some(_) => Err(PyTypeError::new_err(
                "decode() takes at most 1 positional argument",
            )),
        }
    }

    fn name(&mut self, name: &Bound<'py, PyAny>, value: Bound<'py, PyAny>) -> PyResult<()> {
        let word: &str = name.extract()?;
        let old = match word {
            "direction" => self.direction.replace(value),
            "of" => self.of.replace(value),
            _ => {
                let text = format!("decode() got an unexpected keyword argument '{word}'");
                return Err(PyTypeError::new_err(text));
            }
        };
        match old {
            None => Ok(()),
            Some(_) => {
                let text = format!("decode() got multiple values for argument '{word}'");
                Err(PyTypeError::new_err(text))
            }
        }
    }
}

unsafe extern "C" fn compare(
    object: *mut ffi::PyObject,
    other: *mut ffi::PyObject,
    how: c_int,
) -> *mut ffi::PyObject {
    // SAFETY: C passes an object of the class, and another object.
    unsafe {
        with(object, ptr::null_mut(), |own, py| {
            let other = Bound::from_borrowed_ptr(py, other);
            let same = frame(&other).map(|other| own.same(other));
            Ok(match (same, how) {
                (Some(same), ffi::Py_EQ) => same.into_pyobject(py)?.to_owned().into_ptr(),
                (Some(same), ffi::Py_NE) => (!same).into_pyobject(py)?.to_owned().into_ptr(),
                _ => py.NotImplemented().into_ptr(),
            })
        })
    }
}

unsafe extern "C" fn hash(object: *mut ffi::PyObject) -> ffi::Py_hash_t {
    // SAFETY: C passes an object of the class. Python's hashes are never -1.
    unsafe { with(object, -1, NativeFrame::hash) }
}

unsafe extern "C" fn repr(object: *mut ffi::PyObject) -> *mut ffi::PyObject {
    // SAFETY: C passes an object of the class.
    unsafe {
        with(object, ptr::null_mut(), |frame, py| {
            Ok(frame.repr().into_pyobject(py)?.into_ptr())
        })
    }
}

unsafe extern "C" fn dealloc(object: *mut ffi::PyObject) {
    // SAFETY: C passes an object of the class that nothing refers to any more. Its frame is moved out
    // once, and its memory is freed as `PyObject_New` allocated it. The object held a reference to
    // its class, which no class of PyO3's macros gives back for it.
    unsafe {
        let class = ffi::Py_TYPE(object);
        let frame = (&raw const (*object.cast::<Object>()).frame).read();
        frame.drop_in(Python::assume_attached());
        ffi::PyObject_Free(object.cast());
        ffi::Py_DECREF(class.cast());
    }
}
