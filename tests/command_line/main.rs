//! The program as a user runs it: standard output, standard error, exit status and files.

mod bounds;
mod captures;
mod cli;
mod documents;
mod kept_rows;
mod layouts;
#[path = "../common/captures.rs"]
mod made_captures;
mod merge;
mod messages;
mod numerics_features;
#[cfg(unix)]
mod own_method;
#[cfg(feature = "network")]
mod reconstruct;
mod recordings;
mod rows;
mod same_bits;
mod threshold;
#[cfg(feature = "network")]
mod training;
mod worsen;
