//! The tests of the core, in one program: each further one would be compiled and linked by itself.
//!
//! They cover what the Python tests do not reach, and replay the vectors and the found inputs without
//! Python. `tests/codec` and `tests/capture` compare the core with the codec in Python, its
//! specification: framing, values, tables, columns and recordings.

// A failing test may panic.
#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used
)]

mod common;
mod exchange;
mod found;
mod records;
mod replay;
mod tables;
mod vectors;
mod workers;
