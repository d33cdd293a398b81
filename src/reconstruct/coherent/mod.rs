//! Methods with both ends as one aperture, the phase between them included.
//!
//! Each place with energy at both ends has a linear model: the range profile of each element at its own distance from the place, as a sum of steering
//! vectors of all elements. The methods differ in one closure, which computes the next power of each vector.
//!
//! Where the array is short against a range bin, one model has a whole range row. Where a reflector's ranges at the elements differ by more than half a
//! bin over the directions (table 3.1: up to 13 bins to either side), directions are divided into sectors. Each model is exact in its sector's middle and
//! half a bin off at the edges. Echoes of other sectors are plane waves at one end alone. Between two stronger reflectors of a sector that are less than
//! two bins apart there is no model, since models are at range peaks. Such reflectors are found in the residual of the stronger ones, in a few further
//! searches. Dense rows over hundreds of bins need more searches than that, and lose reflectors. So do places right in front of the array's middle, too
//! near for the ends to resolve.
//!
//! | file | content |
//! |---|---|
//! | `ends` | elements with samples, and their range profiles |
//! | `sectors` | directions that share one registration |
//! | `places` | ranges and sectors with energy at both ends |
//! | `model` | steering vectors of one place, and the iteration that gives their powers |
//! | `linear` | that iteration's linear algebra, for wide vectors |
//! | `peaks` | directions of local maxima of power, and their gains |
//! | `refinement` | refinement of reflectors off the grid, and removal of needless ones |
//! | `method` | the whole method |

#[cfg(test)]
mod close_tests;
mod ends;
mod iaa;
mod linear;
mod method;
mod model;
mod peaks;
mod places;
mod refinement;
mod sbl;
mod sectors;

pub use iaa::IAA;
pub use method::CoherentMethod;
pub(super) use method::found_in_residuals;
pub(super) use peaks::{Peak, gains};
pub use sbl::SBL;
