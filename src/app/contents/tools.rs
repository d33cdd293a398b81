//! What settings and tools are told.

use super::{Contents, offered};
use crate::app::jobs::BoundsRequest;
use crate::app::panels::{
    bounds, chirp, controls, doppler, evaluation, found, lesson, phasors, run_time, several, timing, training,
};
use crate::app::state::{Command, MapKind, MethodSlot};
use eframe::egui::{TextureOptions, Ui};

impl Contents<'_> {
    pub(super) fn controls(&mut self, ui: &mut Ui) -> Vec<Command> {
        let (state, pipeline) = (&*self.state, &self.jobs.pipeline);
        let run = controls::Run {
            progress: pipeline.method_progress(),
            refusal: pipeline.refusal(),
            output: pipeline.output().map(|o| (o.method, o.took)),
            // How many blobs there are answers many a question.
            scores: pipeline.scores().filter(|_| !state.is_predicting()),
            outdated: pipeline.output_is_outdated(),
            wanted: pipeline.wants_output(),
            detector_error: pipeline.detector_error(),
            search: controls::Search { progress: self.jobs.thresholds.progress(), note: self.jobs.thresholds.note() },
        };
        let input = controls::Input {
            is_recorded: state.editor.document().recording().is_some(),
            settings: &state.settings,
            radar: state.radar(),
            noise_seed: state.editor.scene().noise_seed,
            methods: offered(state, self.jobs),
            method: state.method().map(|m| m.as_ref()),
            eta: pipeline.eta(state, MethodSlot::First),
            range_db: pipeline.range_db(),
            run,
            uses: state.uses(),
        };
        controls::show(ui, input, &mut self.memory.controls)
    }

    pub(super) fn found(&mut self, ui: &mut Ui) -> Vec<Command> {
        let pipeline = &self.jobs.pipeline;
        let output = pipeline.output_of(self.state);
        let recording = self.state.editor.document().recording();
        let input = found::Input {
            draws_only: self.state.method().map(|m| m.name()).filter(|_| !self.state.finds_reflectors()),
            method: output.map(|o| o.method),
            found: output.filter(|_| !self.state.is_predicting()).and_then(|o| o.found.as_deref()),
            attempts: output.map_or(&[], |o| o.attempts.as_slice()),
            objects: &self.state.editor.scene().objects,
            refusal: pipeline.refusal().map(|r| r.reason.as_str()),
            stale: pipeline.is_stale(MapKind::Output),
            has_ranges: self.state.radar().samples > 1 || recording.is_some_and(|r| r.range_metres.is_some()),
        };
        found::show(ui, input)
    }

    pub(super) fn timing(&mut self, ui: &mut Ui) -> Vec<Command> {
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

    pub(super) fn bounds(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.bounds;
        let input = bounds::Input {
            settings: self.state.settings.bounds,
            elements: self.state.radar().elements,
            has_subject: BoundsRequest::of(self.state).is_some(),
            result: job.value(),
        };
        bounds::show(ui, input, &mut self.memory.bounds)
    }

    pub(super) fn phasors(&mut self, ui: &mut Ui) -> Vec<Command> {
        let state = &*self.state;
        let input = phasors::Input {
            radar: state.radar(),
            settings: state.settings.phasors,
            finds_reflectors: state.finds_reflectors(),
            is_recorded: state.editor.document().recording().is_some(),
            result: self.jobs.phasors.value(),
        };
        phasors::show(ui, input, &mut self.memory.phasors)
    }

    pub(super) fn chirp(&mut self, ui: &mut Ui) -> Vec<Command> {
        let state = &*self.state;
        let input = chirp::Input {
            radar: state.radar(),
            scene: state.scene(),
            settings: state.settings.chirp,
            is_recorded: state.editor.document().recording().is_some(),
            result: self.jobs.chirps.value(),
        };
        chirp::show(ui, input)
    }

    pub(super) fn range_doppler(&mut self, ui: &mut Ui) -> Vec<Command> {
        let state = &*self.state;
        let input = doppler::Input {
            radar: state.radar(),
            scene: state.scene(),
            seconds: state.timeline.seconds(),
            is_playing: state.timeline.is_playing(),
            marks: state.settings.show_reflectors,
            colours: state.settings.colours,
            normalisation: state.settings.normalisation,
            is_recorded: state.editor.document().recording().is_some(),
            result: self.jobs.dopplers.value(),
        };
        doppler::show(ui, input, &mut self.memory.doppler)
    }

    pub(super) fn evaluation(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.evaluation;
        let input = evaluation::Input {
            methods: offered(self.state, self.jobs),
            method: self.state.method().map(|m| m.name()),
            radar: job.radar().unwrap_or(self.state.radar()),
            progress: job.progress(),
            rows: job.rows(),
            note: job.note(),
        };
        evaluation::show(ui, input, &mut self.memory.evaluation)
    }

    pub(super) fn run_time(&mut self, ui: &mut Ui) -> Vec<Command> {
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

    pub(super) fn lesson(&mut self, ui: &mut Ui) -> Vec<Command> {
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

    pub(super) fn several(&mut self, ui: &mut Ui) -> Vec<Command> {
        let input = several::Input {
            several: &self.state.settings.several,
            radar: self.state.radar(),
            methods: offered(self.state, self.jobs),
            maps: self.jobs.several.shown(),
            veiled: self.state.is_predicting(),
        };
        several::show(ui, input, &mut self.memory.several)
    }

    pub(super) fn training(&mut self, ui: &mut Ui) -> Vec<Command> {
        let job = &self.jobs.training;
        let running = job.is_running().then(|| job.progress().unwrap_or(0.0));
        let input = training::Input { path: job.path(), log: job.log(), note: job.note(), running };
        training::show(ui, input, &mut self.memory.training)
    }
}
