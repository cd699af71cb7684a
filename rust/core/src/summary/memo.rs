//! Caches texts that Python writes.

use std::collections::HashMap;
use std::hash::Hash;

/// At most this many texts are cached, so that hostile input does not fill the memory.
const MOST: usize = 1 << 14;

/// Texts by the values that they depend on.
pub(super) struct Memo<K>(HashMap<K, String>);

impl<K> Default for Memo<K> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<K: Eq + Hash> Memo<K> {
    /// Return the text for a key; make it if it is not cached.
    pub(super) fn text(&mut self, key: K, make: impl FnOnce() -> String) -> &str {
        if self.0.len() >= MOST && !self.0.contains_key(&key) {
            self.0.clear();
        }
        self.0.entry(key).or_insert_with(make)
    }
}
