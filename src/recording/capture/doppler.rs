//! Of each range bin the strongest Doppler cell and those that stand out beside it, with chirps in time division compensated for their velocities.
//!
//! Side lobes of an echo fill the bins around it, and the window over the samples takes them out where all are there. So a bin whose strongest cell
//! is another echo's keeps them too.
//!
//! An object that moves turns by `f` turns from loop to loop and by a part of it from chirp to chirp of a loop, each sent by another
//! transmitter. The cell tells `f` up to whole turns; each whole number turns the transmitters against each other, and the one whose
//! spectrum over the array is sharpest is taken.

use super::channels::Channels;
use super::frame::Frame;
use crate::signal::simd::{Fft, Simd};
use ndarray::{Array2, Array3, ArrayView3, Axis, s};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Cosines at which the spectrum over the array is looked at.
const COSINES: usize = 129;
/// Least sharpness of the spectrum at another whole number of turns over its sharpness at none, for the other number to be taken.
const SHARPER: f64 = 1.15;
/// Least power of a cell that counts for itself, over that of the middle one of its bin's cells.
const STANDS_OUT: f64 = 10.0;
/// Least power of a cell beside the strongest, over the strongest's: side lobes of the window over the loops lie below; and least distance from it,
/// cells.
const BELOW_STRONGEST: f64 = 0.003;
const APART_CELLS: f64 = 3.0;
/// Least turns over all loops for which an echo is said to move.
const MOVES: f64 = 0.5;

/// Samples of the strongest Doppler cells, `[chirps, receivers, samples]`, and the sentence on their choice. `turns` are those of the chosen chirps'
/// pairs across the array at a cosine of 1.
pub(super) fn strongest(
    frame: &Frame,
    channels: &Channels,
    chosen: &[usize],
    turns: &[f64],
) -> (Array3<Complex64>, Option<String>) {
    let (loops, chirps, receivers, samples) = frame.samples.dim();
    if loops < 2 {
        return (channels.of_loop(&frame.samples.index_axis(Axis(0), 0)), None);
    }
    let profiles = transformed(frame);
    let cells = Cells::new(frame.weights(true));
    let array = Array::new(chosen, receivers, turns);
    let mut out = Array3::zeros((chirps, receivers, samples));
    let (mut moving, mut ambiguous) = (0usize, 0usize);
    for bin in 0..samples {
        let plain = profiles.slice(s![.., .., bin]).to_owned();
        let (before, after) = ((bin + samples - 1) % samples, (bin + 1) % samples);
        // The window of Hann over the samples is a sum of three bins.
        let windowed = &plain * Complex64::from(0.5)
            - (&profiles.slice(s![.., .., before]) + &profiles.slice(s![.., .., after])) * Complex64::from(0.25);
        let found = cells.strongest(&windowed);
        let turn = if found.ratio >= STANDS_OUT { found } else { cells.strongest(&plain) };
        let value = |of: &Array2<Complex64>, turns: f64, whole: f64| {
            cells.value(of, turns, whole, [chirps, receivers], channels)
        };
        let whole = whole_turns(chirps, |whole| array.sharpness(&value(&windowed, turn.turns, whole)));
        let mut all = value(&plain, turn.turns, whole);
        for turns in cells.beside(&plain, turn.turns) {
            let whole = whole_turns(chirps, |whole| array.sharpness(&value(&plain, turns, whole)));
            all += &value(&plain, turns, whole);
        }
        out.slice_mut(s![.., .., bin]).assign(&all.slice(s![.., .., 0]));
        if found.ratio >= STANDS_OUT * STANDS_OUT {
            moving += usize::from((turn.turns * loops as f64).abs() > MOVES);
            ambiguous += usize::from(whole != 0.0);
        }
    }
    transform_back(&mut out);
    let several =
        if chirps > 1 { " What an echo turns from one transmitter's chirp to the next is taken out." } else { "" };
    let faster = match ambiguous {
        0 => String::new(),
        bins => format!(
            " In {bins} bins it moves faster than the loops tell: the sharper spectrum over the array says which velocity."
        ),
    };
    let held = match moving {
        0 => String::new(),
        1 => " One bin holds an echo that moves.".to_owned(),
        bins => format!(" {bins} bins hold echoes that move."),
    };
    let note = format!(
        "The {loops} loops of the frame are joined: of each range bin the strongest Doppler cell, and those that stand out beside it.{several}{held}{faster}"
    );
    (out, Some(note))
}

/// Range profiles of all loops without a window, `[loops, chirps * receivers, bins]`.
fn transformed(frame: &Frame) -> Array3<Complex64> {
    let (loops, chirps, receivers, samples) = frame.samples.dim();
    let fft = Simd::chosen().forward_fft::<f64>(samples);
    let mut out = Array3::zeros((loops, chirps * receivers, samples));
    for (row, mut to) in frame.samples.lanes(Axis(3)).into_iter().zip(out.lanes_mut(Axis(2))) {
        let mut line = row.to_vec();
        fft.process(&mut line);
        to.iter_mut().zip(line).for_each(|(to, v)| *to = v);
    }
    out
}

fn transform_back(rows: &mut Array3<Complex64>) {
    let samples = rows.dim().2;
    let fft = Simd::chosen().forward_fft::<f64>(samples);
    let scale = (samples.max(1) as f64).recip();
    for mut row in rows.lanes_mut(Axis(2)) {
        let mut line: Vec<Complex64> = row.iter().map(|v| v.conj() * scale).collect();
        fft.process(&mut line);
        row.iter_mut().zip(line).for_each(|(to, v)| *to = v.conj());
    }
}

#[derive(Clone, Copy)]
struct Cell {
    /// Turns from loop to loop, -0.5 to 0.5.
    turns: f64,
    /// Its power over that of the middle cell.
    ratio: f64,
}

/// The transform over loops.
struct Cells {
    transform: Arc<dyn Fft<f64>>,
    weights: Vec<f64>,
}

impl Cells {
    fn new(weights: Vec<f64>) -> Self {
        Cells { transform: Simd::chosen().forward_fft(weights.len()), weights }
    }

    /// Power of each cell, all channels together.
    fn powers(&self, profiles: &Array2<Complex64>) -> Vec<f64> {
        let mut powers = vec![0.0; self.weights.len()];
        for channel in profiles.axis_iter(Axis(1)) {
            let mut line: Vec<Complex64> = channel.iter().zip(&self.weights).map(|(v, w)| v * w).collect();
            self.transform.process(&mut line);
            powers.iter_mut().zip(line).for_each(|(p, v)| *p += v.norm_sqr());
        }
        powers
    }

    fn strongest(&self, profiles: &Array2<Complex64>) -> Cell {
        let powers = self.powers(profiles);
        let (best, peak) =
            powers.iter().copied().enumerate().fold((0, 0.0), |best, v| if v.1 > best.1 { v } else { best });
        Cell { turns: turns_at(&powers, best), ratio: peak / middle(&powers) }
    }

    /// Turns of the cells that stand out beside that of `turns`, the strongest first.
    fn beside(&self, profiles: &Array2<Complex64>, turns: f64) -> Vec<f64> {
        let powers = self.powers(profiles);
        let loops = powers.len();
        let least = (middle(&powers) * STANDS_OUT).max(powers.iter().copied().fold(0.0, f64::max) * BELOW_STRONGEST);
        let is_top = |n: &usize| {
            powers[*n] >= least && powers[*n] >= powers[(n + loops - 1) % loops] && powers[*n] > powers[(n + 1) % loops]
        };
        let mut tops: Vec<usize> = (0..loops).filter(is_top).collect();
        tops.sort_by(|a, b| powers[*b].total_cmp(&powers[*a]));
        let mut taken = vec![turns];
        for at in tops.into_iter().map(|top| turns_at(&powers, top)) {
            let is_apart = |t: &f64| ((at - t) - (at - t).round()).abs() * loops as f64 >= APART_CELLS;
            if taken.iter().all(is_apart) {
                taken.push(at);
            }
        }
        taken.split_off(1)
    }

    /// The bin's value at the cell, `[chirps, receivers, 1]`: chirps turned back, transmitters told apart.
    fn value(
        &self,
        profiles: &Array2<Complex64>,
        turns: f64,
        whole: f64,
        [chirps, receivers]: [usize; 2],
        channels: &Channels,
    ) -> Array3<Complex64> {
        // Counted from the loop in the middle: neighbouring bins, whose turns are a little off, then keep their phases to each other.
        let middle = (self.weights.len() / 2) as f64;
        let loops: Vec<Complex64> = (0..)
            .zip(&self.weights)
            .map(|(n, w): (u32, _)| Complex64::from_polar(*w, -TAU * turns * (f64::from(n) - middle)))
            .collect();
        let mut found = Array3::zeros((chirps, receivers, 1));
        for ((chirp, receiver, _), value) in found.indexed_iter_mut() {
            let channel = profiles.column(chirp * receivers + receiver);
            let back = Complex64::from_polar(1.0, -TAU * (turns + whole) * chirp as f64 / chirps as f64);
            *value = channel.iter().zip(&loops).map(|(v, w)| v * w).sum::<Complex64>() * back;
        }
        channels.of_loop(&ArrayView3::from(&found))
    }
}

fn middle(powers: &[f64]) -> f64 {
    let mut sorted = powers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[powers.len() / 2].max(f64::MIN_POSITIVE)
}

/// Turns from loop to loop of an echo whose cell is the strongest around, -0.5 to 0.5.
fn turns_at(powers: &[f64], top: usize) -> f64 {
    let loops = powers.len();
    let around = [powers[(top + loops - 1) % loops], powers[top], powers[(top + 1) % loops]];
    let turns = (top as f64 + vertex(around)) / loops as f64;
    turns - turns.round()
}

/// Top of the parabola through three logarithms, -0.5 to 0.5 of a cell from the middle one.
fn vertex(powers: [f64; 3]) -> f64 {
    let [a, b, c] = powers.map(|p| p.max(f64::MIN_POSITIVE).ln());
    let bend = a - 2.0 * b + c;
    if bend < 0.0 { (0.5 * (a - c) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// The whole number of turns in a loop whose spectrum over the array is sharpest.
fn whole_turns(chirps: usize, sharpness: impl Fn(f64) -> f64) -> f64 {
    let none = sharpness(0.0) * SHARPER;
    let candidates = (1..chirps).map(|n| if 2 * n > chirps { n as f64 - chirps as f64 } else { n as f64 });
    candidates
        .fold((0.0, none), |best, whole| {
            let found = sharpness(whole);
            if found > best.1 { (whole, found) } else { best }
        })
        .0
}

/// Directions that the array is turned to.
struct Array<'a> {
    chosen: &'a [usize],
    /// Factors of the pairs, a list for each direction; none where the pairs' places are not known.
    directions: Vec<Vec<Complex64>>,
}

impl<'a> Array<'a> {
    fn new(chosen: &'a [usize], receivers: usize, turns: &[f64]) -> Self {
        let half = (COSINES / 2) as f64;
        let factor = |turns: f64, n: usize| Complex64::from_polar(1.0, -TAU * turns * (n as f64 - half) / half);
        let known = turns.len() >= chosen.len() * receivers;
        let directions =
            (0..COSINES).filter(|_| known).map(|n| turns.iter().map(|t| factor(*t, n)).collect()).collect();
        Array { chosen, directions }
    }

    /// Power of the strongest direction.
    fn sharpness(&self, value: &Array3<Complex64>) -> f64 {
        let receivers = value.dim().1;
        let heard: Vec<Complex64> =
            self.chosen.iter().flat_map(|chirp| (0..receivers).map(move |r| value[[*chirp, r, 0]])).collect();
        let power = |direction: &Vec<Complex64>| {
            heard.iter().zip(direction).map(|(v, factor)| v * factor).sum::<Complex64>().norm_sqr()
        };
        self.directions.iter().map(power).fold(0.0, f64::max)
    }
}
