//! What the app holds, without any drawing and without any work: the scene, what the user chose, where the panels are, and every
//! command by name.

#[macro_use]
mod named;

mod arrangement;
mod bounds_settings;
mod card;
mod chirp_settings;
mod command;
mod command_table;
mod compare;
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
mod phasor_settings;
mod room;
mod save_question;
mod settings;
mod several;
mod synonyms;
mod task_layouts;
mod timeline;
mod toggles;
mod view;

pub use crate::view::{DifferenceView, Directions, Projection, Units, View};
pub use arrangement::Arrangement;
pub use bounds_settings::{BoundsSettings, Elements};
pub use card::{CardPlan, LiveFrame};
pub use chirp_settings::ChirpSettings;
pub use command::{
    Command, DocumentCommand, EditCommand, ExportCommand, LessonCommand, NewObject, Purpose, RadarCommand, RowsCommand,
    ThresholdChoice, ViewCommand, Way, WindowCommand, WorkCommand,
};
pub use command_table::{Entry, listed, listed_on_a_page, shortcuts};
pub use compare::{Compare, Layout};
pub use cuts::{CutMap, PinnedCut, Pins};
pub use failures::{Conditions, FailureChoice, Failures, OpenedRow, SearchChoice};
pub use guided::{Guided, Setup};
pub use help::HelpPage;
pub use lesson_run::{Before, LessonRun};
pub use menus::menu_path;
pub use method_times::{MethodTimes, Times};
pub use methods::Methods;
pub use notices::{Notice, NoticeKind, Notices};
pub use panel::{MapKind, MethodSlot, Panel};
pub use phasor_settings::{PhasorMap, PhasorSettings};
pub use save_question::{Doubt, SaveAnswer, SaveQuestion};
pub use settings::{Brightness, Settings};
pub use several::{MAX_MAPS as MAX_MAPS_AT_ONCE, Parameter, Several, Variant};
pub use synonyms::synonyms;
pub use task_layouts::Task;
pub use timeline::{TIMELINE_SECONDS, Timeline};
pub use view::{Cursor, MapView, MapViews, Pointer, SceneView};

use crate::interact::{Document, Editor};
use crate::lesson::{Progress, Uses};
use crate::platform::fs;
use crate::radar::Radar;
use crate::reconstruct::Reconstructor;
use crate::scene::Scene;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// How many recent files are remembered.
const RECENT: usize = 10;

/// Everything that commands change.
pub struct State {
    /// The document being edited: the scene, the radar before it, and the file they are kept in.
    pub editor: Editor,
    /// What the user chose.
    pub settings: Settings,
    /// The reconstruction methods.
    pub methods: Methods,
    /// How long each method takes on this machine.
    pub method_times: MethodTimes,
    /// Where the panels are.
    pub arrangement: Arrangement,
    /// Messages on screen.
    pub notices: Notices,
    /// What part of the scene is shown.
    pub scene_view: SceneView,
    /// What part of the maps is shown.
    pub map_views: MapViews,
    /// Where the pointer is.
    pub pointer: Pointer,
    /// Cuts that stay.
    pub pins: Pins,
    /// What the guide did.
    pub guided: Guided,
    /// A file that can't hold all of the scene, if it is to be written.
    pub save_question: Option<SaveQuestion>,
    /// Rows: which is open, which are in sight.
    pub failures: Failures,
    /// The lesson being taken.
    pub lesson: Option<LessonRun>,
    /// Where the panels were before a lesson or a presentation took the whole screen.
    pub before_presenting: Option<Arrangement>,
    /// Who has answered what.
    pub progress: Progress,
    /// Files opened or saved lately, latest first.
    pub recent: Vec<PathBuf>,
    /// Whether maps and scene say what they show, until the first drag.
    pub captions: bool,
    /// Whether the scene says what the first drag did.
    pub tells_first_drag: bool,
    /// The time at which the scene is looked at.
    pub timeline: Timeline,
    /// The page of help that is open.
    pub help: Option<HelpPage>,
    /// Whether the window is dark at the moment.
    pub dark: bool,
}

impl State {
    /// Puts another document on screen; undo brings the last one back, its file and all.
    pub fn set_document(&mut self, label: &str, document: Document) {
        self.editor.open(label, document);
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

    /// Whether axes and rings tell ranges and directions: while a prediction is asked for only where a place is asked for, since they
    /// tell some of the answers otherwise.
    pub fn shows_axes(&self) -> bool {
        !self.is_predicting() || self.lesson.as_ref().is_some_and(|run| run.clicked_map().is_some())
    }

    /// What the lesson being taken uses of the window; everything without one.
    pub fn uses(&self) -> Uses {
        self.lesson.as_ref().map_or(Uses::ALL, |run| run.lesson.uses())
    }

    /// Whether a lesson has the whole screen, as against a presentation of the scene.
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

    /// Arranges the panels for a task; those that the lesson doesn't use are closed there too.
    pub fn arrange_for(&mut self, task: Task) {
        self.stop_presenting();
        if let Some(run) = &mut self.lesson {
            self.arrangement.open_again(&std::mem::take(&mut run.closed));
        }
        self.arrangement.switch(task);
        self.close_unused();
    }

    /// Where the pointer is, as every panel shows it: none does while a prediction is asked for, since what is under it in one is the
    /// answer in another.
    pub fn shown_cursor(&self) -> Option<Cursor> {
        self.pointer.now.filter(|_| !self.is_predicting())
    }

    /// Whether a lesson or a presentation has the whole screen.
    pub fn is_presenting(&self) -> bool {
        self.before_presenting.is_some()
    }

    /// Gives lessons the whole screen, or ends that.
    pub fn present_lesson(&mut self) {
        match self.is_presenting() {
            true => self.stop_presenting(),
            false => {
                let uses = self.uses();
                let before = std::mem::replace(&mut self.arrangement, Arrangement::of_a_lesson());
                self.arrangement.close_unused(uses);
                self.before_presenting = Some(before);
            }
        }
    }

    /// Gives the scene and the maps the whole screen, in large type, or takes it from what has it.
    pub fn present(&mut self) {
        match self.is_presenting() {
            true => self.stop_presenting(),
            false => {
                let before = std::mem::replace(&mut self.arrangement, Arrangement::presentation());
                self.before_presenting = Some(before);
            }
        }
    }

    /// Puts the panels back to where they were before a lesson or a presentation had the whole screen.
    pub fn stop_presenting(&mut self) {
        if let Some(before) = self.before_presenting.take() {
            self.arrangement = before;
        }
    }

    /// Where the panels are to be at the next start.
    pub fn kept_arrangement(&mut self) -> &mut Arrangement {
        self.before_presenting.as_mut().unwrap_or(&mut self.arrangement)
    }

    /// The radar before the scene.
    pub fn radar(&self) -> &Radar {
        self.editor.radar()
    }

    /// The scene that is looked at: the document's, moved to the time that was chosen.
    pub fn scene(&self) -> &Arc<Scene> {
        self.timeline.scene(self.editor.scene())
    }

    /// Which frame of the recording on screen is looked at, and how many it has; `None` where it has one.
    pub fn frames(&self) -> Option<[u64; 2]> {
        let origin = self.editor.document().recording()?.origin.as_ref()?;
        (origin.frames > 1).then_some([origin.frame, origin.frames])
    }

    /// Everything that the guide may change, as it is.
    pub fn setup(&self) -> Setup {
        Setup {
            view: self.settings.view.clone(),
            radar: self.radar().clone(),
            scene: self.editor.scene().clone(),
            depth: self.editor.history().depth(),
        }
    }

    /// Whether there is something to undo.
    pub fn can_undo(&self) -> bool {
        // A lesson's step stays on screen.
        let is_left = self.lesson.as_ref().is_none_or(|run| self.editor.history().depth() > run.depth);
        is_left && (self.editor.history().undo_label().is_some() || self.guided.can_undo(&self.setup()))
    }

    /// Undoes the last change of the scene, or all that a button of the guide did.
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

    /// Does again what was undone last.
    pub fn redo(&mut self) {
        let Some(step) = self.guided.redo(&self.setup()) else {
            self.editor.redo();
            return;
        };
        while self.editor.history().depth() < step.after.depth && self.editor.redo() {}
        self.settings.take_back(&step.after.view, &step.before.view);
    }

    /// Puts a file among the recent ones.
    pub fn remember(&mut self, path: &Path) {
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|p| *p != path);
        self.recent.insert(0, path);
        self.recent.truncate(RECENT);
    }

    /// Title of the window.
    pub fn title(&self) -> String {
        format!("{} — apertura", self.editor.document().title())
    }

    /// The method in use.
    pub fn method(&self) -> Option<&Arc<dyn Reconstructor>> {
        self.methods.named(&self.settings.method)
    }

    /// Whether the method in use finds places of echoes; some only draw a map.
    pub fn finds_reflectors(&self) -> bool {
        self.method().is_some_and(|method| method.finds_reflectors())
    }

    /// The method that the panel "Compare" sets beside it: the one that was chosen, or a plain one, or any other.
    pub fn second_method(&self) -> Option<&Arc<dyn Reconstructor>> {
        let first = self.method().map(|m| m.name());
        self.methods.second_to(first, &self.settings.compare.second)
    }

    /// Either of the two.
    pub fn method_in(&self, slot: MethodSlot) -> Option<&Arc<dyn Reconstructor>> {
        match slot {
            MethodSlot::First => self.method(),
            MethodSlot::Second => self.second_method(),
        }
    }

    /// eta of either of the two methods: the user's, or what fits the `answer` on screen, or the method's own.
    pub fn eta_in(&self, slot: MethodSlot, answer: Option<f32>) -> f32 {
        let Some(method) = self.method_in(slot) else { return crate::evaluate::TARGET_ETA };
        self.settings.method_eta.get(method.name()).copied().or(answer).unwrap_or_else(|| method.eta())
    }

    /// Whether places where the method found something are drawn: over a recording always.
    pub fn draws_found(&self) -> bool {
        let is_recorded = self.editor.document().recording().is_some();
        !self.is_predicting() && (is_recorded || (self.settings.show_found && self.finds_reflectors()))
    }

    /// Whether a panel in sight marks something of the method's output, which it then needs as if it drew the output.
    pub fn marks_output(&self) -> bool {
        let shown = self.arrangement.shown();
        let marks_found = self.draws_found() && shown.contains(&Panel::Scene);
        let marks_kinds = self.settings.show_kinds && !self.is_predicting();
        let told = self.row_on_screen().is_some() && shown.contains(&Panel::Failures);
        told || marks_found || (marks_kinds && self.pictured().contains(&MapKind::Target))
    }

    /// The maps that a panel in sight draws.
    pub fn pictured(&self) -> BTreeSet<MapKind> {
        let shown = self.arrangement.shown();
        let own = shown.iter().filter_map(|panel| if let Panel::Map(kind) = panel { Some(*kind) } else { None });
        let compared = shown.contains(&Panel::Compare).then(|| self.settings.compare.maps());
        own.chain(compared.into_iter().flatten()).collect()
    }

    /// Where cuts are taken: under the pointer, where it was last, or through the first object.
    pub fn cut_cursor(&self) -> Cursor {
        let first =
            || self.editor.scene().objects.first().map(|o| Cursor::at_place(self.radar(), o.centre_metres().into()));
        let inside = |c: &Cursor| c.cell(self.radar()).is_some();
        let last = self.pointer.last().or_else(first).filter(inside);
        last.unwrap_or_else(|| Cursor::at_cell(self.radar(), 0.0, 0.0))
    }
}
