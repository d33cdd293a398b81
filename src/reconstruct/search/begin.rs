//! Beginnings of walls: rows over two points or from the edge of a wall, tested against the samples.

use super::grow::LOOK_ECHOES;
use super::on_wall::is_on;
use super::propose::edges::rows_from_edges;
use super::propose::end_beams::beam_noise_power;
use super::propose::phased::PhasedBeams;
use super::propose::strides::{MIN_REFLECTORS, rows_over_pairs};
use super::state::{Search, tried};
use super::trace::decades;
use crate::radar::Radar;
use crate::reconstruct::attempt::Refusal;
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Profile, Spectra, bin_spans};
use rayon::prelude::*;

/// BinSpans that are held against the samples themselves at each look, and points, those first on which the ends agree best, that a wall may begin at
/// alone: there is one row a point.
const MOST_TRIED: usize = 24;

/// Least part of the energy in its range bins that a row must explain to be followed to its ends.
const LEAST_BEGUN: f64 = 0.3;

/// Reflectors of a wall, and the part that it must explain: the fewer, the more of them may be what makes up for something else.
const LEAST_EXPLAINED: [(usize, f64); 2] = [(17, 0.85), (MIN_REFLECTORS, 0.97)];

/// This part for a long wall: a wrong row of so many reflectors explains little, and other objects may stand in its range bins.
const LEAST_OF_LONG: f64 = 0.6;

/// Fewest reflectors of a long wall, and fewest range bins that it goes through.
const LEAST_LONG: usize = 45;

/// Whether a wall that explains this part of the energy in its range bins can be believed.
fn is_borne_out(radar: &Radar, wall: &Atom, explained: f64) -> bool {
    let count = wall.reflector_count();
    (is_long(radar, wall) && explained >= LEAST_OF_LONG)
        || LEAST_EXPLAINED.iter().any(|&(least, part)| count >= least && explained >= part)
}

/// Whether `wall` has many reflectors, most of them told apart.
fn is_long(radar: &Radar, wall: &Atom) -> bool {
    let [first, last] = [0.0, wall.reflector_count() as f64 - 1.0].map(|i| wall.position_metres(i));
    let bins = (last[0] - first[0]).hypot(last[1] - first[1]) / radar.range_resolution_metres();
    wall.reflector_count() >= LEAST_LONG && bins >= LEAST_LONG as f64
}

/// The residual in which another wall is searched.
struct Left<'a> {
    fit: &'a Fit,
    profile: Profile,
    /// Energy that noise gives to a range bin of an end.
    noise_a_bin: f64,
    spectra: Spectra<'a>,
}

impl Left<'_> {
    /// Energy in the range bins of a row, less that of the noise.
    fn energy_at(&self, rows: &BinSpans) -> f64 {
        self.profile.energy_over_noise(rows, self.noise_a_bin).max(f64::MIN_POSITIVE)
    }
}

/// The first reflectors of a wall.
#[derive(Debug, Clone, Copy)]
struct Begun {
    atom: Atom,
    /// Part of the energy in their range bins that they explain.
    part: f64,
}

impl Search<'_> {
    /// A wall that begins at one of `points` (x, y; metres), followed to its ends in what `fit` leaves, that is borne out by how much it explains.
    /// Points on the walls of `fit` are taken from `points`.
    pub fn next_wall(&self, fit: &Fit, points: &mut Vec<[f64; 2]>) -> Option<Fit> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let profile = Profile::new(self.radar, &flat);
        let noise_a_bin = beam_noise_power(self.radar, self.fitter.noise_model.noise_variance(self.radar, &flat));
        let left = Left { fit, profile, noise_a_bin, spectra: Spectra::new(self.radar, self.fitter, &fit.residual) };
        points.retain(|&[x_metres, y_metres]| {
            !fit.atoms.iter().any(|wall| is_on(wall, &Atom::Point { x_metres, y_metres }))
        });
        self.fitter.work.spend(LOOK_ECHOES / 10 * points.len());
        let beams = PhasedBeams::new(self.radar, &flat);
        // Looks from one point alone take longest.
        self.borne_out(&left, &rows_over_pairs(&beams, points, self.task)).or_else(|| {
            let is_near = |p: &&[f64; 2]| p[0].hypot(p[1]) < self.radar.max_range_metres();
            let first: Vec<[f64; 2]> = points.iter().filter(is_near).take(MOST_TRIED).copied().collect();
            let from_edges = if self.is_long(&flat) { rows_from_edges(&beams, &first, self.task) } else { Vec::new() };
            self.borne_out(&left, &from_edges)
        })
    }

    /// The row with the part that it explains, where it is, of the energy in its range bins.
    fn begun(&self, left: &Left, atom: Atom) -> Begun {
        let rows = bin_spans(self.radar, &atom);
        let near = left.spectra.gate(&rows, 0.0);
        let energy = near.energy - near.fitter.solve_alone(&near.samples, atom).cost();
        Begun { atom, part: energy / left.energy_at(&rows) }
    }

    /// The row that explains the greatest part of the energy in its range bins.
    fn best_begun(&self, left: &Left, rows: &[Atom]) -> Option<Begun> {
        let begun: Vec<Begun> = rows.par_iter().take(MOST_TRIED).map(|&atom| self.begun(left, atom)).collect();
        tracing::debug!(rows = rows.len(), "rows");
        begun.into_iter().max_by(|a, b| a.part.total_cmp(&b.part))
    }

    /// The best of `rows`, if it is accepted after it was followed to its ends.
    fn borne_out(&self, left: &Left, rows: &[Atom]) -> Option<Fit> {
        let fit = left.fit;
        let best = self.best_begun(left, rows).filter(|row| row.part > LEAST_BEGUN)?;
        let wall = self.followed_to_its_ends(&fit.residual, best.atom);
        let explained = (fit.cost() - wall.cost()) / left.energy_at(&bin_spans(self.radar, &wall.atoms[0]));
        tracing::debug!(?best, explained, before = fit.cost(), cost = wall.cost(), atom = ?wall.atoms[0], "wall");
        let part = best.part.max(explained);
        if is_borne_out(self.radar, &wall.atoms[0], part) {
            return Some(wall);
        }
        self.refuse(tried(&wall.atoms[0]), decades(fit.cost(), wall.cost()), Refusal::ExplainsTooLittle(part));
        None
    }
}
