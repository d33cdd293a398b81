//! The live network: 24 elements in, the whole array's log-magnitude out, in milliseconds.
//!
//! A U-Net on 512 x 64 cells whose decoder knows what a reflector's picture is made of. Its two fine heads say how strong each
//! of the 512 x 1024 cells is by itself and how strong a *source of side lobes in range* it is; a coarse head says the same for
//! side lobes in angle. Two learned circular kernels, started as the tails of a Hann window (1/k^3), carry those sources along the columns and
//! the rows, so that the bright cross that every reflector draws through the whole map costs two matrix products. The parts
//! add up as amplitudes together with the noise floor.
//!
//! Angles wrap around (column 0 follows column 1023), ranges do not. Row and column means mix at the two coarsest levels.
//!
//! `python/apertura/live.py` is the network in PyTorch, with the same names and shapes: what trains.
//!
//! | file | what |
//! |---|---|
//! | [`grid`], [`features`], [`constants`], `capon`, `coarse`, `registration`, `floors` | raw samples of the two ends to the network's tensors |
//! | [`examples`], [`arrays`], [`radars`] | inputs and targets of random scenes |
//! | [`dataset`] | the same as files |
//! | `config`, [`size`], `columns` | how large the network is; a radar of another shape has its samples as rows, and its map is resampled to its elements |
//! | [`engine`], `reading`, `planes`, `winograd`, `filter`, `lobes`, `range_lobes` | the network over [`kernels`](super::kernels): what runs during a drag |
//! | [`doubt`] | how far off the network expects to be |
//! | [`method`] | the network as a reconstruction method |

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

pub use config::LiveConfig;
pub use method::LiveMethod;
