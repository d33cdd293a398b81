//! The thesis' network input: four maps of both ends (section 3.3).

use super::{ComplexMap, LOG_GUARD, Normalisation};
use ndarray::{Array3, Axis, Zip, s};

/// `[4, range bins, columns]`: Lambda_0 cos(arg Y_0), Lambda_0 sin(arg Y_0), Lambda_1 cos(arg Y_1), Lambda_1 sin(arg Y_1),
/// with Lambda normalised by minimum and maximum, as the thesis' program writes `polar_partial_mag_phase`.
pub fn mag_phase(first: &ComplexMap, last: &ComplexMap) -> Array3<f64> {
    let (bins, columns) = first.cells.dim();
    let mut out = Array3::zeros((4, bins, columns));
    for (end, map) in [first, last].into_iter().enumerate() {
        let log = map.log_magnitude();
        let scale = log.scale(Normalisation::MinMax);
        let planes = out.slice_mut(s![2 * end..2 * end + 2, .., ..]);
        let (mut real, mut imaginary) = planes.split_at(Axis(0), 1);
        Zip::from(real.index_axis_mut(Axis(0), 0))
            .and(imaginary.index_axis_mut(Axis(0), 0))
            .and(&map.cells)
            .and(log.decades())
            .par_for_each(|real, imaginary, y, decades| {
                let unit = scale.lambda(*decades) / (y.norm() + LOG_GUARD);
                (*real, *imaginary) = (unit * y.re, unit * y.im);
            });
    }
    out
}
