//! Orthogonal matching pursuit on the near-field polar grid.

use super::backprojector::{Backprojector, RangeWindow};
use super::cells::GridCells;
use super::pursuit::{MAX_RELAXED_PICKS, Pick, Pursuit, energy, unit_gains};
use crate::radar::Radar;
use crate::reconstruct::echoes::{Gained, of_echoes};
use crate::reconstruct::error::Result;
use crate::reconstruct::noise_model::ends_noise_variance;
use crate::reconstruct::polar::too_many_folds;
use crate::reconstruct::significance::decades_above_cells;
use crate::reconstruct::{Family, LayoutSupport, MethodInfo, Reconstruction, Reconstructor, Request};
use crate::signal::TwoEnds;
use ndarray::{Array2, Zip, s};
use num_complex::Complex64;

/// Greedy sparse reconstruction: the atom that explains most of the residual, all gains fitted anew, until only noise remains.
///
/// Y. C. Pati, R. Rezaiifar and P. S. Krishnaprasad, "Orthogonal matching pursuit: recursive function approximation with applications to wavelet
/// decomposition", Asilomar 1993. Atoms are the exact near-field echoes of the cells of the whole array's polar grid, moved between the cells to
/// where they explain most; the map is that of the picked atoms. One look at the grid gives several picks that are far apart in range.
#[derive(Debug, Clone, Copy)]
pub struct Omp {
    pub max_atoms: usize,
}

impl Default for Omp {
    fn default() -> Self {
        Omp { max_atoms: 64 }
    }
}

/// Least distance in range of the picks of one look, whose echoes overlap little then.
const PICKS_APART_BINS: usize = 40;

/// Least power of a pick as a part of the strongest's of its look; weaker picks wait for another look.
const MIN_PICK_POWER_PART: f64 = 0.1;

/// Most picks that are all moved again, which happens each time the residual has fallen to this part of its energy.
const MAX_MOVED_PICKS: usize = 64;
const MOVE_RESIDUAL_PART: f64 = 0.1;

/// Part of the energy that rounding leaves unexplained where phases of 6e4 rad were evaluated in f64: about 1e-11 of each sample's
/// amplitude. It is not white, so that the measured noise understates it.
const ROUNDING_ENERGY_PART: f64 = 1e-22;

/// Least part of all energy that a pick must explain: 100 dB down. Weaker residuals are errors of a pick's place, not echoes.
const MIN_PICK_ENERGY_PART: f64 = 1e-10;

impl Omp {
    fn pursue(&self, radar: &Radar, ends: &TwoEnds, noise_variance: f64, request: &Request) -> Result<Vec<Gained>> {
        let samples = ends.flat();
        let heard = ends.measured_elements().into_iter().filter(|is_measured| *is_measured).count() * radar.samples;
        let noise = noise_variance * heard as f64 * 1.1;
        let all = energy(&samples);
        let enough = noise.max(all * ROUNDING_ENERGY_PART);
        let mut cells = GridCells::with_measured_elements(radar, ends);
        // No reflector stands at the centre: an echo in bin 0 is one range period away.
        if radar.samples > 1 {
            cells.range_metres[0] = radar.max_range_metres();
        }
        let backprojector = Backprojector::new(&cells, RangeWindow::None);
        let (bins, directions) = cells.dim();
        let noise_level = 100f64.powf(decades_above_cells(noise_variance, bins * directions));
        let worth = noise_level.max(all * MIN_PICK_ENERGY_PART);
        let mut settled = all;
        let mut pursuit = Pursuit::new(radar, &cells, &samples);
        while pursuit.picks.len() < self.max_atoms && energy(&pursuit.residual) > enough {
            request.task.check()?;
            request.task.set_progress(0.9 * pursuit.picks.len() as f32 / self.max_atoms as f32);
            let [first, last] = backprojector.amplitudes(&TwoEnds::of_flat(radar, &pursuit.residual));
            // Between the cells the ends' phases differ: each pick is moved to where they agree.
            let heard: Array2<f64> = Zip::from(&first).and(&last).par_map_collect(|a, b| (a.norm() + b.norm()).powi(2));
            if !self.pick(&mut pursuit, heard, &samples, enough, worth) {
                break; // nothing on the grid explains what is left
            }
            let count = pursuit.picks.len();
            if (2..=MAX_MOVED_PICKS).contains(&count) && energy(&pursuit.residual) < MOVE_RESIDUAL_PART * settled {
                pursuit.settle(&samples, enough, request)?;
                settled = energy(&pursuit.residual);
            }
        }
        Ok(fit(&pursuit.picks, &samples))
    }

    /// Picks the strongest cell of `heard`, and those far from it in range. Returns whether the strongest explains at least `worth`.
    fn pick(
        &self,
        pursuit: &mut Pursuit<'_>,
        mut heard: Array2<f64>,
        samples: &[Complex64],
        enough: f64,
        worth: f64,
    ) -> bool {
        let mut least = 0.0;
        while pursuit.picks.len() < self.max_atoms && energy(&pursuit.residual) > enough {
            let Some(pick) = pursuit.strongest(&heard) else { return least > 0.0 };
            let atom = pursuit.refined(pick.atom, &pursuit.residual);
            let power = atom.correlate(&pursuit.residual).norm_sqr();
            if power < worth {
                return least > 0.0;
            }
            if power < least {
                return true;
            }
            let bin = pick.cell.bin;
            if !pursuit.take(Pick { atom, ..pick }) {
                return least > 0.0;
            }
            if (2..=MAX_RELAXED_PICKS).contains(&pursuit.picks.len()) {
                pursuit.relax(samples, true);
            }
            least = f64::max(least, MIN_PICK_POWER_PART * power);
            let bins = heard.nrows();
            let near = bin.saturating_sub(PICKS_APART_BINS)..(bin + PICKS_APART_BINS).min(bins);
            heard.slice_mut(s![near, ..]).fill(0.0);
        }
        true
    }
}

fn fit(picks: &[Pick], samples: &[Complex64]) -> Vec<Gained> {
    let gains = unit_gains(picks, samples);
    let gained = picks.iter().zip(gains);
    gained.map(|(p, gain)| Gained { reflector: p.atom.reflector, gain: gain / p.atom.norm() }).collect()
}

impl Reconstructor for Omp {
    fn family(&self) -> Family {
        Family::Sparse
    }

    fn info(&self) -> MethodInfo {
        MethodInfo {
            name: "omp",
            description: "greedy sparse fit of exact near-field echoes, each moved off the polar grid to where it explains most, and their exact map",
            prior_knowledge: "that a scene holds single reflectors, 64 at most; it measures the noise itself",
            eta: 0.819, // by examples/choose_eta.rs
        }
    }

    fn layout_support(&self) -> LayoutSupport {
        LayoutSupport::Halves
    }

    fn check_radar(&self, radar: &Radar) -> Result<()> {
        too_many_folds(radar).map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        let noise_variance = ends_noise_variance(radar, ends, request.noise);
        let found = self.pursue(radar, ends, noise_variance, request)?;
        Ok(of_echoes(radar, ends, &found, noise_variance, request))
    }
}

#[cfg(test)]
mod tests {
    use super::super::cells::GridCell;
    use super::super::pursuit::subtract;
    use super::*;
    use crate::radar::Carrier;
    use crate::scene::{Reflector, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn reflectors_on_the_grid_are_recovered() {
        let radar = Radar::default();
        let grid = GridCells::new(&radar);
        let cells = [(150usize, 700usize), (230, 512), (231, 300), (390, 620)];
        let atoms = cells.map(|(bin, direction)| grid.echo(GridCell { bin, direction }).unwrap());
        let scene = Scene::of_points(atoms.iter().map(|a| (a.reflector.x_metres, a.reflector.y_metres)));
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let mut found = Omp::default().reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
        found.sort_by(|a, b| a.y_metres.total_cmp(&b.y_metres));
        let mut expected: Vec<Reflector> = scene.reflectors();
        expected.sort_by(|a, b| a.y_metres.total_cmp(&b.y_metres));
        assert_eq!(found.len(), expected.len(), "{found:?}");
        for (f, e) in found.iter().zip(&expected) {
            assert!((f.x_metres - e.x_metres).hypot(f.y_metres - e.y_metres) < 1e-3, "{f:?}");
            assert!((f.reflectivity - 1.0).abs() < 1e-3, "{f:?}");
        }
    }

    /// Part of the energy of `ends` in the residual of `found`.
    fn left(radar: &Radar, ends: &TwoEnds, found: &[Reflector]) -> f64 {
        let samples = ends.flat();
        let cells = GridCells::with_measured_elements(radar, ends);
        let pick = |r: &Reflector| {
            let place = radar.polar_of(r.x_metres, r.y_metres);
            Pick {
                cell: GridCell { bin: 0, direction: 0 },
                atom: cells.echo_at(place.range_metres, place.cos_theta).unwrap(),
            }
        };
        let picks: Vec<Pick> = found.iter().map(pick).collect();
        let mut left = samples.clone();
        for (pick, gain) in picks.iter().zip(unit_gains(&picks, &samples)) {
            subtract(&mut left, &pick.atom.unit_samples(), gain);
        }
        energy(&left) / energy(&samples)
    }

    #[test]
    fn one_reflector_between_cells_is_explained_by_its_first_pick() {
        let radar = Radar::default();
        for i in 0..9 {
            let (range, cos) = (6.0 + 2.37 * f64::from(i), -0.8 + 0.193 * f64::from(i));
            let scene = Scene::of_points([(range * cos, range * (1.0 - cos * cos).sqrt())]);
            let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
            let first = Omp { max_atoms: 1 }.reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
            let all = Omp::default().reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
            assert_eq!(all.len(), 1, "picks for one reflector at {range} m, {cos}");
            let part = left(&radar, &ends, &first);
            assert!(part < 1e-9, "{part} at {range} m, {cos}");
        }
    }

    #[test]
    fn more_than_two_dozen_reflectors_are_found() {
        let radar = Radar::default();
        let scene = Scene::of_points((0..30).map(|i| (f64::from(i * 7 % 11) - 5.0, 6.0 + f64::from(i))));
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let found = Omp::default().reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
        let is_found =
            |r: &Reflector| found.iter().any(|f| (f.x_metres - r.x_metres).hypot(f.y_metres - r.y_metres) < 0.05);
        let count = scene.reflectors().iter().filter(|r| is_found(r)).count();
        assert!(count >= 29 && found.len() <= 40, "{count} of 30, {} picks", found.len());
    }

    #[test]
    #[ignore = "a minute in an unoptimised build"]
    fn the_two_way_carrier_hides_no_direction() {
        let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
        // Both are in columns that have other directions for a one-way array.
        let scene = Scene::of_points([(9.0, 12.0), (-16.0, 6.0)]);
        let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
        let found = Omp::default().reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
        for r in scene.reflectors() {
            let near = found.iter().filter(|f| (f.x_metres - r.x_metres).hypot(f.y_metres - r.y_metres) < 0.1);
            let heard: f64 = near.map(|f| f.reflectivity).sum();
            assert!(heard > 0.7, "{r:?}: {found:?}");
        }
    }
}
