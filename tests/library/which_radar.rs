//! The thesis' radar is a physical one: it sends and hears with every element, begins at 38.5 GHz and falls by 2 GHz.

use crate::prelude::*;
use twofloat::TwoFloat;

/// A radar each of whose elements sends and hears, with the frequencies that it sends.
struct Physical {
    first_hz: TwoFloat,
    fall_hz: TwoFloat,
    spacing_metres: f64,
}

impl Physical {
    /// Table 3.1's: half the carrier, a quarter of that wavelength from element to element. Wavelength and range bin are those of `radar`, as
    /// f64 has them, so that their rounding doesn't count.
    fn of(radar: &Radar) -> Self {
        let first_wavelength_metres = 2.0 * radar.wavelength_metres();
        Physical {
            first_hz: TwoFloat::from(SPEED_OF_LIGHT) / first_wavelength_metres,
            fall_hz: TwoFloat::from(SPEED_OF_LIGHT) / (2.0 * radar.range_resolution_metres()),
            spacing_metres: first_wavelength_metres / 4.0,
        }
    }

    /// Sample `n` of `samples` at element `number` of a point, with a mixer by which phases fall with the range.
    fn sample(&self, radar: &Radar, point: &Reflector, number: usize, n: usize) -> Complex64 {
        let antenna = (number as f64 - (radar.elements as f64 - 1.0) / 2.0) * self.spacing_metres;
        let (dx, y) = (TwoFloat::new_sub(point.x_metres, antenna), point.y_metres);
        let range = (dx * dx + TwoFloat::new_mul(y, y)).sqrt();
        let hz = self.first_hz - self.fall_hz * n as f64 / radar.samples as f64;
        let turns = hz * range * 2.0 / SPEED_OF_LIGHT;
        let phase = TAU * (turns - turns.hi().round()).hi();
        let amplitude = radar.transmit_power_watts * point.reflectivity / (range * range).hi();
        Complex64::from_polar(amplitude, -phase)
    }
}

fn points() -> Vec<Reflector> {
    let at = |x_metres, y_metres| Reflector { x_metres, y_metres, reflectivity: 1.0 };
    vec![at(0.0, 20.0), at(-16.6, 11.06), at(3.3, 5.1), at(25.0, 27.0)]
}

#[test]
fn the_thesis_samples_are_those_of_a_physical_radar() {
    let radar = Radar::default();
    let physical = Physical::of(&radar);
    for point in points() {
        let (mut worst, mut peak) = (0.0f64, 0.0f64);
        for element in (0..radar.elements).step_by(33) {
            let thesis = judge::element_signal(&radar, std::slice::from_ref(&point), element);
            for (n, sample) in thesis.iter().enumerate() {
                worst = worst.max((sample - physical.sample(&radar, &point, element, n)).norm());
                peak = peak.max(sample.norm());
            }
        }
        println!("({}, {}): {:.1e} of the peak", point.x_metres, point.y_metres, worst / peak);
        assert!(worst < 5e-15 * peak, "{:e}", worst / peak);
    }
}

#[test]
fn that_radar_is_the_one_that_the_docs_name() {
    let radar = Radar::default();
    let physical = Physical::of(&radar);
    let [first, last] = [0.0, 1.0].map(|part: f64| (physical.first_hz - physical.fall_hz * part).hi() / 1e9);
    assert!((first - 38.5).abs() < 1e-9 && (last - 36.5).abs() < 1e-9, "{first} to {last} GHz");
    assert_eq!(format!("{:.3}", 1e3 * physical.spacing_metres), "1.947");
    assert_eq!(physical.spacing_metres, radar.element_spacing_metres);
    // A filled array of its first frequency, whose middle frequency is lower by 2.6 %.
    assert!((radar.squint() - 37.5 / 38.5).abs() < 1e-4, "{}", radar.squint());
    for (name, text) in [
        ("guide", include_str!("../../assets/guide.md")),
        ("limits", include_str!("../../docs/limits.md")),
        ("lessons", include_str!("../../docs/lessons.md")),
        ("recordings", include_str!("../../docs/recordings.md")),
        ("the lesson", include_str!("../../assets/lessons/which-radar-is-the-thesis-radar.toml")),
    ] {
        assert!(text.contains("38.5 GHz"), "{name}");
        let text = text.to_lowercase();
        for false_claim in ["no physical array has", "no physical radar measures"] {
            assert!(!text.contains(false_claim), "{name} says \"{false_claim}\"");
        }
    }
}

#[test]
fn preset_radars_have_the_beams_that_they_name() {
    for (id, decimals) in [("table-3.1", 2), ("cascade-86", 1), ("chip-8", 0), ("chip-3x4", 0)] {
        let preset = RadarPreset::by_id(id).unwrap();
        let said =
            format!("a beam of {:.decimals$} degrees", Consequences::of(&preset.radar).full_beam.radians.to_degrees());
        assert!(preset.about.contains(&said), "{id} does not say \"{said}\"");
    }
}
