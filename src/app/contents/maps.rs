//! What maps, cuts and the ROC are told.

use super::{Contents, Reflectors, captions, shown_found};
use crate::app::jobs::{Jobs, TheoryResult, fates_of};
use crate::app::panels::{cuts, map, roc};
use crate::app::state::{Command, MapKind, MethodSlot, State};
use crate::engine::ReadyMap;
use crate::evaluate::{TARGET_ETA, median_offset_metres};
use crate::reconstruct::untrained_noise;
use crate::scattering::Echoing;
use eframe::egui::{TextureFilter, TextureId, TextureOptions, Ui};

impl Contents<'_> {
    pub(super) fn map(&mut self, ui: &mut Ui, kind: MapKind) -> Vec<Command> {
        let texture = self.texture(ui, kind);
        let projection = self.state.settings.projection;
        let mut view = *self.state.map_views.of(projection);
        let objects = marked(self.state, &mut self.memory.reflectors);
        let input = map_input(self.state, self.jobs, objects, texture, kind);
        let asked = map::show(ui, input, &mut view, &mut self.memory.map);
        *self.state.map_views.of(projection) = view;
        asked
    }

    /// A map's picture on the graphics card, if there is one.
    pub(super) fn texture(&mut self, ui: &Ui, kind: MapKind) -> Option<TextureId> {
        let options = TextureOptions { minification: TextureFilter::Linear, ..TextureOptions::NEAREST };
        let picture = self.jobs.pipeline.result().and_then(|r| r.pictures.get(&kind))?;
        let texture = self.memory.textures.entry(kind).or_default();
        Some(texture.of(ui.ctx(), kind.title(), &picture.image, options))
    }

    pub(super) fn cuts(&mut self, ui: &mut Ui) -> Vec<Command> {
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

    pub(super) fn roc(&mut self, ui: &mut Ui) -> Vec<Command> {
        let pipeline = &self.jobs.pipeline;
        let shown = pipeline.result().filter(|_| !self.state.is_predicting());
        let points = pipeline.output().and(shown).and_then(|r| r.roc.as_deref()).map(Vec::as_slice);
        let method = pipeline.output().map_or("output", |o| o.method);
        let refusal = pipeline.refusal().map(|r| r.reason.as_str());
        let eta = pipeline.eta(self.state, MethodSlot::First);
        let cfar = self.state.settings.cfar;
        let is_now = shown.is_some_and(|r| r.request.etas[0] == eta && r.request.cfar == cfar);
        let metrics = pipeline.scores().filter(|_| is_now).map(|scores| scores.metrics);
        roc::show(ui, roc::Input { points, method, eta, cfar, metrics, refusal })
    }

    pub(super) fn map_caption(&self, kind: MapKind) -> Option<String> {
        caption(self.state, self.jobs, kind)
    }
}

/// The reflectors to be marked, object by object.
pub(super) fn marked<'a>(state: &State, reflectors: &'a mut Reflectors) -> &'a [map::Marked] {
    if state.settings.show_reflectors { reflectors.of(state.scene()) } else { &[] }
}

/// What a map is told.
pub(super) fn map_input<'a>(
    state: &'a State,
    jobs: &'a Jobs,
    objects: &'a [map::Marked],
    texture: Option<TextureId>,
    kind: MapKind,
) -> map::Input<'a> {
    let (settings, pipeline) = (&state.settings, &jobs.pipeline);
    let picture = pipeline.result().and_then(|r| r.pictures.get(&kind));
    let found = if kind.slot() == Some(MethodSlot::First) { shown_found(state, pipeline) } else { &[] };
    let of_formulas = jobs
        .theory
        .value()
        .filter(|_| !jobs.theory.is_stale())
        .and_then(Result::ok)
        .filter(|r| r.request.radar == *state.radar());
    map::Input {
        kind,
        radar: state.editor.radar(),
        scene: state.scene(),
        selection: state.editor.selection(),
        projection: settings.projection,
        other_view: state.map_views.seen(settings.projection.other()),
        colours: settings.colours,
        units: settings.units,
        directions: settings.directions,
        difference: settings.difference,
        texture,
        pictured: picture.map_or(settings.projection, |p| p.projection),
        end: picture.map_or(1.0, |p| p.end),
        sentence: picture.map(|p| p.sentence.as_ref()),
        stale: pipeline.is_stale(kind),
        old: old(state, jobs, kind),
        cells: cells(jobs, kind),
        marks: map::Marks { objects, found },
        kinds: kinds(state, jobs, kind),
        told_apart: kind.slot().filter(|_| kind.is_above()).and_then(|slot| told_apart(state, jobs, slot)),
        cfar: settings.cfar.filter(|_| kind.is_above()),
        over: None,
        theory: of_formulas.and_then(|r| theory(r, kind)),
        cursor: state.shown_cursor(),
        note: note(state, kind),
        line: captions::of_map(state, kind),
        shown: map::Shown {
            reflectors: settings.show_reflectors,
            found: settings.show_found,
            theory: settings.show_theory,
            kinds: settings.show_kinds,
        },
        error: error(state, jobs, kind),
        veil: veil(state, kind),
        axes: state.shows_axes(),
        places: places(state, kind),
    }
}

/// What tells hits, misses and false alarms of a method's output apart, where there is a target.
fn told_apart<'a>(state: &State, jobs: &'a Jobs, slot: MethodSlot) -> Option<map::ToldApart<'a>> {
    let pair = &jobs.pipeline.method(slot).output()?.pair;
    let (output, eta) = jobs.pipeline.judged(state, slot)?;
    let target = match state.settings.cfar {
        None => pair.target.as_deref(),
        Some(_) if pair.target.is_none() => None,
        Some(_) => jobs.pipeline.result().and_then(|result| result.detected.target.as_ref()),
    };
    Some(map::ToldApart { output, target: target?, etas: [eta, TARGET_ETA] })
}

/// Over which noise the method whose map it is was trained, where the scene has other noise. A recording's noise is not known.
fn note(state: &State, kind: MapKind) -> Option<String> {
    let method = state.method_in(kind.slot()?).filter(|_| state.editor.document().recording().is_none())?;
    method.trained_noise()?;
    let echoing = Echoing::of(state.radar(), state.scene());
    untrained_noise(method.as_ref(), state.radar(), &echoing, state.settings.floor)
}

/// What became of every object, where that is to be marked: on the maps of the whole array.
fn kinds<'a>(state: &State, jobs: &'a Jobs, kind: MapKind) -> Option<map::Kinds<'a>> {
    let slot = match kind {
        MapKind::Target | MapKind::TargetAbove => MethodSlot::First,
        other => other.slot()?,
    };
    let (fates, current) = fates_of(&jobs.kinds, slot, &jobs.pipeline).filter(|_| state.settings.show_kinds)?;
    Some(map::Kinds { fates, current })
}

/// What stands in a map's title.
pub(super) fn caption(state: &State, jobs: &Jobs, kind: MapKind) -> Option<String> {
    let pipeline = &jobs.pipeline;
    let slot = kind.slot().unwrap_or(MethodSlot::First);
    map::caption(map::Caption {
        kind,
        method: pipeline.method(slot).output().map(|o| o.method),
        updating: is_updating(jobs, kind),
        running: kind.slot().and_then(|slot| running(state, jobs, slot)),
        verdict: verdict(state, jobs, slot),
        metrics: pipeline.scores_in(slot).map(|s| s.metrics).filter(|_| !state.is_predicting()),
        target_eta: state.settings.target_eta,
        output_eta: pipeline.eta(state, slot),
        cfar: state.settings.cfar,
        explained: pipeline.unexplained().map(|u| u.explained),
        units: state.settings.units,
        range_db: pipeline.range_db(),
    })
}

/// What became of the objects in a method's output, as far as that is known of the one on screen: "5 of 5 found, 0 false, 3 cm off".
pub(super) fn verdict(state: &State, jobs: &Jobs, slot: MethodSlot) -> Option<String> {
    let (fates, current) = fates_of(&jobs.kinds, slot, &jobs.pipeline)?;
    if !current || state.is_predicting() || fates.scene.objects.is_empty() {
        return None;
    }
    let output = jobs.pipeline.method(slot).output()?;
    let offset = median_offset_metres(&fates.scene, &fates.failures, &output.reflectors);
    let off = offset.map_or_else(String::new, |metres| format!(", {}", off_text(metres)));
    Some(format!("{}{off}", fates.failures.verdict()))
}

/// A distance in the unit in which it has one to three digits before the point.
fn off_text(metres: f64) -> String {
    match metres {
        m if m < 0.0095 => format!("{:.0} mm off", 1e3 * m),
        m if m < 0.995 => format!("{:.0} cm off", 1e2 * m),
        m => format!("{m:.1} m off"),
    }
}

/// Whether a map is of something else than what is on screen.
pub(super) fn is_updating(jobs: &Jobs, kind: MapKind) -> bool {
    let outdated = |slot| jobs.pipeline.method(slot).outdated().is_some();
    jobs.pipeline.is_stale(kind) || kind.slot().is_some_and(outdated)
}

/// The numbers behind a map's picture.
pub(super) fn cells(jobs: &Jobs, kind: MapKind) -> Option<map::Cells<'_>> {
    let frame = &jobs.pipeline.result()?.frame;
    let pair = kind.slot().and_then(|slot| jobs.pipeline.method(slot).output()).map(|o| &o.pair);
    let scale = frame.full.as_ref().map(|m| m.scale);
    match kind {
        MapKind::Input0 => frame.first.as_ref().map(cells_of),
        MapKind::Input1 => frame.last.as_ref().map(cells_of),
        MapKind::Target | MapKind::TargetAbove => frame.full.as_ref().map(cells_of),
        MapKind::Output | MapKind::OutputAbove | MapKind::Second | MapKind::SecondAbove => {
            pair.map(|p| map::Cells { map: &p.output, minus: None, scale })
        }
        MapKind::Difference | MapKind::SecondDifference => {
            pair.and_then(|p| Some(map::Cells { map: &p.output, minus: Some(p.target.as_deref()?), scale }))
        }
        MapKind::Doubt => pair.and_then(|p| Some(map::Cells { map: p.doubt.as_deref()?, minus: None, scale: None })),
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
        name: &result.request.name,
        overlay: overlay.as_ref()?,
        reflector: result.request.reflector,
        ellipse: result.ellipse.filter(|_| !matches!(kind, MapKind::Input0 | MapKind::Input1)),
        listening: result.request.elements.name(),
        snr: result.request.snr,
        comb: kind.needs_output(),
    })
}

/// The place that was guessed in a lesson's step, and the true one.
fn places(state: &State, kind: MapKind) -> Option<map::Places> {
    let (run, scene) = (state.lesson.as_ref()?, state.editor.scene());
    let (guess, truth) = run.places(kind, state.radar(), scene)?;
    let judged = run.judgement.as_ref()?.as_ref().ok()?;
    Some(map::Places { guess, truth, distance: judged.distance.clone() })
}

/// The method that is at work where another one's output of the same scene is shown.
fn running(state: &State, jobs: &Jobs, slot: MethodSlot) -> Option<&'static str> {
    jobs.pipeline.method(slot).of_another_method()?;
    state.method_in(slot).map(|method| method.name())
}

/// What is said of a map that belongs to something else than what is on screen: whose result it is where only the method is another.
fn old(state: &State, jobs: &Jobs, kind: MapKind) -> String {
    let of_another_method = kind.slot().and_then(|slot| jobs.pipeline.method(slot).of_another_method());
    match (of_another_method, kind.slot().and_then(|slot| state.method_in(slot))) {
        (Some(shown), Some(wanted)) => format!("{shown}'s result; {} is running", wanted.name()),
        _ => map::EARLIER_SCENE.to_owned(),
    }
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
    if is_recorded && (matches!(kind, MapKind::Target | MapKind::TargetAbove) || kind.is_difference()) {
        // Where there is a target, there is a picture, and nobody reads this.
        let reason = "The recording has the samples of the two ends alone: nobody knows what all elements would see.";
        return Some(map::Problem { reason, instead: None });
    }
    if kind.is_above()
        && let Some(reason) = jobs.pipeline.detector_error()
    {
        return Some(map::Problem { reason, instead: None });
    }
    let slot = kind.slot()?;
    if kind == MapKind::Doubt && jobs.pipeline.method(slot).output().is_some_and(|output| output.pair.doubt.is_none()) {
        let reason = "This method does not say how far off it expects its output to be.";
        return Some(map::Problem { reason, instead: None });
    }
    let refusal = jobs.pipeline.method(slot).refusal()?;
    let instead = || state.methods.instead_of(refusal.method, state.radar());
    // The second is chosen beside the maps.
    Some(map::Problem { reason: &refusal.reason, instead: if slot == MethodSlot::First { instead() } else { None } })
}
