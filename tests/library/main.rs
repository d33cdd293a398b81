//! The library as other programs use it.

mod accuracy;
mod baseline_tables;
mod conventions;
mod house;
#[cfg(feature = "network")]
mod live_network;
mod methods;
mod snapshot;
mod stress;
