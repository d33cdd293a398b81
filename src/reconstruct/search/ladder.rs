//! The search in reading order.
//!
//! Each rung changes what was found so far. The search stops after the first rung whose answer leaves nothing that stands out of the
//! noise, or after the last. What was found is then read off as objects (`finish`): one gain for both
//! ends, one reflectivity an object.
//!
//! Within a rung, work is counted ([`Settings::max_work`](super::Settings)): where it is spent, each loop ends with the best it has.

use super::state::{Search, State};
use crate::reconstruct::ReconstructError;
use crate::reconstruct::attempt::{Refusal, Tried};

/// The change that a rung makes to the state of a search.
type RungWork = fn(&Search, State) -> Result<State, ReconstructError>;

/// One step of the search.
pub struct Rung {
    /// Name of the rung in traces.
    pub name: &'static str,
    /// The effect of the rung, in a sentence.
    pub does: &'static str,
    work: RungWork,
}

/// Every rung, in their order.
pub const LADDER: &[Rung] = &[
    Rung {
        name: "tones",
        does: "Pairs the tones that each end hears into points. Keeps them only if they are all there is.",
        work: |search, state| search.tone_points(state),
    },
    Rung {
        name: "lines",
        does: "Looks for lines of any direction that begin where both ends may hear a point.",
        work: |search, state| search.rows_of_any_direction(state),
    },
    Rung {
        name: "pairs",
        does: "Pairs the tones that the lines leave into points, and puts lines in place of points at equal steps.",
        work: |search, state| search.paired_in_rounds(state),
    },
    POINTS,
];

/// Adds points to an answer that is there.
pub(super) const POINTS: Rung = Rung {
    name: "points",
    does: "Adds points where the residual of both ends stands out, refines them, and takes away those that explain too little.",
    work: |search, state| search.points_in_residual(state),
};

/// `state` after `rungs`, one after another until nothing stands out.
///
/// # Errors
/// [`ReconstructError::Cancelled`].
pub(super) fn after_rungs(search: &Search, rungs: &[Rung], mut state: State) -> Result<State, ReconstructError> {
    for rung in rungs {
        search.trace.enter(rung.name);
        let (before, attempts) = (state.fit.atoms.clone(), search.trace.count());
        state = (rung.work)(search, state)?;
        search.record_changes(&before, &state.fit);
        if search.trace.count() == attempts {
            search.record_refusal(Tried::Nothing, 0.0, Refusal::NothingFound);
        }
        if state.is_complete {
            break;
        }
    }
    Ok(state)
}
