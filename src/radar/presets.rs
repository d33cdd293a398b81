//! Radars that exist, and radars that show the effect of one constant.

use super::{CHIRP_SECONDS, Carrier, Radar, SPEED_OF_LIGHT, WindowFunction};
use std::sync::LazyLock;

/// A radar that comes with the program.
#[derive(Debug, Clone, PartialEq)]
pub struct RadarPreset {
    /// Short name.
    pub id: &'static str,
    /// Name for menus.
    pub name: &'static str,
    /// A description of the radar and of its maps.
    pub about: &'static str,
    /// The radar.
    pub radar: Radar,
}

const fn half_wavelength_metres(carrier_hz: f64) -> f64 {
    SPEED_OF_LIGHT / carrier_hz / 2.0
}

const TABLE_3_1: Radar = Radar {
    antennas: None,
    focus_off_line: false,
    budget: None,
    transmit_power_watts: 100.0,
    bandwidth_hz: 2e9,
    carrier_hz: 77e9,
    element_spacing_metres: half_wavelength_metres(77e9),
    elements: 1024,
    end_elements: 12,
    samples: 512,
    chirp_seconds: CHIRP_SECONDS,
    carrier: Carrier::OneWay,
    window: WindowFunction::Hann,
    chirps: 1,
    chirp_interval_seconds: CHIRP_SECONDS,
};

impl Default for Radar {
    fn default() -> Self {
        TABLE_3_1
    }
}

/// Every preset, table 3.1 first.
pub static ALL: LazyLock<Vec<RadarPreset>> = LazyLock::new(|| {
    // Antennas whose pairs make no array would leave table 3.1, which a test would see.
    let of_pairs = |radar: Radar, transmitters, receivers| radar.of_pairs(transmitters, receivers).unwrap_or_default();
    vec![
        RadarPreset {
            id: "table-3.1",
            name: "The thesis' radar (table 3.1)",
            about: "1024 elements over 2 m, 2 GHz of bandwidth: range bins of 7.5 cm, a beam of 0.17 degrees with a Hann window. The table says \
                    77 GHz; the thesis' formula is a radar at 38.5 GHz whose chirp falls. Every scene lies in the near field, which extends to about 2 km.",
            radar: TABLE_3_1,
        },
        RadarPreset {
            id: "table-3.1-physical",
            name: "Table 3.1 in the physical convention",
            about: "The constants of table 3.1, as a radar that is built measures: a chirp that rises from 77 GHz, carrier and beat there and back with \
                    one sign. Elements stand a quarter of a wavelength apart, so the array is 1 m long. Blobs stand 1.3 % farther from \
                    broadside than their reflectors, not 2.6 % nearer.",
            radar: Radar {
                element_spacing_metres: SPEED_OF_LIGHT / (77e9 + 2e9 / 2.0) / 4.0,
                carrier: Carrier::TwoWay,
                ..TABLE_3_1
            },
        },
        RadarPreset {
            id: "cascade-86",
            name: "77 GHz cascade, 86 elements",
            about: "Four radar chips side by side, whose virtual elements form a line of 86: 17 cm wide, a beam of 2.0 degrees with a Hann window. \
                    Its far field begins at 14 m, so plane waves are a fair assumption.",
            radar: Radar { bandwidth_hz: 1e9, elements: 86, samples: 256, ..TABLE_3_1 },
        },
        RadarPreset {
            id: "chip-8",
            name: "77 GHz single chip, 8 elements",
            about: "Two transmitters and four receivers on one chip, the radar of most laboratories: range bins of 5 cm up to 6 m, but a beam of \
                    25 degrees with a Hann window.",
            radar: Radar { bandwidth_hz: 3.072e9, elements: 8, end_elements: 3, samples: 128, ..TABLE_3_1 },
        },
        RadarPreset {
            id: "24-ghz",
            name: "24 GHz, 256 elements",
            about: "The older band: a wavelength three times as long makes the same number of elements three times as wide, and its 250 MHz allow \
                    range bins of 60 cm only.",
            radar: Radar {
                bandwidth_hz: 250e6,
                carrier_hz: 24.125e9,
                element_spacing_metres: half_wavelength_metres(24.125e9),
                elements: 256,
                samples: 256,
                ..TABLE_3_1
            },
        },
        RadarPreset {
            id: "one-wavelength",
            name: "Elements one wavelength apart",
            about: "Table 3.1 with twice the spacing: the beam is half as wide, but each column stands for two directions (grating lobes).",
            radar: Radar { element_spacing_metres: 2.0 * half_wavelength_metres(77e9), ..TABLE_3_1 },
        },
        RadarPreset {
            id: "150-mhz",
            name: "150 MHz of bandwidth",
            about: "Table 3.1 with a fraction of its bandwidth: a range bin is 1 m, as long as a range cell of long-range automotive radars, and \
                    what stands less than that apart merges.",
            radar: Radar { bandwidth_hz: 150e6, ..TABLE_3_1 },
        },
        RadarPreset {
            id: "cascade-12x16",
            name: "77 GHz cascade, 12 x 16 pairs",
            about: "Four radar chips side by side: 12 transmitters, 16 receivers, and a filled line of the 192 elements halfway between them, in the \
                    physical convention. An end is one transmitter with all receivers. Near by the ways of pairs are longer than those of their \
                    midpoints; the map shows it up to some 10 m.",
            radar: of_pairs(Radar { bandwidth_hz: 1e9, end_elements: 16, samples: 256, ..TABLE_3_1 }, 12, 16),
        },
        RadarPreset {
            id: "chip-3x4",
            name: "77 GHz single chip, 3 x 4 pairs",
            about: "Three transmitters and four receivers on one chip, in the physical convention: 12 elements, a beam of 15 degrees with a Hann \
                    window, and range bins of 5 cm up to 6 m.",
            radar: of_pairs(Radar { bandwidth_hz: 3.072e9, end_elements: 4, samples: 128, ..TABLE_3_1 }, 3, 4),
        },
    ]
});

impl RadarPreset {
    /// The preset called `id`.
    pub fn by_id(id: &str) -> Option<&'static RadarPreset> {
        ALL.iter().find(|p| p.id == id)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Convention;
    use std::collections::HashSet;

    #[test]
    fn presets_are_valid() {
        let mut seen = HashSet::new();
        for preset in ALL.iter() {
            preset.radar.validate().unwrap_or_else(|e| panic!("{}: {e}", preset.id));
            assert!(seen.insert(preset.id) && seen.insert(preset.name) && preset.about.len() > 80, "{}", preset.id);
            assert_eq!(RadarPreset::by_id(preset.id), Some(preset));
        }
        assert_eq!(ALL[0].radar, Radar::default());
        assert!(ALL.iter().skip(1).all(|preset| preset.radar != Radar::default()), "every radar of pairs is an array");
    }

    #[test]
    fn they_show_what_they_say() {
        let radar = |id: &str| &RadarPreset::by_id(id).unwrap().radar;
        assert!((radar("150-mhz").range_resolution_metres() - 1.0).abs() < 1e-3);
        assert!((radar("24-ghz").range_resolution_metres() - 0.6).abs() < 1e-3);
        assert!((13.0..15.0).contains(&radar("cascade-86").far_field_metres()));
        assert!((radar("chip-8").max_range_metres() - 6.25).abs() < 0.01);
        assert_eq!(*radar("table-3.1-physical"), Radar::default().in_convention(Convention::Physical));
        let twice = radar("one-wavelength");
        assert!((twice.column_of_cos(0.3) - twice.column_of_cos(-0.7)).abs() < 1e-6, "two directions share a column");
    }
}
