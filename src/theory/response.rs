//! The range-angle map of one reflector in closed form, at any fraction of a bin and of a column.
//!
//! A sum over the elements of equation 3.3's windowed transform over range, which is the window's [`WindowPattern`] moved to the element's own
//! distance; nothing is approximated, so near field, range migration and squint are all in it.

use super::WindowPattern;
use crate::maps::{Aperture, Spectrum};
use crate::radar::Radar;
use crate::scene::Reflector;
use crate::signal::phase::EchoModel;
use num_complex::Complex64;
use std::f64::consts::{PI, TAU};

/// One reflector seen by an aperture.
#[derive(Debug, Clone)]
pub struct Response {
    samples: usize,
    columns: usize,
    over_range: WindowPattern,
    /// Distance in range bins, and amplitude with window, scale and carrier's phase, of every element.
    elements: Vec<(f64, Complex64)>,
}

/// A row of the map of one reflector: the elements' parts of it.
#[derive(Debug, Clone)]
pub struct ResponseRow {
    columns: usize,
    parts: Vec<Complex64>,
}

impl Response {
    /// The response of `reflector` under `aperture`. The radar must be valid ([`Radar::validate`]).
    pub fn new(radar: &Radar, reflector: &Reflector, aperture: Aperture) -> Self {
        let elements = aperture.channels(radar);
        let window = radar.window.weights(elements.len());
        let scale = ((radar.samples * radar.elements) as f64).sqrt().recip();
        let model = EchoModel::new(radar);
        let heard = |(n, weight): (usize, f64)| {
            let echo = model.echo(radar.pair(n), reflector);
            (radar.bin_of_range(echo.distance_metres), echo.sample(0) * (weight * scale))
        };
        let over_range = WindowPattern::new(radar.window, radar.samples);
        let elements = elements.zip(window).map(heard).collect();
        Response { samples: radar.samples, columns: radar.elements, over_range, elements }
    }

    pub fn row(&self, bin: f64) -> ResponseRow {
        let samples = self.samples as f64;
        let part = |(distance_bins, amplitude): &(f64, Complex64)| {
            let offset = distance_bins - bin;
            let offset = offset - (offset / samples).round() * samples;
            let middle = Complex64::cis(PI * (samples - 1.0) / samples * offset);
            amplitude * middle * self.over_range.at(offset)
        };
        ResponseRow { columns: self.columns, parts: self.elements.iter().map(part).collect() }
    }

    /// Magnitude at `bin` and `column`: the cell of [`crate::maps::angle_transform`], where both are whole.
    pub fn magnitude(&self, bin: f64, column: f64) -> f64 {
        self.row(bin).magnitude(column)
    }
}

impl ResponseRow {
    pub fn magnitude(&self, column: f64) -> f64 {
        let turns = (column - (self.columns / 2) as f64) / self.columns as f64;
        let sum: Complex64 =
            self.parts.iter().enumerate().map(|(m, p)| p * Complex64::cis(-TAU * turns * m as f64)).sum();
        sum.norm()
    }

    /// Magnitudes all around the map by one transform, column 0 first; `spectrum` has a whole number of points to a column.
    pub fn magnitudes(&self, spectrum: &Spectrum) -> Vec<f64> {
        let mut cells: Vec<f64> = spectrum.of(self.parts.iter().copied()).iter().map(|v| v.norm()).collect();
        let middle = self.columns / 2 * (cells.len() / self.columns);
        cells.rotate_right(middle);
        cells
    }
}

#[cfg(test)]
mod tests {
    use super::super::blob::tests::{any_place_of_any_radar, simulated};
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        #[test]
        fn every_cell_is_that_of_the_map((radar, reflector) in any_place_of_any_radar()) {
            for aperture in Aperture::ALL {
                let map = simulated(&radar, &reflector, aperture);
                let peak = map.iter().fold(0.0f64, |m, v| m.max(*v));
                let response = Response::new(&radar, &reflector, aperture);
                let spectrum = Spectrum::new(radar.elements);
                for bin in (0..radar.samples).step_by(3) {
                    let row = response.row(bin as f64).magnitudes(&spectrum);
                    for (column, v) in row.iter().enumerate() {
                        prop_assert!((v - map[[bin, column]]).abs() < 1e-9 * peak, "{aperture:?}, {bin}, {column}");
                    }
                    let one = response.magnitude(bin as f64, 5.0);
                    prop_assert!((one - map[[bin, 5]]).abs() < 1e-9 * peak);
                }
            }
        }
    }
}
