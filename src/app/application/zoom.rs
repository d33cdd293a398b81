//! How large everything is while a presentation or a lesson is shown, and whether the window fills the screen.

use crate::app::state::State;
use eframe::egui;

/// Height that a presentation is laid out for, points: on a larger screen everything is larger.
const PRESENTATION_HEIGHT: f32 = 600.0;

/// How much larger everything is in a presentation at least and at most.
const PRESENTATION_ZOOMS: [f32; 2] = [1.0, 2.5];

/// How much larger everything is in a presentation on a window of a height, points at normal size.
fn presentation_zoom(height: f32) -> f32 {
    let [least, most] = PRESENTATION_ZOOMS;
    (height / PRESENTATION_HEIGHT).clamp(least, most)
}

/// Sizes of the interface that come back when what is shown ends.
#[derive(Default)]
pub struct Zoom {
    /// Whether the window fills the screen because a presentation does.
    is_full_screen: bool,
    /// Before the presentation that is shown.
    before_presenting: Option<f32>,
    /// Before the lesson that is taken.
    before_lesson: Option<f32>,
    /// Whether the screen has just been filled or left: what lies under a pointer that rests is no longer what it was moved to.
    pub turned: bool,
}

impl Zoom {
    /// The size that the user chose, where another is shown.
    pub fn before(&self) -> Option<f32> {
        self.before_lesson.or(self.before_presenting)
    }

    /// Follows what is shown.
    pub fn follow(&mut self, ctx: &egui::Context, state: &State) {
        let full_screen = state.is_presenting();
        if full_screen != self.is_full_screen {
            ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(full_screen));
            (self.is_full_screen, self.turned) = (full_screen, true);
        }
        self.follow_presentation(ctx, full_screen);
        self.follow_lesson(ctx, state.lesson.is_some());
    }

    /// Large type while a presentation or a lesson has the whole screen; that of before after it.
    fn follow_presentation(&mut self, ctx: &egui::Context, is_presenting: bool) {
        match (is_presenting, self.before_presenting) {
            (true, None) => {
                self.before_presenting = Some(ctx.zoom_factor());
                let zoom = presentation_zoom(ctx.content_rect().height() * ctx.zoom_factor());
                ctx.set_zoom_factor((zoom * ctx.zoom_factor()).min(3.0));
            }
            (false, Some(before)) => {
                self.before_presenting = None;
                ctx.set_zoom_factor(before);
            }
            _ => {}
        }
    }

    /// The size of before a lesson comes back after it.
    fn follow_lesson(&mut self, ctx: &egui::Context, is_taken: bool) {
        match (is_taken, self.before_lesson) {
            (true, None) => self.before_lesson = Some(self.before_presenting.unwrap_or_else(|| ctx.zoom_factor())),
            (false, Some(before)) => {
                self.before_lesson = None;
                // A presentation gives it back when it ends.
                match &mut self.before_presenting {
                    Some(zoom) => *zoom = before,
                    None => ctx.set_zoom_factor(before),
                }
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_presentation_grows_with_the_screen() {
        let zooms = [400.0, 900.0, 1440.0, 4320.0].map(presentation_zoom);
        assert_eq!(zooms, [1.0, 1.5, 2.4, 2.5]);
    }
}
