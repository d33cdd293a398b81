//! Widgets of panels, which import them from here.

pub mod axes;
mod chart;
mod colour_bar;
mod entry;
pub mod focus_ring;
pub mod icons;
mod inline;
mod labelled;
pub mod legend;
mod method_menu;
#[cfg(feature = "live")]
mod networks;
mod nudge;
mod number_field;
mod numbers;
mod padded;
mod progress;
#[cfg(test)]
#[path = "tests/seen.rs"]
pub mod seen;
mod text_entry;
pub mod theme;

pub use axes::{Axis, Tick};
pub use chart::{Chart, Drawn, Span};
pub use colour_bar::{Bar, Texture, colour_table, picture};
pub use entry::{button, choices, entry, entry_called, item, press, tick, ticked, tooltip};
pub use icons::{Icon, cross, edged, icon};
pub use inline::{LARGE_TEXT_RATIO, inline, large};
pub use labelled::{Quantity, choice, labelled};
pub use method_menu::{
    LIST_HEIGHT, kind_boxes, kind_names, member_box, method_lines, method_list, method_menu, ticking_menu,
};
pub use nudge::{focus_after_click, focused_steps, keep_arrows, list_keys, nudge, pan_keys, zoom_keys};
pub use number_field::{NumberField, Wanted};
pub use numbers::{
    CONVENTION, angle_degrees, angle_of_place_degrees, difference, direction, level, lowest_db, percent, plain,
    scientific, signed, significant, with_minuses, with_unit,
};
pub use padded::{
    Computed, computed, empty_text, group, headings, padded, rarely, right_aligned, row, row_of, scrolled,
    scrolled_both, warning,
};
pub use progress::{bar, progress, start_or_cancel};
pub use text_entry::{entry_problem, text_entry};
pub use theme::{CAPTION, CAPTION_INK, Inks, MARK, MARK_EDGE, MARK_SELECTED};
