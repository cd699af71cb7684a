//! What a client leaves on its port for the next one of this process: replies that may still come,
//! which look like those to its own requests, and halves of requests that the device may hold.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

use cobotwire_core::exchange::PersistedState;

use crate::options::nanos;

/// The entries of each kind that a note has at most.
const MOST_ENTRIES: usize = 64;

/// The state that a session left, and when the zero of its times was.
type Note = (PersistedState, Instant);

static NOTES: Mutex<BTreeMap<String, Note>> = Mutex::new(BTreeMap::new());

/// The names of a port: its device, and a link that keeps its name when the device is replugged.
#[derive(Debug, Default)]
pub(crate) struct PortNames(Vec<String>);

impl PortNames {
    pub fn of(url: &str) -> Self {
        let mut names = vec![url.to_owned()];
        if let Ok(device) = Path::new(url).canonicalize() {
            let device = device.to_string_lossy().into_owned();
            // The next pseudo-terminal of this name is another line.
            if device.starts_with("/dev/pts/") {
                names.retain(|name| *name != device);
            } else if device != url {
                names.push(device);
            }
        }
        Self(names)
    }

    /// Return what was left on the port, and remove it; `begun` is the zero of the caller's times.
    pub fn recall(&self, begun: Instant) -> PersistedState {
        let mut notes = crate::lock(&NOTES);
        let mut found = PersistedState::default();
        for (state, zero) in self.0.iter().filter_map(|name| notes.remove(name)) {
            let passed = nanos(begun.saturating_duration_since(zero));
            for mut late in state.late {
                late.until = late.until.saturating_sub(passed);
                if late.until > 0 && !found.late.contains(&late) {
                    found.late.push(late);
                }
            }
            let parts = state.parts.into_iter();
            let new: Vec<_> = parts.filter(|part| !found.parts.contains(part)).collect();
            found.parts.extend(new);
        }
        found
    }

    /// Leave a note on the port, unless the line is aligned and silent.
    pub fn leave(&self, mut state: PersistedState, begun: Instant) {
        state
            .late
            .drain(..state.late.len().saturating_sub(MOST_ENTRIES));
        state
            .parts
            .drain(..state.parts.len().saturating_sub(MOST_ENTRIES));
        if state != PersistedState::default() {
            let mut notes = crate::lock(&NOTES);
            for name in &self.0 {
                notes.insert(name.clone(), (state.clone(), begun));
            }
        }
    }
}
