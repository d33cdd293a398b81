//! What the program itself is worth: run time against error ([`front`]), numerical stress ([`stress`]), and the bare transform that
//! times are measured in. How good a map is stands in [`evaluate`](crate::evaluate).

mod bare;
pub mod front;
pub mod stress;

pub use bare::BareTransform;
