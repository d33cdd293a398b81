//! Where reflectors and lines of them may be: sources of candidates, none of which is held against the samples here.
//!
//! | file | what it is |
//! |---|---|
//! | `unexplained` | what is left of the samples, as sources look at it |
//! | `view` | at which range and in which direction an end sees a place |
//! | `end_beams` | each end's plain beams |
//! | `registered` | both ends' beams laid over each other |
//! | `peaks` | points where a residual stands out, both ends registered |
//! | `tones` | ranges from one element's chirp |
//! | `pairs` | points that both ends' tones agree on |
//! | `phased` | each end's beams with their phases, and lines looked up in them |
//! | `strides` | lines from their first two reflectors |
//! | `edges` | lines from their first reflector alone |
//! | `runs` | how many range bins in a row hold an echo |

pub mod edges;
pub mod end_beams;
pub mod pairs;
pub mod peaks;
pub mod phased;
mod registered;
pub mod runs;
pub mod strides;
mod tones;
pub mod unexplained;
pub mod view;
