//! Orthogonal matching pursuit on the near-field polar grid.

use super::backprojector::{Backprojector, RangeWindow, too_large};
use super::cells::{Cell, Cells};
use crate::radar::Radar;
use crate::reconstruct::answer::{Reconstruction, Request};
use crate::reconstruct::echoes::{Gained, of_echoes};
use crate::reconstruct::error::ReconstructError;
use crate::reconstruct::family::Family;
use crate::reconstruct::hearing::ends_noise_variance;
use crate::reconstruct::noise_test::decades_above_cells;
use crate::reconstruct::reconstructor::{About, Reconstructor};
use crate::reconstruct::seen::too_many_folds;
use crate::signal::{ArrayEcho, TwoEnds};
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use ndarray::{Array2, Zip, s};
use num_complex::Complex64;
use rayon::prelude::*;

/// Greedy sparse reconstruction: the atom that explains most of what is left, all gains fitted anew, until only noise is left.
///
/// Y. C. Pati, R. Rezaiifar and P. S. Krishnaprasad, "Orthogonal matching pursuit: recursive function approximation with
/// applications to wavelet decomposition", Asilomar 1993. Atoms are the exact near-field echoes of the cells of the whole array's
/// polar grid, moved between the cells to where they explain most; the map is drawn from those that were picked. One look at the grid serves
/// several picks that stand far apart in range.
#[derive(Debug, Clone, Copy)]
pub struct Omp {
    /// Most atoms it picks.
    pub max_atoms: usize,
}

impl Default for Omp {
    fn default() -> Self {
        Omp { max_atoms: 64 }
    }
}

/// Picks of one look stand this far apart in range at least, and hear little of each other.
const PICKS_APART_BINS: usize = 40;

/// Power of a pick as a part of the strongest's of its look, beneath which it waits for another.
const LEAST_PICK: f64 = 0.1;

/// Steps by which a pick is moved off the grid.
const CLIMBING_STEPS: usize = 32;

/// The same for each of the directions that are compared.
const TOOTH_STEPS: usize = 12;

/// Directions to each side of a pick's that are compared: the phase between the ends is the same in all of them.
const TEETH_BESIDE: i32 = 6;

/// Most times that they are compared anew around the outermost of them, where that is the best.
const WALKS: usize = 8;

/// Most picks that are all moved again after each new one, their directions compared.
const MOST_RELAXED: usize = 6;

/// All picks, up to so many, are moved again once this part of the energy is left that was left the last time.
const MOST_MOVED: usize = 64;
const MOVED_AT: f64 = 0.1;

/// They are moved until that leaves more than this part of what was left before, at most so often; their directions are compared every
/// other time.
const STILL_MOVING: f64 = 0.5;
const MOST_ROUNDS: usize = 8;

/// Steps of each of them.
const MOVING_STEPS: usize = 24;

/// Part of the energy that rounding leaves unexplained where phases of 6e4 rad were evaluated in f64: about 1e-11 of each sample's
/// amplitude. It is not white, so that the measured noise understates it.
const ROUNDING_ENERGY: f64 = 1e-22;

/// Least part of an atom that the atoms picked before don't hold: less is no new atom.
const LEAST_NEW: f64 = 1e-7;

/// Part of the residual's energy that a pick must at least explain.
const LEAST_GAIN: f64 = 1e-3;

/// Part of all energy that a pick must at least explain: 100 dB down. What a pick leaves where it has not quite come to its place is no scene.
const LEAST_OF_ALL: f64 = 1e-10;

/// A cell's echo, picked.
struct Pick {
    cell: Cell,
    atom: ArrayEcho,
}

/// What has been picked, and what is left of the samples.
struct Pursuit<'a> {
    radar: &'a Radar,
    cells: Cells<'a>,
    picks: Vec<Pick>,
    /// Orthonormal basis of the picked atoms.
    basis: Vec<Vec<Complex64>>,
    residual: Vec<Complex64>,
}

impl Pursuit<'_> {
    fn is_taken(&self, cell: Cell) -> bool {
        self.picks.iter().any(|p| p.cell == cell)
    }

    /// The free cell where most is `heard`.
    fn strongest(&self, heard: &Array2<f64>) -> Option<Pick> {
        let (cell, _) = heard
            .indexed_iter()
            .map(|((bin, direction), power)| (Cell { bin, direction }, power))
            .filter(|(cell, _)| !self.is_taken(*cell) && self.cells.may_hold(*cell))
            .max_by(|a, b| a.1.total_cmp(b.1))?;
        Some(Pick { cell, atom: self.cells.echo(cell)? })
    }

    /// `atom` moved off the grid to where it explains most of `samples`, of all directions nearby between which only the phase between
    /// the ends tells.
    fn refined(&self, mut atom: ArrayEcho, samples: &[Complex64]) -> ArrayEcho {
        let (radar, cells) = (self.radar, &self.cells);
        let apart_metres = (radar.elements - radar.end_elements) as f64 * radar.element_spacing_metres;
        let tooth_cos = 1.0 / (apart_metres * radar.carrier_turns_per_metre().abs());
        for _ in 0..WALKS {
            let place = radar.polar_of(atom.reflector.x_metres, atom.reflector.y_metres);
            let best = (-TEETH_BESIDE..=TEETH_BESIDE)
                .into_par_iter()
                .filter_map(|tooth| {
                    let cos = place.cos_theta + f64::from(tooth) * tooth_cos;
                    let (heard, atom) = climbed(cells, cells.echo_at(place.range_metres, cos)?, samples, TOOTH_STEPS);
                    Some((heard, tooth, atom))
                })
                .reduce_with(|a, b| if b.0 > a.0 { b } else { a });
            let Some((_, tooth, better)) = best else { break };
            atom = better;
            if tooth.abs() < TEETH_BESIDE {
                break;
            }
        }
        climbed(cells, atom, samples, CLIMBING_STEPS).1
    }

    /// Moves every pick once more, now that the others' shares of `samples` are known: side lobes of an echo that was not yet picked
    /// may have drawn it to a wrong place. `compares` says whether directions between which only the phase between the ends tells are
    /// compared anew.
    fn relax(&mut self, samples: &[Complex64], compares: bool) {
        for (i, gain) in unit_gains(&self.picks, samples).into_iter().enumerate() {
            let atom = self.picks[i].atom.clone();
            let mut own = self.residual.clone();
            subtract(&mut own, &atom.unit_samples(), -gain);
            let atom =
                if compares { self.refined(atom, &own) } else { climbed(&self.cells, atom, &own, MOVING_STEPS).1 };
            let unit = atom.unit_samples();
            let gain = inner(&unit, &own);
            subtract(&mut own, &unit, gain);
            self.residual = own;
            self.picks[i].atom = atom;
        }
        self.basis.clear();
        self.residual = samples.to_vec();
        for pick in std::mem::take(&mut self.picks) {
            self.take(pick);
        }
    }

    /// Moves all picks until they stay where they are, or no more than `enough` is left.
    fn settle(&mut self, samples: &[Complex64], enough: f64, request: &Request) -> Result<(), ReconstructError> {
        for round in 0..MOST_ROUNDS {
            request.task.check()?;
            let before = energy(&self.residual);
            if before <= enough {
                break;
            }
            self.relax(samples, round % 2 == 0 || self.picks.len() <= MOST_RELAXED);
            if energy(&self.residual) > STILL_MOVING * before {
                break;
            }
        }
        Ok(())
    }

    /// Takes the pick's share off the residual; whether that was worth it.
    fn take(&mut self, pick: Pick) -> bool {
        let mut direction = pick.atom.unit_samples();
        // Twice: once leaves rounding error along atoms that lie close together.
        for _ in 0..2 {
            for b in &self.basis {
                let along = inner(b, &direction);
                subtract(&mut direction, b, along);
            }
        }
        let length = energy(&direction).sqrt();
        if length < LEAST_NEW {
            return false;
        }
        direction.iter_mut().for_each(|v| *v /= length);
        let along = inner(&direction, &self.residual);
        let before = energy(&self.residual);
        subtract(&mut self.residual, &direction, along);
        self.basis.push(direction);
        self.picks.push(pick);
        energy(&self.residual) <= before * (1.0 - LEAST_GAIN)
    }
}

impl Omp {
    /// Picks atoms of `ends` until only noise is left, and fits their gains.
    fn pursue(
        &self,
        radar: &Radar,
        ends: &TwoEnds,
        noise_variance: f64,
        request: &Request,
    ) -> Result<Vec<Gained>, ReconstructError> {
        let samples = ends.flat();
        let noise = noise_variance * samples.len() as f64 * 1.1;
        let all = energy(&samples);
        let enough = noise.max(all * ROUNDING_ENERGY);
        let mut cells = Cells::heard_by(radar, ends);
        // Nothing stands at the centre: what is heard in bin 0 stands one range period beyond.
        if radar.samples > 1 {
            cells.range_metres[0] = radar.max_range_metres();
        }
        let backprojector = Backprojector::new(radar, &cells, RangeWindow::None);
        let (bins, directions) = cells.dim();
        let noise_level = 100f64.powf(decades_above_cells(noise_variance, bins * directions));
        let worth = noise_level.max(all * LEAST_OF_ALL);
        let mut settled = all;
        let (picks, basis) = (Vec::new(), Vec::new());
        let mut pursuit = Pursuit { radar, cells, picks, basis, residual: samples.clone() };
        while pursuit.picks.len() < self.max_atoms && energy(&pursuit.residual) > enough {
            request.task.check()?;
            request.task.set_progress(0.9 * pursuit.picks.len() as f32 / self.max_atoms as f32);
            let [first, last] = backprojector.amplitudes(&TwoEnds::of_flat(pursuit.radar, &pursuit.residual));
            // Between the cells the ends' phases are others: each pick is moved to where they agree.
            let heard: Array2<f64> = Zip::from(&first).and(&last).par_map_collect(|a, b| (a.norm() + b.norm()).powi(2));
            if !self.pick(&mut pursuit, heard, &samples, enough, worth) {
                break; // nothing on the grid explains what is left
            }
            let count = pursuit.picks.len();
            if (2..=MOST_MOVED).contains(&count) && energy(&pursuit.residual) < MOVED_AT * settled {
                pursuit.settle(&samples, enough, request)?;
                settled = energy(&pursuit.residual);
            }
        }
        Ok(fit(&pursuit.picks, &samples))
    }

    /// Takes the strongest of `heard`, and those that stand far from it in range; whether the strongest was worth it, which explains no
    /// less than `worth`.
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
            if (2..=MOST_RELAXED).contains(&pursuit.picks.len()) {
                pursuit.relax(samples, true);
            }
            least = f64::max(least, LEAST_PICK * power);
            let bins = heard.nrows();
            let near = bin.saturating_sub(PICKS_APART_BINS)..(bin + PICKS_APART_BINS).min(bins);
            heard.slice_mut(s![near, ..]).fill(0.0);
        }
        true
    }
}

/// `atom` moved to the nearest place where it explains most of `samples`, and its share there; in at most `steps` steps, which get
/// shorter once none helps.
fn climbed(cells: &Cells<'_>, mut atom: ArrayEcho, samples: &[Complex64], steps: usize) -> (f64, ArrayEcho) {
    let radar = cells.radar();
    let place = radar.polar_of(atom.reflector.x_metres, atom.reflector.y_metres);
    let (mut range, mut cos) = (place.range_metres, place.cos_theta);
    let aperture_metres = radar.elements as f64 * radar.element_spacing_metres;
    let mut step =
        (radar.range_resolution_metres() / 4.0, 0.25 / (aperture_metres * radar.carrier_turns_per_metre().abs()));
    let mut heard = atom.correlate(samples).norm();
    for _ in 0..steps {
        let around = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, -1), (1, -1), (-1, 1)];
        let better = around.into_par_iter().filter_map(|(i, j)| {
            let (range, cos) = (range + f64::from(i) * step.0, cos + f64::from(j) * step.1);
            let atom = cells.echo_at(range, cos)?;
            let now = atom.correlate(samples).norm();
            (now > heard).then_some((now, range, cos, atom))
        });
        match better.reduce_with(|a, b| if b.0 > a.0 { b } else { a }) {
            Some((now, r, c, better)) => (heard, range, cos, atom) = (now, r, c, better),
            None => step = (step.0 / 2.0, step.1 / 2.0),
        }
    }
    (heard, atom)
}

/// Gains of the picked atoms by least squares.
fn fit(picks: &[Pick], samples: &[Complex64]) -> Vec<Gained> {
    let gains = unit_gains(picks, samples);
    let gained = picks.iter().zip(gains);
    gained.map(|(p, gain)| Gained { reflector: p.atom.reflector, gain: gain / p.atom.norm() }).collect()
}

/// Gains of the picked atoms' unit samples.
fn unit_gains(picks: &[Pick], samples: &[Complex64]) -> Vec<Complex64> {
    if picks.is_empty() {
        return Vec::new();
    }
    let columns: Vec<Vec<Complex64>> = picks.iter().map(|p| p.atom.unit_samples()).collect();
    let matrix = Mat::from_fn(samples.len(), picks.len(), |i, j| columns[j][i]);
    let gains = matrix.qr().solve_lstsq(Mat::from_fn(samples.len(), 1, |i, _| samples[i]));
    (0..picks.len()).map(|j| gains[(j, 0)]).collect()
}

fn energy(v: &[Complex64]) -> f64 {
    v.iter().map(Complex64::norm_sqr).sum()
}

fn inner(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

fn subtract(from: &mut [Complex64], what: &[Complex64], times: Complex64) {
    from.iter_mut().zip(what).for_each(|(f, w)| *f -= w * times);
}

impl Reconstructor for Omp {
    fn family(&self) -> Family {
        Family::Sparse
    }

    fn about(&self) -> About {
        About {
            name: "omp",
            description: "greedy sparse fit of exact near-field echoes, each moved off the polar grid to where it explains most, and their exact map",
            told: "that a scene holds single reflectors, 64 at most; it measures the noise itself",
            eta: 0.819, // by examples/choose_eta.rs
        }
    }

    fn knows_pairs(&self) -> bool {
        true
    }

    fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
        let why = too_many_folds(radar).or_else(|| too_large(radar, &Cells::new(radar)));
        why.map_or(Ok(()), |reason| Err(self.unusable(reason)))
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let noise_variance = ends_noise_variance(radar, ends, request.noise);
        let found = self.pursue(radar, ends, noise_variance, request)?;
        Ok(of_echoes(radar, ends, &found, noise_variance, request))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::Carrier;
    use crate::scene::{Reflector, Scene};
    use crate::signal::{Floor, simulate};

    #[test]
    fn reflectors_on_the_grid_are_recovered() {
        let radar = Radar::default();
        let grid = Cells::new(&radar);
        let cells = [(150usize, 700usize), (230, 512), (231, 300), (390, 620)];
        let atoms = cells.map(|(bin, direction)| grid.echo(Cell { bin, direction }).unwrap());
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

    /// Part of the energy of `ends` that `found` leaves.
    fn left(radar: &Radar, ends: &TwoEnds, found: &[Reflector]) -> f64 {
        let samples = ends.flat();
        let cells = Cells::heard_by(radar, ends);
        let pick = |r: &Reflector| {
            let place = radar.polar_of(r.x_metres, r.y_metres);
            Pick {
                cell: Cell { bin: 0, direction: 0 },
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
        let mut parts: Vec<f64> = (0..9)
            .map(|i| {
                let (range, cos) = (6.0 + 2.37 * f64::from(i), -0.8 + 0.193 * f64::from(i));
                let scene = Scene::of_points([(range * cos, range * (1.0 - cos * cos).sqrt())]);
                let ends = simulate(&radar, &scene, Floor::Thesis, 0).unwrap().two_ends(&radar);
                let first = Omp { max_atoms: 1 }.reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
                let all = Omp::default().reconstruct(&radar, &ends, &Request::default()).unwrap().reflectors;
                assert_eq!(all.len(), 1, "picks for one reflector at {range} m, {cos}");
                left(&radar, &ends, &first)
            })
            .collect();
        parts.sort_by(f64::total_cmp);
        assert!(parts[8] < 1e-9, "{parts:?}");
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
        // Both stand in columns that a one-way array would take for other directions.
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
