//! State of the lesson panel, kept between frames.

use crate::app::state::LessonRun;
use crate::app::widgets::Texture;

/// Answers that were typed but not sent, and the state of the layout.
#[derive(Default)]
pub struct LessonMemory {
    /// Texture of the map to reproduce, where a challenge hides its scene.
    pub(super) hidden: Texture,
    pub(super) number: String,
    pub(super) eta: f32,
    pub(super) learner: String,
    /// Whether the judgement was scrolled into sight.
    pub(super) told: bool,
    /// Whether the answer's field had the focus since the step began.
    pub(super) focused: bool,
    /// Whether text and question together are higher than the panel.
    pub(super) overflows: bool,
    /// Lesson and step that the state belongs to.
    pub(super) of: Option<(String, usize)>,
}

impl LessonMemory {
    /// Resets the state where another step begins. Returns whether one does.
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
