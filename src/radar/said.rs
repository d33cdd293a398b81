//! The radar's table in files: every constant by its name, and short words for constants that belong together.

use super::{Antennas, CHIRP_SECONDS, Carrier, Convention, LinkBudget, Radar, WindowFunction};
use serde::{Deserialize, Serialize};

/// The table `[radar]`: keys that are left out are table 3.1's. `convention` gives `carrier` and, where that is left out, `element_spacing_metres`.
/// `transmitter_x_metres` with `receiver_x_metres` gives `elements` and `element_spacing_metres`, and ends of at most half of the elements.
/// `transmitter_y_metres` and `receiver_y_metres`, each as long as the list of x, are the antennas' distances from the line; without them all stand
/// on it.
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
    chirp_seconds: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    carrier: Option<Carrier>,
    #[serde(skip_serializing_if = "Option::is_none")]
    convention: Option<Convention>,
    window: Option<WindowFunction>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmitter_x_metres: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    receiver_x_metres: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transmitter_y_metres: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    receiver_y_metres: Option<Vec<f64>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    focus_off_line: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    chirps: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    chirp_interval_seconds: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    budget: Option<LinkBudget>,
}

/// Largest relative difference between a spacing and that of the pairs beside it in a text.
const MAX_SPACING_DIFFERENCE: f64 = 1e-3;

impl From<Radar> for Said {
    fn from(radar: Radar) -> Self {
        let off_line = radar.antennas.as_ref().filter(|antennas| !antennas.is_on_line());
        Said {
            transmit_power_watts: Some(radar.transmit_power_watts),
            bandwidth_hz: Some(radar.bandwidth_hz),
            carrier_hz: Some(radar.carrier_hz),
            element_spacing_metres: Some(radar.element_spacing_metres),
            elements: Some(radar.elements),
            end_elements: Some(radar.end_elements),
            samples: Some(radar.samples),
            chirp_seconds: Some(radar.chirp_seconds).filter(|s| *s != CHIRP_SECONDS),
            carrier: Some(radar.carrier),
            convention: None,
            window: Some(radar.window),
            transmitter_x_metres: radar.antennas.as_ref().map(|a| a.transmitter_x_metres().to_vec()),
            receiver_x_metres: radar.antennas.as_ref().map(|a| a.receiver_x_metres().to_vec()),
            transmitter_y_metres: off_line.map(|a| a.transmitter_y_metres().to_vec()),
            receiver_y_metres: off_line.map(|a| a.receiver_y_metres().to_vec()),
            focus_off_line: radar.focus_off_line.then_some(true),
            // One chirp is the only count of older programs: a text without the key is read by them, too.
            chirps: Some(radar.chirps).filter(|chirps| *chirps != 1),
            chirp_interval_seconds: Some(radar.chirp_interval_seconds).filter(|s| *s != CHIRP_SECONDS),
            budget: radar.budget,
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
                let (name, expected) = (convention.name(), convention.carrier().name());
                return Err(format!(
                    "radar.carrier is \"{}\" beside convention = \"{name}\"; expected \"{expected}\", or one of the two alone",
                    carrier.name()
                ));
            }
            (Some(convention), _) => convention.carrier(),
            (None, carrier) => carrier.unwrap_or(usual.carrier),
        };
        let filled = said.convention.map(|c| c.filled_spacing_metres(carrier_hz, bandwidth_hz));
        let antennas = said.antennas()?;
        let radar = Radar {
            transmit_power_watts: said.transmit_power_watts.unwrap_or(usual.transmit_power_watts),
            bandwidth_hz,
            carrier_hz,
            element_spacing_metres: said.element_spacing_metres.or(filled).unwrap_or(usual.element_spacing_metres),
            elements: said.elements.unwrap_or(usual.elements),
            end_elements: said.end_elements.unwrap_or(usual.end_elements),
            samples: said.samples.unwrap_or(usual.samples),
            chirp_seconds: said.chirp_seconds.unwrap_or(CHIRP_SECONDS),
            carrier,
            window: said.window.unwrap_or(usual.window),
            antennas: None,
            focus_off_line: said.focus_off_line.unwrap_or_default(),
            chirps: said.chirps.unwrap_or(usual.chirps),
            chirp_interval_seconds: said.chirp_interval_seconds.unwrap_or(usual.chirp_interval_seconds),
            budget: said.budget,
        };
        let Some(antennas) = antennas else { return Ok(radar) };
        let end_elements = said.end_elements;
        let radar = radar.with_antennas(antennas);
        Ok(Radar { end_elements: end_elements.unwrap_or(radar.end_elements), ..radar })
    }
}

impl Said {
    /// The antennas; the error names a key beside them that disagrees.
    fn antennas(&self) -> Result<Option<Antennas>, String> {
        let lists = [
            ("transmitter", &self.transmitter_x_metres, &self.transmitter_y_metres),
            ("receiver", &self.receiver_x_metres, &self.receiver_y_metres),
        ];
        let [(_, Some(transmitters), _), (_, Some(receivers), _)] = lists else {
            let [one, other] = lists.map(|(of, x_metres, _)| (of, x_metres.is_some()));
            if one.1 || other.1 {
                let (missing, there) = if one.1 { (other.0, one.0) } else { (one.0, other.0) };
                return Err(format!("radar.{missing}_x_metres is missing; expected it beside {there}_x_metres"));
            }
            return lists.into_iter().find(|(_, _, y_metres)| y_metres.is_some()).map_or(Ok(None), |(of, ..)| {
                Err(format!("radar.{of}_y_metres is there without radar.{of}_x_metres; expected it beside that list"))
            });
        };
        let [of_transmitters, of_receivers] =
            lists.map(|(_, x, y)| y.clone().unwrap_or_else(|| vec![0.0; x.as_ref().map_or(0, Vec::len)]));
        let antennas = Antennas::new(transmitters, receivers)
            .and_then(|antennas| antennas.off_line(&of_transmitters, &of_receivers))
            .map_err(|e| format!("radar: {e}"))?;
        let (pairs, spacing) = (antennas.pairs().len(), antennas.spacing_metres());
        if let Some(elements) = self.elements.filter(|n| *n != pairs) {
            return Err(format!(
                "radar.elements is {elements}; the antennas make {pairs} places: expected that, or no such key"
            ));
        }
        let is_alike = |said: &f64| (said / spacing - 1.0).abs() < MAX_SPACING_DIFFERENCE;
        if let Some(said) = self.element_spacing_metres.filter(|said| !is_alike(said)) {
            return Err(format!(
                "radar.element_spacing_metres is {said}; the midpoints of the antennas' pairs stand {spacing} m apart: expected that, or no such key"
            ));
        }
        Ok(Some(antennas))
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
    fn a_carrier_against_the_convention_is_told() {
        let told = read("convention = \"physical\"\ncarrier = \"one-way\"").unwrap_err();
        assert!(told.contains("radar.carrier is \"one-way\"") && told.contains("expected \"two-way\""), "{told}");
        assert!(read("convention = \"physical\"\ncarrier = \"two-way\"").is_ok());
    }

    #[test]
    fn antennas_say_elements_with_spacing() {
        let antennas = "transmitter_x_metres = [-0.008, 0, 0.008]\nreceiver_x_metres = [0.0, 0.002, 0.004, 0.006]\n";
        let radar = read(&format!("{antennas}convention = \"physical\"")).unwrap();
        radar.validate().unwrap();
        assert_eq!((radar.elements, radar.end_elements, radar.carrier), (12, 6, Carrier::TwoWay));
        assert!((radar.element_spacing_metres - 0.001).abs() < 1e-12);
        assert_eq!(read(&toml::to_string(&radar).unwrap()).unwrap(), radar);
        for (beside, told) in [
            ("elements = 13", "elements is 13; the antennas make 12 places"),
            ("element_spacing_metres = 0.002", "stand 0.00"),
        ] {
            let error = read(&format!("{antennas}{beside}")).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
        let alone = read("transmitter_x_metres = [0.0]").unwrap_err();
        assert!(alone.contains("receiver_x_metres is missing"), "{alone}");
    }

    #[test]
    fn places_off_the_line_are_read_as_they_are_written() {
        let x = "transmitter_x_metres = [-0.008, 0, 0.008]\nreceiver_x_metres = [0.0, 0.002, 0.004, 0.006]\n";
        let bent = read(&format!("{x}transmitter_y_metres = [-0.01, 0.0, -0.01]\nfocus_off_line = true")).unwrap();
        let antennas = bent.antennas.clone().unwrap();
        let wanted = (&[-0.01, 0.0, -0.01][..], &[0.0; 4][..]);
        assert_eq!((antennas.transmitter_y_metres(), antennas.receiver_y_metres()), wanted);
        assert!(bent.focus_off_line);
        assert_eq!(read(&toml::to_string(&bent).unwrap()).unwrap(), bent);
        let straight = toml::to_string(&read(x).unwrap()).unwrap();
        assert!(!straight.contains("_y_metres") && !straight.contains("focus"), "older programs read it: {straight}");
        let far = "radar: number 3 of transmitter_y_metres is 7; expected at most 1 m";
        for (x, y, told) in [
            (x, "receiver_y_metres = [0.1]", "radar: receiver_y_metres has 1 numbers; expected 4"),
            (x, "transmitter_y_metres = [0, 0, 7]", far),
            ("", "receiver_y_metres = [0.1]", "radar.receiver_y_metres is there without radar.receiver_x_metres"),
        ] {
            let error = read(&format!("{x}{y}")).unwrap_err();
            assert!(error.contains(told), "{error}");
        }
    }

    #[test]
    fn what_is_written_is_read() {
        let wide = LinkBudget { half_power_width_degrees: Some(70.0), ..LinkBudget::default() };
        for (convention, budget) in Convention::ALL.into_iter().zip([Some(wide), Some(LinkBudget::default())]) {
            let radar =
                Radar { elements: 77, chirp_seconds: 1e-4, budget, ..Radar::default() }.in_convention(convention);
            assert_eq!(read(&toml::to_string(&radar).unwrap()).unwrap(), radar);
        }
        let several = Radar { chirps: 128, chirp_interval_seconds: 3e-5, ..Radar::default() };
        assert_eq!(read(&toml::to_string(&several).unwrap()).unwrap(), several);
        assert!(!toml::to_string(&several.of_one_chirp()).unwrap().contains("chirp") && read("chirps = -1").is_err());
        assert_eq!(read("carrier = \"two-way\"").unwrap(), Radar { carrier: Carrier::TwoWay, ..Radar::default() });
        assert_eq!(read("").unwrap(), Radar::default());
    }
}
