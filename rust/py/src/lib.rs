//! `cobotwire._native`: implements Python's codec interface with `cobotwire-core`.
//!
//! It only converts: the core decides what is legal, and `cobotwire.protocol.rejection` writes the
//! error messages.

use pyo3::prelude::*;

#[cfg(target_os = "linux")]
mod alarm_clock;
mod bulk;
mod capture;
mod codec;
mod column;
mod convert;
#[cfg(unix)]
mod descriptor;
mod edition;
mod errors;
mod events;
mod exclusive;
mod frame;
mod framer;
mod given;
mod interpreter;
mod memory;
mod names;
mod objects;
mod parts;
mod plain;
mod summary;
mod values;
mod words;

// This module is not tested without the interpreter's lock, so a free-threaded interpreter enables
// its lock when it loads this module.
#[pymodule(gil_used = true)]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    // First, so that no class is made in a subinterpreter.
    interpreter::check_main(module.py())?;
    // Cargo.toml states the version of all parts.
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<memory::Memory>()?;
    module.add_class::<codec::NativeCodec>()?;
    module.add_class::<bulk::NativeColumnReader>()?;
    module.add_class::<capture::NativeCaptureReader>()?;
    module.add_class::<frame::NativeFrame>()?;
    module.add_class::<summary::NativeSummary>()?;
    module.add_class::<framer::NativeFramer>()?;
    #[cfg(unix)]
    descriptor::add_to(module)?;
    #[cfg(target_os = "linux")]
    module.add_class::<alarm_clock::AlarmClock>()?;
    Ok(())
}
