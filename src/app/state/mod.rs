//! State of the app without drawing and without work: the scene, the user's settings, the arrangement, and every command.

#[macro_use]
mod named;

mod arrangement;
mod card;
mod command;
mod command_table;
mod cuts;
mod failures;
mod guided;
mod help;
pub mod lesson_focus;
mod lesson_run;
pub mod menus;
mod method_times;
mod methods;
mod notices;
mod page_commands;
mod panel;
mod room;
mod save_question;
mod settings;
mod several;
mod start;
mod synonyms;
mod task_layouts;
mod timeline;
mod toggles;
mod view;

pub use crate::view::{DifferenceView, Directions, Projection, Units, View};
pub use arrangement::Arrangement;
pub use card::{CardPlan, LiveFrame};
pub use command::{
    Command, DocumentCommand, EditCommand, ExportCommand, LessonCommand, NewObject, Purpose, PurposeFacts,
    RadarCommand, RowsCommand, ViewCommand, Way, WindowCommand, WorkCommand,
};
pub use command_table::{Entry, listed, listed_on_a_page, shortcuts};
pub use cuts::{CutMap, PinnedCut, pin_cut};
pub use failures::{Conditions, FailureChoice, Failures, OpenedRow};
pub use guided::{Guided, Setup};
pub use help::HelpPage;
use lesson_focus::{control_of, map_of};
pub use lesson_run::{Before, LessonRun};
pub use menus::menu_path;
pub use method_times::MethodTimes;
pub use methods::Methods;
pub use notices::{Notice, Notices};
pub use panel::{MapKind, MethodSlot, Panel};
pub use save_question::{Doubt, SaveAnswer, SaveQuestion};
pub use settings::{BoundsSettings, ChirpSettings, Compare, Elements, Layout, PhasorMap, PhasorSettings, Settings};
pub use several::{MAX_MAPS as MAX_MAPS_AT_ONCE, Parameter, Several, Variant};
pub use synonyms::synonyms;
pub use task_layouts::Task;
pub use timeline::{TIMELINE_SECONDS, Timeline};
pub use view::{Cursor, MapView, MapViews, Pointer, SceneView};

use crate::interact::{Document, Editor};
use crate::lesson::{Progress, Uses};
use crate::platform::fs;
use crate::radar::{BuiltArray, Radar};
use crate::reconstruct::Reconstructor;
use crate::scene::Scene;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Most recent files in the list.
const MAX_RECENT_FILES: usize = 10;

/// All state that commands change.
#[derive(Default)]
pub struct State {
    /// The document in the editor: scene, radar and file.
    pub editor: Editor,
    pub settings: Settings,
    pub methods: Methods,
    pub method_times: MethodTimes,
    pub arrangement: Arrangement,
    pub notices: Notices,
    pub scene_view: SceneView,
    pub map_views: MapViews,
    pub pointer: Pointer,
    pub pins: Vec<PinnedCut>,
    pub guided: Guided,
    /// The question before a scene is written to a file that can't hold all of it or was changed.
    pub save_question: Option<SaveQuestion>,
    /// The opened row and the rows in sight.
    pub failures: Failures,
    pub lesson: Option<LessonRun>,
    /// The arrangement before a lesson or a presentation took the whole screen.
    pub before_presenting: Option<Arrangement>,
    pub progress: Progress,
    /// Files opened or saved lately, latest first.
    pub recent: Vec<PathBuf>,
    /// Whether maps and scene have captions, until the first drag.
    pub captions: bool,
    /// Whether the scene explains the first drag.
    pub tells_first_drag: bool,
    /// The time of the scene, and of the recording's next frame.
    pub timeline: Timeline,
    pub help: Option<HelpPage>,
    pub dark: bool,
}

impl State {
    /// Whether a recording takes the place of the scene's echoes.
    pub fn is_recorded(&self) -> bool {
        self.editor.document().recording().is_some()
    }

    /// Opens another document; undo brings the last one back with its file.
    pub fn set_document(&mut self, document: Document) {
        self.editor.open(document);
        self.scene_view.fit = true;
    }

    /// The row whose scene is on screen, edited or not.
    pub fn row_on_screen(&self) -> Option<&OpenedRow> {
        self.failures.opened.as_ref().filter(|opened| opened.document == self.editor.document().id())
    }

    /// Whether maps are hidden, since a lesson asks for a prediction.
    pub fn is_predicting(&self) -> bool {
        self.lesson.as_ref().is_some_and(LessonRun::is_predicting)
    }

    /// Whether axes and rings have ranges and directions. During a prediction they have them only where a place is asked for: they would tell other answers.
    pub fn shows_axes(&self) -> bool {
        !self.is_predicting() || self.lesson.as_ref().is_some_and(|run| run.clicked_map().is_some())
    }

    /// The parts of the window that the lesson uses; all without a lesson.
    pub fn uses(&self) -> Uses {
        self.lesson.as_ref().map_or(Uses::ALL, |run| run.lesson.uses())
    }

    /// Whether a lesson has the whole screen, and not a presentation of the scene.
    pub fn presents_lesson(&self) -> bool {
        self.is_presenting() && self.arrangement.is_open(Panel::Lesson)
    }

    /// Closes the panels that the lesson doesn't use.
    pub fn close_unused(&mut self) {
        let uses = self.uses();
        let presents_lesson = self.presents_lesson();
        let Some(run) = &mut self.lesson else { return };
        if let Some(before) = &mut self.before_presenting {
            run.closed.extend(before.close_unused(uses));
            if presents_lesson {
                self.arrangement = Arrangement::of_a_lesson();
                self.arrangement.close_unused(uses);
            }
        } else {
            run.closed.extend(self.arrangement.close_unused(uses));
        }
    }

    /// Switches to the panels of a task, without those that the lesson doesn't use.
    pub fn arrange_for(&mut self, task: Task) {
        self.stop_presenting();
        if let Some(run) = &mut self.lesson {
            self.arrangement.open_again(&std::mem::take(&mut run.closed));
        }
        self.arrangement.switch(task);
        self.close_unused();
    }

    /// The pointer's place, as every panel shows it. It is `None` during a prediction, since its place in one panel would tell the answer in another.
    pub fn shown_cursor(&self) -> Option<Cursor> {
        self.pointer.now.filter(|_| !self.is_predicting())
    }

    /// Whether a lesson or a presentation has the whole screen.
    pub fn is_presenting(&self) -> bool {
        self.before_presenting.is_some()
    }

    /// Gives the lesson the whole screen, or ends that.
    pub fn present_lesson(&mut self) {
        let uses = self.uses();
        let run = self.lesson.as_ref();
        let map = run.and_then(LessonRun::current).map(map_of);
        let control = run.filter(|run| !run.is_predicting()).and_then(LessonRun::current).and_then(control_of);
        self.present_as(|| {
            let mut arrangement = Arrangement::of_a_lesson();
            arrangement.close_unused(uses);
            map.into_iter().for_each(|map| arrangement.put_large(map));
            control.into_iter().for_each(|(panel, _)| arrangement.set_open(panel, true));
            arrangement
        });
    }

    /// Gives the scene and the maps the whole screen in large type, or ends a presentation or a lesson on the whole screen.
    pub fn present(&mut self) {
        self.present_as(Arrangement::presentation);
    }

    fn present_as(&mut self, arrangement: impl FnOnce() -> Arrangement) {
        if !self.stop_presenting() {
            self.before_presenting = Some(std::mem::replace(&mut self.arrangement, arrangement()));
        }
    }

    /// Restores the arrangement before a lesson or a presentation took the whole screen; true where one had.
    pub fn stop_presenting(&mut self) -> bool {
        let before = self.before_presenting.take();
        let is_presented = before.is_some();
        before.into_iter().for_each(|before| self.arrangement = before);
        is_presented
    }

    /// The arrangement to keep for the next start.
    pub fn kept_arrangement(&mut self) -> &mut Arrangement {
        self.before_presenting.as_mut().unwrap_or(&mut self.arrangement)
    }

    pub fn radar(&self) -> &Radar {
        self.editor.radar()
    }

    /// The radar's elements as they are built.
    pub fn elements(&self) -> &BuiltArray {
        &self.editor.scene().disturbances.elements
    }

    /// The document's scene at the timeline's time.
    pub fn scene(&self) -> &Arc<Scene> {
        self.timeline.scene(self.editor.scene())
    }

    /// Number of the recording's frame on screen, from 0, and the count of frames; `None` where it has one.
    pub fn frames(&self) -> Option<[u64; 2]> {
        let origin = self.editor.document().recording()?.origin.as_ref()?;
        (origin.frames > 1).then_some([origin.frame, origin.frames])
    }

    pub fn setup(&self) -> Setup {
        Setup {
            view: self.settings.view.clone(),
            radar: self.radar().clone(),
            scene: self.editor.scene().clone(),
            depth: self.editor.history().depth(),
        }
    }

    pub fn can_undo(&self) -> bool {
        // Undo does not leave a lesson's step.
        let is_left = self.lesson.as_ref().is_none_or(|run| self.editor.history().depth() > run.depth);
        is_left && (self.editor.history().depth() > 0 || self.guided.can_undo(&self.setup()))
    }

    pub fn can_redo(&self) -> bool {
        self.editor.history().can_redo()
    }

    /// Undoes the last change of the scene, or all changes of a button of the guide.
    pub fn undo(&mut self) {
        if !self.can_undo() {
            return;
        }
        let Some(step) = self.guided.undo(&self.setup()) else {
            self.editor.undo();
            return;
        };
        while self.editor.history().depth() > step.before.depth && self.editor.undo() {}
        self.settings.take_back(&step.before.view, &step.after.view);
    }

    pub fn redo(&mut self) {
        let Some(step) = self.guided.redo(&self.setup()) else {
            self.editor.redo();
            return;
        };
        while self.editor.history().depth() < step.after.depth && self.editor.redo() {}
        self.settings.take_back(&step.after.view, &step.before.view);
    }

    /// Adds a file to the recent ones.
    pub fn remember(&mut self, path: &Path) {
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path);
        self.recent.truncate(MAX_RECENT_FILES);
    }

    pub fn title(&self) -> String {
        format!("{} — apertura", self.editor.document().title())
    }

    pub fn method(&self) -> Option<&Arc<dyn Reconstructor>> {
        self.methods.named(&self.settings.method)
    }

    /// Whether the method in use finds places of echoes; some only make a map.
    pub fn finds_reflectors(&self) -> bool {
        self.method().is_some_and(|method| method.finds_reflectors())
    }

    pub fn method_in(&self, slot: MethodSlot) -> Option<&Arc<dyn Reconstructor>> {
        match slot {
            MethodSlot::First => self.method(),
            MethodSlot::Second => {
                self.methods.second_to(self.method().map(|m| m.name()), &self.settings.compare.second)
            }
        }
    }

    /// eta of a slot's method: the user's, else that of the `answer` on screen, else the method's own.
    pub fn eta_in(&self, slot: MethodSlot, answer: Option<f32>) -> f32 {
        let Some(method) = self.method_in(slot) else { return crate::evaluate::TARGET_ETA };
        self.settings.method_eta.get(method.name()).copied().or(answer).unwrap_or_else(|| method.eta())
    }

    /// Whether reflectors found by the method are drawn: over a recording always.
    pub fn draws_found(&self) -> bool {
        !self.is_predicting() && (self.is_recorded() || (self.settings.show_found && self.finds_reflectors()))
    }

    /// Whether a panel in sight marks results of the method's output, which must then be made.
    pub fn marks_output(&self) -> bool {
        let shown = self.arrangement.shown();
        let marks_found = self.draws_found() && shown.contains(&Panel::Scene);
        let marks_kinds = self.settings.show_kinds && !self.is_predicting();
        let told = self.row_on_screen().is_some() && shown.contains(&Panel::Failures);
        told || marks_found || (marks_kinds && self.pictured().contains(&MapKind::Target))
    }

    /// The maps drawn by panels in sight.
    pub fn pictured(&self) -> BTreeSet<MapKind> {
        let shown = self.arrangement.shown();
        let own = shown.iter().filter_map(|panel| if let Panel::Map(kind) = panel { Some(*kind) } else { None });
        let compared = shown.contains(&Panel::Compare).then(|| self.settings.compare.maps());
        own.chain(compared.into_iter().flatten()).collect()
    }

    /// The cursor of cuts: the pointer's place, else its last one, else the first object's centre.
    pub fn cut_cursor(&self) -> Cursor {
        let first =
            || self.editor.scene().objects.first().map(|o| Cursor::at_place(self.radar(), o.centre_metres().into()));
        let inside = |c: &Cursor| c.cell(self.radar()).is_some();
        let last = self.pointer.last.or_else(first).filter(inside);
        last.unwrap_or_else(|| Cursor::at_cell(self.radar(), 0.0, 0.0))
    }
}
