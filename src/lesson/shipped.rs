//! The lessons that come with the program: the files of `assets/lessons`, embedded.

use super::file::{Lesson, LessonTextError};

/// A lesson that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Name of its file in `assets/lessons`, without `.toml`.
    pub id: &'static str,
    /// The file's text.
    pub toml: &'static str,
}

macro_rules! lessons {
    ($($id:literal),* $(,)?) => {
        &[$(Shipped { id: $id, toml: include_str!(concat!("../../assets/lessons/", $id, ".toml")) }),*]
    };
}

/// Every lesson, in the order they are best taken.
pub const ALL: &[Shipped] = lessons![
    "range-and-bandwidth",
    "chirps-and-beats",
    "range-and-velocity",
    "angle-and-aperture",
    "grating-lobes",
    "windows-and-side-lobes",
    "near-field",
    "pairs-of-antennas",
    "phasors",
    "two-ends-and-the-comb",
    "a-line",
    "points-taken-for-a-line",
    "occlusion",
    "where-a-wall-shines",
    "which-points-a-car-is",
    "smooth-and-rough",
    "what-one-end-sees",
    "folding-and-wrapping",
    "the-floor",
    "the-link-budget",
    "a-threshold-that-follows-the-noise",
    "which-radar-is-the-thesis-radar",
    "what-a-network-can-know",
];

impl Shipped {
    /// The lesson.
    ///
    /// # Errors
    /// None for the lessons of [`ALL`]: a test reads each of them.
    pub fn load(&self) -> Result<Lesson, LessonTextError> {
        Lesson::from_toml(self.toml)
    }
}
