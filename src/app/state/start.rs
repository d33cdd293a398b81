//! The state of a first start.

use super::{Methods, State};
use crate::interact::{Document, Editor};
use crate::reconstruct::Reconstructor;
use crate::scene::presets;
use std::sync::Arc;

impl State {
    pub fn new(methods: Vec<Arc<dyn Reconstructor>>) -> State {
        let editor = Editor::of(Document::shipped(presets::default_scene()));
        State { editor, methods: Methods::new(methods), captions: true, ..State::default() }
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
