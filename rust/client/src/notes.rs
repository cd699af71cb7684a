//! The state that a client stores for the next client of the same port in this process: replies
//! that may still come and could be mistaken for replies to the next client, and incomplete
//! requests that the device may hold.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::time::Instant;

use cobotwire_core::exchange::PersistedState;

use crate::options::nanos;

/// The largest number of entries of each kind in a note.
const MOST_ENTRIES: usize = 64;

/// The state stored for each port, and the instant from which its times count.
static NOTES: Mutex<BTreeMap<String, (PersistedState, Instant)>> = Mutex::new(BTreeMap::new());

/// The name of a port, and when its session began. `None`: the port has no lasting name, or its
/// state was stored already.
#[derive(Debug)]
pub(crate) struct Note(Option<String>, Instant);

impl Note {
    /// Return the note of a port, and the state stored for it; its times count from now.
    pub fn of(url: Option<&str>) -> (Self, PersistedState) {
        // A later pseudo-terminal with this name belongs to another device.
        let (name, now) = (
            url.filter(|url| !url.starts_with("/dev/pts/")),
            Instant::now(),
        );
        let note = name.and_then(|name| crate::lock(&NOTES).remove(name));
        let (mut state, at) = note.unwrap_or_else(|| (PersistedState::default(), now));
        let passed = nanos(now.saturating_duration_since(at));
        state.late.retain(|late| late.until > passed);
        state.late.iter_mut().for_each(|late| late.until -= passed);
        (Self(name.map(str::to_owned), now), state)
    }

    /// Store the state once, unless it is empty.
    pub fn leave(&mut self, mut state: PersistedState) {
        let (late, parts) = (&mut state.late, &mut state.parts);
        late.drain(..late.len().saturating_sub(MOST_ENTRIES));
        parts.drain(..parts.len().saturating_sub(MOST_ENTRIES));
        let name = self.0.take().filter(|_| state != PersistedState::default());
        if let Some(name) = name {
            crate::lock(&NOTES).insert(name, (state, self.1));
        }
    }
}
