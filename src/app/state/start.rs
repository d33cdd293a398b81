//! The state of a first start.

use super::{
    Arrangement, Failures, Guided, MapViews, MethodTimes, Methods, Notices, Pointer, SceneView, Settings, State,
    Timeline,
};
use crate::interact::{Document, Editor};
use crate::lesson::Progress;
use crate::reconstruct::Reconstructor;
use crate::scene::presets;
use std::sync::Arc;

impl State {
    /// The state of a first start with these methods.
    pub fn new(methods: Vec<Arc<dyn Reconstructor>>) -> State {
        State {
            editor: Editor::of(Document::shipped(presets::default_scene())),
            settings: Settings::default(),
            methods: Methods::new(methods),
            method_times: MethodTimes::default(),
            arrangement: Arrangement::default(),
            notices: Notices::default(),
            scene_view: SceneView::default(),
            map_views: MapViews::default(),
            pointer: Pointer::default(),
            pins: Vec::new(),
            guided: Guided::default(),
            save_question: None,
            failures: Failures::default(),
            lesson: None,
            before_presenting: None,
            progress: Progress::default(),
            recent: Vec::new(),
            captions: true,
            tells_first_drag: false,
            timeline: Timeline::default(),
            help: None,
            dark: false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    impl State {
        /// The state with this radar and scene, without methods.
        pub fn of(radar: crate::radar::Radar, scene: crate::scene::Scene) -> State {
            let document = Document::shipped(crate::scene::file::SceneFile { radar, scene });
            State { editor: Editor::of(document), ..State::new(Vec::new()) }
        }

        /// The state with this recording on screen, without methods.
        pub fn recorded(recording: crate::recording::Recording) -> State {
            let document = Document::of_frame(recording, std::path::Path::new("capture.cfg"));
            State { editor: Editor::of(document), ..State::new(Vec::new()) }
        }
    }
}
