//! Grids that a dragged object snaps to.

use super::Place;
use crate::radar::Radar;
use serde::{Deserialize, Serialize};

/// Grid that dragged objects snap to.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Snap {
    #[default]
    Off,
    /// A square grid of this many metres.
    Metres(f64),
    /// The centre of a cell of the map: a whole range bin and a whole column.
    Cells,
}

impl Snap {
    /// The allowed place nearest to `place`.
    pub fn apply(self, radar: &Radar, place: Place) -> Place {
        match self {
            Snap::Off => place,
            Snap::Metres(step) if step > 0.0 => {
                Place::new((place.x_metres / step).round() * step, (place.y_metres / step).round() * step)
            }
            Snap::Metres(_) => place,
            Snap::Cells => {
                let polar = radar.polar_of(place.x_metres, place.y_metres);
                let range = radar.range_of_bin_metres(radar.bin_of_range(polar.range_metres).round().max(1.0));
                // With the two-way carrier a column stands for two directions; snap in units of a column around the true one.
                let step = radar.cos_of_column(1.0) - radar.cos_of_column(0.0);
                let cos = ((polar.cos_theta / step).round() * step).clamp(-1.0, 1.0);
                let y = range * (1.0 - cos * cos).max(0.0).sqrt();
                Place::new(range * cos, if place.y_metres < 0.0 { -y } else { y })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapped_places_are_whole_cells() {
        let radar = Radar::default();
        let p = Snap::Cells.apply(&radar, Place::new(4.321, 12.345));
        let polar = radar.polar_of(p.x_metres, p.y_metres);
        let (bin, column) = (radar.bin_of_range(polar.range_metres), radar.column_of_cos(polar.cos_theta));
        assert!((bin - bin.round()).abs() < 1e-9 && (column - column.round()).abs() < 1e-6, "{bin} {column}");
        assert!(p.distance_metres(Place::new(4.321, 12.345)) < 0.1);
    }

    #[test]
    fn a_grid_rounds_places() {
        let radar = Radar::default();
        assert_eq!(Snap::Metres(0.5).apply(&radar, Place::new(1.3, -0.8)), Place::new(1.5, -1.0));
        assert_eq!(Snap::Off.apply(&radar, Place::new(1.3, 0.8)), Place::new(1.3, 0.8));
        assert_eq!(Snap::Metres(0.0).apply(&radar, Place::new(1.3, 0.8)), Place::new(1.3, 0.8));
    }
}
