//! Lessons, and the numbers that their texts must have.

use crate::prelude::*;

pub fn text(id: &str) -> &'static str {
    shipped::ALL.iter().find(|s| s.id == id).unwrap_or_else(|| panic!("no lesson {id}")).toml
}

pub fn lesson(id: &str) -> Lesson {
    Lesson::from_toml(text(id)).unwrap()
}

/// Asserts that the text has this number; its minus sign may be a hyphen here.
pub fn taught(id: &str, number: &str) {
    let is_said = text(id).contains(&number.replace('-', "−")) || text(id).contains(number);
    assert!(is_said, "{id} does not say \"{number}\"");
}

pub fn physical() -> Radar {
    Radar::default().in_convention(Convention::Physical)
}
