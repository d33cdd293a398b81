//! The test of candidates for rows against the samples.

use super::grow::DETECTION_WORK;
use super::on_row::is_on_row;
use super::propose::edges::rows_from_edges;
use super::propose::phased::PhasedBeams;
use super::propose::strides::{MIN_REFLECTORS, rows_over_pairs};
use super::state::{Search, tried};
use super::trace::decades;
use crate::radar::Radar;
use crate::reconstruct::attempt::Refusal;
use crate::reconstruct::fit::{Atom, BinSpans, Fit, Profile, Spectra, bin_spans};
use rayon::prelude::*;

/// Largest number of candidates from one source that are fitted to the samples, and of points from which edges are searched: each gives one row.
const MAX_CANDIDATES: usize = 24;

/// Least part of the energy in its range bins that a candidate explains, for its ends to be searched.
const MIN_CANDIDATE_PART: f64 = 0.3;

/// Least number of reflectors of a row, and least part of the energy in its range bins that it explains. Rows of few reflectors fit other objects too.
const MIN_EXPLAINED_PARTS: [(usize, f64); 2] = [(17, 0.85), (MIN_REFLECTORS, 0.97)];

/// This part for a long row. A wrong row of so many reflectors explains little, and a right one shares its range bins with other objects.
const MIN_LONG_ROW_PART: f64 = 0.6;

/// Least number of reflectors of a long row, and of range bins of its length.
const MIN_LONG_ROW_REFLECTORS: usize = 45;

/// Whether a row is accepted that explains the part `explained` of the energy in its range bins.
fn is_accepted(radar: &Radar, row: &Atom, explained: f64) -> bool {
    let count = row.reflector_count();
    (is_long(radar, row) && explained >= MIN_LONG_ROW_PART)
        || MIN_EXPLAINED_PARTS.iter().any(|&(least, part)| count >= least && explained >= part)
}

/// Whether `row` has many reflectors, most of them resolved in range.
fn is_long(radar: &Radar, row: &Atom) -> bool {
    let [first, last] = [0.0, row.reflector_count() as f64 - 1.0].map(|i| row.position_metres(i));
    let bins = (last[0] - first[0]).hypot(last[1] - first[1]) / radar.range_resolution_metres();
    row.reflector_count() >= MIN_LONG_ROW_REFLECTORS && bins >= MIN_LONG_ROW_REFLECTORS as f64
}

/// The residual in which a row is searched.
struct SearchedResidual<'a> {
    fit: &'a Fit,
    profile: Profile,
    /// Energy of the noise in a range bin of an end.
    noise_energy: f64,
    spectra: Spectra<'a>,
}

impl SearchedResidual<'_> {
    /// Energy in range bins, without that of the noise.
    fn energy(&self, spans: &BinSpans) -> f64 {
        self.profile.energy_over_noise(spans, self.noise_energy).max(f64::MIN_POSITIVE)
    }
}

/// The first reflectors of a row.
#[derive(Debug, Clone, Copy)]
struct Candidate {
    atom: Atom,
    /// Part of the energy in its range bins that it explains.
    explained: f64,
}

impl Search<'_> {
    /// A row in the residual of `fit` that begins at one of `points` (x, y; metres) and explains enough; points on rows of `fit` are removed.
    pub fn next_row(&self, fit: &Fit, points: &mut Vec<[f64; 2]>) -> Option<Fit> {
        let flat = fit.residual.flat(&self.fitter.sensor);
        let profile = Profile::new(self.radar, &flat);
        let spectra = Spectra::new(self.radar, self.fitter, &fit.residual);
        let residual = SearchedResidual { fit, profile, noise_energy: self.noise_power(&flat), spectra };
        points.retain(|&[x_metres, y_metres]| {
            !fit.atoms.iter().any(|row| is_on_row(row, &Atom::Point { x_metres, y_metres }))
        });
        self.fitter.work.spend(DETECTION_WORK / 10 * points.len());
        let beams = PhasedBeams::new(self.radar, &flat);
        // The search for edges takes longest.
        self.accepted(&residual, &rows_over_pairs(&beams, points, self.fitter.task)).or_else(|| {
            let is_unwrapped = |p: &&[f64; 2]| p[0].hypot(p[1]) < self.radar.max_range_metres();
            let first: Vec<[f64; 2]> = points.iter().filter(is_unwrapped).take(MAX_CANDIDATES).copied().collect();
            let from_edges = self.has_long_run(&flat).then(|| rows_from_edges(&beams, &first, self.fitter.task));
            self.accepted(&residual, &from_edges.unwrap_or_default())
        })
    }

    fn candidate(&self, residual: &SearchedResidual, atom: Atom) -> Candidate {
        let spans = bin_spans(self.radar, &atom);
        let gate = residual.spectra.gate(&spans, 0.0);
        let energy = gate.energy - gate.fitter.solve_alone(&gate.samples, atom).cost();
        Candidate { atom, explained: energy / residual.energy(&spans) }
    }

    /// The best of `rows`, if it is accepted with the ends that are found.
    fn accepted(&self, residual: &SearchedResidual, rows: &[Atom]) -> Option<Fit> {
        let fit = residual.fit;
        let tested = rows.par_iter().take(MAX_CANDIDATES).map(|&atom| self.candidate(residual, atom));
        let candidates: Vec<Candidate> = tested.collect();
        tracing::debug!(rows = rows.len(), "rows");
        let best = candidates.into_iter().max_by(|a, b| a.explained.total_cmp(&b.explained));
        let best = best.filter(|row| row.explained > MIN_CANDIDATE_PART)?;
        let row = self.extended_to_its_ends(&residual.spectra, best.atom);
        let explained = (fit.cost() - row.cost()) / residual.energy(&bin_spans(self.radar, &row.atoms[0]));
        tracing::debug!(?best, explained, before = fit.cost(), cost = row.cost(), atom = ?row.atoms[0], "row");
        let explained = best.explained.max(explained);
        if is_accepted(self.radar, &row.atoms[0], explained) {
            return Some(row);
        }
        self.record_refusal(
            tried(&row.atoms[0]),
            decades(fit.cost(), row.cost()),
            Refusal::ExplainsTooLittle(explained),
        );
        None
    }
}
