//! The live network, which estimates the whole array's log-magnitude from 24 elements in milliseconds.
//!
//! A U-Net on 512 x 64 cells whose decoder models a reflector's picture. Its two fine heads give the strength of each of the 512 x 1024 cells by
//! itself and its strength as a *source of side lobes in range*; a coarse head gives the sources of side lobes in angle. Two learned circular
//! kernels, started as the tails of a Hann window (1/k^3), spread those sources along the columns and the rows, so that the bright cross of
//! every reflector through the whole map costs two matrix products. The parts add up as amplitudes together with the noise floor.
//!
//! Angles wrap around (column 0 follows column 1023), ranges do not. Row and column means mix at the two coarsest levels.
//!
//! `python/apertura/live.py` is the network in PyTorch, with the same names and shapes, for training.

pub mod arrays;
mod capon;
mod coarse;
mod columns;
mod config;
pub mod constants;
pub mod dataset;
pub mod doubt;
pub mod engine;
pub mod examples;
pub mod features;
mod filter;
mod floors;
pub mod grid;
mod lobes;
pub mod method;
mod planes;
pub mod radars;
mod range_lobes;
mod reading;
mod registration;
pub mod size;
#[cfg(test)]
mod twin_tests;
mod winograd;

pub use method::LiveMethod;
