//! The near-field matched filter of both ends.

use super::backprojector::{Backprojector, RangeWindow};
use super::cells::GridCells;
use crate::radar::{Layout, Radar};
use crate::reconstruct::error::Result;
use crate::reconstruct::noise_model::ends_noise_variance;
use crate::reconstruct::polar::too_many_folds;
use crate::reconstruct::power::{focused_gain, of_power};
use crate::reconstruct::{LayoutSupport, MethodInfo, Reconstruction, Reconstructor, Request, layout_matched_filter};
use crate::signal::TwoEnds;
use ndarray::Zip;

/// Both ends' samples projected back onto the centre's polar grid.
///
/// Back-projection of a distributed array: see `backprojector` for its source. Added coherently the two ends form an interferometer, whose
/// fringes are one column of the whole array's map wide; added incoherently only the ranges and angles have to agree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MatchedFilter {
    /// Amplitudes are added.
    Coherent,
    /// Powers are added.
    Incoherent,
}

impl Reconstructor for MatchedFilter {
    fn info(&self) -> MethodInfo {
        // Thresholds by examples/choose_eta.rs.
        let (name, description, eta) = match self {
            MatchedFilter::Coherent => {
                let what = "both ends projected back onto the scene, amplitudes added: an interferometer";
                ("matched-filter", what, 0.950)
            }
            MatchedFilter::Incoherent => {
                ("matched-filter-incoherent", "both ends projected back onto the scene, powers added", 0.960)
            }
        };
        MethodInfo {
            name,
            description,
            prior_knowledge: "nothing about the scene or the floor; it measures the noise itself",
            eta,
        }
    }

    fn finds_reflectors(&self) -> bool {
        false
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn fewest_end_elements(&self) -> usize {
        // The power at one element has no direction.
        if *self == MatchedFilter::Coherent { 1 } else { 2 }
    }

    fn check_radar(&self, radar: &Radar) -> Result<()> {
        too_many_folds(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn layout_support(&self) -> LayoutSupport {
        if *self == MatchedFilter::Coherent { LayoutSupport::AnyLayout } else { LayoutSupport::TwoEnds }
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        if let Some(layout_samples) = &request.layout_samples {
            let layout = Layout::of_numbers(radar, &layout_samples.layout);
            let lambda = layout_matched_filter(radar, &layout, layout_samples.samples.view(), request)?;
            return Ok(Reconstruction::of_map(lambda));
        }
        let cells = GridCells::new(radar);
        let backprojector = Backprojector::new(&cells, RangeWindow::Hann);
        request.task.check()?;
        let [first, last] = backprojector.amplitudes(ends);
        request.task.set_progress(0.8);
        let gain = focused_gain(radar).powi(2);
        let power = Zip::from(&first).and(&last).par_map_collect(|a, b| {
            gain * match self {
                MatchedFilter::Coherent => ((a + b) / 2.0).norm_sqr(),
                MatchedFilter::Incoherent => (a.norm_sqr() + b.norm_sqr()) / 2.0,
            }
        });
        Ok(of_power(radar, cells.folded(&power), ends_noise_variance(radar, ends, request.noise), request))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_reflector_on_a_cell_is_strongest_there() {
        let radar = Radar::default();
        let (bin, column) = (211usize, 640usize);
        let (range, cos) = (radar.range_of_bin_metres(bin as f64), radar.cos_of_column(column as f64));
        let scene = Scene::of_points([(range * cos, range * (1.0 - cos * cos).sqrt())]);
        let ends = simulate(&radar, &scene, Floor::Exact, 0).unwrap().two_ends(&radar);
        let [a, b] = Backprojector::new(&GridCells::new(&radar), RangeWindow::None).amplitudes(&ends);
        let expected = radar.transmit_power_watts / (range * range);
        let sum = &a + &b;
        let (at, peak) = sum.indexed_iter().max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).unwrap();
        assert_eq!(at, (bin, column));
        // Linear interpolation of the spectrum loses up to 4 %.
        assert!((peak / 2.0 / expected - 1.0).norm() < 0.05, "{peak} {expected}");
        let tooth = (sum[[bin, column + 1]].norm() / peak.norm(), sum[[bin, column + 2]].norm() / peak.norm());
        assert!(tooth.0 > 0.95 && tooth.1 > 0.9, "the comb of ambiguities: {tooth:?}");
    }
}
