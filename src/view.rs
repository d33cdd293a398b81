//! The view of a scene, which settings keep, links and lessons change, and campaigns, pictures and undo read.

use crate::evaluate::campaign::Campaign;
use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::picture::ColourMap;
#[cfg(feature = "pictures")]
use crate::picture::Style;
use crate::radar::{DecibelMilliwatts, Decibels, LayoutKind, Radar};
use crate::signal::Floor;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Coordinates of the maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Projection {
    /// cos(theta) across, range up.
    #[default]
    RangeAngle,
    /// x across, y up, as in the scene.
    Cartesian,
}

impl Projection {
    /// The other projection.
    pub fn other(self) -> Projection {
        match self {
            Projection::RangeAngle => Projection::Cartesian,
            Projection::Cartesian => Projection::RangeAngle,
        }
    }
}

/// Units of the scale of a map or a cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Units {
    /// Lambda, 0 to 1.
    #[default]
    Lambda,
    /// Decibels below the peak.
    Decibels,
}

impl Units {
    /// The other units.
    pub fn other(self) -> Units {
        match self {
            Units::Lambda => Units::Decibels,
            Units::Decibels => Units::Lambda,
        }
    }
}

/// Units of the axis of directions, in every map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Directions {
    /// cos θ, which the columns divide evenly.
    #[default]
    Cosine,
    /// Degrees from straight ahead.
    Degrees,
}

/// Sign and scale of the difference of output and target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct DifferenceView {
    /// Whether the absolute value is drawn, in place of output minus target.
    pub absolute: bool,
    /// Whether the scale reaches 1 for any difference, in place of the smallest that holds it.
    pub whole: bool,
}

/// The struct of the view, and its undo field by field.
macro_rules! view {
    ($($(#[$meta:meta])* $field:ident: $type:ty = $default:expr,)*) => {
        /// The view of a scene: conditions, method and marks.
        #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
        #[serde(default)]
        pub struct View {
            $($(#[$meta])* pub $field: $type,)*
        }

        impl Default for View {
            fn default() -> Self {
                View { $($field: $default,)* }
            }
        }

        impl View {
            /// Restores `before` in every field that was changed to `after` and not since.
            pub fn take_back(&mut self, before: &View, after: &View) {
                $(if self.$field == after.$field {
                    self.$field.clone_from(&before.$field);
                })*
            }
        }
    };
}

view! {
    floor: Floor = Floor::Thesis,
    /// The ratio last used with [`Floor::Snr`].
    snr: Decibels = Decibels(20.0),
    /// The level last used with [`Floor::Level`].
    level: DecibelMilliwatts = DecibelMilliwatts(-20.0),
    normalisation: Normalisation = Normalisation::MinMax,
    colours: ColourMap = ColourMap::default(),
    projection: Projection = Projection::default(),
    units: Units = Units::default(),
    directions: Directions = Directions::default(),
    /// Whether inputs, target and output are drawn on one scale; each on its own where not.
    one_scale: bool = false,
    /// Whether maps of fewer than 128 elements are drawn on 256 columns or more; on as many as they have where not.
    fine_columns: bool = true,
    /// Whether range-Doppler maps of recordings leave out static clutter, the mean over the loops.
    static_clutter_out: bool = false,
    difference: DifferenceView = DifferenceView::default(),
    /// eta', the threshold of the target.
    target_eta: f32 = crate::evaluate::TARGET_ETA,
    cfar: Option<Cfar> = None,
    last_cfar: Cfar = Cfar::default(),
    /// eta for each method, where it differs from the method's own.
    method_eta: BTreeMap<String, f32> = BTreeMap::new(),
    method: String = String::new(),
    /// The elements that methods use; `None` for the two ends.
    layout: Option<LayoutKind> = None,
    show_reflectors: bool = false,
    show_found: bool = false,
    show_fields_of_view: bool = false,
    show_theory: bool = false,
    /// Whether every object is marked by the verdict on it in the output.
    show_kinds: bool = false,
}

impl View {
    /// Selects a detector, or thresholds where `None`; keeps the detector's cells for the next time.
    pub fn detect_by(&mut self, cfar: Option<Cfar>) {
        self.cfar = cfar;
        self.last_cfar = cfar.unwrap_or(self.last_cfar);
    }

    /// Sets the floor beneath scenes; keeps the level of each kind for the next time.
    pub fn set_floor(&mut self, floor: Floor) {
        self.floor = floor;
        match floor {
            Floor::Snr(snr) => self.snr = snr,
            Floor::Level(level) => self.level = level,
            Floor::Thesis | Floor::Exact | Floor::Thermal => {}
        }
    }

    /// Sets the user's threshold of the method called `method`; its own where `None`.
    pub fn set_method_eta(&mut self, method: &str, eta: Option<f32>) {
        match eta {
            Some(eta) => _ = self.method_eta.insert(method.to_owned(), eta),
            None => _ = self.method_eta.remove(method),
        }
    }

    /// Numbers of the elements of `radar` that methods use in place of the two ends. `None` for the two ends, also where `radar` lacks elements of the layout.
    pub fn layout_numbers(&self, radar: &Radar) -> Option<Vec<usize>> {
        self.layout.as_ref()?.numbers(radar).ok()
    }

    /// A campaign over this floor, with this normalisation, detector and layout.
    pub fn campaign(&self, radar: &Radar) -> Campaign {
        let View { floor, normalisation, cfar, .. } = *self;
        Campaign {
            radar: radar.clone(),
            floor,
            normalisation,
            cfar,
            layout: self.layout_numbers(radar),
            ..Campaign::default()
        }
    }

    /// The style of pictures of a method's maps.
    #[cfg(feature = "pictures")]
    pub fn style(&self, method: &str) -> Style {
        let View { floor, normalisation, colours, target_eta, cfar, .. } = *self;
        let (eta, layout) = (self.method_eta.get(method).copied(), self.layout.clone());
        Style { floor, layout, normalisation, colours, eta, target_eta, cfar }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_changed_since_is_not_taken_back() {
        let before = View::default();
        let after = View { floor: Floor::Exact, target_eta: 0.5, show_theory: true, ..before.clone() };
        let mut now = View { target_eta: 0.6, colours: ColourMap::Viridis, ..after.clone() };
        now.take_back(&before, &after);
        assert_eq!(now, View { target_eta: 0.6, colours: ColourMap::Viridis, ..before });
    }
}
