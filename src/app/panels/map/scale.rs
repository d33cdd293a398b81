//! What the colours of a map stand for.

use crate::app::state::{DifferenceView, MapKind, Units};
use crate::app::widgets::colour_bar::Bar;
use crate::app::widgets::levels::lowest_db;
use crate::app::widgets::textures::colour_table;
use crate::maps::LambdaScale;
use crate::picture::ColourMap;

/// The scale of a map's colours.
pub struct Scale {
    /// Which map.
    pub kind: MapKind,
    /// Colours of Lambda.
    pub colours: ColourMap,
    /// What is counted.
    pub units: Units,
    /// From Lambda to decades, where it is known.
    pub lambda: Option<LambdaScale>,
    /// How a difference is drawn.
    pub difference: DifferenceView,
    /// Where the scale of a difference or of doubt ends, Lambda.
    pub end: f32,
}

impl Scale {
    /// The bar of this scale.
    pub fn bar(&self) -> Bar {
        let range_db = self.lambda.map(|s| 20.0 * (s.peak - s.floor)).filter(|range| *range > 0.0);
        let range_db = range_db.filter(|_| self.units == Units::Decibels);
        if self.kind == MapKind::Doubt {
            let high = f64::from(self.end) * range_db.unwrap_or(1.0);
            return Bar::new(colour_table(self.colours), 0.0, high, if range_db.is_some() { "± dB" } else { "± Λ" });
        }
        if !self.kind.is_difference() {
            let table = colour_table(self.colours);
            return match range_db {
                Some(range) => Bar { told_from: lowest_db(range), ..Bar::new(table, -range, 0.0, "dB") },
                None => Bar::new(table, 0.0, 1.0, "Λ, normalised"),
            };
        }
        let high = f64::from(self.end) * range_db.unwrap_or(1.0);
        let decibels = range_db.is_some();
        match (self.difference.absolute, decibels) {
            (true, true) => Bar::new(colour_table(self.colours), 0.0, high, "|Δ| dB"),
            (true, false) => Bar::new(colour_table(self.colours), 0.0, high, "|ΔΛ|"),
            (false, true) => Bar::new(colour_table(ColourMap::Diverging), -high, high, "Δ dB"),
            (false, false) => Bar::new(colour_table(ColourMap::Diverging), -high, high, "ΔΛ"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const END: f32 = 0.2;

    /// Ends and title of the bar.
    fn scale(kind: MapKind, units: Units, absolute: bool) -> (f64, f64, &'static str) {
        let lambda = Some(LambdaScale { peak: 1.0, floor: -2.0 });
        let difference = DifferenceView { absolute, whole: false };
        let bar = Scale { kind, colours: ColourMap::Grey, units, lambda, difference, end: END }.bar();
        (bar.low, bar.high, bar.title)
    }

    #[test]
    fn the_scale_of_a_map_is_normalised() {
        assert_eq!(scale(MapKind::Target, Units::Lambda, false), (0.0, 1.0, "Λ, normalised"));
        assert_eq!(scale(MapKind::Target, Units::Decibels, false), (-60.0, 0.0, "dB"));
    }

    #[test]
    fn a_difference_is_symmetric() {
        let end = f64::from(END);
        assert_eq!(scale(MapKind::Difference, Units::Lambda, false), (-end, end, "ΔΛ"));
        assert_eq!(scale(MapKind::Difference, Units::Decibels, false), (-60.0 * end, 60.0 * end, "Δ dB"));
    }

    #[test]
    fn what_has_no_sign_begins_at_0() {
        assert_eq!(scale(MapKind::Doubt, Units::Lambda, false), (0.0, f64::from(END), "± Λ"));
        assert_eq!(scale(MapKind::Difference, Units::Lambda, true), (0.0, f64::from(END), "|ΔΛ|"));
    }
}
