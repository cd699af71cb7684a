//! What holds for any bytes: one function a target.

pub mod decoding;
pub mod framing;
pub mod linear;
pub mod tables;
