//! The radars for which a network was trained.

use crate::radar::{Carrier, Radar, WindowFunction, counted};
use crate::reconstruct::ReconstructError;
use serde::{Deserialize, Serialize};

/// Largest relative difference of two quantities that count as equal.
const SAME_QUANTITY: f64 = 1e-9;

/// Places behind the point of a quantity that differs: more than the minimum where two would look alike.
const MIN_PLACES: usize = 4;
const MAX_PLACES: usize = 15;

/// The radars for which a network was trained.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Domain {
    /// One radar, and all others with the same samples of a scene.
    Radar(Box<Radar>),
    /// All radars within limits.
    Limits(RadarLimits),
}

/// Limits of radars of one antenna an element, in both conventions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RadarLimits {
    /// Elements of the whole array.
    pub elements: usize,
    /// Elements of an end.
    pub end_elements: usize,
    /// Samples of a chirp.
    pub samples: usize,
    /// Lowest and highest carrier, hertz.
    pub carrier_hz: [f64; 2],
    /// Lowest and highest bandwidth, hertz.
    pub bandwidth_hz: [f64; 2],
    /// Most bandwidth, as a part of the carrier.
    pub max_relative_bandwidth: f64,
    /// Most range bins that a reflector at end-fire migrates from the first element to the last.
    pub max_migration_bins: f64,
    /// Least and most spacing of elements, over the one that fills the convention ([`Radar::filled_spacing_metres`]).
    pub relative_spacing: [f64; 2],
    /// Narrowest and widest pattern of elements, beside isotropic ones: degrees between its half-power directions.
    pub half_power_width_degrees: [f64; 2],
    /// Windows; empty: all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub windows: Vec<WindowFunction>,
}

/// A quantity that differs, in words: its value in training, and that of the radar.
type Difference = [String; 2];

impl Domain {
    /// The domain as JSON, for an entry of a weight file.
    /// # Errors
    /// [`serde_json::Error`] for numbers that JSON can't express.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string(self)
    }

    /// Whether the domain is one radar whose transmitters stand apart from its receivers.
    pub fn is_of_pairs(&self) -> bool {
        matches!(self, Domain::Radar(radar) if !radar.is_monostatic())
    }

    /// Whether the network was trained for samples of `radar`.
    pub fn holds(&self, radar: &Radar) -> bool {
        self.differences(radar).is_empty()
    }

    /// Refuses a radar whose samples differ from those that `method` was trained with, since the network's answer for them has no meaning.
    /// # Errors
    /// [`ReconstructError::Unusable`] names the quantities that differ.
    pub fn check(&self, method: &'static str, radar: &Radar) -> Result<(), ReconstructError> {
        let differences = self.differences(radar);
        if differences.is_empty() {
            return Ok(());
        }
        let list = |which: usize| differences.iter().map(|d| d[which].as_str()).collect::<Vec<_>>().join(", ");
        let reason = format!("the network was trained for {}; this radar has {}", list(0), list(1));
        Err(ReconstructError::Unusable { method, reason })
    }

    pub(super) fn shape(&self) -> [usize; 2] {
        match self {
            Domain::Radar(radar) => [radar.samples, radar.elements],
            Domain::Limits(limits) => [limits.samples, limits.elements],
        }
    }

    fn differences(&self, radar: &Radar) -> Vec<Difference> {
        match self {
            Domain::Radar(trained) => differences(trained, radar),
            Domain::Limits(limits) => limits.differences(radar),
        }
    }
}

/// Two numbers to four places behind the point, or to as many as tell them apart.
fn told_apart(pair: [f64; 2]) -> [String; 2] {
    let to_places = |places: usize| pair.map(|v| format!("{v:.places$}"));
    (MIN_PLACES..=MAX_PLACES).map(to_places).find(|[a, b]| a != b).unwrap_or_else(|| to_places(MIN_PLACES))
}

pub(super) fn is_alike(trained: &Radar, radar: &Radar) -> bool {
    differences(trained, radar).is_empty()
}

/// Range bins that a reflector at end-fire migrates from the first element to the last.
pub(super) fn migration_bins(radar: &Radar) -> f64 {
    radar.aperture_metres() / radar.range_resolution_metres()
}

/// The quantities by which the samples of `radar` differ from those of `trained`. The transmit power only scales samples, and networks normalise
/// them; the chirp's duration changes no echo, and of a link budget only the pattern of an element does.
fn differences(trained: &Radar, radar: &Radar) -> Vec<Difference> {
    // A new constant of the radar must be listed here, or networks would accept any value of it.
    let Radar {
        transmit_power_watts: _,
        bandwidth_hz: _,
        carrier_hz: _,
        element_spacing_metres: _,
        elements: _,
        end_elements: _,
        samples: _,
        chirp_seconds: _,
        carrier: _,
        window: _,
        antennas: _,
        focus_off_line: _,
        // Networks get samples of one chirp.
        chirps: _,
        chirp_interval_seconds: _,
        budget: _,
    } = radar;
    let named = |name: &dyn Fn(&Radar) -> String| {
        let [trained, found] = [trained, radar].map(name);
        (trained != found).then_some([trained, found])
    };
    let quantity = |of: fn(&Radar) -> f64, scale: f64, what: &str| {
        let [a, b] = [trained, radar].map(of);
        ((a - b).abs() > SAME_QUANTITY * a.abs())
            .then(|| told_apart([a, b].map(|v| v / scale)).map(|v| format!("{v} {what}")))
    };
    let convention = |radar: &Radar| match radar.carrier {
        Carrier::OneWay => "the thesis' convention (one-way carrier)".to_owned(),
        Carrier::TwoWay => "the physical convention (two-way carrier)".to_owned(),
    };
    let antennas = |radar: &Radar| match radar.antennas {
        None => "one antenna an element".to_owned(),
        Some(_) => "transmitters apart from receivers".to_owned(),
    };
    let pattern = |radar: &Radar| match radar.budget.and_then(|b| b.half_power_width_degrees) {
        None => "isotropic elements".to_owned(),
        Some(degrees) => format!("elements of {degrees:.1} degrees"),
    };
    let found = [
        named(&|radar| counted(radar.elements, "element", "elements")),
        named(&|radar| counted(radar.end_elements, "element an end", "elements an end")),
        named(&|radar| counted(radar.samples, "sample", "samples")),
        quantity(|radar| radar.bandwidth_hz, 1e9, "GHz of bandwidth"),
        quantity(|radar| radar.carrier_hz, 1e9, "GHz of carrier"),
        quantity(|radar| radar.element_spacing_metres, 1e-3, "mm between elements"),
        named(&convention),
        named(&antennas),
        named(&pattern),
        named(&|radar| format!("the {} window", radar.window.name())),
    ];
    found.into_iter().flatten().collect()
}

impl RadarLimits {
    pub(super) fn has_shape(&self, radar: &Radar) -> bool {
        self.of_shape(radar).is_empty()
    }

    fn of_shape(&self, radar: &Radar) -> Vec<Difference> {
        let RadarLimits { elements, end_elements, samples, .. } = *self;
        differences(&Radar { elements, end_elements, samples, antennas: None, ..radar.clone() }, radar)
    }

    fn differences(&self, radar: &Radar) -> Vec<Difference> {
        let between = |[least, most]: [f64; 2], found: f64, scale: f64, what: &str| {
            let inside = (least * (1.0 - SAME_QUANTITY)..=most * (1.0 + SAME_QUANTITY)).contains(&found);
            let trained = match least {
                0.0 => format!("at most {} {what}", most / scale),
                least => format!("{} to {} {what}", least / scale, most / scale),
            };
            let near = if found < least { least } else { most };
            (!inside).then(|| [trained, format!("{} {what}", told_apart([found, near].map(|v| v / scale))[0])])
        };
        let relative_bandwidth = radar.bandwidth_hz / radar.carrier_hz;
        let relative_spacing = radar.element_spacing_metres / radar.filled_spacing_metres();
        let width = radar.budget.and_then(|b| b.half_power_width_degrees);
        let quantities = [
            between(self.carrier_hz, radar.carrier_hz, 1e9, "GHz of carrier"),
            between(self.bandwidth_hz, radar.bandwidth_hz, 1e9, "GHz of bandwidth"),
            between([0.0, self.max_relative_bandwidth], relative_bandwidth, 0.01, "% of the carrier as bandwidth"),
            between([0.0, self.max_migration_bins], migration_bins(radar), 1.0, "range bins from end to end"),
            between(self.relative_spacing, relative_spacing, 1.0, "of the filled spacing between elements"),
            width.and_then(|width| between(self.half_power_width_degrees, width, 1.0, "degrees of elements' pattern")),
        ];
        let known = self.windows.is_empty() || self.windows.contains(&radar.window);
        let windows = || self.windows.iter().map(|window| window.name()).collect::<Vec<_>>().join(" or ");
        let window =
            (!known).then(|| [format!("the {} window", windows()), format!("the {} window", radar.window.name())]);
        self.of_shape(radar).into_iter().chain(quantities.into_iter().flatten()).chain(window).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::LinkBudget;

    /// The refusal of a network that was trained for table 3.1.
    fn refused(radar: &Radar) -> Option<String> {
        Domain::Radar(Box::default()).check("live", radar).err().map(|e| e.to_string())
    }

    #[test]
    fn a_louder_radar_is_no_other_radar() {
        assert_eq!(refused(&Radar { transmit_power_watts: 7.0, ..Radar::default() }), None);
        let budget = Radar { chirp_seconds: 1e-3, budget: Some(LinkBudget::default()), ..Radar::default() };
        assert_eq!(refused(&budget), None);
    }

    #[test]
    fn what_differs_from_a_radar_is_named() {
        let told = refused(&Radar { elements: 512, carrier: Carrier::TwoWay, ..Radar::default() }).unwrap();
        let expected = "trained for 1024 elements, the thesis' convention (one-way carrier); this radar has 512 elements, \
                        the physical convention (two-way carrier)";
        assert!(told.contains(expected), "{told}");
        let narrow = LinkBudget { half_power_width_degrees: Some(60.0), ..LinkBudget::default() };
        let told = refused(&Radar { budget: Some(narrow), ..Radar::default() }).unwrap();
        assert!(told.contains("isotropic elements; this radar has elements of 60.0 degrees"), "{told}");
        let told = refused(&Radar { carrier_hz: 76e9, ..Radar::default() }).unwrap();
        assert!(told.contains("77.0000 GHz of carrier; this radar has 76.0000 GHz"), "{told}");
        let spaced = Radar { element_spacing_metres: 0.001_946_7, ..Radar::default() };
        let told = refused(&spaced).unwrap();
        assert!(told.ends_with("1.946704 mm between elements; this radar has 1.946700 mm between elements"), "{told}");
        let told = refused(&Radar { samples: 1, ..Radar::default() }).unwrap();
        assert!(told.ends_with("trained for 512 samples; this radar has 1 sample"), "{told}");
    }
}
