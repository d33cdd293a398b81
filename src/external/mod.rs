//! Methods that other programs compute, such as a user's own network in any language.
//!
//! [`start`] starts a command once and asks for its name. Each reconstruction is one question on the process' standard input and one answer on
//! its standard output; `docs/own-network.md` describes both. A process that hangs, ends, or answers anything but a map is ended. The error has
//! the reason, with the end of the process' standard error. The next reconstruction starts the process anew.

mod command;
mod message;
mod method;
mod process;
mod tail;

pub use command::CommandLine;
pub use message::VERSION;
pub use method::{ExternalMethod, StartError, start};
