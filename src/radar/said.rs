//! A radar as files have it: every constant by its name, and short words for what belongs together.

use super::{Carrier, Convention, Radar, WindowFunction};
use serde::{Deserialize, Serialize};

/// The table `[radar]`: what is left out is that of table 3.1. `convention` says `carrier` and, where that is left out,
/// `element_spacing_metres`.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Said {
    transmit_power_watts: Option<f64>,
    bandwidth_hz: Option<f64>,
    carrier_hz: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    element_spacing_metres: Option<f64>,
    elements: Option<usize>,
    end_elements: Option<usize>,
    samples: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    carrier: Option<Carrier>,
    #[serde(skip_serializing_if = "Option::is_none")]
    convention: Option<Convention>,
    window: Option<WindowFunction>,
}

impl From<Radar> for Said {
    fn from(radar: Radar) -> Self {
        Said {
            transmit_power_watts: Some(radar.transmit_power_watts),
            bandwidth_hz: Some(radar.bandwidth_hz),
            carrier_hz: Some(radar.carrier_hz),
            element_spacing_metres: Some(radar.element_spacing_metres),
            elements: Some(radar.elements),
            end_elements: Some(radar.end_elements),
            samples: Some(radar.samples),
            carrier: Some(radar.carrier),
            convention: None,
            window: Some(radar.window),
        }
    }
}

impl TryFrom<Said> for Radar {
    type Error = String;

    fn try_from(said: Said) -> Result<Self, String> {
        let usual = Radar::default();
        let carrier_hz = said.carrier_hz.unwrap_or(usual.carrier_hz);
        let bandwidth_hz = said.bandwidth_hz.unwrap_or(usual.bandwidth_hz);
        let carrier = match (said.convention, said.carrier) {
            (Some(convention), Some(carrier)) if convention.carrier() != carrier => {
                let (name, expected) = (convention.name(), carrier_name(convention.carrier()));
                return Err(format!(
                    "radar.carrier is \"{}\" beside convention = \"{name}\"; expected \"{expected}\", or one of the two alone",
                    carrier_name(carrier)
                ));
            }
            (Some(convention), _) => convention.carrier(),
            (None, carrier) => carrier.unwrap_or(usual.carrier),
        };
        let filled = said.convention.map(|c| c.filled_spacing_metres(carrier_hz, bandwidth_hz));
        Ok(Radar {
            transmit_power_watts: said.transmit_power_watts.unwrap_or(usual.transmit_power_watts),
            bandwidth_hz,
            carrier_hz,
            element_spacing_metres: said.element_spacing_metres.or(filled).unwrap_or(usual.element_spacing_metres),
            elements: said.elements.unwrap_or(usual.elements),
            end_elements: said.end_elements.unwrap_or(usual.end_elements),
            samples: said.samples.unwrap_or(usual.samples),
            carrier,
            window: said.window.unwrap_or(usual.window),
        })
    }
}

fn carrier_name(carrier: Carrier) -> &'static str {
    match carrier {
        Carrier::OneWay => "one-way",
        Carrier::TwoWay => "two-way",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Radar, String> {
        toml::from_str(text).map_err(|e: toml::de::Error| e.to_string())
    }

    #[test]
    fn a_convention_says_carrier_with_spacing() {
        let radar = read("convention = \"physical\"\nbandwidth_hz = 1e9").unwrap();
        let usual = Radar { bandwidth_hz: 1e9, ..Radar::default() };
        assert_eq!(radar, usual.in_convention(Convention::Physical));
        let wider = read("convention = \"physical\"\nelement_spacing_metres = 0.002").unwrap();
        assert_eq!((wider.carrier, wider.element_spacing_metres), (Carrier::TwoWay, 0.002));
    }

    #[test]
    fn older_names_are_still_read() {
        let radar = read("carrier = \"two-way\"").unwrap();
        assert_eq!(radar, Radar { carrier: Carrier::TwoWay, ..Radar::default() });
        assert_eq!(read("").unwrap(), Radar::default());
    }

    #[test]
    fn a_carrier_against_the_convention_is_told() {
        let told = read("convention = \"physical\"\ncarrier = \"one-way\"").unwrap_err();
        assert!(told.contains("radar.carrier is \"one-way\"") && told.contains("expected \"two-way\""), "{told}");
        assert!(read("convention = \"physical\"\ncarrier = \"two-way\"").is_ok());
    }

    #[test]
    fn what_is_written_is_read() {
        for convention in Convention::ALL {
            let radar = Radar { elements: 77, ..Radar::default() }.in_convention(convention);
            assert_eq!(read(&toml::to_string(&radar).unwrap()).unwrap(), radar);
        }
    }
}
