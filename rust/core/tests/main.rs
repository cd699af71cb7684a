//! The tests of the core. They are one program, since cargo compiles and links each program
//! separately.
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
