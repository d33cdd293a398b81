//! What rows of an evaluation allow to say: whether one method is better than another, and what the bad rows have in common.

mod chance;
mod paired;
mod shared;

pub use paired::{MOST_RESAMPLED, Paired, RESAMPLES};
pub use shared::{DISCOVERY_RATE, Rule, Shared, USUALLY_BAD, rules};
