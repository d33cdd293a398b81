//! The type of a panel: its query, its memory and its drawing.

use super::jobs::{Derived, Failure, Jobs, Query, Want};
use super::state::{Command, MapKind, Panel, State};
use crate::task::Task;
use eframe::egui::Ui;

/// A type of panel: its memory between frames is an `M`, its own value that of the query `Q`. A panel's file has one as `PANEL`;
/// [`every_panel`](super) has its line.
pub struct Content<M = (), Q: Query = Nothing> {
    /// The maps and methods that the panel reads, which are computed for all panels.
    pub wants: &'static [Want],
    /// Whether the panel marks old values itself; otherwise it is dimmed as a whole.
    pub marks_age: bool,
    /// Whether the panel shows answers to a lesson's questions. It is hidden until the learner has predicted.
    pub tells_answers: bool,
    /// The query of the panel's value, asked while the panel is in sight.
    pub asks: fn(&State, &Jobs) -> Option<Q>,
    /// Text in the title bar beside the panel's name, from its longest form to its shortest.
    pub caption: fn(&State, &Jobs, Panel) -> Vec<String>,
    /// Draws the panel; returns the user's commands.
    pub show: fn(&mut Ui, Cx<'_, M, Q>) -> Vec<Command>,
}

impl<M> Content<M> {
    /// A panel without a value of its own.
    pub const fn drawn(show: fn(&mut Ui, Cx<'_, M>) -> Vec<Command>) -> Self {
        Content::computed(|_, _| None, show)
    }
}

impl<M, Q: Query> Content<M, Q> {
    /// A panel with a value that a thread of its own computes.
    pub const fn computed(
        asks: fn(&State, &Jobs) -> Option<Q>,
        show: fn(&mut Ui, Cx<'_, M, Q>) -> Vec<Command>,
    ) -> Self {
        Content { wants: &[], marks_age: false, tells_answers: false, asks, caption: |_, _, _| Vec::new(), show }
    }
}

/// The data that a panel is drawn from.
pub struct Cx<'a, M = (), Q: Query = Nothing> {
    /// The panel that is drawn: all maps are one type.
    pub panel: Panel,
    pub state: &'a mut State,
    /// Results computed for all panels.
    pub jobs: &'a Jobs,
    pub memory: &'a mut M,
    /// The panel's own value, or the reason why there is none; `None` before the first.
    pub value: Option<Result<&'a Q::Value, &'a str>>,
}

/// The query of a panel without a value of its own.
#[derive(Debug, Clone, PartialEq)]
pub enum Nothing {}

impl Query for Nothing {
    type Value = ();
    type State = ();
    const WHAT: &'static str = "Computing nothing";

    fn compute(&self, (): &mut (), _: &Task) -> Result<(), Failure> {
        match *self {}
    }
}

/// A panel with its memory and its computed value.
pub struct Held<M, Q: Query> {
    content: Content<M, Q>,
    memory: M,
    pub derived: Derived<Q>,
}

impl<M: Default + 'static, Q: Query> Held<M, Q> {
    /// Starts the worker of the value, idle at first; `wake` is called from its thread.
    pub fn start(content: Content<M, Q>, wake: impl Fn() + Send + Sync + 'static) -> Box<dyn AnyPanel> {
        Box::new(Held { content, memory: M::default(), derived: Derived::start(wake) })
    }
}

pub trait AnyPanel: std::any::Any {
    fn wants(&self) -> &'static [Want];

    /// Asks for the panel's value where the panel is in sight; asks for none elsewhere.
    fn ask(&mut self, state: &State, jobs: &Jobs, is_in_sight: bool);

    /// Takes in the panel's own value. Returns a message for the user.
    fn poll(&mut self) -> Option<String>;

    fn is_busy(&self) -> bool;

    /// Values asked for since the start.
    fn requests(&self) -> u64;

    /// Whether the panel has drawn results of an earlier scene or settings for so long that it must be marked. Only this function decides it.
    fn is_stale(&self, jobs: &Jobs, panel: Panel) -> bool;

    /// Whether the panel draws results of an earlier scene or settings without marking them.
    fn is_fresh_but_old(&self, state: &State, jobs: &Jobs) -> bool;

    fn caption(&self, state: &State, jobs: &Jobs, panel: Panel) -> Vec<String>;

    fn draw(&mut self, ui: &mut Ui, state: &mut State, jobs: &Jobs, panel: Panel) -> Vec<Command>;
}

/// Opacity of an old panel.
pub const OLD_PANEL_OPACITY: f32 = 0.55;

impl<M: 'static, Q: Query> AnyPanel for Held<M, Q> {
    fn wants(&self) -> &'static [Want] {
        self.content.wants
    }

    fn ask(&mut self, state: &State, jobs: &Jobs, is_in_sight: bool) {
        self.derived.ask(is_in_sight.then(|| (self.content.asks)(state, jobs)).flatten());
    }

    fn poll(&mut self) -> Option<String> {
        self.derived.poll()
    }

    fn is_busy(&self) -> bool {
        self.derived.is_busy()
    }

    fn requests(&self) -> u64 {
        self.derived.requests()
    }

    fn is_stale(&self, jobs: &Jobs, panel: Panel) -> bool {
        let is_old = |kind| jobs.pipeline.is_stale(kind);
        match panel {
            Panel::Map(kind) => is_old(kind),
            _ => {
                self.derived.is_stale()
                    || (self.content.wants.contains(&Want::Output) && is_old(MapKind::Output))
                    || (self.content.wants.contains(&Want::Second) && is_old(MapKind::Second))
            }
        }
    }

    fn is_fresh_but_old(&self, state: &State, jobs: &Jobs) -> bool {
        self.derived.is_fresh_but_old((self.content.asks)(state, jobs).as_ref())
    }

    fn caption(&self, state: &State, jobs: &Jobs, panel: Panel) -> Vec<String> {
        (self.content.caption)(state, jobs, panel)
    }

    fn draw(&mut self, ui: &mut Ui, state: &mut State, jobs: &Jobs, panel: Panel) -> Vec<Command> {
        if self.content.tells_answers && state.is_predicting() {
            ui.centered_and_justified(|ui| ui.weak("Hidden until you have predicted."));
            return Vec::new();
        }
        if !self.content.marks_age && self.is_stale(jobs, panel) {
            ui.multiply_opacity(OLD_PANEL_OPACITY);
        }
        let Held { content, memory, derived } = self;
        (content.show)(ui, Cx { panel, state, jobs, memory, value: derived.value() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shared::Shared;
    use crate::app::state::EditCommand;
    use crate::app::widgets::seen::{Harness, Queryable, User};
    use crate::app::{App, Options};
    use crate::scene::Scene;

    /// The scene whose reflectors are counted.
    #[derive(Clone, PartialEq)]
    struct Counted(Shared<Scene>);

    impl Query for Counted {
        type Value = usize;
        type State = ();
        const WHAT: &'static str = "Counting";

        fn compute(&self, (): &mut (), _: &Task) -> Result<usize, Failure> {
            Ok(self.0.reflector_count())
        }
    }

    /// The panel of ARCHITECTURE, with a count of reflectors and a button.
    const PANEL: Content<(), Counted> = Content::computed(|state, _| Some(Counted(state.scene().into())), show);

    fn show(ui: &mut Ui, cx: Cx<'_, (), Counted>) -> Vec<Command> {
        if let Some(Ok(count)) = cx.value {
            ui.label(format!("{count} reflectors"));
        }
        let is_clicked = ui.button("Select all").clicked();
        is_clicked.then(|| EditCommand::SelectAll.into()).into_iter().collect()
    }

    #[test]
    fn a_small_panel_draws_its_value_and_answers_with_commands() {
        let app = Harness::builder().build_eframe(|creation| App::new(creation, Options::default()).unwrap());
        let count = app.state().editor.scene().reflector_count();
        let draw = |ui: &mut Ui, (app, held, asked): &mut (Harness<'_, App>, Box<dyn AnyPanel>, Vec<Command>)| {
            let App { state, jobs, .. } = app.state_mut();
            held.ask(state, jobs, true);
            held.poll();
            asked.extend(held.draw(ui, state, jobs, Panel::Guide));
        };
        let held = Held::start(PANEL, || ());
        let mut drawn = Harness::new_ui_state(draw, (app, held, Vec::new()));
        while drawn.state().1.is_busy() {
            std::thread::yield_now();
        }
        drawn.run();
        drawn.get_by_label(&format!("{count} reflectors"));
        drawn.clicks(&["Select all"]);
        assert_eq!(drawn.state().2, [Command::from(EditCommand::SelectAll)]);
    }
}
