//! All panels of the app, each with its memory and its computed value.

use super::chrome::tiles::Draw;
use super::content::{AnyPanel, Held};
use super::jobs::{Derived, Jobs, Query, Want};
use super::panels;
use super::state::{Command, Panel, State};
use eframe::egui::Ui;
use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};

/// Starts a panel by the content in its line of the list.
macro_rules! starts {
    ($($(#[$meta:meta])* $name:ident $($drawn_by:ident)::+, $place:expr, $key:expr, $title:literal, $help:literal;)*) => {
        fn start(panel: Panel, wake: impl Fn() + Send + Sync + 'static) -> Box<dyn AnyPanel> {
            match panel {
                Panel::Map(_) => Held::start(panels::map::PANEL, wake),
                $(Panel::$name => Held::start(panels::$($drawn_by)::+, wake),)*
            }
        }
    };
}

every_panel!(starts);

pub struct Panels(BTreeMap<Panel, Box<dyn AnyPanel>>);

impl Panels {
    /// Starts the workers of all panels' values, idle at first; `wake` is called from their threads.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> Panels {
        Panels(Panel::all().into_iter().map(|panel| (panel, start(panel, wake.clone()))).collect())
    }

    /// Takes in values computed since the last frame. Returns messages for the user.
    pub fn poll(&mut self) -> Vec<String> {
        self.0.values_mut().filter_map(|panel| panel.poll()).collect()
    }

    /// The maps and methods that the last frame's panels read.
    pub fn wants(&self, state: &State) -> BTreeSet<Want> {
        let shown = state.arrangement.shown().iter().filter_map(|panel| self.0.get(panel));
        shown.flat_map(|panel| panel.wants()).copied().collect()
    }

    /// Asks for the own values of this frame's panels.
    pub fn ask(&mut self, state: &State, jobs: &Jobs) {
        for (panel, held) in &mut self.0 {
            held.ask(state, jobs, state.arrangement.shown().contains(panel));
        }
    }

    /// Whether the own value of any panel is being computed.
    pub fn is_busy(&self) -> bool {
        self.0.values().any(|panel| panel.is_busy())
    }

    /// Titles of the panels that draw results of an earlier scene or settings without marking them.
    pub fn drawn_as_fresh_but_old(&self, state: &State, jobs: &Jobs) -> Vec<String> {
        let old = self.0.iter().filter(|(_, held)| held.is_fresh_but_old(state, jobs));
        old.map(|(panel, _)| panel.title().to_owned()).collect()
    }

    /// Values that a panel has asked for since the start.
    pub fn requests(&self, panel: Panel) -> u64 {
        self.0.get(&panel).map_or(0, |held| held.requests())
    }

    /// The own value of a panel with this memory and this query.
    pub fn derived<M: 'static, Q: Query>(&self, panel: Panel) -> Option<&Derived<Q>> {
        let held: &dyn Any = self.0.get(&panel)?.as_ref();
        held.downcast_ref::<Held<M, Q>>().map(|held| &held.derived)
    }
}

/// Draws panels and gathers the user's commands.
pub struct Contents<'a> {
    pub state: &'a mut State,
    pub jobs: &'a Jobs,
    pub panels: &'a mut Panels,
    pub commands: Vec<Command>,
}

impl Draw for Contents<'_> {
    fn draw(&mut self, ui: &mut Ui, panel: Panel) {
        if let Some(held) = self.panels.0.get_mut(&panel) {
            self.commands.extend(held.draw(ui, self.state, self.jobs, panel));
        }
    }

    fn caption(&self, panel: Panel) -> Vec<String> {
        self.panels.0.get(&panel).map_or_else(Vec::new, |held| held.caption(self.state, self.jobs, panel))
    }

    fn is_old(&self, panel: Panel) -> bool {
        self.panels.0.get(&panel).is_some_and(|held| held.is_stale(self.jobs, panel))
    }
}
