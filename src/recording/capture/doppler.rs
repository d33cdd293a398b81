//! The strong Doppler cells of each range bin, without the phases that moving echoes gain between transmitters that send in turn.
//!
//! A bin keeps side lobes of other bins' echoes, too: a later window over the samples removes these only where all bins have them.
//!
//! The phase of a moving echo changes by `f` turns from loop to loop, and by equal parts of it from chirp to chirp of a loop. The Doppler cell gives
//! `f` up to a whole number of turns. Each whole number gives other phases between the transmitters: that with the sharpest spectrum over the array is
//! used.

use super::channels::Channels;
use super::frame::Frame;
use crate::signal::simd::{Fft, Simd};
use ndarray::{Array2, Array3, ArrayView3, Axis, s};
use num_complex::Complex64;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Number of cosines at which the spectrum over the array is computed, from -1 to 1.
const COSINE_COUNT: usize = 129;
/// Least sharpness of the spectrum at a whole number of turns, relative to that at 0 turns, for which the number is used.
const MIN_SHARPNESS_RATIO: f64 = 1.15;
/// Least power of an echo's cell, relative to the median of its range bin.
const MIN_POWER_RATIO: f64 = 10.0;
/// Least power of another cell, relative to the strongest: side lobes of the window over the loops lie below. Least distance between two, cells.
const MIN_RELATIVE_POWER: f64 = 0.003;
const MIN_DISTANCE_CELLS: f64 = 3.0;
/// Least phase change over all loops of an echo that counts as moving, turns.
const MIN_MOVING_TURNS: f64 = 0.5;

/// Samples of the strong Doppler cells, `[chirps, receivers, samples]`, and a sentence on them; `turns` as in [`super::join_strongest`].
pub(super) fn strongest(
    frame: &Frame,
    channels: &Channels,
    chosen: &[usize],
    turns: &[f64],
) -> (Array3<Complex64>, Option<String>) {
    let (loops, chirps, receivers, samples) = frame.samples.dim();
    if loops < 2 {
        return (channels.correct_loop(&frame.samples.index_axis(Axis(0), 0)), None);
    }
    let profiles = range_profiles(frame);
    let cells = Cells::new(frame.weights(true));
    let array = Array::new(chosen, receivers, turns);
    let mut out = Array3::zeros((chirps, receivers, samples));
    let (mut moving, mut ambiguous) = (0usize, 0usize);
    for bin in 0..samples {
        let plain = profiles.slice(s![.., .., bin]).to_owned();
        let (before, after) = ((bin + samples - 1) % samples, (bin + 1) % samples);
        // A Hann window over the samples is this sum of three bins.
        let windowed = &plain * Complex64::from(0.5)
            - (&profiles.slice(s![.., .., before]) + &profiles.slice(s![.., .., after])) * Complex64::from(0.25);
        let found = cells.strongest(&windowed);
        let turn = if found.ratio >= MIN_POWER_RATIO { found } else { cells.strongest(&plain) };
        let value = |of: &Array2<Complex64>, turns: f64, whole: f64| {
            cells.value(of, turns, whole, [chirps, receivers], channels)
        };
        let whole = whole_turns(chirps, |whole| array.sharpness(&value(&windowed, turn.turns, whole)));
        let mut all = value(&plain, turn.turns, whole);
        for turns in cells.other_cells(&plain, turn.turns) {
            let whole = whole_turns(chirps, |whole| array.sharpness(&value(&plain, turns, whole)));
            all += &value(&plain, turns, whole);
        }
        out.slice_mut(s![.., .., bin]).assign(&all.slice(s![.., .., 0]));
        if found.ratio >= MIN_POWER_RATIO * MIN_POWER_RATIO {
            moving += usize::from((turn.turns * loops as f64).abs() > MIN_MOVING_TURNS);
            ambiguous += usize::from(whole != 0.0);
        }
    }
    samples_of_profiles(&mut out);
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
fn range_profiles(frame: &Frame) -> Array3<Complex64> {
    let (loops, chirps, receivers, samples) = frame.samples.dim();
    let fft = Simd::chosen().forward_fft::<f64>(samples);
    let mut out = Array3::zeros((loops, chirps * receivers, samples));
    for (row, mut to) in frame.samples.lanes(Axis(3)).into_iter().zip(out.lanes_mut(Axis(2))) {
        let mut spectrum = row.to_vec();
        fft.process(&mut spectrum);
        to.iter_mut().zip(spectrum).for_each(|(to, v)| *to = v);
    }
    out
}

fn samples_of_profiles(rows: &mut Array3<Complex64>) {
    let samples = rows.dim().2;
    let fft = Simd::chosen().forward_fft::<f64>(samples);
    let scale = (samples.max(1) as f64).recip();
    for mut row in rows.lanes_mut(Axis(2)) {
        let mut inverse: Vec<Complex64> = row.iter().map(|v| v.conj() * scale).collect();
        fft.process(&mut inverse);
        row.iter_mut().zip(inverse).for_each(|(to, v)| *to = v.conj());
    }
}

#[derive(Clone, Copy)]
struct Cell {
    /// Phase change from loop to loop, turns from -0.5 to 0.5.
    turns: f64,
    /// Power relative to the median cell.
    ratio: f64,
}

/// The transform over loops, with the weight of each loop.
struct Cells {
    transform: Arc<dyn Fft<f64>>,
    weights: Vec<f64>,
}

impl Cells {
    fn new(weights: Vec<f64>) -> Self {
        Cells { transform: Simd::chosen().forward_fft(weights.len()), weights }
    }

    /// Power of each cell, summed over channels.
    fn powers(&self, profiles: &Array2<Complex64>) -> Vec<f64> {
        let mut powers = vec![0.0; self.weights.len()];
        for channel in profiles.axis_iter(Axis(1)) {
            let mut spectrum: Vec<Complex64> = channel.iter().zip(&self.weights).map(|(v, w)| v * w).collect();
            self.transform.process(&mut spectrum);
            powers.iter_mut().zip(spectrum).for_each(|(p, v)| *p += v.norm_sqr());
        }
        powers
    }

    fn strongest(&self, profiles: &Array2<Complex64>) -> Cell {
        let powers = self.powers(profiles);
        let (best, peak) =
            powers.iter().copied().enumerate().fold((0, 0.0), |best, v| if v.1 > best.1 { v } else { best });
        Cell { turns: turns_at(&powers, best), ratio: peak / median(&powers) }
    }

    /// Turns of the other strong cells, the strongest first. `turns` are those of the cell that is used already.
    fn other_cells(&self, profiles: &Array2<Complex64>, turns: f64) -> Vec<f64> {
        let powers = self.powers(profiles);
        let loops = powers.len();
        let least =
            (median(&powers) * MIN_POWER_RATIO).max(powers.iter().copied().fold(0.0, f64::max) * MIN_RELATIVE_POWER);
        let is_top = |n: &usize| {
            powers[*n] >= least && powers[*n] >= powers[(n + loops - 1) % loops] && powers[*n] > powers[(n + 1) % loops]
        };
        let mut peaks: Vec<usize> = (0..loops).filter(is_top).collect();
        peaks.sort_by(|a, b| powers[*b].total_cmp(&powers[*a]));
        let mut taken = vec![turns];
        for at in peaks.into_iter().map(|peak_cell| turns_at(&powers, peak_cell)) {
            let is_apart = |t: &f64| ((at - t) - (at - t).round()).abs() * loops as f64 >= MIN_DISTANCE_CELLS;
            if taken.iter().all(is_apart) {
                taken.push(at);
            }
        }
        taken.split_off(1)
    }

    /// Value of the cell, `[chirps, receivers, 1]`, without the phases of the motion and with channels corrected.
    fn value(
        &self,
        profiles: &Array2<Complex64>,
        turns: f64,
        whole: f64,
        [chirps, receivers]: [usize; 2],
        channels: &Channels,
    ) -> Array3<Complex64> {
        // Phases are relative to the middle loop: they hardly depend on the small differences in turns between neighbouring bins.
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
        channels.correct_loop(&ArrayView3::from(&found))
    }
}

fn median(powers: &[f64]) -> f64 {
    let mut sorted = powers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[powers.len() / 2].max(f64::MIN_POSITIVE)
}

/// Phase change from loop to loop of the echo at the peak `peak_cell`, turns from -0.5 to 0.5.
fn turns_at(powers: &[f64], peak_cell: usize) -> f64 {
    let loops = powers.len();
    let around = [powers[(peak_cell + loops - 1) % loops], powers[peak_cell], powers[(peak_cell + 1) % loops]];
    let turns = (peak_cell as f64 + vertex(around)) / loops as f64;
    turns - turns.round()
}

/// Vertex of the parabola through three logarithms, -0.5 to 0.5 cells from the middle one.
fn vertex(powers: [f64; 3]) -> f64 {
    let [a, b, c] = powers.map(|p| p.max(f64::MIN_POSITIVE).ln());
    let bend = a - 2.0 * b + c;
    if bend < 0.0 { (0.5 * (a - c) / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

/// The whole number of turns in a loop whose spectrum over the array is sharpest.
fn whole_turns(chirps: usize, sharpness: impl Fn(f64) -> f64) -> f64 {
    let none = sharpness(0.0) * MIN_SHARPNESS_RATIO;
    let candidates = (1..chirps).map(|n| if 2 * n > chirps { n as f64 - chirps as f64 } else { n as f64 });
    candidates
        .fold((0.0, none), |best, whole| {
            let found = sharpness(whole);
            if found > best.1 { (whole, found) } else { best }
        })
        .0
}

/// The array, as phase factors for each of [`COSINE_COUNT`] directions.
struct Array<'a> {
    chosen: &'a [usize],
    /// Factors of the pairs, a list for each direction; empty where the pairs' places are unknown.
    directions: Vec<Vec<Complex64>>,
}

impl<'a> Array<'a> {
    fn new(chosen: &'a [usize], receivers: usize, turns: &[f64]) -> Self {
        let half = (COSINE_COUNT / 2) as f64;
        let factor = |turns: f64, n: usize| Complex64::from_polar(1.0, -TAU * turns * (n as f64 - half) / half);
        let known = turns.len() >= chosen.len() * receivers;
        let directions =
            (0..COSINE_COUNT).filter(|_| known).map(|n| turns.iter().map(|t| factor(*t, n)).collect()).collect();
        Array { chosen, directions }
    }

    /// Power of the strongest direction.
    fn sharpness(&self, value: &Array3<Complex64>) -> f64 {
        let receivers = value.dim().1;
        let values: Vec<Complex64> =
            self.chosen.iter().flat_map(|chirp| (0..receivers).map(move |r| value[[*chirp, r, 0]])).collect();
        let power = |direction: &Vec<Complex64>| {
            values.iter().zip(direction).map(|(v, factor)| v * factor).sum::<Complex64>().norm_sqr()
        };
        self.directions.iter().map(power).fold(0.0, f64::max)
    }
}
