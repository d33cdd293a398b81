//! Scale of the interface and full screen, during a presentation or a lesson.

use crate::app::state::State;
use eframe::egui;

/// Height that a presentation is laid out for, points. A higher window scales it up.
const PRESENTATION_HEIGHT: f32 = 600.0;

/// How much larger everything is in a presentation at least and at most.
const PRESENTATION_ZOOMS: [f32; 2] = [1.0, 2.5];

/// Change of the window's height that is rounding, points: the user's own scale during a presentation stays.
const SAME_HEIGHT_POINTS: f32 = 3.0;

/// Scale of a presentation on a window of `height` points, measured at normal scale.
fn presentation_zoom(height: f32) -> f32 {
    let [least, most] = PRESENTATION_ZOOMS;
    (height / PRESENTATION_HEIGHT).clamp(least, most)
}

/// The user's scale of the interface, kept during a presentation or a lesson.
#[derive(Default)]
pub struct Zoom {
    /// Whether the window fills the screen because a presentation does.
    is_full_screen: bool,
    before_presenting: Option<f32>,
    /// Height of the window for which the presentation was scaled, points at normal scale.
    scaled_for_height: f32,
    before_lesson: Option<f32>,
    /// Whether the screen has just been filled or left: what lies under a pointer that rests is no longer what it was moved to.
    pub turned: bool,
}

impl Zoom {
    /// The user's own scale, where a presentation or a lesson changed it.
    pub fn before(&self) -> Option<f32> {
        self.before_lesson.or(self.before_presenting)
    }

    /// Adapts scale and full screen to the presentation or lesson of `state`.
    pub fn follow(&mut self, ctx: &egui::Context, state: &State) {
        let full_screen = state.is_presenting();
        if full_screen != self.is_full_screen {
            ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(full_screen));
            (self.is_full_screen, self.turned) = (full_screen, true);
        }
        self.follow_presentation(ctx, full_screen);
        self.follow_lesson(ctx, state.lesson.is_some());
    }

    /// Scales the interface up while a presentation or a lesson fills the screen, again whenever the window's height changes, and back after it.
    fn follow_presentation(&mut self, ctx: &egui::Context, is_presenting: bool) {
        let height = ctx.content_rect().height() * ctx.zoom_factor();
        match (is_presenting, self.before_presenting) {
            (true, before) if before.is_none() || (height - self.scaled_for_height).abs() > SAME_HEIGHT_POINTS => {
                let before = before.unwrap_or_else(|| ctx.zoom_factor());
                (self.before_presenting, self.scaled_for_height) = (Some(before), height);
                ctx.set_zoom_factor((presentation_zoom(height) * before).min(3.0));
            }
            (false, Some(before)) => {
                self.before_presenting = None;
                ctx.set_zoom_factor(before);
            }
            _ => {}
        }
    }

    /// Keeps the scale before a lesson and restores it after the lesson.
    fn follow_lesson(&mut self, ctx: &egui::Context, is_taken: bool) {
        match (is_taken, self.before_lesson) {
            (true, None) => self.before_lesson = Some(self.before_presenting.unwrap_or_else(|| ctx.zoom_factor())),
            (false, Some(before)) => {
                self.before_lesson = None;
                // The presentation restores the scale when it ends.
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
    fn a_presentation_follows_the_size_of_its_window() {
        let (ctx, mut zoom) = (egui::Context::default(), Zoom::default());
        let mut scale_at = |height: f32, is_presenting: bool| {
            for _ in 0..3 {
                let size = egui::vec2(1.6 * height, height) / ctx.zoom_factor();
                let screen_rect = Some(egui::Rect::from_min_size(egui::Pos2::ZERO, size));
                let input = egui::RawInput { screen_rect, ..Default::default() };
                ctx.run_ui(input, |ui| zoom.follow_presentation(ui.ctx(), is_presenting)).textures_delta.clear();
            }
            ctx.zoom_factor()
        };
        let scales = [1440.0, 640.0, 400.0, 4320.0, 900.0].map(|height| scale_at(height, true));
        let wanted = [2.4, 640.0 / 600.0, 1.0, 2.5, 1.5];
        assert_eq!(scale_at(900.0, false), 1.0, "as before the presentation");
        assert!(scales.iter().zip(wanted).all(|(scale, wanted)| (scale - wanted).abs() < 0.01), "{scales:?}");
    }
}
