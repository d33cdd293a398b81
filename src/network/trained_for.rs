//! The radar that a network was trained for.

use crate::radar::{Antennas, Carrier, LinkBudget, Radar};
use crate::reconstruct::ReconstructError;

/// Quantities that differ by less than this part of themselves are the same.
const SAME_QUANTITY: f64 = 1e-9;

/// What makes the samples of `radar` others than those of `trained`: of each quantity what the network was trained with, and what it is now.
/// The transmit power only makes samples louder, which no network hears; the chirp's duration changes no echo, and of a link budget only the pattern of an element does.
fn differences(trained: &Radar, radar: &Radar) -> Vec<[String; 2]> {
    // A new constant must be named here, or the networks would not know of it.
    let Radar {
        transmit_power_watts: _,
        bandwidth_hz,
        carrier_hz,
        element_spacing_metres,
        elements,
        end_elements,
        samples,
        chirp_seconds: _,
        carrier,
        window,
        antennas,
        focus_off_line: _,
        // Networks see one chirp.
        chirps: _,
        chirp_interval_seconds: _,
        budget,
    } = radar;
    let convention = |carrier: &Carrier| match carrier {
        Carrier::OneWay => "the thesis' convention (one-way carrier)",
        Carrier::TwoWay => "the physical convention (two-way carrier)",
    };
    let antennas_of = |antennas: Option<&Antennas>| match antennas {
        None => "one antenna an element",
        Some(_) => "transmitters apart from receivers",
    };
    let pattern_of = |budget: &Option<LinkBudget>| match budget.and_then(|b| b.half_power_width_degrees) {
        None => "isotropic elements".to_owned(),
        Some(degrees) => format!("elements of {degrees:.1} degrees"),
    };
    let count = |a: usize, b: usize, what: &str| (a != b).then(|| [a, b].map(|n| format!("{n} {what}")));
    let quantity = |a: f64, b: f64, scale: f64, what: &str| {
        ((a - b).abs() > SAME_QUANTITY * a.abs()).then(|| [a, b].map(|v| format!("{:.4} {what}", v / scale)))
    };
    let named = |a: &str, b: &str| (a != b).then(|| [a.to_owned(), b.to_owned()]);
    [
        count(trained.elements, *elements, "elements"),
        count(trained.end_elements, *end_elements, "elements an end"),
        count(trained.samples, *samples, "samples"),
        quantity(trained.bandwidth_hz, *bandwidth_hz, 1e9, "GHz of bandwidth"),
        quantity(trained.carrier_hz, *carrier_hz, 1e9, "GHz of carrier"),
        quantity(trained.element_spacing_metres, *element_spacing_metres, 1e-3, "mm between elements"),
        named(convention(&trained.carrier), convention(carrier)),
        named(antennas_of(trained.antennas.as_ref()), antennas_of(antennas.as_ref())),
        named(&pattern_of(&trained.budget), &pattern_of(budget)),
        named(&format!("the {} window", trained.window.name()), &format!("the {} window", window.name())),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Whether the samples of `radar` are as those of `trained`.
pub(super) fn is_alike(trained: &Radar, radar: &Radar) -> bool {
    differences(trained, radar).is_empty()
}

/// Refuses every radar whose samples are others than those that `method` was trained with: its weights know no other, and what they would
/// draw means nothing.
///
/// # Errors
/// [`ReconstructError::Unusable`] names what differs.
pub(super) fn check_radar(method: &'static str, trained: &Radar, radar: &Radar) -> Result<(), ReconstructError> {
    let differences = differences(trained, radar);
    if differences.is_empty() {
        return Ok(());
    }
    let list = |which: usize| differences.iter().map(|d| d[which].as_str()).collect::<Vec<_>>().join(", ");
    let reason = format!("the network was trained with {}; this radar has {}", list(0), list(1));
    Err(ReconstructError::Unusable { method, reason })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(radar: &Radar) -> Option<String> {
        check_radar("live", &Radar::default(), radar).err().map(|e| e.to_string())
    }

    #[test]
    fn a_louder_radar_is_no_other_radar() {
        assert_eq!(refused(&Radar { transmit_power_watts: 7.0, ..Radar::default() }), None);
        assert_eq!(
            refused(&Radar { chirp_seconds: 1e-3, budget: Some(LinkBudget::default()), ..Radar::default() }),
            None
        );
    }

    #[test]
    fn what_differs_is_named() {
        let told = refused(&Radar { elements: 512, carrier: Carrier::TwoWay, ..Radar::default() }).unwrap();
        let expected = "trained with 1024 elements, the thesis' convention (one-way carrier); this radar has 512 elements, \
                        the physical convention (two-way carrier)";
        assert!(told.contains(expected), "{told}");
        let narrow = LinkBudget { half_power_width_degrees: Some(60.0), ..LinkBudget::default() };
        let told = refused(&Radar { budget: Some(narrow), ..Radar::default() }).unwrap();
        assert!(told.contains("isotropic elements; this radar has elements of 60.0 degrees"), "{told}");
        let told = refused(&Radar { carrier_hz: 76e9, ..Radar::default() }).unwrap();
        assert!(told.contains("77.0000 GHz of carrier; this radar has 76.0000 GHz"), "{told}");
    }
}
