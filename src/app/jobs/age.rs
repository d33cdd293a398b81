//! Checks for old maps and marks that are drawn as fresh.

use super::Jobs;
use super::source::Source;
use super::theory::TheoryRequest;
use crate::app::state::{MapKind, MethodSlot, Panel, State};

impl Jobs {
    /// Names of the maps and marks drawn as fresh that belong to an earlier scene or settings. There are some only for a moment after a change.
    pub fn drawn_as_fresh_but_old(&self, state: &State) -> Vec<String> {
        let mut old = Vec::new();
        let shown = state.arrangement.shown();
        let mut note = |is_old: bool, what: &str| old.extend(is_old.then(|| what.to_owned()));
        for kind in state.pictured() {
            note(!self.pipeline.is_stale(kind) && self.is_of_another_source(state, kind), kind.title());
        }
        let marks_found =
            state.draws_found() && shown.contains(&Panel::Scene) && !self.pipeline.is_stale(MapKind::Output);
        let output = self.pipeline.output_of(state).filter(|o| marks_found && !o.reflectors.is_empty());
        let source = Source::of(state);
        note(output.is_some_and(|o| o.pair.origin.source != source), "what was found");
        let judged = super::judged_output(&self.kinds, MethodSlot::First, &self.pipeline);
        let marks_kinds = state.settings.show_kinds && !state.is_predicting();
        note(
            judged.is_some_and(|(judged, current)| marks_kinds && current && judged.scene != source.scene),
            "kinds of failure",
        );
        note(self.theory.is_fresh_but_old(TheoryRequest::of(state).as_ref()), "theory");
        old
    }

    /// Whether the picture of a map is made of other samples, or by another method, than those on screen.
    fn is_of_another_source(&self, state: &State, kind: MapKind) -> bool {
        let source = Source::of(state);
        let Some(maps) = self.pipeline.maps.result().filter(|r| r.pictures.contains_key(&kind)) else { return false };
        let Some(slot) = kind.slot() else { return maps.request.source != source };
        let pair = maps.request.pairs[slot as usize].as_ref();
        let method = state.method_in(slot).map(|method| method.name());
        pair.is_some_and(|pair| pair.origin.source != source || Some(pair.origin.method) != method)
    }
}
