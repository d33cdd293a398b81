//! Panel by panel, what each is told: the only place that knows all of them.

mod bars;
mod captions;
mod comparison;
mod failures;
mod maps;
mod scene;
mod tools;

pub use bars::{menu_input, status_input};

use super::chrome::tiles::{Draw, OLD};
use super::jobs::{Jobs, Pipeline};
use super::panels::{
    bounds, controls, cuts, doppler, elements, evaluation, failures as failures_panel, guide, lesson, map, objects,
    phasors, run_time, several, training,
};
use super::state::{Command, MapKind, Panel, State};
use super::widgets::method_menu::Offered;
use super::widgets::textures::Texture;
use crate::scene::{Object, Reflector, Scene};
use eframe::egui::Ui;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What panels remember from frame to frame.
#[derive(Default)]
pub struct Memory {
    textures: BTreeMap<MapKind, Texture>,
    reflectors: Reflectors,
    bounds: bounds::Memory,
    controls: controls::Memory,
    phasors: phasors::Memory,
    doppler: doppler::Memory,
    cuts: cuts::Memory,
    elements: elements::Memory,
    evaluation: evaluation::Memory,
    failures: failures_panel::Memory,
    run_time: run_time::Memory,
    training: training::Memory,
    guide: guide::Memory,
    lesson: lesson::Memory,
    several: several::Memory,
    map: map::Memory,
    objects: objects::Memory,
    hidden: Texture,
}

/// The reflectors of the scene on screen: spelled out once a scene, not once a map and frame.
#[derive(Default)]
struct Reflectors {
    of: Option<Arc<Scene>>,
    list: Vec<map::Marked>,
}

impl Reflectors {
    fn of(&mut self, scene: &Arc<Scene>) -> &[map::Marked] {
        if !self.of.as_ref().is_some_and(|of| Arc::ptr_eq(of, scene)) {
            let marked = |object: &Object| map::Marked {
                reflectors: object.marks(),
                is_line: matches!(object, Object::Line(_)),
            };
            self.list = scene.objects.iter().map(marked).collect();
            self.of = Some(scene.clone());
        }
        &self.list
    }
}

/// Draws panels, and gathers what they ask for.
pub struct Contents<'a> {
    state: &'a mut State,
    jobs: &'a Jobs,
    memory: &'a mut Memory,
    commands: Vec<Command>,
}

impl<'a> Contents<'a> {
    /// Of what there is.
    pub fn new(state: &'a mut State, jobs: &'a Jobs, memory: &'a mut Memory) -> Self {
        Contents { state, jobs, memory, commands: Vec::new() }
    }

    /// What was asked for.
    pub fn into_commands(self) -> Vec<Command> {
        self.commands
    }
}

impl Draw for Contents<'_> {
    fn draw(&mut self, ui: &mut Ui, panel: Panel) {
        // Maps, scene and lists say so themselves, beside what is not old in them.
        let tells_age = matches!(panel, Panel::Scene | Panel::Map(_) | Panel::Found | Panel::Compare);
        if !tells_age && self.jobs.is_stale(panel) {
            ui.multiply_opacity(OLD);
        }
        let commands = match panel {
            _ if tells_answers(panel) && self.state.is_predicting() => hidden(ui),
            Panel::Scene => self.scene(ui),
            Panel::Controls => self.controls(ui),
            Panel::Radar => self.radar(ui),
            Panel::Inspector => self.inspector(ui),
            Panel::Objects => self.objects(ui),
            Panel::Map(kind) => self.map(ui, kind),
            Panel::Cuts => self.cuts(ui),
            Panel::Elements => self.elements(ui),
            Panel::Disturbances => self.disturbances(ui),
            Panel::Found => self.found(ui),
            Panel::Roc => self.roc(ui),
            Panel::Timing => self.timing(ui),
            Panel::Bounds => self.bounds(ui),
            Panel::Phasors => self.phasors(ui),
            Panel::Chirp => self.chirp(ui),
            Panel::RangeDoppler => self.range_doppler(ui),
            Panel::Evaluation => self.evaluation(ui),
            Panel::Failures => self.failures(ui),
            Panel::RunTime => self.run_time(ui),
            Panel::Training => self.training(ui),
            Panel::Guide => guide::show(ui, &mut self.memory.guide),
            Panel::Lesson => self.lesson(ui),
            Panel::Several => self.several(ui),
            Panel::Compare => self.compare(ui),
            Panel::Values => self.values(ui),
        };
        self.commands.extend(commands);
    }

    fn caption(&self, panel: Panel) -> Option<String> {
        match panel {
            Panel::Map(kind) => self.map_caption(kind),
            _ => None,
        }
    }

    fn is_old(&self, panel: Panel) -> bool {
        self.jobs.is_stale(panel)
    }
}

/// The methods to choose from, with the times that are known of them.
fn offered<'a>(state: &'a State, jobs: &Jobs) -> Offered<'a> {
    let times = state.method_times.on(state.radar());
    Offered { all: &state.methods.all, times, timing: jobs.method_times.progress() }
}

/// Whether a panel tells what lessons ask: what follows from the radar, where maps show an object, what looks alike, how far
/// the axes reach.
fn tells_answers(panel: Panel) -> bool {
    matches!(
        panel,
        Panel::Radar
            | Panel::Inspector
            | Panel::Bounds
            | Panel::Cuts
            | Panel::Phasors
            | Panel::Chirp
            | Panel::RangeDoppler
    )
}

/// In the place of a panel that would answer the question.
fn hidden(ui: &mut Ui) -> Vec<Command> {
    ui.centered_and_justified(|ui| ui.weak("Hidden until you have predicted."));
    Vec::new()
}

/// Where the method found something, if that is to be drawn: over a recording always.
pub(super) fn shown_found<'a>(state: &State, pipeline: &'a Pipeline) -> &'a [Reflector] {
    pipeline.output_of(state).filter(|_| state.draws_found()).map_or(&[], |output| &output.reflectors)
}
