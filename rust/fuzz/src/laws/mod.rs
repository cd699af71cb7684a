//! Properties that hold for any bytes: one function for each target.

pub mod captures;
pub mod columns;
pub mod decoding;
pub mod exchange;
pub mod framing;
pub mod linear;
pub mod rows;
pub mod tables;
pub mod tally;
