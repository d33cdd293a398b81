//! Main lobe and side lobes of an ambiguity function, each as one number.

use super::ambiguity;
use crate::radar::{Layout, Polar, Radar};

/// Lobes of a layout's ambiguity function along cos(theta), at the reflector's range.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Lobes {
    /// Width in cos(theta) over which the ambiguity function stays above half power.
    pub main_lobe_cos: f64,
    /// The highest value beyond the main lobe's first minima; 0 where there is none.
    pub highest_side_lobe: f64,
    /// cos(theta) of that side lobe, less the reflector's.
    pub highest_side_lobe_offset: f64,
    /// Root mean square of the ambiguity function beyond the main lobe.
    pub side_lobe_rms: f64,
}

/// Likeness along cos(theta) from -1 to 1 at the range of `centre`, `steps_per_column` to a column of the whole array's map.
pub fn cut(radar: &Radar, layout: &Layout, centre: Polar, steps_per_column: usize) -> (Vec<f64>, Vec<f64>) {
    let steps = (radar.elements * steps_per_column.max(1)) as f64;
    // The reflector itself is one of the steps.
    let first = ((-1.0 - centre.cos_theta) / 2.0 * steps).ceil() as i64;
    let last = ((1.0 - centre.cos_theta) / 2.0 * steps).floor() as i64;
    let cosines: Vec<f64> = (first..=last).map(|i| centre.cos_theta + 2.0 * i as f64 / steps).collect();
    let likeness = ambiguity(radar, layout, centre, &[centre.range_metres], &cosines).likeness;
    (cosines, likeness.into_raw_vec_and_offset().0)
}

/// The lobes of `likeness` over `cosines` (rising, evenly spaced) of a reflector at `centre_cos`, or `None` for an empty cut.
pub fn lobes(cosines: &[f64], likeness: &[f64], centre_cos: f64) -> Option<Lobes> {
    let distance = |i: &usize| (cosines[*i] - centre_cos).abs();
    let centre = (0..cosines.len().min(likeness.len())).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let step = if cosines.len() > 1 { cosines[1] - cosines[0] } else { 0.0 };
    let half_power = likeness[centre] * std::f64::consts::FRAC_1_SQRT_2;
    // Steps from the centre to where `ends` first holds between a value and the one before it.
    let reach = |values: &mut dyn Iterator<Item = &f64>, ends: &dyn Fn(f64, f64) -> bool| {
        let mut before = likeness[centre];
        let mut steps = 0;
        for value in values {
            if ends(before, *value) {
                break;
            }
            (before, steps) = (*value, steps + 1);
        }
        steps
    };
    let (left, right) = (&likeness[..centre], &likeness[centre + 1..]);
    let below = |_: f64, value: f64| value < half_power;
    let rises = |before: f64, value: f64| value > before;
    let main = reach(&mut left.iter().rev(), &below) + reach(&mut right.iter(), &below) + 1;
    let first_minimum = (reach(&mut left.iter().rev(), &rises), reach(&mut right.iter(), &rises));
    let beyond: Vec<usize> =
        (0..centre - first_minimum.0).chain(centre + first_minimum.1 + 1..likeness.len()).collect();
    let highest = beyond.iter().copied().max_by(|a, b| likeness[*a].total_cmp(&likeness[*b]));
    let power: f64 = beyond.iter().map(|i| likeness[*i].powi(2)).sum();
    Some(Lobes {
        main_lobe_cos: main as f64 * step,
        highest_side_lobe: highest.map_or(0.0, |i| likeness[i]),
        highest_side_lobe_offset: highest.map_or(0.0, |i| cosines[i] - cosines[centre]),
        side_lobe_rms: if beyond.is_empty() { 0.0 } else { (power / beyond.len() as f64).sqrt() },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(layout: &Layout) -> Lobes {
        // A place so far out that waves are plane and the textbook's figures hold.
        let centre = Polar { range_metres: 3e4, cos_theta: 0.0 };
        let (cosines, likeness) = cut(&Radar::default(), layout, centre, 8);
        lobes(&cosines, &likeness, 0.0).unwrap()
    }

    #[test]
    fn a_uniform_line_has_the_lobes_of_the_textbook() {
        let radar = Radar::default();
        let full = of(&Layout::uniform(&radar));
        // First side lobe -13.26 dB, half-power width 0.886 columns; the grid is an eighth of a column fine.
        assert!((20.0 * full.highest_side_lobe.log10() + 13.26).abs() < 0.2, "{full:?}");
        assert!((full.main_lobe_cos / (2.0 / 1024.0) - 0.886).abs() < 0.15, "{full:?}");
        assert!((full.highest_side_lobe_offset.abs() / (2.0 / 1024.0) - 1.43).abs() < 0.15, "{full:?}");
    }

    #[test]
    fn only_two_ends_repeat_their_main_lobe() {
        let radar = Radar::default();
        assert!(of(&Layout::two_ends(&radar)).highest_side_lobe > 0.98);
        let random = of(&Layout::random(&radar, 24, 1).unwrap());
        assert!(random.highest_side_lobe < 0.85, "{random:?}");
        // 24 phasors in random directions would leave 1 / sqrt(24); far off, the echoes also part in range.
        assert!((0.02..24f64.sqrt().recip()).contains(&random.side_lobe_rms), "{random:?}");
    }

    #[test]
    fn degenerate_cuts_have_no_side_lobes() {
        assert_eq!(lobes(&[], &[], 0.0), None);
        let one = lobes(&[0.2], &[1.0], 0.2).unwrap();
        assert_eq!((one.highest_side_lobe, one.side_lobe_rms), (0.0, 0.0));
    }
}
