//! Sources of candidates for points and rows, which are tested against the samples elsewhere.
//!
//! | file | content |
//! |---|---|
//! | `view` | the range and the direction of a place from an end |
//! | `end_beams` | beams of each end over range |
//! | `peaks` | points at peaks of a residual at both ends |
//! | `tones` | ranges from one element's chirp |
//! | `pairs` | points from tones of both ends |
//! | `phased` | beams with phases, and the echoes of rows in them |
//! | `strides` | rows from their first two reflectors |
//! | `edges` | rows from their first reflector alone |
//! | `runs` | the number of successive range bins with an echo |

pub mod edges;
pub mod end_beams;
pub mod pairs;
pub mod peaks;
pub mod phased;
pub mod runs;
pub mod strides;
mod tones;
pub mod view;
