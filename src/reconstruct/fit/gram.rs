//! The banded Gram matrix of atoms and of their derivatives, in closed form.
//!
//! Without samples: an inner product of two echoes is an entry of the window's [`Moments`] a channel, and 0 for echoes far apart in range.

use super::atom::Atom;
use super::echo::{Echo, Echoes};
use super::echoes::Products;
use super::moments::Moments;
use super::sensor::{Sensor, W};
use crate::scene::Reflector;
use crate::signal::simd::{ComplexLanes, Kernel, Lanes, Simd};
use faer::Mat;
use num_complex::Complex64;
use rayon::prelude::*;

/// Columns of a linear model: the echo of each atom of gain 1, and its derivatives.
pub struct Dictionary<'a> {
    sensor: &'a Sensor,
    moments: &'a Moments,
    pub atoms: &'a [Atom],
    echoes: Vec<Vec<Echo>>,
    /// Column of each atom's echo. Its derivatives follow if they are requested. The last entry is the number of columns.
    pub first_column: Vec<usize>,
    derivatives: bool,
}

/// Largest number of columns of an atom.
const MAX_COLUMNS: usize = 5;

/// Inner products of the columns of two atoms at one end, `[column of the first][column of the second]`.
type AtomProducts = [[Complex64; MAX_COLUMNS]; MAX_COLUMNS];

/// Inner products of two echoes at one end. In each dimension: the echo, its derivative by x, its derivative by half the square of y.
type EchoProducts = [[Complex64; 3]; 3];

impl<'a> Dictionary<'a> {
    /// The columns of `atoms`, with `derivatives` by all parameters or without.
    pub fn new(sensor: &'a Sensor, moments: &'a Moments, atoms: &'a [Atom], derivatives: bool) -> Self {
        let simd = Simd::chosen();
        let echoes_of = |atom: &Atom| {
            let reflectors: Vec<Reflector> = atom.reflectors(1.0).collect();
            simd.run(Echoes { sensor, reflectors: &reflectors })
        };
        let echoes = atoms.par_iter().map(echoes_of).collect();
        let mut first_column = vec![0];
        for atom in atoms {
            let width = 1 + if derivatives { atom.parameter_count() } else { 0 };
            first_column.push(first_column[first_column.len() - 1] + width);
        }
        Dictionary { sensor, moments, atoms, echoes, first_column, derivatives }
    }

    /// Gram matrices of the first and of the last end, `[columns, columns]`.
    pub fn grams(&self) -> [Mat<Complex64>; 2] {
        let n = self.atoms.len();
        let rows: Vec<Vec<(usize, AtomProducts)>> = (0..2 * n)
            .into_par_iter()
            .map(|at| Simd::chosen().run(GramRow { dictionary: self, i: at / 2, end: at % 2 }))
            .collect();
        let columns = self.first_column[n];
        let mut grams = [Mat::zeros(columns, columns), Mat::zeros(columns, columns)];
        for (at, row) in rows.into_iter().enumerate() {
            let (i, gram) = (at / 2, &mut grams[at % 2]);
            for (j, block) in row {
                for (p, line) in block.iter().enumerate().take(self.width(i)) {
                    for (q, v) in line.iter().enumerate().take(self.width(j)) {
                        let (r, c) = (self.first_column[i] + p, self.first_column[j] + q);
                        gram[(r, c)] = *v;
                        gram[(c, r)] = v.conj();
                    }
                }
            }
        }
        grams
    }

    /// Inner products of the columns with a residual at the first and at the last end, `[columns]`, from `products`, those of each reflector's echo.
    pub fn slopes(&self, products: &[Products]) -> [Vec<Complex64>; 2] {
        let columns = self.first_column[self.atoms.len()];
        let mut slopes = [vec![Complex64::default(); columns], vec![Complex64::default(); columns]];
        let [rate, drift] = self.sensor.radians_per_metre_over_chirp();
        let mut products = products.iter();
        for (i, (atom, echoes)) in self.atoms.iter().zip(&self.echoes).enumerate() {
            for (member, (echo, product)) in echoes.iter().zip(&mut products).enumerate() {
                for channel in 0..self.sensor.element_x.len() {
                    let (end, channel_of_end) =
                        (channel / self.sensor.end_elements, channel % self.sensor.end_elements);
                    let (part, lane) = (&echo.end(end)[channel_of_end / W], channel_of_end % W);
                    let slopes = &mut slopes[end][self.first_column[i]..];
                    let (zeroth, first) = (product.zeroth[channel], product.first[channel]);
                    slopes[0] += zeroth;
                    if self.derivatives {
                        let along = Complex64::new(-part.decay.0[lane], -rate) * zeroth - Complex64::I * drift * first;
                        for p in 0..atom.parameter_count() {
                            let [x, half_square] = atom.derivatives(member, p);
                            slopes[1 + p] +=
                                along * (x * part.by_x.0[lane] + half_square * part.by_half_square.0[lane]);
                        }
                    }
                }
            }
        }
        slopes
    }

    fn width(&self, atom: usize) -> usize {
        self.first_column[atom + 1] - self.first_column[atom]
    }

    /// Whether two echoes are so far apart in range at one end that they count as orthogonal.
    #[inline(always)]
    fn are_apart(&self, a: &Echo, b: &Echo, end: usize) -> bool {
        let middle =
            |echo: &Echo| echo.end(end)[self.sensor.end_elements / 2 / W].bins.0[self.sensor.end_elements / 2 % W];
        let bins = (middle(a) - middle(b)).abs();
        bins.min((self.sensor.samples as f64 - bins).abs()) > self.moments.reach_bins
    }

    #[inline(always)]
    fn block<const FMA: bool>(&self, a: &Echo, b: &Echo, end: usize) -> EchoProducts {
        if self.derivatives { self.derivative_block::<FMA>(a, b, end) } else { self.value_block::<FMA>(a, b, end) }
    }

    #[inline(always)]
    fn value_block<const FMA: bool>(&self, a: &Echo, b: &Echo, end: usize) -> EchoProducts {
        let mut sum = ComplexLanes::zero();
        for (a, b) in a.end(end).iter().zip(b.end(end)) {
            let m = self.moments.at::<false, FMA>(b.bins - a.bins);
            sum = sum + a.middle.conj().times::<FMA>(b.middle).scaled(m.zeroth);
        }
        let mut out = EchoProducts::default();
        out[0][0] = total(sum);
        out
    }

    #[inline(always)]
    fn derivative_block<const FMA: bool>(&self, a: &Echo, b: &Echo, end: usize) -> EchoProducts {
        let [rate, drift] = self.sensor.radians_per_metre_over_chirp().map(Lanes::<f64, W>::splat);
        let mut sums = [[ComplexLanes::zero(); 3]; 3];
        for (a, b) in a.end(end).iter().zip(b.end(end)) {
            let m = self.moments.at::<true, FMA>(b.bins - a.bins);
            let phase = a.middle.conj().times::<FMA>(b.middle);
            let (decays, turning) = (drift * m.first, rate * m.zeroth);
            let right = ComplexLanes { re: -(b.decay * m.zeroth) - decays, im: turning };
            let left = ComplexLanes { re: decays - a.decay * m.zeroth, im: -turning };
            let more = b.decay - a.decay;
            let re = (rate * rate + a.decay * b.decay) * m.zeroth - more * decays + drift * drift * m.second;
            let im = more * turning + Lanes::splat(2.0) * rate * decays;
            let (right, left) = (phase.times::<FMA>(right), phase.times::<FMA>(left));
            let both = phase.times::<FMA>(ComplexLanes { re, im });
            let (by_x, by_half_square) = (both.scaled(a.by_x), both.scaled(a.by_half_square));
            sums[0][0] = sums[0][0] + phase.scaled(m.zeroth);
            sums[0][1] = sums[0][1] + right.scaled(b.by_x);
            sums[0][2] = sums[0][2] + right.scaled(b.by_half_square);
            sums[1][0] = sums[1][0] + left.scaled(a.by_x);
            sums[2][0] = sums[2][0] + left.scaled(a.by_half_square);
            sums[1][1] = sums[1][1] + by_x.scaled(b.by_x);
            sums[1][2] = sums[1][2] + by_x.scaled(b.by_half_square);
            sums[2][1] = sums[2][1] + by_half_square.scaled(b.by_x);
            sums[2][2] = sums[2][2] + by_half_square.scaled(b.by_half_square);
        }
        sums.map(|line| line.map(total))
    }
}

#[inline(always)]
fn total(v: ComplexLanes<f64, W>) -> Complex64 {
    Complex64::new(v.re.total(), v.im.total())
}

/// Kernel of the inner products of atom `i` with those up to itself at one end; orthogonal ones are left out.
struct GramRow<'a, 'b> {
    dictionary: &'a Dictionary<'b>,
    i: usize,
    end: usize,
}

impl Kernel for GramRow<'_, '_> {
    type Output = Vec<(usize, AtomProducts)>;

    #[inline(always)]
    fn run<const FMA: bool>(self) -> Self::Output {
        let GramRow { dictionary: d, i, end } = self;
        let mut row = Vec::new();
        for j in 0..=i {
            let mut sums = AtomProducts::default();
            let mut is_coupled = false;
            for (k, a) in d.echoes[i].iter().enumerate() {
                // In an atom each two reflectors are visited once: the other order is the conjugate transpose.
                let others = if j == i { k } else { d.echoes[j].len() };
                for (l, b) in d.echoes[j][..others].iter().enumerate() {
                    if d.are_apart(a, b, end) {
                        continue;
                    }
                    is_coupled = true;
                    let block = d.block::<FMA>(a, b, end);
                    add_by_parameters(&mut sums, &block, (&d.atoms[i], k), (&d.atoms[j], l), d.derivatives);
                }
            }
            if j == i {
                sums = plus_adjoint(sums);
                for (k, a) in d.echoes[i].iter().enumerate() {
                    let (own, block) = ((&d.atoms[i], k), d.block::<FMA>(a, a, end));
                    add_by_parameters(&mut sums, &block, own, own, d.derivatives);
                }
            }
            if is_coupled || j == i {
                row.push((j, sums));
            }
        }
        row
    }
}

/// The sum of a block and its conjugate transpose.
fn plus_adjoint(block: AtomProducts) -> AtomProducts {
    std::array::from_fn(|p| std::array::from_fn(|q| block[p][q] + block[q][p].conj()))
}

/// Adds the products of two reflectors, numbers `k` and `l` of their atoms, to those of the atoms by the chain rule.
#[inline(always)]
fn add_by_parameters(
    sums: &mut AtomProducts,
    block: &EchoProducts,
    (left, k): (&Atom, usize),
    (right, l): (&Atom, usize),
    derivatives: bool,
) {
    sums[0][0] += block[0][0];
    if !derivatives {
        return;
    }
    for q in 0..right.parameter_count() {
        let [x, h] = right.derivatives(l, q);
        sums[0][1 + q] += block[0][1] * x + block[0][2] * h;
    }
    for p in 0..left.parameter_count() {
        let [x, h] = left.derivatives(k, p);
        let line: [Complex64; 3] = std::array::from_fn(|c| block[1][c] * x + block[2][c] * h);
        sums[1 + p][0] += line[0];
        for q in 0..right.parameter_count() {
            let [x, h] = right.derivatives(l, q);
            sums[1 + p][1 + q] += line[1] * x + line[2] * h;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{Radar, hann};
    use crate::reconstruct::fit::echoes::{ProductKind, Samples, remainder};

    const WALL: Atom = Atom::Row { x_metres: -4.0, y_metres: 9.0, dx_metres: 0.03, dy_metres: 0.1, count: 5 };

    /// The echo of `atom` in the samples of both ends.
    fn value(sensor: &Sensor, atom: &Atom) -> Vec<Complex64> {
        let silence = Samples::new(sensor, &vec![Complex64::default(); sensor.sample_count()]);
        let echoes: Vec<_> = atom.reflectors(1.0).map(|r| (r, [Complex64::from(-1.0); 2])).collect();
        remainder(sensor, &vec![1.0; sensor.samples], &silence, &echoes, ProductKind::None).residual.flat(sensor)
    }

    fn columns(sensor: &Sensor, window: &[f64], atoms: &[Atom]) -> Vec<Vec<Complex64>> {
        let mut out = Vec::new();
        for atom in atoms {
            out.push(value(sensor, atom));
            for k in 0..atom.parameter_count() {
                let moved = |h: f64| {
                    let mut step = vec![0.0; atom.parameter_count()];
                    step[k] = h;
                    value(sensor, &atom.moved(&step))
                };
                let h = 1e-7;
                out.push(moved(h).iter().zip(moved(-h)).map(|(a, b)| (a - b) / (2.0 * h)).collect());
            }
        }
        for column in &mut out {
            column.iter_mut().enumerate().for_each(|(i, v)| *v *= window[i % sensor.samples]);
        }
        out
    }

    #[test]
    fn the_closed_form_is_the_product_of_columns_by_differences() {
        let radar = Radar::default();
        let sensor = Sensor::new(&radar);
        let atoms = [
            Atom::Point { x_metres: 3.0, y_metres: 9.0 },
            Atom::Point { x_metres: 2.9, y_metres: 9.1 },
            WALL,
            Atom::Point { x_metres: 3.0, y_metres: 30.0 },
        ];
        for window in [hann(radar.samples), vec![1.0; radar.samples]] {
            let moments = Moments::new(&window);
            let dictionary = Dictionary::new(&sensor, &moments, &atoms, true);
            let slow = columns(&sensor, &window, &atoms);
            let end_len = sensor.sample_count() / 2;
            for (end, gram) in dictionary.grams().iter().enumerate() {
                let part = |c: usize| &slow[c][end * end_len..(end + 1) * end_len];
                let dot =
                    |a: usize, b: usize| -> Complex64 { part(a).iter().zip(part(b)).map(|(a, b)| a.conj() * b).sum() };
                for a in 0..slow.len() {
                    for b in 0..slow.len() {
                        let scale = (dot(a, a).re * dot(b, b).re).sqrt();
                        let difference = (gram[(a, b)] - dot(a, b)).norm();
                        assert!(difference < 1e-6 * scale, "columns {a} and {b}: {} {}", gram[(a, b)], dot(a, b));
                    }
                }
            }
        }
    }

    #[test]
    fn slopes_are_products_with_the_columns() {
        let radar = Radar::default();
        let sensor = Sensor::new(&radar);
        let window = hann(radar.samples);
        let squared: Vec<f64> = window.iter().map(|w| w * w).collect();
        let atoms = [WALL, Atom::Point { x_metres: 3.0, y_metres: 9.0 }];
        let target = value(&sensor, &Atom::Point { x_metres: -3.9, y_metres: 9.3 });
        let moments = Moments::new(&window);
        let dictionary = Dictionary::new(&sensor, &moments, &atoms, true);
        let echoes: Vec<_> =
            atoms.iter().flat_map(|a| a.reflectors(1.0)).map(|r| (r, [Complex64::default(); 2])).collect();
        let left = remainder(&sensor, &squared, &Samples::new(&sensor, &target), &echoes, ProductKind::Slopes);
        let slopes = dictionary.slopes(&left.products);
        let end_len = sensor.sample_count() / 2;
        for (c, column) in columns(&sensor, &window, &atoms).iter().enumerate() {
            for (end, slopes) in slopes.iter().enumerate() {
                let range = end * end_len..(end + 1) * end_len;
                let windowed = |i: usize| target[i] * window[i % radar.samples];
                let expected: Complex64 = range.clone().map(|i| column[i].conj() * windowed(i)).sum();
                let size = range.clone().map(|i| column[i].norm_sqr()).sum::<f64>()
                    * range.map(|i| windowed(i).norm_sqr()).sum::<f64>();
                assert!((slopes[c] - expected).norm() < 1e-6 * size.sqrt(), "column {c}: {} {expected}", slopes[c]);
            }
        }
    }
}
