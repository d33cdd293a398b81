//! Sources of candidates for reflectors and lines of them; none of the candidates is tested against the samples here.
//!
//! | file | content |
//! |---|---|
//! | `view` | the range and the direction of a place from an end |
//! | `end_beams` | each end's plain beams |
//! | `peaks` | points where a residual stands out, both ends registered |
//! | `tones` | ranges from one element's chirp |
//! | `pairs` | points that both ends' tones agree on |
//! | `phased` | each end's beams with their phases, and lines looked up in them |
//! | `strides` | lines from their first two reflectors |
//! | `edges` | lines from their first reflector alone |
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
