//! Commands that start long work, or stop it.

use crate::app::jobs::{EvaluationPlan, Jobs, Purpose, tell};
use crate::app::state::{Command, EvaluationChoice, MethodSlot, Panel, PinnedCut, State};
use crate::evaluate::campaign::Campaign;

/// Does those commands, and hands others on.
pub fn apply(state: &mut State, jobs: &mut Jobs, command: Command) -> Option<Command> {
    match command {
        Command::NextMethod => {
            let next = state.method().and_then(|now| state.methods.after(now.name()));
            next.into_iter().for_each(|name| state.settings.method = name.to_owned());
        }
        Command::PinCuts => {
            let (radar, cursor) = (state.radar().clone(), state.cut_cursor());
            state.pins.push(PinnedCut { radar, cursor, maps: jobs.pipeline.cut_maps() });
        }
        Command::Unpin(index) => state.pins.remove(index),
        Command::UnpinAll => state.pins.clear(),
        Command::CancelMethod => jobs.pipeline.cancel_method(MethodSlot::First),
        Command::CancelSecond => jobs.pipeline.cancel_method(MethodSlot::Second),
        Command::Evaluate(choice) => jobs.evaluation.begin(evaluation_plan(state, &choice)),
        Command::CancelEvaluation => jobs.evaluation.cancel(),
        Command::Measure { thorough } => jobs.run_time.begin(state.radar().clone(), thorough),
        Command::CancelMeasurement => jobs.run_time.cancel(),
        Command::OpenLog => jobs.choose_file(state, Purpose::OpenLog),
        Command::WatchLog(path) => {
            jobs.training.follow(path);
            state.arrangement.set_open(Panel::Training, true);
        }
        Command::Train(recipe) => train(state, jobs, recipe),
        Command::CancelTraining => jobs.training.cancel(),
        other => return Some(other),
    }
    None
}

fn evaluation_plan(state: &State, choice: &EvaluationChoice) -> EvaluationPlan {
    let campaign = Campaign {
        radar: state.radar().clone(),
        count: choice.count,
        seed: choice.seed,
        floor: state.settings.floor,
        normalisation: state.settings.normalisation,
        ..Campaign::default()
    };
    let methods = state.methods.all.iter().filter(|m| choice.methods.contains(&m.name())).cloned().collect();
    EvaluationPlan { campaign, sets: choice.sets.clone(), methods }
}

#[cfg(feature = "network")]
fn train(state: &mut State, jobs: &mut Jobs, name: &str) {
    use crate::network::recipe::{Recipe, SHIPPED};
    let shipped = SHIPPED.iter().find(|(shipped, _)| *shipped == name);
    let Some(recipe) = shipped.and_then(|(name, text)| Recipe::parse(name, text).ok()) else { return };
    let steps = recipe.training_scenes().len() / recipe.batch.max(1) * recipe.epochs as usize;
    let Some(folder) = jobs.new_run(name) else {
        return state.notices.error("There is no folder to train in; start it with apertura train instead.");
    };
    tell(
        state,
        match jobs.training.begin(name, &folder, Some(steps as u64)) {
            Ok(()) => Ok(format!("Training {name} in {}", folder.display())),
            Err(error) => Err(format!("{}: the training can't be started: {error}", folder.display())),
        },
    );
}

#[cfg(not(feature = "network"))]
fn train(state: &mut State, _: &mut Jobs, _: &str) {
    state.notices.error("This build can't train.");
}
