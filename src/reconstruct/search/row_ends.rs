//! The ends of a row: reflectors are added or removed one by one, and the row is refined, while this lowers the residual.

use super::on_row::MAX_ROW_REFLECTORS;
use super::propose::strides::MIN_REFLECTORS;
use super::state::Search;
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Limits, RangeGate, Spectra, Tie, bin_spans};

/// Reflectors beyond the best end after which the search for a better one stops.
const MAX_FAILED_REFLECTORS: usize = 8;

/// Largest number of times that a row is made longer and refined.
const MAX_EXTENSIONS: usize = 8;

/// Range bins beside a row's own in which reflectors are added: the least number, and the part of its own.
const MIN_MARGIN_BINS: f64 = 12.0;
const MARGIN_PART: f64 = 0.5;

impl Search<'_> {
    /// The row `seed` with the ends and the place that fit the samples of `spectra` best.
    pub fn extended_to_its_ends(&self, spectra: &Spectra, seed: Atom) -> Fit {
        let mut gate = self.gate(spectra, &seed);
        let seed = trimmed(&gate, seed);
        let mut row = gate.refined(seed, Gains::default());
        for _ in 0..MAX_EXTENSIONS {
            let missing = |at_last| self.missing_reflectors(&gate, &row, at_last);
            let (before, after) = rayon::join(|| missing(false), || missing(true));
            if before + after == 0 {
                break;
            }
            let Some(longer) = resized(row.atoms[0], -(before as i64), -(after as i64)) else { break };
            let explained = gate.energy - row.cost();
            let wider = self.gate(spectra, &longer);
            let trial = wider.refined(longer, row.gains[0]);
            if wider.energy - trial.cost() <= explained || self.fitter.work.is_spent() {
                break;
            }
            (gate, row) = (wider, trial);
        }
        let shorter = trimmed(&gate, row.atoms[0]);
        if shorter != row.atoms[0] {
            let trial = gate.refined(shorter, row.gains[0]);
            if trial.cost() < row.cost() {
                row = trial;
            }
        }
        self.fitter.refine(spectra.samples, row.atoms, row.gains, Tie::PerEnd, Limits::ROUGH_FIT)
    }

    fn gate<'a>(&self, spectra: &Spectra<'a>, row: &Atom) -> RangeGate<'a> {
        let spans = bin_spans(self.radar, row);
        let longest = spans.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
        spectra.gate(&spans, MIN_MARGIN_BINS.max(MARGIN_PART * longest))
    }

    /// Number of reflectors beyond the last end, or the first, with the least residual. At most as many as the row has: its direction is not more exact.
    fn missing_reflectors(&self, gate: &RangeGate, row: &Fit, at_last: bool) -> usize {
        let Some(atom) = row.atoms.first() else { return 0 };
        let count = atom.reflector_count();
        let next = |more: usize| atom.position_metres(if at_last { (count - 1 + more) as f64 } else { -(more as f64) });
        let is_within = |&[x_metres, y_metres]: &[f64; 2]| {
            y_metres >= 0.0 && gate.contains(&bin_spans(self.radar, &Atom::Point { x_metres, y_metres }))
        };
        best_count(&gate.fitter, row, &row.gains, (1..=count).map(next).take_while(is_within))
    }
}

impl RangeGate<'_> {
    /// The row refined in the gate, with `gains` to begin with.
    fn refined(&self, row: Atom, gains: Gains) -> Fit {
        self.fitter.refine(&self.samples, vec![row], vec![gains], Tie::PerEnd, Limits::ROUGH_FIT)
    }
}

/// `seed` without the reflectors at its ends whose removal lowers the residual.
fn trimmed(gate: &RangeGate, mut seed: Atom) -> Atom {
    loop {
        let row = gate.fitter.solve_alone(&gate.samples, seed);
        let excess = |at_last| excess_reflectors(&gate.fitter, &row, at_last);
        let (first, last) = rayon::join(|| excess(false), || excess(true));
        match resized(seed, first as i64, last as i64) {
            Some(shorter) if first + last > 0 => seed = shorter,
            _ => return seed,
        }
    }
}

/// Number of reflectors at the last end, or at the first, whose removal has the least residual.
fn excess_reflectors(fitter: &Fitter, row: &Fit, at_last: bool) -> usize {
    let Some(atom) = row.atoms.first() else { return 0 };
    let count = atom.reflector_count();
    let negative: Vec<Gains> = row.gains.iter().map(|g| g.map(|g| -g)).collect();
    let next = |fewer: usize| atom.position_metres(if at_last { (count - fewer) as f64 } else { (fewer - 1) as f64 });
    best_count(fitter, row, &negative, (1..=count / 2).map(next))
}

/// Number of the first `places` at which reflectors of these gains, subtracted from the residual of `row`, have the least residual.
fn best_count(fitter: &Fitter, row: &Fit, gains: &[Gains], places: impl Iterator<Item = [f64; 2]>) -> usize {
    let (mut best, mut least) = (0, row.cost());
    let mut residual = row.residual.clone();
    for (count, [x_metres, y_metres]) in (1..).zip(places) {
        let trial = fitter.subtract(&residual, &[Atom::Point { x_metres, y_metres }], gains);
        residual = trial.residual;
        let cost = trial.energy[0] + trial.energy[1];
        if cost < least {
            (best, least) = (count, cost);
        } else if count >= best + MAX_FAILED_REFLECTORS {
            break;
        }
    }
    best
}

/// `row` without `first` reflectors at its first end and `last` at its last; negative numbers add reflectors. `None` where too few or too many remain.
fn resized(row: Atom, first: i64, last: i64) -> Option<Atom> {
    let Atom::Row { dx_metres, dy_metres, count, .. } = row else { return None };
    let [x_metres, y_metres] = row.position_metres(first as f64);
    let count = usize::try_from(count as i64 - first - last).ok()?;
    let is_valid = (MIN_REFLECTORS..=MAX_ROW_REFLECTORS).contains(&count);
    is_valid.then_some(Atom::Row { x_metres, y_metres, dx_metres, dy_metres, count })
}
