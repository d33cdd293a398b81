//! The program as a user runs it: standard output, standard error, exit status and files.

mod bounds;
mod cli;
#[cfg(feature = "network")]
mod reconstruct;
mod recordings;
mod rows;
mod same_bits;
