//! Commands that start or stop long work.

use crate::app::jobs::{Jobs, RunTimePlan, Watched, tell};
use crate::app::state::{MethodSlot, Panel, State, WorkCommand};
use std::path::PathBuf;

pub fn apply(state: &mut State, jobs: &mut Jobs, command: WorkCommand) {
    match command {
        WorkCommand::CancelMethod => jobs.pipeline.method_mut(MethodSlot::First).cancel(),
        WorkCommand::CancelSecond => jobs.pipeline.method_mut(MethodSlot::Second).cancel(),
        WorkCommand::Measure { thorough } => {
            jobs.run_time.begin(RunTimePlan { radar: state.radar().clone(), thorough });
        }
        WorkCommand::CancelMeasurement => jobs.run_time.cancel(),
        WorkCommand::WatchLog(path) => watch(state, jobs, path),
        WorkCommand::Listen(plan) => {
            state.arrangement.set_open(Panel::Recording, true);
            let said =
                jobs.listening.begin(plan).map(|port| format!("Listening to a capture card on UDP port {port}."));
            tell(state, said);
        }
        WorkCommand::StopListening => jobs.listening.stop(),
    }
}

pub fn watch(state: &mut State, jobs: &mut Jobs, log: PathBuf) {
    jobs.training = Some(Watched::of(log));
    state.arrangement.set_open(Panel::Training, true);
}
