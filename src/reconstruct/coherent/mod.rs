//! The methods that use both ends as one aperture, phase between them included.
//!
//! Every place that both ends hear is one linear model: what each element heard at its own distance from there, as a sum of steering
//! vectors of all its elements. A method is one closure, which says how the power of each vector follows from what the model
//! explains; everything around it is shared.
//!
//! Where the array is small against a range bin, one model holds a whole range row and nothing is lost. Where the ranges that the
//! elements see a reflector at differ by more than half a bin over the directions (table 3.1: up to 13 bins to either side), directions
//! are cut into sectors, and each model is registered for its own: exact at its middle, half a bin off at the edges. Lost is what
//! other sectors' echoes would tell: in a model they are plane waves that one end alone hears. Reflectors at ranges between those of
//! two stronger ones less than two bins apart in the same sector have no model of their own, which stand where the echo is strongest;
//! they show once the stronger ones' exact echoes have been taken off, and a few such looks are taken. Where rows of reflectors stand
//! closer than that over hundreds of bins, looks run out: the map then shows fewer of them.
//! Lost as well is what stands right before the array's middle, too near for the ends to vouch for it.
//!
//! | file | what it is |
//! |---|---|
//! | `ends` | elements that heard something, and their range profiles |
//! | `sectors` | directions that one registration serves |
//! | `places` | ranges and sectors from which both ends hear something |
//! | `model` | steering vectors of one place, and the iteration that gives their powers |
//! | `linear` | that iteration's linear algebra, for wide vectors |
//! | `peaks` | reflectors from powers, and their gains |
//! | `settle` | those moved off the grid, and those that are needless taken away |
//! | `split` | one echo found for two, and two for one |
//! | `method` | all of these in order |

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
mod split;
#[cfg(test)]
mod split_tests;

pub use iaa::IAA;
pub use method::CoherentMethod;
pub(super) use method::explained;
pub(super) use peaks::{Peak, gains};
pub use sbl::SBL;
