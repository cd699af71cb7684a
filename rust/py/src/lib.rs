//! `cobotwire._native`: the codec of `cobotwire-core` behind Python's codec interface.
//!
//! It converts and decides nothing: what is legal the core says, and what an error's text says
//! `cobotwire.codec.refusal` does.

use pyo3::prelude::*;

mod bulk;
mod codec;
mod convert;
mod edition;
mod errors;
mod events;
mod frame;
mod framer;
mod given;
mod memory;
mod names;
mod objects;
mod parts;
mod values;
mod words;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::bulk::NativeColumnReader;
    #[pymodule_export]
    use crate::codec::NativeCodec;
    #[pymodule_export]
    use crate::frame::NativeFrame;
    #[pymodule_export]
    use crate::framer::NativeFramer;
    #[pymodule_export]
    use crate::memory::Memory;
}
