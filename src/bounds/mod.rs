//! What no estimator can beat: bounds on position errors, and how alike two places look to an array.

mod ambiguity;
mod cramer_rao;
mod lobes;

pub use ambiguity::{Ambiguity, ambiguity};
pub use cramer_rao::{BoundsError, PositionBound, cramer_rao, noise_variance};
pub use lobes::{Lobes, cut, lobes};
