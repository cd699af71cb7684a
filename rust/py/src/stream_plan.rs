//! What one stream sends next.

use std::sync::{Mutex, MutexGuard, PoisonError};

use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::swap::now;

/// A loop that is later than this many seconds has waited for a busy thread.
const LATE: f64 = 0.001;
/// For how many slots after that the thread writes.
const LATE_SLOTS: u32 = 50;

/// What a slot is to send.
pub struct Plan {
    pub frame: Py<PyBytes>,
    pub command: Py<PyAny>,
    /// For how many seconds its reply is waited for.
    pub wait: f64,
    /// The future of its consumer.
    pub over: Py<PyAny>,
}

/// The slots of one stream.
pub struct Slot {
    /// The `AsyncSlots` of the stream.
    pub slots: Py<PyAny>,
    pub next: Mutex<Next>,
}

/// What a slot does next.
#[derive(Default)]
pub struct Next {
    pub plan: Option<Plan>,
    pub at: f64,
    /// Whether what was planned last was sent.
    pub sent: bool,
    /// For how many slots more the thread is to write.
    pub late: u32,
}

impl Slot {
    pub fn locked(&self) -> MutexGuard<'_, Next> {
        self.next.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn taken(&self) -> Option<Plan> {
        self.locked().plan.take()
    }

    /// Note whether the loop was late.
    pub fn note_lateness(&self) {
        let mut next = self.locked();
        next.late = if now() - next.at > LATE {
            LATE_SLOTS
        } else {
            next.late.saturating_sub(1)
        };
    }
}
