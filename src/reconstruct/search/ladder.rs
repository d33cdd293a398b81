//! The steps of the search in their order.
//!
//! Each rung changes the list of objects. The search stops after the first rung whose residual has no peak above the noise, or after the last. Then
//! each object gets one gain for both ends and one reflectivity (`finish`). Where the budget of work
//! ([`Settings::max_work`](super::Settings)) is used up, each loop ends with its best result.

use super::state::{Search, State};
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Proposal, Refusal};

/// The state of a search after a rung, from that before.
type RungWork = fn(&Search, State) -> Result<State, ReconstructError>;

/// A step of the search.
pub struct Rung {
    /// Name in traces.
    pub name: &'static str,
    /// The effect, in a sentence for the user.
    pub does: &'static str,
    work: RungWork,
}

/// All rungs, the first one first.
pub const LADDER: &[Rung] = &[
    Rung {
        name: "tones",
        does: "Pairs the tones of both ends into points, and keeps them if they explain the samples.",
        work: |search, state| search.tone_points(state),
    },
    Rung {
        name: "lines",
        does: "Searches for lines of any direction that begin where both ends may have a point.",
        work: |search, state| search.rows_of_any_direction(state),
    },
    Rung {
        name: "pairs",
        does: "Pairs the tones that the lines leave into points.",
        work: |search, state| search.paired_in_rounds(state),
    },
    POINTS,
];

/// The last rung, which a followed answer uses alone too.
pub(super) const POINTS: Rung = Rung {
    name: "points",
    does: "Adds points where the residual of both ends stands out, refines them, and removes those that explain too little.",
    work: |search, state| search.points_in_residual(state),
};

/// `state` after `rungs`, up to the first that completes it.
pub(super) fn after_rungs(search: &Search, rungs: &[Rung], mut state: State) -> Result<State, ReconstructError> {
    for rung in rungs {
        search.trace.enter(rung.name);
        let (before, attempts) = (state.fit.atoms.clone(), search.trace.count());
        state = (rung.work)(search, state)?;
        search.record_changes(&before, &state.fit);
        if search.trace.count() == attempts {
            search.record_refusal(Proposal::Nothing, 0.0, Refusal::NothingFound);
        }
        if state.is_complete {
            break;
        }
    }
    Ok(state)
}
