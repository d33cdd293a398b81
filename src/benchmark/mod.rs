//! What the program itself is worth: run time against error ([`front`]), run time of scenes of bodies ([`bodies`]) and of a face against its error ([`faces`]), numerical stress
//! ([`stress`]), the page against the native program ([`one_thread`]), and the bare transform that times are measured in. How good a map is stands in [`evaluate`](crate::evaluate).

mod bare;
pub mod bodies;
pub mod faces;
pub mod front;
pub mod one_thread;
pub mod stress;
mod times;

pub use bare::BareTransform;
