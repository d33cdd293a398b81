//! The live network, which estimates the whole array's log-magnitude from 24 elements in milliseconds.
//!
//! A U-Net on 512 x 64 cells whose decoder models the point spread of a reflector. Two fine heads give the amplitude of the main lobe in each of the
//! 512 x 1024 cells, and that of a *source of side lobes in range*. A coarse head gives the sources of side lobes in angle. Two learned circular
//! kernels, initialised with the decay of a Hann window's side lobes (1/k^3), spread the sources along the columns and the rows by two matrix products.
//! The map is the sum of these amplitudes and the noise floor.
//!
//! Convolutions are circular in angle (column 0 follows column 1023), and padded with zeros in range. At the two coarsest levels each cell also gets
//! the means and maxima of its row and its column.
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
