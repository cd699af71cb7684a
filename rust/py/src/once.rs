//! `Once`: a tuple that an object makes on first use.

#![allow(unsafe_code)] // safe code needs a lock, which takes 4 % of reading a frame once

use std::ptr;
use std::sync::atomic::{AtomicPtr, Ordering};

use pyo3::ffi;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// A tuple, or nothing yet. Once there is one, it stays until this is dropped.
pub struct Once(AtomicPtr<ffi::PyObject>);

impl Once {
    pub fn new() -> Self {
        Self(AtomicPtr::new(ptr::null_mut()))
    }

    /// Return the tuple, if there is one.
    #[inline]
    pub fn get<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyTuple>> {
        let tuple = self.0.load(Ordering::Acquire);
        // SAFETY: it is null, or a tuple to which this holds a reference.
        unsafe { Some(Bound::from_borrowed_ptr_or_opt(py, tuple)?.cast_into_unchecked()) }
    }

    /// Store a tuple, unless a thread stored one meanwhile; return the one that is stored.
    #[inline]
    pub fn set<'py>(&self, tuple: Bound<'py, PyTuple>) -> Bound<'py, PyTuple> {
        let (new, none) = (tuple.as_ptr(), ptr::null_mut());
        let stored = self
            .0
            .compare_exchange(none, new, Ordering::AcqRel, Ordering::Acquire);
        match stored {
            Ok(_) => {
                // The reference that `drop` gives back.
                let _ = tuple.clone().into_ptr();
                tuple
            }
            Err(_) => self.get(tuple.py()).unwrap_or(tuple),
        }
    }
}

impl Drop for Once {
    fn drop(&mut self) {
        let tuple = *self.0.get_mut();
        if !tuple.is_null() {
            // SAFETY: it is a tuple, and this gives back the reference that `set` kept. Python drops
            // its objects while the thread is attached to it.
            drop(unsafe { Bound::from_owned_ptr(Python::assume_attached(), tuple) });
        }
    }
}
