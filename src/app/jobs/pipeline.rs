//! The UI's side of the workers of maps and methods: requests and results.
//!
//! ```text
//!   scene, panels in sight ──► maps worker (engine, pictures, scores) ──► MapsResult
//!                               ▲                                          │ ends, target
//!                               └── pairs of maps ◄── method workers ◄─────┘
//! ```
//!
//! The second method works only while the panel that compares it with the first is in sight.

use super::derived::STALE;
use super::maps::MapsJob;
use super::method::{Basis, MethodJob, MethodRequest, MethodResult};
use super::recorded::Unexplained;
use super::scene_maps::{MapsRequest, MapsResult, Origin, Scores};
use super::source::Source;
use crate::app::shared::Shared;
use crate::app::state::{CutMap, MapKind, MethodSlot, MethodTimes, State};
use crate::engine::{EngineFrame, MapRequest};
use crate::evaluate::TARGET_ETA;
use crate::maps::RangeAngleMap;
use crate::maps::cfar::DETECTION_THRESHOLD;
use crate::platform::Instant;
use crate::scene::Reflector;
use std::collections::BTreeSet;
use std::sync::Arc;

pub struct Pipeline {
    pub maps: MapsJob,
    /// The first method and the second.
    methods: [MethodJob; 2],
}

impl Pipeline {
    /// Starts the workers; `wake` is called from their threads when there is a result to show.
    pub fn start(wake: impl Fn() + Clone + Send + Sync + 'static) -> Pipeline {
        let maps = MapsJob::start(wake.clone());
        let methods = [MethodJob::start("reconstruction", wake.clone()), MethodJob::start("second method", wake)];
        Pipeline { maps, methods }
    }

    /// The threshold of either method's output: the user's, else the one derived for the output on screen, else the method's own.
    pub fn eta(&self, state: &State, slot: MethodSlot) -> f32 {
        let method = state.method_in(slot).map(|method| method.name());
        let output = self.method(slot).output().filter(|output| Some(output.method()) == method);
        state.eta_in(slot, output.and_then(|output| output.eta))
    }

    /// Takes in the workers' results since the last frame, and the methods' durations in `times`. Returns messages for the user.
    pub fn poll(&mut self, times: &mut MethodTimes) -> Vec<String> {
        let Pipeline { maps, methods } = self;
        let mut messages = maps.poll(|maps| methods.iter_mut().for_each(|method| method.attach_maps(maps)));
        for method in methods {
            messages.extend(method.poll(maps.result(), times));
        }
        messages
    }

    /// Asks the workers for the values that this frame's panels need, if they changed.
    pub fn ask(&mut self, state: &State, wants: &BTreeSet<Want>) {
        let pictures = state.pictured();
        let drawn = pictures.iter().any(|kind| kind.slot() == Some(MethodSlot::First)) || state.marks_output();
        let read = [drawn || wants.contains(&Want::Output), wants.contains(&Want::Second)];
        let source = Source::of(state);
        for slot in MethodSlot::BOTH {
            let wanted = state.method_in(slot).filter(|_| read[slot as usize]).map(|method| Origin {
                source: source.clone(),
                normalisation: state.settings.normalisation,
                layout: state.settings.layout_numbers(state.radar()),
                method: method.name(),
            });
            let pictured = self.maps.result().and_then(|maps| maps.request.pairs[slot as usize].as_ref());
            self.methods[slot as usize].track_outdated_output(wanted, pictured);
        }
        let request = self.maps_request(state, source, (pictures, read), wants);
        let is_recorded = request.source.recording.is_some();
        self.maps.ask(request, state.editor.dragged().is_some());
        let listed = wants.contains(&Want::Listed) || is_recorded;
        for slot in MethodSlot::BOTH {
            match read[slot as usize] {
                true => self.ask_method(state, slot, slot == MethodSlot::First && listed),
                false if slot == MethodSlot::Second => self.methods[slot as usize].cancel_hidden_work(),
                false => {}
            }
        }
    }

    /// The request for the pictures in sight, the outputs that are `read`, and other wanted values.
    fn maps_request(
        &self,
        state: &State,
        source: Source,
        (pictures, read): (BTreeSet<MapKind>, [bool; 2]),
        wants: &BTreeSet<Want>,
    ) -> MapsRequest {
        let map = |kind| pictures.contains(&kind);
        let all = wants.contains(&Want::EveryMap);
        let output = read.contains(&true);
        let settings = &state.settings;
        let layout = settings.layout_numbers(state.radar());
        let on_one_scale = settings.one_scale && (map(MapKind::Input0) || map(MapKind::Input1) || all);
        let wanted = MapRequest {
            floor: settings.floor,
            seed: state.editor.scene().noise_seed,
            normalisation: settings.normalisation,
            first: (map(MapKind::Input0) || all) && layout.is_none(),
            last: (map(MapKind::Input1) || all) && layout.is_none(),
            full: on_one_scale
                || map(MapKind::Target)
                || map(MapKind::TargetAbove)
                || output
                || map(MapKind::Unexplained),
            ends: output,
        };
        let is_read = |slot: MethodSlot| read[slot as usize];
        let pair = |slot: MethodSlot| {
            let output = self.method(slot).output().filter(|o| o.radar() == state.radar());
            output.filter(|_| is_read(slot)).map(|o| o.pair.clone())
        };
        // An empty scene over noise has false alarms to count; one without noise has none.
        let is_noise = settings.floor.has_level();
        MapsRequest {
            document: state.editor.document().id(),
            wanted,
            layout,
            at_rest: false,
            pictures,
            pairs: MethodSlot::BOTH.map(pair),
            colours: settings.colours,
            projection: settings.projection,
            one_scale: settings.one_scale,
            fine_columns: settings.fine_columns,
            difference: settings.difference,
            dark: state.dark,
            target_eta: settings.target_eta,
            cfar: settings.cfar,
            etas: MethodSlot::BOTH.map(|slot| if is_read(slot) { self.eta(state, slot) } else { TARGET_ETA }),
            scores: output && (source.recording.is_some() || !source.scene.objects.is_empty() || is_noise),
            roc: wants.contains(&Want::Roc),
            source,
        }
    }

    /// Asks for a method's output of the latest maps, unless the last request serves.
    fn ask_method(&mut self, state: &State, slot: MethodSlot, listed: bool) {
        let latest = self.maps.result().and_then(|r| {
            let target = r.target();
            // A recording of the two ends has no target; a scene has one as soon as it is wanted.
            (target.is_some() || r.request.source.recording.is_some()).then_some((Basis::of(r)?, target, &r.request))
        });
        let Some(((basis, target, maps), method)) = latest.zip(state.method_in(slot).map(Shared::from)) else { return };
        let (document, at_rest, origin) = (maps.document, maps.at_rest, maps.origin(method.name()));
        let request = MethodRequest { document, origin, basis, target, method, listed, at_rest };
        self.methods[slot as usize].ask(request, state.editor.dragged().is_some());
    }

    /// The job of either method, to be stopped.
    pub fn method_mut(&mut self, slot: MethodSlot) -> &mut MethodJob {
        &mut self.methods[slot as usize]
    }

    /// The job of either method, with its latest output or the reason why it has none.
    pub fn method(&self, slot: MethodSlot) -> &MethodJob {
        &self.methods[slot as usize]
    }

    /// The latest output of the first method.
    pub fn output(&self) -> Option<&MethodResult> {
        self.method(MethodSlot::First).output()
    }

    /// The latest output of the first method, where it was made for the document on screen. Reflectors found in another document are not shown.
    pub fn output_of(&self, state: &State) -> Option<&MethodResult> {
        self.output().filter(|output| output.document == state.editor.document().id())
    }

    /// Places of reflectors found by the first method, where they are to be drawn: over a recording always.
    pub fn shown_found(&self, state: &State) -> &[Reflector] {
        self.output_of(state).filter(|_| state.draws_found()).map_or(&[], |output| &output.reflectors)
    }

    /// The reason why the detector in use fails.
    pub fn detector_error(&self) -> Option<&str> {
        self.maps.result()?.detected.error.as_deref()
    }

    /// The map and threshold of a method's detections: the output and its threshold, or a detector's map and the middle of its two values. `None` while the
    /// detector's map of the output is not there.
    pub fn judged(&self, state: &State, slot: MethodSlot) -> Option<(&Arc<RangeAngleMap>, f32)> {
        let output = &self.method(slot).output()?.pair.output;
        let Some(cfar) = state.settings.cfar else { return Some((&**output, self.eta(state, slot))) };
        let result = self.maps.result().filter(|r| r.request.cfar == Some(cfar))?;
        let is_of_it = result.request.pairs[slot as usize].as_ref().is_some_and(|p| p.output == *output);
        Some((result.detected.outputs[slot as usize].as_ref().filter(|_| is_of_it)?, DETECTION_THRESHOLD))
    }

    pub fn cut_maps(&self) -> Vec<CutMap> {
        let Some(MapsResult { frame: EngineFrame { first, last, full, .. }, .. }) = self.maps.result() else {
            return Vec::new();
        };
        let scale = full.as_ref().map(|map| map.scale);
        let ready = [(MapKind::Input0, first), (MapKind::Input1, last), (MapKind::Target, full)];
        let ready = ready.into_iter().filter_map(|(kind, map)| {
            let map = map.as_ref()?;
            Some(CutMap { kind, map: map.lambda.clone(), scale: Some(map.scale) })
        });
        // A method aims for the target's Lambda, so its decibels are the target's.
        let output = self.output().map(|o| CutMap { kind: MapKind::Output, map: Arc::clone(&o.pair.output), scale });
        ready.chain(output).collect()
    }

    /// Span of the target's Lambda, decibels.
    pub fn range_db(&self) -> Option<f64> {
        let scale = self.maps.result()?.frame.full.as_ref()?.scale;
        Some(scale.decibels())
    }

    /// The part of the recording that the reflectors on screen leave unexplained, where its map is in sight.
    pub fn unexplained(&self) -> Option<&Unexplained> {
        self.maps.result()?.unexplained.as_ref()?.as_ref().ok()
    }

    /// Figures of either method's output against the target of the same scene.
    pub fn scores_in(&self, slot: MethodSlot) -> Option<Scores> {
        self.method(slot).output()?;
        self.maps.result()?.scores[slot as usize]
    }

    /// Whether any worker is busy, or will be as soon as the scene rests.
    pub fn is_busy(&self) -> bool {
        self.maps.is_busy() || self.methods.iter().any(MethodJob::is_busy)
    }

    /// Whether the shown output belongs to other samples than the shown maps.
    pub fn output_is_outdated(&self) -> bool {
        self.method(MethodSlot::First).outdated().is_some()
    }

    /// Whether a map has belonged to an earlier scene for so long that it must be marked.
    pub fn is_stale(&self, kind: MapKind) -> bool {
        let old = |since: Option<Instant>| since.is_some_and(|t| t.elapsed() > STALE);
        old(self.maps.waiting) || kind.slot().is_some_and(|slot| old(self.method(slot).outdated()))
    }
}

/// A value of maps and methods that panels read, besides the pictures of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Want {
    EveryMap,
    /// The first method's output.
    Output,
    Second,
    Listed,
    Roc,
}
