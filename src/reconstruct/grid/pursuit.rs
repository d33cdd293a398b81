//! Picked echoes, moved off the grid to where they explain most, and their residual.

use super::cells::{GridCell, GridCells};
use crate::radar::Radar;
use crate::reconstruct::answer::Request;
use crate::reconstruct::error::Result;
use crate::signal::ArrayEcho;
use faer::Mat;
use faer::linalg::solvers::SolveLstsq;
use ndarray::Array2;
use num_complex::Complex64;
use rayon::prelude::*;

/// Steps by which a pick is moved off the grid.
const CLIMBING_STEPS: usize = 32;

/// Steps for each of the directions that are compared.
const TOOTH_STEPS: usize = 12;

/// Directions to each side of a pick's that are compared: the phase between the ends is the same for all of them.
const SIDE_TEETH: i32 = 6;

/// Most comparisons, each around the outermost direction of the last where that was the best.
const MAX_COMPARISONS: usize = 8;

/// Most picks that are all moved again after each new one, with their directions compared.
pub(super) const MAX_RELAXED_PICKS: usize = 6;

/// All picks are moved until a round leaves more than this part of the energy before it, in at most so many rounds; their directions are
/// compared every other round.
const MAX_ROUND_ENERGY_PART: f64 = 0.5;
const MAX_RELAX_ROUNDS: usize = 8;

/// Steps of each pick in a round.
const MOVING_STEPS: usize = 24;

/// Least part of an atom outside the span of the picked atoms; an atom with less is not new.
const MIN_NEW_ATOM_PART: f64 = 1e-7;

/// Part of the residual's energy that a pick must at least explain.
const MIN_PICK_GAIN_PART: f64 = 1e-3;

pub(super) struct Pick {
    pub cell: GridCell,
    pub atom: ArrayEcho,
}

pub(super) struct Pursuit<'a> {
    radar: &'a Radar,
    cells: &'a GridCells<'a>,
    pub picks: Vec<Pick>,
    /// Orthonormal basis of the picked atoms.
    basis: Vec<Vec<Complex64>>,
    pub residual: Vec<Complex64>,
}

impl<'a> Pursuit<'a> {
    /// The start, without picks: the residual is `samples`.
    pub fn new(radar: &'a Radar, cells: &'a GridCells<'a>, samples: &[Complex64]) -> Self {
        let (picks, basis) = (Vec::new(), Vec::new());
        Pursuit { radar, cells, picks, basis, residual: samples.to_vec() }
    }

    fn is_taken(&self, cell: GridCell) -> bool {
        self.picks.iter().any(|p| p.cell == cell)
    }

    /// The free cell with the largest value of `heard`.
    pub fn strongest(&self, heard: &Array2<f64>) -> Option<Pick> {
        let cells = heard.indexed_iter().map(|((bin, direction), power)| (GridCell { bin, direction }, power));
        let free = cells.filter(|(cell, _)| !self.is_taken(*cell) && self.cells.may_hold(*cell));
        let (cell, _) = free.max_by(|a, b| a.1.total_cmp(b.1))?;
        Some(Pick { cell, atom: self.cells.echo(cell)? })
    }

    /// `atom` moved off the grid to where it explains most of `samples`, over all nearby directions that only the phase between the ends distinguishes.
    pub fn refined(&self, mut atom: ArrayEcho, samples: &[Complex64]) -> ArrayEcho {
        let (radar, cells) = (self.radar, self.cells);
        let apart_metres = (radar.elements - radar.end_elements) as f64 * radar.element_spacing_metres;
        let tooth_cos = 1.0 / (apart_metres * radar.carrier_turns_per_metre().abs());
        for _ in 0..MAX_COMPARISONS {
            let place = radar.polar_of(atom.reflector.x_metres, atom.reflector.y_metres);
            let best = (-SIDE_TEETH..=SIDE_TEETH)
                .into_par_iter()
                .filter_map(|tooth| {
                    let cos = place.cos_theta + f64::from(tooth) * tooth_cos;
                    let (heard, atom) = climbed(cells, cells.echo_at(place.range_metres, cos)?, samples, TOOTH_STEPS);
                    Some((heard, tooth, atom))
                })
                .reduce_with(|a, b| if b.0 > a.0 { b } else { a });
            let Some((_, tooth, better)) = best else { break };
            atom = better;
            if tooth.abs() < SIDE_TEETH {
                break;
            }
        }
        climbed(cells, atom, samples, CLIMBING_STEPS).1
    }

    /// Moves every pick again, with the others' shares of `samples` subtracted: side lobes of an echo that was not yet picked may have drawn the
    /// pick to a wrong place. `compares` is whether directions that only the phase between the ends distinguishes are compared anew.
    pub fn relax(&mut self, samples: &[Complex64], compares: bool) {
        for (i, gain) in unit_gains(&self.picks, samples).into_iter().enumerate() {
            let atom = self.picks[i].atom.clone();
            let mut own = self.residual.clone();
            subtract(&mut own, &atom.unit_samples(), -gain);
            let atom =
                if compares { self.refined(atom, &own) } else { climbed(self.cells, atom, &own, MOVING_STEPS).1 };
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

    /// Moves all picks until they stay where they are, or the residual's energy is at most `enough`.
    pub fn settle(&mut self, samples: &[Complex64], enough: f64, request: &Request) -> Result<()> {
        for round in 0..MAX_RELAX_ROUNDS {
            request.task.check()?;
            let before = energy(&self.residual);
            if before <= enough {
                break;
            }
            self.relax(samples, round % 2 == 0 || self.picks.len() <= MAX_RELAXED_PICKS);
            if energy(&self.residual) > MAX_ROUND_ENERGY_PART * before {
                break;
            }
        }
        Ok(())
    }

    /// Subtracts the pick's share from the residual; returns whether the share was large enough.
    pub fn take(&mut self, pick: Pick) -> bool {
        let mut direction = pick.atom.unit_samples();
        // Twice, since one pass leaves rounding errors along atoms that lie close together.
        for _ in 0..2 {
            for b in &self.basis {
                let along = inner(b, &direction);
                subtract(&mut direction, b, along);
            }
        }
        let length = energy(&direction).sqrt();
        if length < MIN_NEW_ATOM_PART {
            return false;
        }
        direction.iter_mut().for_each(|v| *v /= length);
        let along = inner(&direction, &self.residual);
        let before = energy(&self.residual);
        subtract(&mut self.residual, &direction, along);
        self.basis.push(direction);
        self.picks.push(pick);
        energy(&self.residual) <= before * (1.0 - MIN_PICK_GAIN_PART)
    }
}

/// `atom` moved to the nearest place where it explains most of `samples`, and its correlation there; steps get shorter once none helps.
fn climbed(cells: &GridCells<'_>, mut atom: ArrayEcho, samples: &[Complex64], steps: usize) -> (f64, ArrayEcho) {
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

pub(super) fn unit_gains(picks: &[Pick], samples: &[Complex64]) -> Vec<Complex64> {
    if picks.is_empty() {
        return Vec::new();
    }
    let columns: Vec<Vec<Complex64>> = picks.iter().map(|p| p.atom.unit_samples()).collect();
    let matrix = Mat::from_fn(samples.len(), picks.len(), |i, j| columns[j][i]);
    let gains = matrix.qr().solve_lstsq(Mat::from_fn(samples.len(), 1, |i, _| samples[i]));
    (0..picks.len()).map(|j| gains[(j, 0)]).collect()
}

pub(super) fn energy(v: &[Complex64]) -> f64 {
    v.iter().map(Complex64::norm_sqr).sum()
}

fn inner(a: &[Complex64], b: &[Complex64]) -> Complex64 {
    a.iter().zip(b).map(|(a, b)| a.conj() * b).sum()
}

pub(super) fn subtract(from: &mut [Complex64], what: &[Complex64], times: Complex64) {
    from.iter_mut().zip(what).for_each(|(f, w)| *f -= w * times);
}
