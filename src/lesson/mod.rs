//! Lessons: the learner predicts, sees the maps, and then changes the scene until a condition holds.
//!
//! ```text
//!   Lesson (TOML) ──► Step: text, scene, radar ──► Question ──► Guess ──► Judgement
//!                                               └► Challenge ──► Measured requirements
//! ```
//!
//! Truth comes from the simulation: a [`Stage`] holds the step's maps, and questions and challenges are checked on them. Predicting before
//! seeing is what makes a demonstration teach (C. Crouch, A. Fagen, J. Callan, E. Mazur, "Classroom demonstrations: Learning tools or
//! entertainment?", Am. J. Phys. 72, 2004).

pub mod challenge;
mod criterion;
mod fault;
pub mod file;
pub mod progress;
pub mod quantity;
pub mod question;
pub mod shipped;
pub mod stage;
mod trial;

pub use challenge::Challenge;
pub use criterion::Measured;
pub use fault::LessonTextError;
pub use file::{Lesson, LessonError, Step, Uses};
pub use progress::Progress;
pub use question::{Guess, Judgement, Question, Truth};
pub use stage::{Cell, MapName, Stage, StepView};

#[cfg(test)]
mod tests;
