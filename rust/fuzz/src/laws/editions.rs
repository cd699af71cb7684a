//! The law of reading tables: any file gives a table that can be used, or an error with a message.

use std::sync::LazyLock;

use serde_json::Value;

use crate::damage::{changed, used};

static DOCUMENT: LazyLock<Value> = LazyLock::new(|| {
    let file = include_bytes!("../../../../python/cobotwire/editions/mycobot/edition.json");
    serde_json::from_slice(file).expect("the generator writes JSON")
});

/// Read the bytes as a file; then read the file of an edition with changes that the bytes choose.
pub fn files_are_read_or_refused(data: &[u8]) {
    used(data);
    let mut rest = data.iter();
    let mut roll = |below: usize| {
        let [high, low] = [rest.next(), rest.next()].map(|byte| usize::from(*byte.unwrap_or(&0)));
        (high << 8 | low) % below
    };
    used(&changed(&DOCUMENT, &mut roll));
}
