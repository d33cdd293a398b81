//! A method that another program computes: a network of one's own in any language.
//!
//! [`start`] starts a command once and asks it who it is. Each reconstruction is one question on the process' standard input and one answer on its
//! standard output; `docs/own-network.md` describes both. A process that hangs, ends, or answers anything but a map is ended. The error says
//! why, with the end of its standard error. The next reconstruction starts it anew.

mod command;
mod message;
mod method;
mod process;
mod tail;

pub use command::{CommandLine, CommandLineError};
pub use message::VERSION;
pub use method::{ExternalMethod, StartError, start};
