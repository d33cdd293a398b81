//! Measurements on a line of decibels: levels and widths of peaks.

/// Drop below a peak at which its width is measured, decibels.
const DROP_DB: f64 = 3.0;

/// The 3 dB width of a peak.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Width {
    /// Place on the axis where the near side has fallen by 3 dB.
    pub low: f64,
    /// Place on the axis where the far side has fallen by 3 dB.
    pub high: f64,
    /// Level at both places, decibels.
    pub level_db: f64,
    /// Width between both places, cells.
    pub cells: f64,
}

/// Value at a place between the first cell and the last, along straight lines between cells.
pub fn value_at(points: &[[f64; 2]], place: f64) -> Option<f64> {
    let after = points.iter().position(|[x, _]| *x >= place)?;
    let [x1, y1] = points[after];
    let [x0, y0] = points[after.saturating_sub(1)];
    match x1 > x0 {
        true if place >= x0 => Some(y0 + (y1 - y0) * (place - x0) / (x1 - x0)),
        true => None,
        false => (place == x1).then_some(y1),
    }
}

/// Width of the peak that is uphill of a place, in decibels over equidistant cells. The summit is that of the parabola through the three
/// highest cells, and so is the width where it is at most two cells: exact for a Gaussian lobe. Wider ones are measured along straight
/// lines between cells. `None` where there is no peak, or where it doesn't fall by 3 dB before something higher comes.
pub fn width_at(points: &[[f64; 2]], place: f64) -> Option<Width> {
    let distance = |i: &usize| (points[*i][0] - place).abs();
    let mut top = (0..points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
    let level = |i: usize| points[i][1];
    let higher = |from: usize| [from.checked_sub(1), Some(from + 1).filter(|i| *i < points.len())];
    while let Some(next) = higher(top)
        .into_iter()
        .flatten()
        .filter(|i| level(*i) > level(top))
        .max_by(|a, b| level(*a).total_cmp(&level(*b)))
    {
        top = next;
    }
    if top == 0 || top + 1 >= points.len() {
        return None;
    }
    let (left, right) = (level(top - 1), level(top + 1));
    let bend = level(top) - (left + right) / 2.0;
    if bend <= 0.0 {
        return None;
    }
    let slope = (right - left) / 2.0;
    let (summit, peak) = (slope / (2.0 * bend), level(top) + slope * slope / (4.0 * bend));
    let half = (DROP_DB / bend).sqrt();
    let threshold = peak - DROP_DB;
    // Number of cells from the summit to the fall below the threshold on one side.
    let side = |sign: f64| -> Option<f64> {
        let near = summit + sign * half;
        if half <= 1.0 {
            // The line must fall as far as the parabola predicts before it rises again.
            let beyond = top as f64 + near.signum() * near.abs().ceil().max(1.0);
            return (beyond >= 0.0 && beyond < points.len() as f64 && level(beyond as usize) <= threshold)
                .then_some(near);
        }
        let mut steps = 1;
        loop {
            let here =
                if sign > 0.0 { Some(top + steps).filter(|i| *i < points.len()) } else { top.checked_sub(steps) }?;
            if level(here) > level(top) {
                return None;
            }
            if level(here) <= threshold {
                let before = level(if sign > 0.0 { here - 1 } else { here + 1 });
                let part = (before - threshold) / (before - level(here));
                return Some(sign * ((steps - 1) as f64 + part.clamp(0.0, 1.0)));
            }
            steps += 1;
        }
    };
    let (low, high) = (side(-1.0)?, side(1.0)?);
    let cell = points[top + 1][0] - points[top][0];
    let at = |offset: f64| points[top][0] + cell * offset;
    Some(Width { low: at(low), high: at(high), level_db: threshold, cells: high - low })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lobe that is a parabola in decibels, 3 dB down at `half` cells from `centre`.
    fn lobe(centre: f64, half: f64, count: usize) -> Vec<[f64; 2]> {
        let level = |i: usize| (-3.0 * ((i as f64 - centre) / half).powi(2)).max(-60.0);
        (0..count).map(|i| [0.5 * i as f64, level(i)]).collect()
    }

    #[test]
    fn a_gaussian_lobe_has_its_own_width_wherever_its_summit_falls() {
        for centre in [20.0, 20.3, 20.5] {
            let width = width_at(&lobe(centre, 0.72, 40), 10.4).unwrap();
            assert!((width.cells - 1.44).abs() < 1e-9, "{centre}: {width:?}");
            assert!((width.low - 0.5 * (centre - 0.72)).abs() < 1e-9 && (width.level_db + 3.0).abs() < 1e-9);
        }
        let wide = width_at(&lobe(20.0, 6.0, 40), 8.0).unwrap();
        assert!((wide.cells - 12.0).abs() < 0.1, "straight lines between far cells: {wide:?}");
    }

    #[test]
    fn there_is_no_width_without_a_peak_that_falls() {
        let flat: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), -60.0]).collect();
        assert_eq!(width_at(&flat, 4.0), None);
        let rising: Vec<[f64; 2]> = (0..9).map(|i| [f64::from(i), f64::from(i)]).collect();
        assert_eq!(width_at(&rising, 2.0), None, "the end of the line is no peak");
        let shoulder: Vec<[f64; 2]> =
            [-9.0, -4.0, -5.0, 0.0, -9.0].into_iter().enumerate().map(|(i, y)| [i as f64, y]).collect();
        assert_eq!(width_at(&shoulder, 1.0), None, "it runs into a higher one");
        assert!(width_at(&shoulder, 3.0).is_some());
        assert_eq!(width_at(&[], 0.0), None);
    }

    #[test]
    fn values_are_read_only_between_cells() {
        let line = [[0.0, -10.0], [2.0, -20.0]];
        assert_eq!(
            [-0.1, 0.0, 1.0, 2.0, 2.1].map(|x| value_at(&line, x)),
            [None, Some(-10.0), Some(-15.0), Some(-20.0), None]
        );
    }
}
