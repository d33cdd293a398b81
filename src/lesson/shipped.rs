//! The lessons that come with the program: the files of `assets/lessons`, embedded.

use super::{Lesson, LessonTextError};
use std::sync::OnceLock;

/// A lesson that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Name of its file in `assets/lessons`, without `.toml`.
    pub id: &'static str,
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

/// Every lesson with its place in [`ALL`], read once.
pub fn all_read() -> &'static [(usize, Lesson)] {
    static READ: OnceLock<Vec<(usize, Lesson)>> = OnceLock::new();
    READ.get_or_init(|| ALL.iter().enumerate().filter_map(|(index, file)| Some((index, file.load().ok()?))).collect())
}

/// The place in [`ALL`] of the lesson of this name, or of the one lesson whose name begins so.
/// # Errors
/// [`UnknownLesson`] lists the lessons that may be meant.
pub fn by_name(name: &str) -> Result<usize, UnknownLesson> {
    if let Some(index) = ALL.iter().position(|lesson| lesson.id == name) {
        return Ok(index);
    }
    let begun: Vec<usize> = (0..ALL.len()).filter(|&i| !name.is_empty() && ALL[i].id.starts_with(name)).collect();
    if let [index] = begun[..] {
        return Ok(index);
    }
    let (fault, may_be_meant): (_, Vec<&str>) = match begun.is_empty() {
        true => ("names no lesson", ALL.iter().map(|lesson| lesson.id).collect()),
        false => ("begins the names of several lessons", begun.into_iter().map(|index| ALL[index].id).collect()),
    };
    Err(UnknownLesson { name: name.to_owned(), fault, known: may_be_meant.join(", ") })
}

/// A name that is that of no lesson, or the beginning of several.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("\"{name}\" {fault}; expected one of {known}")]
pub struct UnknownLesson {
    name: String,
    fault: &'static str,
    known: String,
}

impl Shipped {
    /// The lesson.
    /// # Errors
    /// None for the lessons of [`ALL`]: a test reads each of them.
    pub fn load(&self) -> Result<Lesson, LessonTextError> {
        Lesson::from_toml(self.toml)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_beginning_of_a_name_is_enough_where_one_lesson_has_it() {
        let name = |name| by_name(name).map(|index| ALL[index].id);
        assert_eq!(name("two-ends"), Ok("two-ends-and-the-comb"));
        assert_eq!(name("a-line"), Ok("a-line"), "the whole name");
        let several = name("range-and").unwrap_err().to_string();
        let begun = "\"range-and\" begins the names of several lessons; expected one of range-and-bandwidth, range-and-velocity";
        assert_eq!(several, begun);
        for none in ["", "three-ends"] {
            let told = name(none).unwrap_err().to_string();
            assert!(told.contains("names no lesson; expected") && told.contains("two-ends-and-the-comb"), "{told}");
        }
    }
}
