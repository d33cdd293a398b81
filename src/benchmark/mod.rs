//! Benchmarks of the program itself: run time against error ([`front`]), run time of scenes of bodies ([`bodies`]), the page against the native
//! program ([`one_thread`]), and the bare transform that is the unit of times. Measures of maps are in [`evaluate`](crate::evaluate).

mod bare;
pub mod bodies;
pub mod front;
pub mod one_thread;
#[cfg(test)]
mod stress_tests;
mod times;

pub use bare::BareTransform;
