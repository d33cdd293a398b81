//! The time of a scene of moving objects. The document is the scene at time 0 and is not changed. For a recording, the time of the next frame.

use crate::scene::Scene;
use std::sync::Arc;

pub const TIMELINE_SECONDS: f64 = 5.0;

/// Time and motion of the scene on screen.
#[derive(Default)]
pub struct Timeline {
    /// The document's scene, and the scene at the chosen time; `None` at time 0.
    moved: Option<(Arc<Scene>, Arc<Scene>)>,
    pub seconds: f64,
    pub is_playing: bool,
    /// Time until a recording's next frame is due, seconds.
    until_frame: f64,
}

/// Least time between frames of a playing recording, seconds; a slow file takes longer.
const FRAME_SECONDS: f64 = 0.1;
/// Ratio of the time that reading a recording's frames may take.
const READING_PART: f64 = 0.5;

impl Timeline {
    /// Sets the time of the scene. The end of the timeline stops playing.
    pub fn set(&mut self, document: &Arc<Scene>, seconds: f64) {
        self.seconds = if seconds.is_finite() { seconds.clamp(0.0, TIMELINE_SECONDS) } else { 0.0 };
        self.is_playing &= self.seconds < TIMELINE_SECONDS;
        let is_moved = self.seconds > 0.0 && document.is_moving();
        self.moved = is_moved.then(|| (document.clone(), Arc::new(document.at(self.seconds))));
    }

    /// Plays the scene's motion, from the beginning where it is at its end, or stops it.
    pub fn play(&mut self, document: &Arc<Scene>, is_playing: bool) {
        if is_playing && self.seconds >= TIMELINE_SECONDS {
            self.set(document, 0.0);
        }
        self.is_playing = is_playing;
    }

    /// Whether a recording's next frame is due, `step` seconds after the last call.
    pub fn is_frame_due(&mut self, step: f64) -> bool {
        self.until_frame -= step;
        self.until_frame <= 0.0
    }

    /// Notes that a recording's frame took `seconds` to read, which delays the next one.
    pub fn frame_took(&mut self, seconds: f64) {
        self.until_frame = FRAME_SECONDS.max(seconds / READING_PART);
    }

    /// Plays a recording's frames, or stops them.
    pub fn play_frames(&mut self, is_playing: bool) {
        (self.is_playing, self.until_frame) = (is_playing, 0.0);
    }

    /// Returns to time 0 where the document's scene has changed since the time was set.
    pub fn follow(&mut self, document: &Arc<Scene>) {
        if self.moved.as_ref().is_some_and(|(of, _)| !Arc::ptr_eq(of, document)) {
            *self = Timeline::default();
        }
    }

    /// The scene at the chosen time; at time 0 the document's own.
    pub fn scene<'a>(&'a self, document: &'a Arc<Scene>) -> &'a Arc<Scene> {
        match &self.moved {
            Some((of, moved)) if Arc::ptr_eq(of, document) => moved,
            _ => document,
        }
    }

    /// The scene at the chosen time, where it isn't the document's.
    pub fn moved(&self) -> Option<Arc<Scene>> {
        self.moved.as_ref().map(|(_, moved)| moved.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Object, Point};

    #[test]
    fn a_slow_frame_delays_the_one_after_it() {
        let mut timeline = Timeline::default();
        timeline.play_frames(true);
        assert!(timeline.is_frame_due(0.0));
        timeline.frame_took(0.01);
        assert!(!timeline.is_frame_due(0.09) && timeline.is_frame_due(0.02));
        timeline.frame_took(0.3);
        assert!(!timeline.is_frame_due(0.5) && timeline.is_frame_due(0.11));
    }

    fn scene() -> Arc<Scene> {
        let point = Point { velocity_x_metres_per_second: 2.0, ..Point::new(1.0, 9.0) };
        Arc::new(Scene { objects: vec![Object::Point(point)], ..Scene::default() })
    }

    #[test]
    fn the_document_is_the_scene_at_time_0() {
        let (document, mut timeline) = (scene(), Timeline::default());
        assert!(Arc::ptr_eq(timeline.scene(&document), &document));
        timeline.set(&document, 1.5);
        assert_eq!(timeline.scene(&document).objects[0].anchor_metres(), [4.0, 9.0]);
        assert_eq!(document.objects[0].anchor_metres(), [1.0, 9.0]);
        timeline.set(&document, f64::NAN);
        assert!(Arc::ptr_eq(timeline.scene(&document), &document) && timeline.moved().is_none());
    }

    #[test]
    fn a_change_of_the_scene_goes_back_to_time_0() {
        let (document, mut timeline) = (scene(), Timeline::default());
        timeline.set(&document, 1.5);
        timeline.play(&document, true);
        timeline.follow(&document);
        assert_eq!(timeline.seconds, 1.5);
        let edited = scene();
        assert!(Arc::ptr_eq(timeline.scene(&edited), &edited));
        timeline.follow(&edited);
        assert_eq!((timeline.seconds, timeline.is_playing), (0.0, false));
    }

    #[test]
    fn what_plays_stops_at_the_end_and_plays_from_the_beginning() {
        let (document, mut timeline) = (scene(), Timeline::default());
        timeline.play(&document, true);
        timeline.set(&document, 99.0);
        assert_eq!((timeline.seconds, timeline.is_playing), (TIMELINE_SECONDS, false));
        timeline.play(&document, true);
        assert_eq!((timeline.seconds, timeline.is_playing), (0.0, true));
    }
}
