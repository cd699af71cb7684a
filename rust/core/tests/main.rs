//! All tests of the core, in one program: each further one would be compiled and linked by itself.

// A failing test may panic.
#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used
)]

mod bulk;
mod capture;
mod common;
mod exchange;
mod formats;
mod found;
mod framing;
mod records;
mod replay;
mod values;
mod vectors;
mod workers;
