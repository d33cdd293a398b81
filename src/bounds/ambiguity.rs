//! The ambiguity function: correlation of the echoes of two places over an array (P. M. Woodward, "Probability and Information
//! Theory, with Applications to Radar", 1953).

use crate::radar::{Layout, Polar, Radar};
use crate::signal::ArrayEcho;
use ndarray::Array2;
use rayon::prelude::*;

/// Likeness of every place in a patch of the polar grid with one reflector.
#[derive(Debug, Clone, PartialEq)]
pub struct Ambiguity {
    pub range_metres: Vec<f64>,
    pub cos_theta: Vec<f64>,
    /// `|<echo there, reflector's echo>|` of echoes of norm 1, `[ranges, cosines]`: 1 where the layout can't tell them apart for any gains.
    pub likeness: Array2<f64>,
}

/// Ambiguity function of `layout` between a reflector at `centre` and places at `ranges_metres` and `cosines`; 0 without elements.
pub fn ambiguity(radar: &Radar, layout: &Layout, centre: Polar, ranges_metres: &[f64], cosines: &[f64]) -> Ambiguity {
    let pairs = layout.pairs();
    let atom = |range, cos| ArrayEcho::at_pairs(radar, &pairs, range, cos);
    let reflector = atom(centre.range_metres, centre.cos_theta);
    let likeness: Vec<f64> = ranges_metres
        .par_iter()
        .flat_map_iter(|range| cosines.iter().map(|cos| atom(*range, *cos).inner(&reflector).norm()))
        .map(|v| if v.is_finite() { v.min(1.0) } else { 0.0 })
        .collect();
    let mut out = Array2::zeros((ranges_metres.len(), cosines.len()));
    out.iter_mut().zip(likeness).for_each(|(o, v)| *o = v);
    Ambiguity { range_metres: ranges_metres.to_vec(), cos_theta: cosines.to_vec(), likeness: out }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::End;

    const CENTRE: Polar = Polar { range_metres: 20.0, cos_theta: 0.0 };

    #[test]
    fn two_ends_have_a_comb_of_one_tooth_an_angle_bin() {
        let radar = Radar::default();
        let bin = 2.0 / radar.elements as f64;
        let cosines: Vec<f64> = (-6 * 64..=6 * 64).map(|i| f64::from(i) * bin / 64.0).collect();
        let along = ambiguity(&radar, &Layout::two_ends(&radar), CENTRE, &[20.0], &cosines).likeness.row(0).to_vec();
        let peaks: Vec<usize> =
            (1..along.len() - 1).filter(|&i| along[i] > along[i - 1] && along[i] >= along[i + 1]).collect();
        let middle = peaks.iter().position(|i| *i == 6 * 64).expect("the reflector itself is a peak");
        assert!((along[6 * 64] - 1.0).abs() < 1e-9);
        // One bin off, as an independent program has it. The tooth itself stands 4 % further out, where the chirp's own phase has
        // caught up with the carrier's, and is higher still.
        let one_bin_off = along[6 * 64 + 64];
        assert!((one_bin_off - 0.992).abs() < 0.001, "{one_bin_off}");
        let first = along[peaks[middle + 1]];
        assert!(first > one_bin_off && first < 0.9995, "first side peak {first}");
        for pair in peaks.windows(2) {
            assert!((pair[1] - pair[0]).abs_diff(66) <= 2, "teeth {} apart", pair[1] - pair[0]);
        }
    }

    #[test]
    fn echoes_in_other_range_bins_are_distinguishable() {
        let radar = Radar::default();
        let far = [20.0, 20.0 + radar.range_resolution_metres()];
        let a = ambiguity(&radar, &Layout::one_end(&radar, End::First), CENTRE, &far, &[0.0]);
        assert!(a.likeness[[1, 0]] < 0.05, "one bin off is a null of the range response: {}", a.likeness[[1, 0]]);
        let none = ambiguity(&radar, &Layout::at(Vec::new()), CENTRE, &far, &[0.0]);
        assert!(none.likeness.iter().all(|v| *v == 0.0));
    }
}
