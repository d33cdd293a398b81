//! The methods that work on one end and one range row at a time.
//!
//! Each end's samples become range profiles; each range row is a snapshot of twelve elements from which a method estimates power
//! over angle. Both ends' estimates are laid onto the centre's grid and their geometric mean is taken: what only one end
//! believes in fades. Nothing uses the phase between the ends.

mod bartlett;
mod capon;
mod covariance;
mod linear_prediction;
mod method;
mod music;
mod registered;
mod root_music;
mod row;

pub use bartlett::BARTLETT;
pub use capon::CAPON;
pub use linear_prediction::LINEAR_PREDICTION;
pub use method::RowMethod;
pub use music::MUSIC;
pub use root_music::ROOT_MUSIC;
