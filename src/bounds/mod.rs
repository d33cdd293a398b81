//! Bounds on the position error of any unbiased estimator, and the ambiguity function of an array.

mod ambiguity;
mod cramer_rao;
mod lobes;

pub use ambiguity::{Ambiguity, ambiguity};
pub use cramer_rao::{BoundsError, Gains, PositionBound, cramer_rao, cramer_rao_of, noise_variance};
pub use lobes::{Lobes, cut, lobes};
