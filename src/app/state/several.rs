//! Settings of one map shown for several values of a parameter.

use super::panel::MapKind;
use crate::app::shared::Shared;
use crate::radar::{Decibels, Radar, WindowFunction, presets};
use crate::reconstruct::Reconstructor;
use crate::signal::Floor;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Most maps at once.
pub const MAX_MAPS: usize = 8;

const FLOORS: [(&str, Floor); 4] = [
    ("thesis", Floor::Thesis),
    ("exact", Floor::Exact),
    ("SNR 40 dB", Floor::Snr(Decibels(40.0))),
    ("SNR 20 dB", Floor::Snr(Decibels(20.0))),
];

named! {
    /// The parameter that differs from map to map.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
    pub enum Parameter {
        #[default]
        Window = "window",
        Bandwidth = "bandwidth",
        /// Elements of each end.
        EndElements = "elements of an end",
        /// Distance between elements, wavelengths.
        Spacing = "element spacing",
        Floor = "floor",
        /// Signal-to-noise ratio of a sample, dB.
        Snr = "SNR",
        /// One of the radars that come with the program.
        Radar = "radar",
        /// The reconstruction method.
        Method = "method",
    }
}

impl Parameter {
    /// Unit of the parameter's values, where they are numbers.
    pub fn unit(self) -> Option<&'static str> {
        match self {
            Parameter::Window | Parameter::Method | Parameter::Floor | Parameter::Radar => None,
            Parameter::Bandwidth => Some(" GHz"),
            Parameter::EndElements => Some(" elements"),
            Parameter::Spacing => Some(" λ"),
            Parameter::Snr => Some(" dB"),
        }
    }

    /// Default first and last value, around the radar's own.
    pub fn usual(self, radar: &Radar) -> [f64; 2] {
        let spacing = radar.element_spacing_metres / radar.wavelength_metres();
        match self {
            Parameter::Window | Parameter::Method | Parameter::Floor | Parameter::Radar => [0.0, 0.0],
            Parameter::Bandwidth => [radar.bandwidth_hz / 8e9, radar.bandwidth_hz / 1e9 * 2.0],
            Parameter::EndElements => [3.0, (radar.elements / 4).clamp(3, 96) as f64],
            Parameter::Spacing => [spacing / 2.0, spacing * 4.0],
            Parameter::Snr => [-30.0, 40.0],
        }
    }

    /// The map that shows the parameter's effect best.
    pub fn usual_map(self) -> MapKind {
        match self {
            Parameter::EndElements => MapKind::Input0,
            Parameter::Method => MapKind::Output,
            _ => MapKind::Target,
        }
    }
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Several {
    pub parameter: Parameter,
    pub map: MapKind,
    /// The first value, in the parameter's unit.
    pub low: f64,
    pub high: f64,
    /// Number of maps, where the parameter is a number.
    pub count: usize,
    /// Names of methods, where the parameter is the method; the first eight of the list where empty.
    pub methods: BTreeSet<String>,
}

impl Default for Several {
    fn default() -> Self {
        let parameter = Parameter::default();
        let (map, methods) = (parameter.usual_map(), BTreeSet::new());
        Several { parameter, map, low: 0.0, high: 0.0, count: MAX_MAPS, methods }
    }
}

/// Label, radar, floor and method of one map.
#[derive(Clone, PartialEq)]
pub struct Variant {
    pub label: String,
    pub radar: Radar,
    pub floor: Floor,
    /// The method that makes the map, if it needs one.
    pub method: Option<Shared<dyn Reconstructor>>,
}

impl Several {
    /// These settings for another parameter, with its usual values and its usual map.
    pub fn with(&self, parameter: Parameter, radar: &Radar) -> Several {
        let [low, high] = parameter.usual(radar);
        Several { parameter, map: parameter.usual_map(), low, high, ..self.clone() }
    }

    /// The maps of a scene before `radar` over `floor`: at most [`MAX_MAPS`], without those of invalid radars.
    pub fn variants(
        &self,
        radar: &Radar,
        floor: Floor,
        method: Option<&Arc<dyn Reconstructor>>,
        methods: &[Arc<dyn Reconstructor>],
    ) -> Vec<Variant> {
        let method = method.map(Shared::from);
        let like = |label: String, radar: Radar, floor: Floor| Variant { label, radar, floor, method: method.clone() };
        let mut variants: Vec<Variant> = match self.parameter {
            Parameter::Window => WindowFunction::ALL
                .into_iter()
                .map(|window| like(window.name().to_owned(), Radar { window, ..radar.clone() }, floor))
                .collect(),
            Parameter::Floor => FLOORS.map(|(name, floor)| like(name.to_owned(), radar.clone(), floor)).to_vec(),
            Parameter::Radar => {
                presets::ALL.iter().map(|preset| like(preset.id.to_owned(), preset.radar.clone(), floor)).collect()
            }
            Parameter::Method => {
                let chosen = |m: &&Arc<dyn Reconstructor>| self.methods.is_empty() || self.methods.contains(m.name());
                let named = |m: &Arc<dyn Reconstructor>| Variant {
                    method: Some(m.into()),
                    ..like(m.name().to_owned(), radar.clone(), floor)
                };
                methods.iter().filter(chosen).map(named).collect()
            }
            numbered => self
                .values()
                .into_iter()
                .filter_map(|value| {
                    let (radar, floor) = numbered.set(radar, floor, value)?;
                    Some(like(numbered.label(value), radar, floor))
                })
                .collect(),
        };
        variants.retain(|v| v.radar.validate().is_ok());
        // Rounded values may give one map twice.
        let map = |v: &Variant| (v.radar.clone(), v.floor, v.method.clone());
        variants.dedup_by(|a, b| map(a) == map(b));
        variants.truncate(MAX_MAPS);
        variants
    }

    /// The values of a numeric parameter: SNR in even steps, others in even ratios.
    fn values(&self) -> Vec<f64> {
        let count = self.count.clamp(2, MAX_MAPS);
        let part = |i: usize| i as f64 / (count - 1) as f64;
        let even = |i: usize| self.low + (self.high - self.low) * part(i);
        let ratio = |i: usize| self.low * (self.high / self.low).powf(part(i));
        let linear = self.parameter == Parameter::Snr || self.low <= 0.0 || self.high <= 0.0;
        (0..count).map(|i| if linear { even(i) } else { ratio(i) }).filter(|v| v.is_finite()).collect()
    }
}

impl Parameter {
    /// The radar and the floor with this value; `None` for an impossible value.
    fn set(self, radar: &Radar, floor: Floor, value: f64) -> Option<(Radar, Floor)> {
        let mut radar = radar.clone();
        match self {
            Parameter::Bandwidth => radar.bandwidth_hz = value * 1e9,
            Parameter::EndElements if value >= 1.0 => radar.end_elements = value.round() as usize,
            Parameter::Spacing => {
                let metres = value * radar.wavelength_metres();
                radar = radar.with_spacing(metres);
            }
            Parameter::Snr => return Some((radar, Floor::Snr(Decibels(value.clamp(-100.0, 300.0))))),
            _ => return None,
        }
        Some((radar, floor))
    }

    fn label(self, value: f64) -> String {
        let unit = self.unit().unwrap_or_default();
        if self == Parameter::EndElements { format!("{value:.0}{unit}") } else { format!("{}{unit}", number(value)) }
    }
}

/// A number with three digits, fewer of them behind the point the larger it is.
fn number(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reconstruct::Baseline;

    fn variants(several: &Several) -> Vec<Variant> {
        let methods: Vec<Arc<dyn Reconstructor>> = vec![Arc::new(Baseline)];
        several.variants(&Radar::default(), Floor::Thesis, methods.first(), &methods)
    }

    #[test]
    fn every_parameter_makes_valid_radars_that_differ() {
        let radar = Radar::default();
        for parameter in Parameter::ALL {
            let several = Several::default().with(parameter, &radar);
            let variants = variants(&several);
            let expected = match parameter {
                Parameter::Window => WindowFunction::ALL.len(),
                Parameter::Floor => FLOORS.len(),
                Parameter::Radar => presets::ALL.len().min(MAX_MAPS),
                Parameter::Method => 1,
                _ => MAX_MAPS,
            };
            assert_eq!(variants.len(), expected, "{parameter:?}");
            assert!(variants.windows(2).all(|v| v[0] != v[1] && v[0].label != v[1].label), "{parameter:?}");
        }
        let bandwidths = variants(&Several::default().with(Parameter::Bandwidth, &radar));
        assert!((bandwidths[0].radar.bandwidth_hz - 0.25e9).abs() < 1.0 && bandwidths[7].label == "4.00 GHz");
        let ratios: Vec<f64> =
            bandwidths.windows(2).map(|v| v[1].radar.bandwidth_hz / v[0].radar.bandwidth_hz).collect();
        assert!(ratios.iter().all(|r| (r / ratios[0] - 1.0).abs() < 1e-9), "{ratios:?}");
    }

    #[test]
    fn values_that_no_radar_can_have_make_no_map() {
        let several = Several { parameter: Parameter::EndElements, low: -5.0, high: 1e9, ..Several::default() };
        assert!(variants(&several).iter().all(|v| v.radar.validate().is_ok()));
        let several = Several { parameter: Parameter::Bandwidth, low: f64::NAN, high: 1.0, ..Several::default() };
        assert!(variants(&several).is_empty());
    }
}
