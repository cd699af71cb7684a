//! `cobotwire._native`: implements Python's codec interface with `cobotwire-core`.
//!
//! It only converts: the core decides what is legal, and `cobotwire.protocol.rejection` writes the
//! error messages.

use pyo3::prelude::*;

mod bulk;
mod codec;
mod column;
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

// A free-threaded interpreter enables its lock when it loads this module, which is not tested
// there.
#[pymodule(gil_used = true)]
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
