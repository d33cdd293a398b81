//! Input of a map, taken from the state of the app.

use super::caption::{Caption, caption};
use super::frame::{Cells, Marked};
use super::{EARLIER_SCENE_TEXT, HandMemory, Input, Kinds, Problem, Theory, ToldApart, show};
use crate::app::content::{Content, Cx};
use crate::app::jobs::{Jobs, Scores, TheoryResult, judged_output};
use crate::app::state::{Command, MapKind, MethodSlot, Panel, State};
use crate::app::widgets::Texture;
use crate::engine::ReadyMap;
use crate::evaluate::{TARGET_ETA, median_offset_metres};
use crate::scene::{Object, Scene};
use eframe::egui::{Id, TextureFilter, TextureId, TextureOptions, Ui};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Pictures of a panel of maps on the graphics card, and the state of the pointer.
#[derive(Default)]
pub struct MapMemory {
    textures: BTreeMap<MapKind, Texture>,
    pub hand: HandMemory,
}

impl MapMemory {
    /// A map's picture on the graphics card, if there is one.
    pub fn texture(&mut self, ui: &Ui, jobs: &Jobs, kind: MapKind) -> Option<TextureId> {
        let options = TextureOptions { minification: TextureFilter::Linear, ..TextureOptions::NEAREST };
        let picture = jobs.pipeline.maps.result().and_then(|r| r.pictures.get(&kind))?;
        let texture = self.textures.entry(kind).or_default();
        Some(texture.of(ui.ctx(), kind.title(), &picture.image, options))
    }
}

pub const PANEL: Content<MapMemory> = Content { marks_age: true, caption: caption_in, ..Content::drawn(draw) };

fn caption_in(state: &State, jobs: &Jobs, panel: Panel) -> Vec<String> {
    let Panel::Map(kind) = panel else { return Vec::new() };
    caption_of(state, jobs, kind)
}

fn draw(ui: &mut Ui, cx: Cx<'_, MapMemory>) -> Vec<Command> {
    let Cx { panel: Panel::Map(kind), state, jobs, memory, .. } = cx else { return Vec::new() };
    let texture = memory.texture(ui, jobs, kind);
    let projection = state.settings.projection;
    let mut view = *state.map_views.of(projection);
    let marks = marks_of(ui, state);
    let asked = show(ui, map_input(state, jobs, &marks, texture, kind), &mut view, &mut memory.hand);
    *state.map_views.of(projection) = view;
    asked
}

/// The reflectors of a scene, kept between frames.
#[derive(Clone, Default)]
struct Spelled {
    of: Option<Arc<Scene>>,
    marks: Arc<[Marked]>,
}

/// The reflectors to be marked, object by object, computed once a scene and not once a map and frame.
pub fn marks_of(ui: &Ui, state: &State) -> Arc<[Marked]> {
    let scene = state.scene();
    if !state.settings.show_reflectors {
        return Arc::default();
    }
    ui.data_mut(|data| {
        let spelled: &mut Spelled = data.get_temp_mut_or_default(Id::unique("marks of the scene"));
        if !spelled.of.as_ref().is_some_and(|of| Arc::ptr_eq(of, scene)) {
            let marked =
                |object: &Object| Marked { reflectors: object.marks(), is_line: matches!(object, Object::Line(_)) };
            *spelled = Spelled { of: Some(scene.clone()), marks: scene.objects.iter().map(marked).collect() };
        }
        spelled.marks.clone()
    })
}

pub fn map_input<'a>(
    state: &'a State,
    jobs: &'a Jobs,
    objects: &'a [Marked],
    texture: Option<TextureId>,
    kind: MapKind,
) -> Input<'a> {
    let (settings, pipeline) = (&state.settings.view, &jobs.pipeline);
    let picture = pipeline.maps.result().and_then(|r| r.pictures.get(&kind));
    let found = if kind.slot() == Some(MethodSlot::First) { pipeline.shown_found(state) } else { &[] };
    let of_formulas = jobs
        .theory
        .value()
        .filter(|_| !jobs.theory.is_stale())
        .and_then(Result::ok)
        .filter(|r| r.request.radar == *state.radar())
        // The formulas of both inputs are those of the two ends, and hold for no other layout.
        .filter(|_| settings.layout.is_none() || !matches!(kind, MapKind::Input0 | MapKind::Input1));
    Input {
        kind,
        state,
        texture,
        pictured: picture.map_or(settings.projection, |p| p.projection),
        end: picture.map_or(1.0, |p| p.end),
        sentence: picture.map(|p| p.sentence.as_ref()),
        stale: pipeline.is_stale(kind),
        old: old(state, jobs, kind),
        cells: cells(jobs, kind),
        objects,
        found,
        kinds: kinds(state, jobs, kind),
        told_apart: kind.slot().filter(|_| kind.is_above()).and_then(|slot| told_apart(state, jobs, slot)),
        theory: of_formulas.and_then(|r| theory(r, kind)),
        error: error(state, jobs, kind),
    }
}

/// Maps and thresholds that separate hits, misses and false alarms of a method's output, where there is a target.
fn told_apart<'a>(state: &State, jobs: &'a Jobs, slot: MethodSlot) -> Option<ToldApart<'a>> {
    let pair = &jobs.pipeline.method(slot).output()?.pair;
    let (output, eta) = jobs.pipeline.judged(state, slot)?;
    let target = match state.settings.cfar {
        None => pair.target.as_deref(),
        Some(_) if pair.target.is_none() => None,
        Some(_) => jobs.pipeline.maps.result().and_then(|result| result.detected.target.as_ref()),
    };
    // Ghosts of another output would be drawn where this one has nothing.
    let ghosts = judged_output(&jobs.kinds, slot, &jobs.pipeline).filter(|(_, current)| *current);
    let ghosts = ghosts.map_or(&[][..], |(judged, _)| &judged.verdicts.ghosts);
    Some(ToldApart { output, target: target?, etas: [eta, TARGET_ETA], ghosts })
}

/// Verdicts on the objects, where they are marked: on the maps of the whole array.
fn kinds<'a>(state: &State, jobs: &'a Jobs, kind: MapKind) -> Option<Kinds<'a>> {
    let slot = match kind {
        MapKind::Target | MapKind::TargetAbove => MethodSlot::First,
        other => other.slot()?,
    };
    let (judged, current) = judged_output(&jobs.kinds, slot, &jobs.pipeline).filter(|_| state.settings.show_kinds)?;
    Some(Kinds { judged, current })
}

/// Text in the title bar of a map, from its longest form to its shortest.
pub fn caption_of(state: &State, jobs: &Jobs, kind: MapKind) -> Vec<String> {
    let pipeline = &jobs.pipeline;
    if let (MapKind::Input0, Some(layout)) = (kind, &state.settings.layout) {
        return vec![format!("{layout} {}", updating(state, jobs, kind))];
    }
    if state.is_predicting() && kind.is_above() {
        // A lesson may ask for the threshold.
        return Vec::new();
    }
    let slot = kind.slot().unwrap_or(MethodSlot::First);
    caption(Caption {
        kind,
        view: &state.settings.view,
        method: pipeline.method(slot).output().map(|o| o.method()),
        updating: &updating(state, jobs, kind),
        verdict: verdict(state, jobs, slot, false),
        with_distance: verdict(state, jobs, slot, true).filter(|_| !kind.is_above()),
        metrics: scores(state, jobs, slot).map(|s| s.metrics),
        output_eta: pipeline.eta(state, slot),
        explained: pipeline.unexplained().map(|u| u.explained),
        range_db: pipeline.range_db(),
    })
}

/// Figures of a method's output against the target; none while a lesson's question is open, and none for a recording, which is its own target.
pub fn scores(state: &State, jobs: &Jobs, slot: MethodSlot) -> Option<Scores> {
    let is_shown = !state.is_predicting() && !state.is_recorded();
    jobs.pipeline.scores_in(slot).filter(|_| is_shown)
}

/// Text of the number of echoes that a method finds in the recording on screen, and of the power that they explain where it is known: "2
/// echoes found, 99.8 % of the power explained". `None` for methods that list no echoes.
pub fn echoes_found(state: &State, jobs: &Jobs, slot: MethodSlot) -> Option<String> {
    state.editor.document().recording()?;
    let count = jobs.pipeline.method(slot).output()?.reflectors.len();
    let explained = jobs.pipeline.unexplained().map(|u| u.explained);
    (count > 0).then(|| echoes_text(count, explained))
}

fn echoes_text(count: usize, explained: Option<f64>) -> String {
    let plural = if count == 1 { "" } else { "es" };
    let explained =
        explained.map_or_else(String::new, |part| format!(", {:.1} % of the power explained", 100.0 * part));
    format!("{count} echo{plural} found{explained}")
}

/// The verdict on the objects in a method's output, such as "5 of 5 found, 0 false". With `tells_distance` the distance of found points follows:
/// "3 cm off (bound 1 cm)". `None` until the output on screen is judged.
pub fn verdict(state: &State, jobs: &Jobs, slot: MethodSlot, tells_distance: bool) -> Option<String> {
    if let Some(found) = echoes_found(state, jobs, slot) {
        return Some(found);
    }
    let (judged, current) = judged_output(&jobs.kinds, slot, &jobs.pipeline)?;
    if !current || state.is_predicting() || judged.scene.objects.is_empty() {
        return None;
    }
    if !tells_distance {
        return Some(judged.verdicts.headline());
    }
    let output = jobs.pipeline.method(slot).output()?;
    let offset = median_offset_metres(&judged.scene, &judged.verdicts, &output.reflectors);
    let bound = judged.bound_metres.map_or_else(String::new, |metres| format!(" (bound {})", length(metres)));
    let off = offset.map_or_else(String::new, |metres| format!(", {} off{bound}", length(metres)));
    Some(format!("{}{off}", judged.verdicts.headline()))
}

/// A distance in the unit in which it has one to three digits before the point.
fn length(metres: f64) -> String {
    match metres {
        m if m < 0.0005 => "<1 mm".to_owned(),
        m if m < 0.0095 => format!("{:.0} mm", 1e3 * m),
        m if m < 0.995 => format!("{:.0} cm", 1e2 * m),
        m => format!("{m:.1} m"),
    }
}

/// Whether a map is of an earlier scene or of another method.
pub fn is_updating(jobs: &Jobs, kind: MapKind) -> bool {
    let outdated = |slot| jobs.pipeline.method(slot).outdated().is_some();
    jobs.pipeline.is_stale(kind) || kind.slot().is_some_and(outdated)
}

/// Values of a map's cells, with the scale of its picture.
pub fn cells(jobs: &Jobs, kind: MapKind) -> Option<Cells<'_>> {
    let result = jobs.pipeline.maps.result()?;
    if let Some(rescaled) = result.on_one_scale.get(&kind) {
        return Some(cells_of(rescaled));
    }
    let frame = &result.frame;
    let pair = kind.slot().and_then(|slot| jobs.pipeline.method(slot).output()).map(|o| &o.pair);
    let scale = frame.full.as_ref().map(|m| m.scale);
    match kind {
        MapKind::Input0 => frame.first.as_ref().map(cells_of),
        MapKind::Input1 => frame.last.as_ref().map(cells_of),
        MapKind::Target | MapKind::TargetAbove => frame.full.as_ref().map(cells_of),
        MapKind::Output | MapKind::OutputAbove | MapKind::Second | MapKind::SecondAbove => {
            pair.map(|p| Cells { map: &p.output, minus: None, scale })
        }
        MapKind::Difference | MapKind::SecondDifference => {
            pair.and_then(|p| Some(Cells { map: &p.output, minus: Some(p.target.as_deref()?), scale }))
        }
        MapKind::Doubt => pair.and_then(|p| Some(Cells { map: p.doubt.as_deref()?, minus: None, scale: None })),
        MapKind::Unexplained => jobs.pipeline.unexplained().map(|u| cells_of(&u.map)),
    }
}

fn cells_of(map: &ReadyMap) -> Cells<'_> {
    Cells { map: &map.lambda, minus: None, scale: Some(map.scale) }
}

/// Predictions of the formulas for a map, where they exist.
fn theory(result: &TheoryResult, kind: MapKind) -> Option<Theory<'_>> {
    let [first, last, full] = &result.overlays;
    let overlay = match kind {
        MapKind::Input0 => first,
        MapKind::Input1 => last,
        _ => full,
    };
    Some(Theory {
        name: &result.request.name,
        overlay: overlay.as_ref()?,
        reflector: result.request.reflector,
        ellipse: result.ellipse.filter(|_| !matches!(kind, MapKind::Input0 | MapKind::Input1)),
        listening: result.request.settings.elements.name(),
        snr: result.request.settings.snr,
        comb: kind.needs_output(),
    })
}

/// The running method in brackets while another method's output of the same scene is shown, or that a map is of an earlier scene.
fn updating(state: &State, jobs: &Jobs, kind: MapKind) -> String {
    let is_of_another = |slot: &MethodSlot| jobs.pipeline.method(*slot).of_another_method().is_some();
    match kind.slot().filter(is_of_another).and_then(|slot| state.method_in(slot)) {
        Some(method) => format!("({} is running) ", method.name()),
        None if is_updating(jobs, kind) => "(updating) ".to_owned(),
        None => String::new(),
    }
}

/// Text over an outdated map: the method that made it where only the method has changed, else that the scene is an earlier one.
pub fn old(state: &State, jobs: &Jobs, kind: MapKind) -> String {
    let of_another_method = kind.slot().and_then(|slot| jobs.pipeline.method(slot).of_another_method());
    match (of_another_method, kind.slot().and_then(|slot| state.method_in(slot))) {
        (Some(shown), Some(wanted)) => format!("{shown}'s result; {} is running", wanted.name()),
        _ => EARLIER_SCENE_TEXT.to_owned(),
    }
}

/// Reason why a map has no picture, and a method that would have one.
fn error<'a>(state: &State, jobs: &'a Jobs, kind: MapKind) -> Option<Problem<'a>> {
    let (pipeline, is_recorded) = (&jobs.pipeline, state.is_recorded());
    let reason = match kind {
        _ if let Some(reason) = pipeline.maps.scene_error() => reason,
        MapKind::Input1 if state.settings.layout.is_some() => "Input 0 shows what the elements of the layout hear.",
        MapKind::Unexplained if let Some(Some(Err(reason))) = pipeline.maps.result().map(|m| &m.unexplained) => reason,
        MapKind::Unexplained if is_recorded => return None,
        MapKind::Unexplained => "Open a recording: this map shows what reflectors laid over it leave unexplained.",
        // Not read where there is a target, since the map then has a picture.
        _ if is_recorded && (matches!(kind, MapKind::Target | MapKind::TargetAbove) || kind.is_difference()) => {
            "The recording has the samples of the two ends alone: what all elements would hear is unknown."
        }
        _ if let Some(reason) = pipeline.detector_error().filter(|_| kind.is_above()) => reason,
        _ => return refusal(state, jobs, kind),
    };
    Some(Problem { reason, instead: None })
}

/// Reason why a method's map has no picture, and a method that would have one.
fn refusal<'a>(state: &State, jobs: &'a Jobs, kind: MapKind) -> Option<Problem<'a>> {
    let slot = kind.slot()?;
    let job = jobs.pipeline.method(slot);
    if kind == MapKind::Doubt && job.output().is_some_and(|output| output.pair.doubt.is_none()) {
        let reason = "This method does not say how far off it expects its output to be.";
        return Some(Problem { reason, instead: None });
    }
    let refusal = job.refusal()?;
    // The second method is chosen beside the maps.
    let instead =
        (slot == MethodSlot::First).then(|| state.methods.instead_of(refusal.method, state.radar())).flatten();
    Some(Problem { reason: &refusal.reason, instead })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn echoes_are_counted_and_what_they_explain_is_told() {
        assert_eq!(echoes_text(1, None), "1 echo found");
        assert_eq!(echoes_text(3, Some(0.9984)), "3 echoes found, 99.8 % of the power explained");
    }
}
