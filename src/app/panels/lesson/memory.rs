//! What the panel remembers from frame to frame.

use crate::app::state::LessonRun;
use crate::app::widgets::textures::Texture;

/// What was typed but not answered yet.
#[derive(Default)]
pub struct LessonMemory {
    /// The picture that a challenge hides.
    pub(super) hidden: Texture,
    pub(super) number: String,
    pub(super) eta: f32,
    pub(super) learner: String,
    /// Whether the judgement was brought into sight.
    pub(super) told: bool,
    /// Whether the field of the answer had the focus since the step began.
    pub(super) focused: bool,
    /// Whether text and question are higher than the panel.
    pub(super) overflows: bool,
    /// Lesson and step these belong to.
    pub(super) of: Option<(String, usize)>,
}

impl LessonMemory {
    /// Forgets what belongs to another step; whether a step begins.
    pub(super) fn begin(&mut self, run: &LessonRun) -> bool {
        let of = Some((run.id.clone(), run.step));
        let begins = self.of != of;
        if begins {
            let (learner, hidden) = (std::mem::take(&mut self.learner), std::mem::take(&mut self.hidden));
            *self = LessonMemory { of, eta: 0.5, learner, hidden, ..LessonMemory::default() };
        }
        begins
    }
}
