//! `Exclusive`: state that one thread uses at a time.

use std::sync::{Mutex, MutexGuard, TryLockError};

use pyo3::prelude::*;

use crate::errors;

/// State that belongs to one call at a time. A call from a second thread fails; it never waits,
/// since a wait would hide the conflict.
pub struct Exclusive<T> {
    state: Mutex<T>,
    /// The name of the object in errors.
    name: &'static str,
}

impl<T> Exclusive<T> {
    pub fn new(name: &'static str, state: T) -> Self {
        Self {
            state: Mutex::new(state),
            name,
        }
    }

    /// Return the state for the length of one call; fail if another call has it.
    pub fn get(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, T>> {
        match self.state.try_lock() {
            Ok(state) => Ok(state),
            Err(TryLockError::Poisoned(poisoned)) => Ok(poisoned.into_inner()),
            Err(TryLockError::WouldBlock) => Err(errors::shared(py, self.name)),
        }
    }
}
