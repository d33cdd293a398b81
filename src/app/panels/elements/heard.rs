//! Choice of the layout of elements that methods use: from a list, or by its typed name or numbers.

use crate::app::state::{Command, State, ViewCommand};
use crate::app::widgets::{choice, entry_problem, text_entry};
use crate::radar::{LayoutKind, Radar};
use eframe::egui::Ui;

const HEARD_TOOLTIP: &str = "The elements that methods hear. The target stays the map of the whole array. Not every method hears other elements than those of the two ends";

pub(super) fn show(ui: &mut Ui, state: &State, asked: &mut Vec<Command>) {
    // No other layout can be used on the samples of the two ends alone.
    if state.editor.document().recording().is_some_and(|recording| recording.signal().is_none()) {
        return;
    }
    let (radar, layout, id) = (state.radar(), state.settings.layout.as_ref(), ui.scope_id().with("heard as text"));
    ui.horizontal_wrapped(|ui| {
        let mut chosen = layout.cloned();
        let offered = std::iter::once(None).chain(suggested(radar).map(Some));
        choice(ui, "heard", HEARD_TOOLTIP, &mut chosen, offered, |layout| {
            (name(layout.as_ref()), tip(layout.as_ref()))
        });
        let shown = (layout.unwrap_or(&LayoutKind::TwoEnds).to_string(), 180.0);
        let typed = text_entry(ui, id, ("as text", LayoutKind::NAMES), shown, true, |text| layout_of(text, radar));
        let new = typed.or_else(|| (chosen.as_ref() != layout).then_some(chosen));
        asked.extend(new.map(|layout| Command::View(ViewCommand::Hear(layout))));
    });
    entry_problem(ui, id);
}

fn name(layout: Option<&LayoutKind>) -> String {
    layout.map_or_else(|| "the two ends".to_owned(), LayoutKind::to_string)
}

fn tip(layout: Option<&LayoutKind>) -> &'static str {
    match layout {
        None => "The first and the last elements of the array",
        Some(LayoutKind::Nested { .. }) => "nested=AxB: A neighbours, and B elements A + 1 apart",
        Some(LayoutKind::Coprime { .. }) => "coprime=MxN: N elements M apart, and 2 M elements N apart",
        Some(LayoutKind::Thinned { .. }) => "thinned=K: every K-th element",
        Some(LayoutKind::Random { .. }) => "random=N:SEED: N elements at random places, the outermost two among them",
        Some(_) => "These elements",
    }
}

/// A layout of each kind over most of the array.
fn suggested(radar: &Radar) -> impl Iterator<Item = LayoutKind> {
    let elements = radar.elements;
    let neighbours = elements.isqrt().saturating_sub(1).max(1);
    let reaches = |step: &usize| (2 * step - 1) * (step + 1) < elements;
    let step = (1..).take_while(reaches).last().unwrap_or(1);
    let few = (2 * radar.end_elements).clamp(2, elements.max(2));
    [
        LayoutKind::Nested { neighbours, apart: (elements / (neighbours + 1)).max(1) },
        LayoutKind::Coprime { step, many: step + 1 },
        LayoutKind::Thinned { step: elements.div_ceil(few) },
        LayoutKind::Random { elements: few, seed: 0 },
    ]
    .into_iter()
    .filter(|layout| layout.numbers(radar).is_ok())
}

/// The layout that a text names; `None` for the two ends.
fn layout_of(text: &str, radar: &Radar) -> Result<Option<LayoutKind>, String> {
    let layout: LayoutKind = text.parse()?;
    layout.numbers(radar)?;
    Ok(Some(layout).filter(|layout| *layout != LayoutKind::TwoEnds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_of_layout_is_offered_for_the_radar() {
        for (elements, end_elements) in [(1024, 12), (86, 8), (64, 3), (16, 4)] {
            let radar = Radar { elements, end_elements, ..Radar::default() };
            let offered: Vec<LayoutKind> = suggested(&radar).collect();
            assert_eq!(offered.len(), 4, "{elements}: {offered:?}");
            for layout in offered {
                let numbers = layout.numbers(&radar).unwrap();
                assert!(numbers.len() < elements && *numbers.last().unwrap() > elements / 2, "{layout}: {numbers:?}");
            }
        }
    }
}
