//! `cobotwire._native`: the codec of `cobotwire-core` behind Python's codec interface.
//!
//! It converts and decides nothing: what is legal the core says, and what an error's text says
//! `cobotwire.codec.refusal` does.

use pyo3::prelude::*;

mod codec;
mod convert;
mod errors;
mod events;
mod framer;
mod given;
mod names;
mod objects;
mod values;
mod words;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::codec::NativeCodec;
    #[pymodule_export]
    use crate::framer::NativeFramer;
}
