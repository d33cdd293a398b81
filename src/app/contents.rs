//! Panel by panel, what each is told: the only file that knows all of them.

use super::chrome::tiles::Draw;
use super::chrome::{menu, status_bar};
use super::jobs::{Jobs, Pipeline, TheoryResult};
use super::panels::{
    bounds, controls, cuts, disturbances, elements, evaluation, found, guide, inspector, lesson, map, objects, radar,
    roc, run_time, scene, several, timing, training,
};
use super::state::{Command, MapKind, Panel, State};
use super::widgets::textures::Texture;
use crate::engine::ReadyMap;
use crate::scene::{Object, Reflector, Scene};
use eframe::egui::{TextureFilter, TextureOptions, Ui};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What panels remember from frame to frame.
#[derive(Default)]
pub struct Memory {
    textures: BTreeMap<MapKind, Texture>,
    reflectors: Reflectors,
    bounds: bounds::Memory,
    cuts: cuts::Memory,
    elements: elements::Memory,
    evaluation: evaluation::Memory,
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
                reflectors: object.reflectors(),
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

    fn scene(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (state, pipeline) = (&mut *self.state, &self.jobs.pipeline);
        let found = shown_found(state, pipeline);
        let radar = state.editor.radar().clone();
        let input = scene::Input {
            radar: &radar,
            snap: state.settings.snap,
            fields_of_view: state.settings.show_fields_of_view,
            found,
            cursor: state.shown_cursor(),
            error: pipeline.scene_error(),
            numbers: shows_numbers(state),
        };
        scene::show(ui, input, &mut state.editor, &mut state.scene_view)
    }

    fn controls(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (state, pipeline) = (&*self.state, &self.jobs.pipeline);
        let run = controls::Run {
            progress: pipeline.method_progress(),
            refusal: pipeline.refusal(),
            output: pipeline.output().map(|o| (o.method, o.took)),
            scores: pipeline.scores(),
            outdated: pipeline.output_is_outdated(),
            wanted: pipeline.wants_output(),
        };
        let input = controls::Input {
            is_recorded: state.editor.document().recording().is_some(),
            settings: &state.settings,
            radar: state.radar(),
            noise_seed: state.editor.scene().noise_seed,
            methods: &state.methods.all,
            method: state.method().map(|m| m.as_ref()),
            eta: state.output_eta(),
            run,
        };
        controls::show(ui, input)
    }

    fn map(&mut self, ui: &mut Ui, kind: MapKind) -> Vec<Command> {
        let pipeline = &self.jobs.pipeline;
        let options = TextureOptions { minification: TextureFilter::Linear, ..TextureOptions::NEAREST };
        let picture = pipeline.result().and_then(|r| r.pictures.get(&kind));
        let texture = picture.map(|picture| {
            let texture = self.memory.textures.entry(kind).or_default();
            texture.of(ui.ctx(), kind.title(), &picture.image, options)
        });
        let settings = &self.state.settings;
        let scene = self.state.editor.scene();
        let objects = if settings.show_reflectors { self.memory.reflectors.of(scene) } else { &[] };
        let found = if kind.needs_output() { shown_found(self.state, pipeline) } else { &[] };
        let input = map::Input {
            kind,
            radar: self.state.editor.radar(),
            scene,
            selection: self.state.editor.selection(),
            projection: settings.projection,
            colours: settings.colours,
            units: settings.units,
            difference: settings.difference,
            texture,
            end: picture.map_or(1.0, |p| p.end),
            stale: pipeline.is_stale(kind),
            cells: cells(self.jobs, kind),
            marks: map::Marks { objects, found },
            theory: self
                .jobs
                .theory
                .result()
                .filter(|r| r.request.radar == *self.state.radar())
                .and_then(|r| theory(r, kind)),
            cursor: self.state.shown_cursor(),
            error: error(self.state, self.jobs, kind),
            veil: veil(self.state, kind),
            numbers: shows_numbers(self.state),
        };
        map::show(ui, input, self.state.map_views.of(settings.projection), &mut self.memory.map)
    }

    fn cuts(&mut self, ui: &mut Ui) -> Vec<Command> {
        let state = &*self.state;
        // What is to be predicted is not to be read off a cut.
        let hidden = state.is_predicting();
        let maps = if hidden { Vec::new() } else { self.jobs.pipeline.cut_maps() };
        let input = cuts::Input {
            radar: state.radar(),
            cursor: state.cut_cursor(),
            maps: &maps,
            pins: if hidden { &[] } else { state.pins.all() },
            units: state.settings.units,
        };
        cuts::show(ui, input, &mut self.memory.cuts)
    }

    fn roc(&mut self, ui: &mut Ui) -> Vec<Command> {
        let pipeline = &self.jobs.pipeline;
        let shown = pipeline.result().filter(|_| !self.state.is_predicting());
        let points = pipeline.output().and(shown).and_then(|r| r.roc.as_deref()).map(Vec::as_slice);
        let method = pipeline.output().map_or("output", |o| o.method);
        let refusal = pipeline.refusal().map(|r| r.reason.as_str());
        roc::show(ui, roc::Input { points, method, eta: self.state.output_eta(), refusal })
    }

    fn radar(&mut self, ui: &mut Ui) -> Vec<Command> {
        let recording = self.state.editor.document().recording();
        let measured = recording.map(|r| radar::Measured { by_all_elements: r.signal().is_some() });
        radar::show(ui, radar::Input { radar: self.state.radar(), measured })
    }

    fn elements(&mut self, ui: &mut Ui) -> Vec<Command> {
        let input = elements::Input {
            radar: self.state.radar(),
            elements: &self.state.editor.scene().disturbances.elements,
            calibration: self.jobs.calibration.result(),
        };
        elements::show(ui, input, &mut self.memory.elements)
    }

    fn disturbances(&mut self, ui: &mut Ui) -> Vec<Command> {
        let document = self.state.editor.document();
        let is_recorded = document.recording().is_some();
        disturbances::show(ui, disturbances::Input { disturbances: &document.scene().disturbances, is_recorded })
    }

    fn found(&mut self, ui: &mut Ui) -> Vec<Command> {
        let pipeline = &self.jobs.pipeline;
        let output = pipeline.output();
        let recording = self.state.editor.document().recording();
        let input = found::Input {
            method: output.map(|o| o.method),
            found: output.filter(|_| !self.state.is_predicting()).and_then(|o| o.found.as_deref()),
            refusal: pipeline.refusal().map(|r| r.reason.as_str()),
            has_ranges: self.state.radar().samples > 1 || recording.is_some_and(|r| r.range_metres.is_some()),
        };
        found::show(ui, input)
    }

    fn timing(&mut self, ui: &mut Ui) -> Vec<Command> {
        let pipeline = &self.jobs.pipeline;
        let update = pipeline.result().map(|r| timing::Update {
            report: &r.frame.report,
            took: r.took,
            painted: r.painted,
            output: pipeline.output().map(|o| (o.method, o.took)),
            outdated: pipeline.output_is_outdated(),
        });
        timing::show(ui, timing::Input { update })
    }

    fn bounds(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.bounds;
        let input = bounds::Input {
            settings: self.state.settings.bounds,
            elements: self.state.radar().elements,
            has_subject: job.has_subject(),
            result: job.result(),
            error: job.error(),
        };
        bounds::show(ui, input, &mut self.memory.bounds)
    }

    fn evaluation(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.evaluation;
        let input = evaluation::Input {
            methods: &self.state.methods.all,
            method: self.state.method().map(|m| m.name()),
            radar: job.radar().unwrap_or(self.state.radar()),
            progress: job.progress(),
            rows: job.rows(),
            note: job.note(),
        };
        evaluation::show(ui, input, &mut self.memory.evaluation)
    }

    fn run_time(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.run_time;
        let input = run_time::Input {
            radar: job.radar().unwrap_or(self.state.radar()),
            progress: job.progress(),
            rows: job.rows(),
            bare_fft_ms: job.bare_fft_ms(),
            note: job.note(),
        };
        run_time::show(ui, input, &mut self.memory.run_time)
    }

    fn lesson(&mut self, ui: &mut Ui) -> Vec<Command> {
        let hidden = self.jobs.lessons.hidden();
        let texture = hidden.map(|image| self.memory.hidden.of(ui.ctx(), "hidden", image, TextureOptions::NEAREST));
        let input = lesson::Input {
            run: self.state.lesson.as_ref(),
            progress: &self.state.progress,
            hidden: texture,
            presenting: self.state.is_presenting(),
        };
        lesson::show(ui, input, &mut self.memory.lesson)
    }

    fn several(&mut self, ui: &mut Ui) -> Vec<Command> {
        let input = several::Input {
            several: &self.state.settings.several,
            radar: self.state.radar(),
            methods: &self.state.methods.all,
            maps: self.jobs.several.shown(),
            veiled: self.state.is_predicting(),
        };
        several::show(ui, input, &mut self.memory.several)
    }

    fn training(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.training;
        let running = job.is_running().then(|| job.progress().unwrap_or(0.0));
        let input = training::Input { path: job.path(), log: job.log(), note: job.note(), running };
        training::show(ui, input, &mut self.memory.training)
    }

    fn inspector(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (editor, coordinates) = (&self.state.editor, self.state.settings.coordinates);
        inspector::show(ui, inspector::Input { editor, radar: editor.radar(), coordinates })
    }

    fn objects(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (editor, coordinates) = (&self.state.editor, self.state.settings.coordinates);
        let input = objects::Input { scene: editor.scene(), selection: editor.selection(), coordinates };
        objects::show(ui, input, &mut self.memory.objects)
    }
}

impl Draw for Contents<'_> {
    fn draw(&mut self, ui: &mut Ui, panel: Panel) {
        let commands = match panel {
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
            Panel::Evaluation => self.evaluation(ui),
            Panel::RunTime => self.run_time(ui),
            Panel::Training => self.training(ui),
            Panel::Guide => guide::show(ui, &mut self.memory.guide),
            Panel::Lesson => self.lesson(ui),
            Panel::Several => self.several(ui),
        };
        self.commands.extend(commands);
    }

    fn caption(&self, panel: Panel) -> Option<String> {
        let Panel::Map(kind) = panel else { return None };
        if !shows_numbers(self.state) {
            return None;
        }
        let pipeline = &self.jobs.pipeline;
        map::caption(map::Caption {
            kind,
            method: pipeline.output().map(|o| o.method),
            updating: pipeline.is_stale(kind) || (kind.needs_output() && pipeline.output_is_outdated()),
            metrics: pipeline.scores().map(|s| s.metrics).filter(|_| !self.state.is_predicting()),
            target_eta: self.state.settings.target_eta,
            output_eta: self.state.output_eta(),
            explained: pipeline.unexplained().map(|u| u.explained),
        })
    }
}

/// Whether numbers are told: not in a presentation.
fn shows_numbers(state: &State) -> bool {
    !state.without_numbers
}

/// Where the method found something, if that is to be drawn: over a recording always.
fn shown_found<'a>(state: &State, pipeline: &'a Pipeline) -> &'a [Reflector] {
    let drawn = state.settings.show_found || state.editor.document().recording().is_some();
    pipeline.output().filter(|_| drawn && !state.is_predicting()).map_or(&[], |output| &output.reflectors)
}

/// The numbers behind a map's picture.
fn cells(jobs: &Jobs, kind: MapKind) -> Option<map::Cells<'_>> {
    let frame = &jobs.pipeline.result()?.frame;
    let pair = jobs.pipeline.output().map(|o| &o.pair);
    let scale = frame.full.as_ref().map(|m| m.scale);
    match kind {
        MapKind::Input0 => frame.first.as_ref().map(cells_of),
        MapKind::Input1 => frame.last.as_ref().map(cells_of),
        MapKind::Target | MapKind::TargetAbove => frame.full.as_ref().map(cells_of),
        MapKind::Output | MapKind::OutputAbove => pair.map(|p| map::Cells { map: &p.output, minus: None, scale }),
        MapKind::Difference => {
            pair.and_then(|p| Some(map::Cells { map: &p.output, minus: Some(p.target.as_deref()?), scale }))
        }
        MapKind::Unexplained => jobs.pipeline.unexplained().map(|u| cells_of(&u.map)),
    }
}

fn cells_of(map: &ReadyMap) -> map::Cells<'_> {
    map::Cells { map: &map.lambda, minus: None, scale: Some(map.scale) }
}

/// What the formulas say of the map.
fn theory(result: &TheoryResult, kind: MapKind) -> Option<map::Theory<'_>> {
    let [first, last, full] = &result.overlays;
    let overlay = match kind {
        MapKind::Input0 => first,
        MapKind::Input1 => last,
        _ => full,
    };
    Some(map::Theory {
        overlay: overlay.as_ref()?,
        reflector: result.request.reflector,
        ellipse: result.ellipse.filter(|_| !matches!(kind, MapKind::Input0 | MapKind::Input1)),
        listening: result.request.elements.name(),
        snr: result.request.snr,
        comb: kind.needs_output(),
    })
}

/// Why a map is hidden: a lesson asks for a prediction first.
fn veil(state: &State, kind: MapKind) -> Option<map::Veil> {
    let run = state.lesson.as_ref().filter(|run| run.is_predicting())?;
    Some(map::Veil { is_clicked: run.clicked_map() == Some(kind) })
}

/// Why a map has no picture, and what would help.
fn error<'a>(state: &State, jobs: &'a Jobs, kind: MapKind) -> Option<map::Problem<'a>> {
    if let Some(reason) = jobs.pipeline.scene_error() {
        return Some(map::Problem { reason, instead: None });
    }
    let is_recorded = state.editor.document().recording().is_some();
    if kind == MapKind::Unexplained {
        let reason = match jobs.pipeline.why_unexplained() {
            Some(reason) => reason,
            None if is_recorded => return None,
            None => "Open a recording: this map shows what reflectors laid over it leave unexplained.",
        };
        return Some(map::Problem { reason, instead: None });
    }
    if is_recorded && matches!(kind, MapKind::Target | MapKind::TargetAbove | MapKind::Difference) {
        // Where there is a target, there is a picture, and nobody reads this.
        let reason = "The recording has the samples of the two ends alone: nobody knows what all elements would see.";
        return Some(map::Problem { reason, instead: None });
    }
    let refusal = jobs.pipeline.refusal().filter(|_| kind.needs_output())?;
    Some(map::Problem { reason: &refusal.reason, instead: state.methods.instead_of(refusal.method, state.radar()) })
}

/// What the menu bar shows.
pub fn menu_input<'a>(state: &'a State, jobs: &Jobs, is_open: &'a dyn Fn(Panel) -> bool) -> menu::Input<'a> {
    let history = state.editor.history();
    menu::Input {
        presents: state.is_presenting(),
        can_undo: state.can_undo(),
        can_redo: history.redo_label().is_some(),
        selected: !state.editor.selection().is_empty(),
        projection: state.settings.projection,
        colours: state.settings.colours,
        random: (state.settings.random_seed, state.settings.random_number),
        recent: &state.recent,
        is_recording: jobs.recorder.is_at_work(),
        left: state.editor.left(),
        is_open,
    }
}

/// What the status bar says.
pub fn status_input(state: &State, jobs: &Jobs) -> status_bar::Input {
    let scene = state.editor.scene();
    status_bar::Input {
        cursor: state.shown_cursor(),
        objects: scene.objects.len(),
        reflectors: scene.reflector_count(),
        took: jobs.pipeline.took(),
    }
}
