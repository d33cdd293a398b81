//! What the program itself is worth: run time against error ([`front`]), run time of scenes of bodies ([`bodies`]), the page against
//! the native program ([`one_thread`]), and the bare transform that times are measured in. How good a map is stands in [`evaluate`](crate::evaluate).

mod bare;
pub mod bodies;
pub mod front;
pub mod one_thread;
#[cfg(test)]
mod stress_tests;
mod times;

pub use bare::BareTransform;
