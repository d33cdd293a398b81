//! The trait of a panel: its query, its memory and its drawing.

use super::jobs::{Derived, Failure, Jobs, Query, Wants};
use super::state::{Command, MapKind, Panel, State};
use crate::task::Task;
use eframe::egui::Ui;

/// A type of panel. A panel's own file implements the trait; [`every_panel`](super) has its line.
pub trait Content: 'static {
    /// The query of a value for this panel alone; [`Nothing`] where it has none.
    type Asks: Query;
    /// The panel's state between frames.
    type Remembers: Default + 'static;
    /// The maps and methods that the panel reads, which are computed for all panels.
    const WANTS: Wants = Wants::NOTHING;
    /// Whether the panel marks old values itself; otherwise it is dimmed as a whole.
    const MARKS_AGE: bool = false;
    /// Whether the panel shows answers to a lesson's questions. It is hidden until the learner has predicted.
    const TELLS_ANSWERS: bool = false;

    /// The query of the panel's value, asked while the panel is in sight.
    fn asks(_state: &State, _jobs: &Jobs) -> Option<Self::Asks> {
        None
    }

    /// Text in the title bar beside the panel's name.
    fn caption(_state: &State, _jobs: &Jobs, _panel: Panel) -> Option<String> {
        None
    }

    /// Draws the panel; returns the user's commands.
    fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command>;
}

/// The data that a panel is drawn from.
pub struct Cx<'a, C: Content + ?Sized> {
    /// The panel that is drawn: all maps are one type.
    pub panel: Panel,
    pub state: &'a mut State,
    /// Results computed for all panels.
    pub jobs: &'a Jobs,
    pub memory: &'a mut C::Remembers,
    /// The panel's own value, or the reason why there is none; `None` before the first.
    pub value: Option<Result<&'a <C::Asks as Query>::Value, &'a str>>,
}

/// The query of a panel without a value of its own.
#[derive(Debug, Clone, PartialEq)]
pub enum Nothing {}

impl Query for Nothing {
    type Value = ();
    type State = ();
    const THREAD: &'static str = "nothing";
    const WHAT: &'static str = "Computing nothing";

    fn compute(&self, (): &mut (), _: &Task) -> Result<(), Failure> {
        match *self {}
    }
}

/// A panel's memory and its computed value.
pub struct Held<C: Content> {
    memory: C::Remembers,
    /// The panel's computed value.
    pub derived: Derived<C::Asks>,
}

impl<C: Content> Held<C> {
    /// Starts the worker of the value, idle at first; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Send + Sync + 'static) -> Box<dyn AnyPanel> {
        Box::new(Held::<C> { memory: C::Remembers::default(), derived: Derived::start(wake) })
    }
}

/// A panel of any type.
pub trait AnyPanel: std::any::Any {
    fn wants(&self) -> Wants;

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

    /// Text in the title bar beside the panel's name.
    fn caption(&self, state: &State, jobs: &Jobs, panel: Panel) -> Option<String>;

    /// Draws the panel; returns the user's commands.
    fn draw(&mut self, ui: &mut Ui, state: &mut State, jobs: &Jobs, panel: Panel) -> Vec<Command>;
}

/// Opacity of an old panel.
pub const OLD: f32 = 0.55;

impl<C: Content> AnyPanel for Held<C> {
    fn wants(&self) -> Wants {
        C::WANTS
    }

    fn ask(&mut self, state: &State, jobs: &Jobs, is_in_sight: bool) {
        self.derived.ask(is_in_sight.then(|| C::asks(state, jobs)).flatten());
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
                    || (C::WANTS.output && is_old(MapKind::Output))
                    || (C::WANTS.second && is_old(MapKind::Second))
            }
        }
    }

    fn is_fresh_but_old(&self, state: &State, jobs: &Jobs) -> bool {
        self.derived.is_fresh_but_old(C::asks(state, jobs).as_ref())
    }

    fn caption(&self, state: &State, jobs: &Jobs, panel: Panel) -> Option<String> {
        C::caption(state, jobs, panel)
    }

    fn draw(&mut self, ui: &mut Ui, state: &mut State, jobs: &Jobs, panel: Panel) -> Vec<Command> {
        if C::TELLS_ANSWERS && state.is_predicting() {
            ui.centered_and_justified(|ui| ui.weak("Hidden until you have predicted."));
            return Vec::new();
        }
        if !C::MARKS_AGE && self.is_stale(jobs, panel) {
            ui.multiply_opacity(OLD);
        }
        let Held { memory, derived } = self;
        C::show(ui, Cx { panel, state, jobs, memory, value: derived.value() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::shared::Shared;
    use crate::app::state::EditCommand;
    use crate::app::widgets::seen::User;
    use crate::app::{App, Options};
    use crate::scene::Scene;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// The scene whose reflectors are counted.
    #[derive(Clone, PartialEq)]
    struct Counted(Shared<Scene>);

    impl Query for Counted {
        type Value = usize;
        type State = ();
        const THREAD: &'static str = "count";
        const WHAT: &'static str = "Counting";

        fn compute(&self, (): &mut (), _: &Task) -> Result<usize, Failure> {
            Ok(self.0.reflector_count())
        }
    }

    /// The panel of ARCHITECTURE, with a count of reflectors and a button.
    struct CountPanel;

    impl Content for CountPanel {
        type Asks = Counted;
        type Remembers = ();

        fn asks(state: &State, _: &Jobs) -> Option<Counted> {
            Some(Counted(state.scene().into()))
        }

        fn show(ui: &mut Ui, cx: Cx<'_, Self>) -> Vec<Command> {
            if let Some(Ok(count)) = cx.value {
                ui.label(format!("{count} reflectors"));
            }
            let is_clicked = ui.button("Select all").clicked();
            is_clicked.then(|| EditCommand::SelectAll.into()).into_iter().collect()
        }
    }

    #[test]
    fn a_small_panel_draws_its_value_and_answers_with_commands() {
        let app = Harness::builder().build_eframe(|creation| App::new(creation, Options::default()).unwrap());
        let count = app.state().editor().scene().reflector_count();
        let draw = |ui: &mut Ui, (app, held, asked): &mut (Harness<'_, App>, Box<dyn AnyPanel>, Vec<Command>)| {
            let App { state, jobs, .. } = app.state_mut();
            held.ask(state, jobs, true);
            held.poll();
            asked.extend(held.draw(ui, state, jobs, Panel::Guide));
        };
        let held = Held::<CountPanel>::start(|| ());
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
