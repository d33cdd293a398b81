//! Sharing of the scene on screen and its view as a line of text.

use super::lesson;
use crate::app::state::{MapView, State, View};
use crate::interact::Document;
use crate::lesson::shipped;
use crate::platform;
use crate::radar::Radar;
use crate::share::{LessonPlace, ShareError, SharedScene, SharedView, VisiblePart};
use eframe::egui::pos2;

/// Longest link that browsers open, bytes.
const MAX_LINK_BYTES: usize = 2 << 20;

/// A link to this page that opens the scene on screen.
///
/// # Errors
/// The reason why there is none.
pub fn link(state: &State) -> Result<String, String> {
    let address = platform::page_address().ok_or("only a page has an address")?;
    let link = format!("{address}#{}", of(state).map_err(|e| e.to_string())?);
    let letters = link.len();
    let too_long = || {
        format!(
            "the link would have {letters} letters, browsers open {MAX_LINK_BYTES}; save the scene as a file instead"
        )
    };
    (letters <= MAX_LINK_BYTES).then_some(link).ok_or_else(too_long)
}

/// The scene on screen and its view as text.
///
/// # Errors
/// [`ShareError`] where they can't be written as text.
pub fn of(state: &State) -> Result<String, ShareError> {
    share(state).to_text()
}

fn share(state: &State) -> SharedScene {
    let method = state.method().map_or_else(String::new, |m| m.name().to_owned());
    let is_shipped = |id: &str| shipped::ALL.iter().any(|s| s.id == id);
    let lesson = state.lesson.as_ref().filter(|run| is_shipped(&run.id));
    let lesson = lesson.map(|run| LessonPlace { id: run.id.clone(), step: run.step + 1 });
    let parts = [by_column(state.radar(), part(state.map_views.range_angle)), part(state.map_views.cartesian)];
    let view = SharedView::of(&View { method, ..state.settings.view.clone() }, parts, lesson);
    let view = SharedView { time_seconds: state.timeline.seconds, ..view };
    SharedScene { file: state.editor.document().to_file(), view }
}

fn part(view: MapView) -> VisiblePart {
    let [left, bottom, right, top] =
        [view.low.x, view.low.y, view.high.x, view.high.y].map(|edge| edge.clamp(0.0, 1.0));
    VisiblePart { left, bottom, right, top }
}

/// Mirrors a visible part where cos(theta) falls from column to column: shared texts count from the first column.
fn by_column(radar: &Radar, part: VisiblePart) -> VisiblePart {
    if radar.columns_fall() { VisiblePart { left: 1.0 - part.right, right: 1.0 - part.left, ..part } } else { part }
}

/// Opens a shared text.
///
/// # Errors
/// The reason why it can't be read; the scene on screen stays.
pub fn open(state: &mut State, text: &str) -> Result<(), String> {
    let shared = SharedScene::from_text(text);
    let SharedScene { file, view } = shared.map_err(|error| format!("{error}\nThe scene on screen was kept."))?;
    if let Some(place) = &view.lesson {
        let index = shipped::ALL.iter().position(|lesson| lesson.id == place.id);
        match index {
            Some(index) => {
                lesson::begin_shipped(state, index)?;
                lesson::go_to(state, place.step.saturating_sub(1));
            }
            None => {
                state.notices.error(format!("There is no lesson \"{}\" here; the scene was opened alone.", place.id))
            }
        }
    }
    let before = state.setup();
    state.set_document(Document::unsaved(None, file));
    look(state, view);
    let after = state.setup();
    // Leaving a lesson takes everything back, so no undo step is needed.
    if state.lesson.is_none() {
        state.guided.push(before, after);
    }
    Ok(())
}

fn look(state: &mut State, view: SharedView) {
    if state.methods.called(&view.method).is_none() {
        state.notices.info(format!("There is no method \"{}\" here; another one is shown.", view.method));
    }
    let seen = |part: VisiblePart| MapView { low: pos2(part.left, part.bottom), high: pos2(part.right, part.top) };
    state.map_views.range_angle = seen(by_column(state.radar(), view.range_angle_part));
    state.map_views.cartesian = seen(view.cartesian_part);
    state.timeline.set(state.editor.scene(), view.time_seconds);
    view.show_in(&mut state.settings);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Convention;

    #[test]
    fn the_part_of_a_map_in_a_text_counts_from_the_first_column() {
        let (thesis, physical) = (Radar::default(), Radar::default().in_convention(Convention::Physical));
        let drawn = VisiblePart { left: 0.0, right: 0.25, ..VisiblePart::default() };
        assert_eq!(by_column(&thesis, drawn), drawn);
        assert_eq!(by_column(&physical, drawn), VisiblePart { left: 0.75, right: 1.0, ..drawn });
        assert_eq!(by_column(&physical, by_column(&physical, drawn)), drawn);
    }
}
