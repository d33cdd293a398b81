//! The methods that use both ends as one aperture, phase between them included.
//!
//! Every place with energy at both ends gets one linear model: the profile of each element at its own distance from the place, as a sum of
//! steering vectors over all elements. A method is one closure, which computes the next power of each vector from the model; the rest is shared.
//!
//! Where the array is small against a range bin, one model holds a whole range row without loss. Where the ranges of a reflector at the elements
//! differ by more than half a bin over the directions (table 3.1: up to 13 bins to either side), directions are cut into sectors, and each model
//! is registered for its own: exact at its middle, half a bin off at the edges. The echoes of other sectors are lost: in a model they are plane
//! waves at one end alone. Reflectors at ranges between those of two stronger ones less than two bins apart in the same sector have no model of
//! their own, since models stand where the echo is strongest; they show once the stronger ones' exact echoes have been subtracted, in a few
//! further looks. Where rows of reflectors stand closer than that over hundreds of bins, there are too few looks, and the map shows fewer of
//! them.
//! Places right in front of the array's middle are lost too, too near for the ends to resolve.
//!
//! | file | content |
//! |---|---|
//! | `ends` | elements with samples, and their range profiles |
//! | `sectors` | directions that share one registration |
//! | `places` | ranges and sectors with energy at both ends |
//! | `model` | steering vectors of one place, and the iteration that gives their powers |
//! | `linear` | that iteration's linear algebra, for wide vectors |
//! | `peaks` | reflectors from powers, and their gains |
//! | `settle` | reflectors moved off the grid, without needless ones |
//! | `method` | all of these in order |

#[cfg(test)]
mod close_tests;
mod ends;
mod iaa;
mod linear;
mod method;
mod model;
mod peaks;
mod places;
mod sbl;
mod sectors;
mod settle;

pub use iaa::IAA;
pub use method::CoherentMethod;
pub(super) use method::found_in_residuals;
pub(super) use peaks::{Peak, gains};
pub use sbl::SBL;
