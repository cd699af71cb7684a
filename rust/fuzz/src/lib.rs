//! What the fuzz targets assert, and how fuzz bytes become tables, streams and chunks.
//!
//! A target is one function of `laws`. Each compares the core with `oracle`, the law of
//! `docs/framing.md` once more, as plainly as it can be said.

#![forbid(unsafe_code)]

// The core's own test helpers: reading the generator's tables, values to encode.
#[path = "../../core/tests/common/mod.rs"]
pub mod common;
#[path = "../../core/tests/records/mod.rs"]
pub mod records;
#[path = "../../core/tests/replay/mod.rs"]
pub mod replay;

pub mod input;
pub mod laws;
pub mod oracle;
pub mod random;
pub mod reading;
pub mod script;
pub mod subjects;
