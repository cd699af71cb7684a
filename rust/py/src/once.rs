//! `Once`: a tuple that an object keeps from its second use on.

#![allow(unsafe_code)] // safe code needs a lock, which takes 4 % of reading a frame once

use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

use pyo3::ffi;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A tuple, or nothing yet, or the address of `USED`. Once there is a tuple, it stays until this is
/// dropped.
pub struct Once(AtomicPtr<ffi::PyObject>);

/// Its address states that the tuple was used, but not kept.
static USED: u8 = 0;

fn used() -> *mut ffi::PyObject {
    (&raw const USED).cast_mut().cast()
}

impl Once {
    pub fn new() -> Self {
        Self(AtomicPtr::new(ptr::null_mut()))
    }

    /// Return the tuple, if there is one.
    #[inline]
    pub fn get<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyTuple>> {
        let tuple = self.0.load(Ordering::Acquire);
        if tuple == used() {
            return None;
        }
        // SAFETY: it is null, or a tuple to which this holds a reference.
        unsafe { Some(Bound::from_borrowed_ptr_or_opt(py, tuple)?.cast_into_unchecked()) }
    }

    /// Return whether this is the first use; a tuple that is cheap to make need not be kept then.
    #[inline]
    pub fn is_first(&self, _: Python<'_>) -> bool {
        let first = self.0.load(Ordering::Relaxed).is_null();
        if first {
            self.0.store(used(), Ordering::Relaxed);
        }
        first
    }

    /// Store a tuple, unless a thread stored one meanwhile; return the one that is stored.
    #[inline]
    pub fn set<'py>(&self, tuple: Bound<'py, PyTuple>) -> Bound<'py, PyTuple> {
        if let Some(stored) = self.get(tuple.py()) {
            return stored;
        }
        // Nothing came between: this thread holds the interpreter's lock, which the tuple proves, and
        // runs no code of Python's here. So no atomic exchange is needed, which is slower. `drop` gives
        // this reference back.
        self.0.store(tuple.clone().into_ptr(), Ordering::Release);
        tuple
    }
}

impl Drop for Once {
    fn drop(&mut self) {
        let tuple = *self.0.get_mut();
        if !tuple.is_null() && tuple != used() {
            // SAFETY: it is a tuple, and this gives back the reference that `set` kept. Python drops
            // its objects while the thread is attached to it.
            drop(unsafe { Bound::from_owned_ptr(Python::assume_attached(), tuple) });
        }
    }
}
