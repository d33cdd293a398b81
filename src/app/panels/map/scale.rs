//! Scale of a map's colours.

use super::input::Input;
use crate::app::state::{MapKind, Units};
use crate::app::widgets::{Bar, colour_table, lowest_db};
use crate::picture::ColourMap;

pub fn bar(input: &Input<'_>) -> Bar {
    let (kind, look) = (input.kind, &input.state.settings.view);
    let lambda = input.cells.as_ref().and_then(|cells| cells.scale);
    let range_db = lambda.map(|s| s.decibels()).filter(|range| *range > 0.0);
    let range_db = range_db.filter(|_| look.units == Units::Decibels);
    let table = colour_table(look.colours);
    let high = f64::from(input.end) * range_db.unwrap_or(1.0);
    if kind == MapKind::Doubt {
        return Bar::new(table, 0.0, high, if range_db.is_some() { "± dB" } else { "± Λ" });
    }
    if !kind.is_difference() {
        return match range_db {
            Some(range) => Bar { told_from: lowest_db(range), ..Bar::new(table, -range, 0.0, "dB") },
            None => Bar::new(table, 0.0, 1.0, "Λ, normalised"),
        };
    }
    match (look.difference.absolute, range_db.is_some()) {
        (true, true) => Bar::new(table, 0.0, high, "|Δ| dB"),
        (true, false) => Bar::new(table, 0.0, high, "|ΔΛ|"),
        (false, true) => Bar::new(colour_table(ColourMap::Diverging), -high, high, "Δ dB"),
        (false, false) => Bar::new(colour_table(ColourMap::Diverging), -high, high, "ΔΛ"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::panels::map::frame::Cells;
    use crate::app::state::{DifferenceView, State};
    use crate::maps::{LambdaScale, RangeAngleMap};

    const END: f32 = 0.2;

    fn scale(kind: MapKind, units: Units, absolute: bool) -> (f64, f64, &'static str) {
        let mut state = State::new(Vec::new());
        (state.settings.units, state.settings.difference) = (units, DifferenceView { absolute, whole: false });
        let map = RangeAngleMap { lambda: ndarray::Array2::zeros((1, 1)) };
        let cells = Some(Cells { map: &map, minus: None, scale: Some(LambdaScale { peak: 1.0, floor: -2.0 }) });
        let bar = bar(&Input { cells, end: END, ..Input::bare(kind, &state) });
        (bar.low, bar.high, bar.title)
    }

    #[test]
    fn a_map_is_normalised_and_only_a_signed_difference_symmetric() {
        let end = f64::from(END);
        for (kind, units, absolute, expected) in [
            (MapKind::Target, Units::Lambda, false, (0.0, 1.0, "Λ, normalised")),
            (MapKind::Target, Units::Decibels, false, (-60.0, 0.0, "dB")),
            (MapKind::Difference, Units::Lambda, false, (-end, end, "ΔΛ")),
            (MapKind::Difference, Units::Decibels, false, (-60.0 * end, 60.0 * end, "Δ dB")),
            (MapKind::Doubt, Units::Lambda, false, (0.0, end, "± Λ")),
            (MapKind::Difference, Units::Lambda, true, (0.0, end, "|ΔΛ|")),
        ] {
            assert_eq!(scale(kind, units, absolute), expected, "{kind:?}");
        }
    }
}
