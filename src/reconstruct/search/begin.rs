//! Beginnings of rows: rows over two points or from the edge of a row, tested against the samples.

use super::grow::DETECTION_WORK;
use super::on_row::is_on_row;
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

/// BinSpans that are held against the samples themselves at each look, and points, those first on which the ends agree best, that a row may begin at
/// alone: there is one row a point.
const MAX_CANDIDATES: usize = 24;

/// Least part of the energy in its range bins that a row must explain to be followed to its ends.
const MIN_CANDIDATE_PART: f64 = 0.3;

/// Reflectors of a row, and the part that it must explain: the fewer, the more of them may be what makes up for something else.
const MIN_EXPLAINED_PARTS: [(usize, f64); 2] = [(17, 0.85), (MIN_REFLECTORS, 0.97)];

/// This part for a long row: a wrong row of so many reflectors explains little, and other objects may stand in its range bins.
const MIN_LONG_ROW_PART: f64 = 0.6;

/// Fewest reflectors of a long row, and fewest range bins that it goes through.
const MIN_LONG_ROW_REFLECTORS: usize = 45;

/// Whether a row that explains this part of the energy in its range bins can be believed.
fn is_accepted(radar: &Radar, row: &Atom, explained: f64) -> bool {
    let count = row.reflector_count();
    (has_long_run(radar, row) && explained >= MIN_LONG_ROW_PART)
        || MIN_EXPLAINED_PARTS.iter().any(|&(least, part)| count >= least && explained >= part)
}

/// Whether `row` has many reflectors, most of them told apart.
fn has_long_run(radar: &Radar, row: &Atom) -> bool {
    let [first, last] = [0.0, row.reflector_count() as f64 - 1.0].map(|i| row.position_metres(i));
    let bins = (last[0] - first[0]).hypot(last[1] - first[1]) / radar.range_resolution_metres();
    row.reflector_count() >= MIN_LONG_ROW_REFLECTORS && bins >= MIN_LONG_ROW_REFLECTORS as f64
}

/// The residual in which another row is searched.
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

/// The first reflectors of a row.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    atom: Atom,
    /// Part of the energy in their range bins that they explain.
    part: f64,
}

impl Search<'_> {
    /// A row that begins at one of `points` (x, y; metres), followed to its ends in what `fit` leaves, that is borne out by how much it explains.
    /// Points on the rows of `fit` are taken from `points`.
    pub fn next_row(&self, fit: &Fit, points: &mut Vec<[f64; 2]>) -> Option<Fit> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let profile = Profile::new(self.radar, &flat);
        let noise_a_bin = beam_noise_power(self.radar, self.fitter.noise_model.noise_variance(self.radar, &flat));
        let left = Left { fit, profile, noise_a_bin, spectra: Spectra::new(self.radar, self.fitter, &fit.residual) };
        points.retain(|&[x_metres, y_metres]| {
            !fit.atoms.iter().any(|row| is_on_row(row, &Atom::Point { x_metres, y_metres }))
        });
        self.fitter.work.spend(DETECTION_WORK / 10 * points.len());
        let beams = PhasedBeams::new(self.radar, &flat);
        // Looks from one point alone take longest.
        self.accepted(&left, &rows_over_pairs(&beams, points, self.task)).or_else(|| {
            let is_near = |p: &&[f64; 2]| p[0].hypot(p[1]) < self.radar.max_range_metres();
            let first: Vec<[f64; 2]> = points.iter().filter(is_near).take(MAX_CANDIDATES).copied().collect();
            let from_edges =
                if self.has_long_run(&flat) { rows_from_edges(&beams, &first, self.task) } else { Vec::new() };
            self.accepted(&left, &from_edges)
        })
    }

    /// The row with the part that it explains, where it is, of the energy in its range bins.
    fn candidate(&self, left: &Left, atom: Atom) -> Candidate {
        let rows = bin_spans(self.radar, &atom);
        let near = left.spectra.gate(&rows, 0.0);
        let energy = near.energy - near.fitter.solve_alone(&near.samples, atom).cost();
        Candidate { atom, part: energy / left.energy_at(&rows) }
    }

    /// The row that explains the greatest part of the energy in its range bins.
    fn best_candidate(&self, left: &Left, rows: &[Atom]) -> Option<Candidate> {
        let candidate: Vec<Candidate> =
            rows.par_iter().take(MAX_CANDIDATES).map(|&atom| self.candidate(left, atom)).collect();
        tracing::debug!(rows = rows.len(), "rows");
        candidate.into_iter().max_by(|a, b| a.part.total_cmp(&b.part))
    }

    /// The best of `rows`, if it is accepted after it was followed to its ends.
    fn accepted(&self, left: &Left, rows: &[Atom]) -> Option<Fit> {
        let fit = left.fit;
        let best = self.best_candidate(left, rows).filter(|row| row.part > MIN_CANDIDATE_PART)?;
        let row = self.extended_to_its_ends(&fit.residual, best.atom);
        let explained = (fit.cost() - row.cost()) / left.energy_at(&bin_spans(self.radar, &row.atoms[0]));
        tracing::debug!(?best, explained, before = fit.cost(), cost = row.cost(), atom = ?row.atoms[0], "row");
        let part = best.part.max(explained);
        if is_accepted(self.radar, &row.atoms[0], part) {
            return Some(row);
        }
        self.record_refusal(tried(&row.atoms[0]), decades(fit.cost(), row.cost()), Refusal::ExplainsTooLittle(part));
        None
    }
}
