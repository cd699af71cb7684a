//! The assertions of the fuzz targets, and the code that turns fuzz bytes into tables and streams.
//!
//! A target is one function of `laws`. Each compares the core with `oracle`, a second and plain
//! implementation of `docs/framing.md`.

#![forbid(unsafe_code)]

pub mod bytes;
pub mod capture_script;
pub mod damage;
pub mod input;
pub mod laws;
pub mod oracle;
pub mod plain_capture;
pub mod random;
pub mod reading;
pub mod replay;
pub mod sample;
pub mod script;
pub mod subjects;
