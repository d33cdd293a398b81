//! The whole array's map from range profiles: decades in f32, in one pass over the rows.

use super::GROUP_ROWS;
use super::log::{Extremes, LogScale, log_rolled};
use crate::maps::RangeProfiles;
use crate::radar::Radar;
use crate::signal::simd::{Kernel, LANES_F64, Simd};
use ndarray::{Array2, Axis, s};
use num_complex::Complex64;
use rayon::prelude::*;

/// Decades of the whole array's map, `[range bins, columns]`: those of [`crate::maps::LogMap`] within 1e-5, in less time.
pub fn whole_map(radar: &Radar, profiles: &RangeProfiles) -> Array2<f32> {
    let (simd, columns) = (Simd::chosen(), radar.elements);
    let fft = simd.forward_fft::<f64>(columns);
    let scale = (columns as f64).sqrt().recip();
    let window: Vec<f64> = radar.window.weights(columns).into_iter().map(|w| w * scale).collect();
    let strongest = profiles.profiles.iter().map(Complex64::norm_sqr).fold(0.0, f64::max).sqrt();
    // Upper bound of a cell: all profiles have the strongest amplitude, in phase.
    let log = LogScale::new(strongest * window.iter().sum::<f64>());
    let mut map = Array2::zeros((radar.samples, columns));
    map.axis_chunks_iter_mut(Axis(0), GROUP_ROWS).into_par_iter().enumerate().for_each_init(
        || [GROUP_ROWS * columns, fft.get_inplace_scratch_len()].map(|len| vec![Complex64::default(); len]),
        |[rows, scratch], (group, mut map)| {
            let first = group * GROUP_ROWS;
            let profiles_of_rows = profiles.profiles.slice(s![.., first..first + map.nrows()]);
            // Neighbouring bins of an element lie side by side.
            for ((element, bins), w) in profiles_of_rows.outer_iter().enumerate().zip(&window) {
                bins.iter().enumerate().for_each(|(i, v)| rows[i * columns + element] = v * w);
            }
            for (row, mut out) in rows.chunks_mut(columns).zip(map.outer_iter_mut()) {
                fft.process_with_scratch(row, scratch);
                if let Some(out) = out.as_slice_mut() {
                    simd.run(Row { row, log: &log, out });
                }
            }
        },
    );
    map
}

struct Row<'a> {
    row: &'a [Complex64],
    log: &'a LogScale,
    out: &'a mut [f32],
}

impl Kernel for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn run<const FMA: bool>(self) {
        log_rolled::<f64, LANES_F64, FMA>(self.row, self.log, self.out, &mut Extremes::new());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{LogMaps, range_transform};
    use crate::scene::Scene;
    use crate::signal::{Floor, simulate};

    fn compare(radar: &Radar, places: &[(f64, f64)], floor: Floor) {
        let signal = simulate(radar, &Scene::of_points(places.iter().copied()), floor, 3).unwrap();
        let map = whole_map(radar, &range_transform(radar, &signal));
        let expected = LogMaps::of_signal(radar, &signal).full;
        assert_eq!(map.dim(), expected.decades().dim());
        for (fast, slow) in map.iter().zip(expected.decades()) {
            assert!((f64::from(*fast) - slow).abs() < 1e-5, "{fast} for {slow}");
        }
    }

    #[test]
    fn the_map_is_the_plain_one() {
        let radar = Radar::default();
        compare(&radar, &[(1.0, 6.0), (-2.0, 9.5), (4.0, 33.0)], Floor::Thesis);
        compare(&radar, &[(0.0, 38.0)], Floor::Thesis);
        let odd = Radar { elements: 90, samples: 61, end_elements: 7, ..radar };
        compare(&odd, &[(0.1, 1.0), (0.3, 2.0)], Floor::Thesis);
        compare(&odd, &[], Floor::Exact);
    }
}
