//! The tests of the core, in one program: each further one would be compiled and linked by itself.
//!
//! They cover what the Python tests do not reach. `tests/codec` and `tests/capture` compare the core
//! with the codec in Python, its specification: vectors, found inputs, framing, values, tables,
//! columns and recordings.

// A failing test may panic.
#![allow(
    clippy::expect_used,
    clippy::indexing_slicing,
    clippy::panic,
    clippy::unwrap_used
)]

mod common;
mod exchange;
mod tables;
mod workers;
