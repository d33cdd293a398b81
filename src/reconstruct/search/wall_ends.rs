//! The ends of a wall: it is followed reflector by reflector, and moved, until neither leaves less of the samples.

use super::on_wall::MOST_REFLECTORS;
use super::propose::strides::MIN_REFLECTORS;
use super::state::Search;
use crate::reconstruct::fit::{Atom, Fit, Fitter, Gains, Limits, RangeGate, Samples, Spectra, Tie, bin_spans};

/// Reflectors beyond the best end of a wall that are tried.
const BEYOND: usize = 8;

/// Most times reflectors are taken from a wall's ends.
const MOST_TRIMS: usize = 2;

/// Most times a wall is followed further and moved to its best place.
const MOST_WALKS: usize = 8;

/// Range bins beyond a wall's own in which it is followed, at least, and as a part of its own.
const ROOM_BINS: f64 = 12.0;
const ROOM: f64 = 0.5;

impl Search<'_> {
    /// The wall moved to its best place in `samples` and made longer, by turns, until neither helps.
    pub fn followed_to_its_ends(&self, samples: &Samples, seed: Atom) -> Fit {
        let spectra = Spectra::new(self.radar, self.fitter, samples);
        let mut near = self.near(&spectra, &seed);
        let seed = trimmed(&near, seed);
        let mut wall = near.moved(seed, Gains::default());
        for _ in 0..MOST_WALKS {
            let (before, after) =
                rayon::join(|| self.more_reflectors(&near, &wall, false), || self.more_reflectors(&near, &wall, true));
            if before + after == 0 {
                break;
            }
            let Some(longer) = resized(wall.atoms[0], -(before as i64), -(after as i64)) else { break };
            let explained = near.energy - wall.cost();
            let wider = self.near(&spectra, &longer);
            let trial = wider.moved(longer, wall.gains[0]);
            if wider.energy - trial.cost() <= explained || self.fitter.work.is_spent() {
                break;
            }
            (near, wall) = (wider, trial);
        }
        let shorter = trimmed(&near, wall.atoms[0]);
        if shorter != wall.atoms[0] {
            let trial = near.moved(shorter, wall.gains[0]);
            if trial.cost() < wall.cost() {
                wall = trial;
            }
        }
        self.fitter.refine(samples, wall.atoms, wall.gains, Tie::PerEnd, Limits::ROUGH)
    }

    /// The range bins in which `wall` is followed.
    fn near<'a>(&self, spectra: &Spectra<'a>, wall: &Atom) -> RangeGate<'a> {
        let rows = bin_spans(self.radar, wall);
        let longest = rows.iter().map(|(low, high)| high - low).fold(0.0, f64::max);
        spectra.gate(&rows, ROOM_BINS.max(ROOM * longest))
    }

    /// Number of reflectors that the wall lacks at its last end, or at its first: as many more as leave least. No more than it
    /// already has, as far as its direction can be trusted.
    fn more_reflectors(&self, near: &RangeGate, wall: &Fit, at_last: bool) -> usize {
        let Some(atom) = wall.atoms.first() else { return 0 };
        let count = atom.reflector_count();
        let next = |more: usize| atom.position_metres(if at_last { (count - 1 + more) as f64 } else { -(more as f64) });
        let is_within = |&[x_metres, y_metres]: &[f64; 2]| {
            y_metres >= 0.0 && near.contains(&bin_spans(self.radar, &Atom::Point { x_metres, y_metres }))
        };
        how_many(&near.fitter, wall, &wall.gains, (1..=count).map(next).take_while(is_within))
    }
}

impl RangeGate<'_> {
    /// The wall moved to its best place from where its gains may be these.
    fn moved(&self, wall: Atom, gains: Gains) -> Fit {
        self.fitter.refine(&self.samples, vec![wall], vec![gains], Tie::PerEnd, Limits::ROUGH)
    }
}

/// `seed` without the reflectors at its ends whose absence explains the samples better.
fn trimmed(near: &RangeGate, mut seed: Atom) -> Atom {
    for _ in 0..MOST_TRIMS {
        let wall = near.fitter.solve_alone(&near.samples, seed);
        let (first, last) = rayon::join(
            || fewer_reflectors(&near.fitter, &wall, false),
            || fewer_reflectors(&near.fitter, &wall, true),
        );
        match resized(seed, first as i64, last as i64) {
            Some(shorter) if first + last > 0 => seed = shorter,
            _ => break,
        }
    }
    seed
}

/// Number of reflectors at the wall's last end, or at its first, whose removal leaves less.
fn fewer_reflectors(fitter: &Fitter, wall: &Fit, at_last: bool) -> usize {
    let Some(atom) = wall.atoms.first() else { return 0 };
    let count = atom.reflector_count();
    let back: Vec<Gains> = wall.gains.iter().map(|g| g.map(|g| -g)).collect();
    let next = |fewer: usize| atom.position_metres(if at_last { (count - fewer) as f64 } else { (fewer - 1) as f64 });
    how_many(fitter, wall, &back, (1..=count / 2).map(next))
}

/// Number of successive `places` at which reflectors of these gains, subtracted from the residual of `wall`, leave least.
fn how_many(fitter: &Fitter, wall: &Fit, gains: &[Gains], places: impl Iterator<Item = [f64; 2]>) -> usize {
    let (mut best, mut least) = (0, wall.cost());
    let mut residual = wall.residual.clone();
    for (taken, [x_metres, y_metres]) in (1..).zip(places) {
        let left = fitter.subtract(&residual, &[Atom::Point { x_metres, y_metres }], gains);
        residual = left.residual;
        let cost = left.energy[0] + left.energy[1];
        if cost < least {
            (best, least) = (taken, cost);
        } else if taken >= best + BEYOND {
            break;
        }
    }
    best
}

/// `wall` without this many reflectors at its first and at its last end; with more of them where the numbers are negative.
fn resized(wall: Atom, first: i64, last: i64) -> Option<Atom> {
    let Atom::Segment { dx_metres, dy_metres, count, .. } = wall else { return None };
    let [x_metres, y_metres] = wall.position_metres(first as f64);
    let count = usize::try_from(count as i64 - first - last).ok()?;
    let is_wall = (MIN_REFLECTORS..=MOST_REFLECTORS).contains(&count);
    is_wall.then_some(Atom::Segment { x_metres, y_metres, dx_metres, dy_metres, count })
}
