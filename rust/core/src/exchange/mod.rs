//! The exchange of requests and replies over one transport: bytes and times go in, bytes, finished
//! requests and events come out.
//!
//! It has no thread, clock or port. `python/cobotwire/session` is its specification.

mod events;
mod facts;
mod machine;
mod outcome;
mod pending;
mod received;
mod request;
mod text;
mod values;

pub use events::{Event, SeenFrame};
pub use facts::{Addressee, Facts, Named, Nanos, Protocol, Safety, TextForm};
pub use machine::{Exchange, LateFrame, Part, PersistedState};
pub use outcome::{Answer, Failure, ReplyError, WaitedFor};
pub use pending::{RetryPolicy, Ticket};
pub use received::{Kind, Received};
pub use request::{Replier, Request, RequestError};
pub use text::{TextError, TextFault};
