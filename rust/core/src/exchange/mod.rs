//! The exchange of requests and replies over one transport: bytes and times go in, bytes, finished
//! requests and events come out.
//!
//! It has no thread, clock or port. `python/cobotwire/session` is its specification.

mod facts;

pub use facts::{Facts, Nanos, Named, Protocol, Safety, TextForm};
