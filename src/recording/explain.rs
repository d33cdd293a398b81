//! The part of a recording that given reflectors explain, and the residual.

use super::{Recorded, Recording};
use crate::radar::{End, Pair, Radar};
use crate::scene::{Reflector, Scene, SceneError};
use crate::signal::BeatSignal;
use crate::signal::echo::{ArrayEcho, add_echo};
use crate::signal::phase::EchoModel;
use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use ndarray::{Array2, Axis, s};
use num_complex::Complex64;
use rayon::prelude::*;

/// Most reflectors whose gains are fitted to a recording together.
pub const MAX_REFLECTORS: usize = 512;

/// Ridge on the diagonal of the normal equations, relative to it: reflectors at one place get equal gains.
const SHARED_GAIN_RIDGE: f64 = 1e-10;

/// A recording explained by reflectors.
#[derive(Debug, Clone, PartialEq)]
pub struct Explanation {
    /// Complex gain of each reflector: the factor of a unit reflector's echo there. Its magnitude is the reflectivity in the recording's unit.
    pub gains: Vec<Complex64>,
    /// Part of the recording's power in the reflectors' echoes, 0 to 1.
    pub explained: f64,
    /// The recording less the reflectors' echoes.
    pub residual: Recording,
}

/// A reason for which reflectors can't explain a recording.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ExplainError {
    /// The recording's radar can't see the scene.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The scene has too many reflectors.
    #[error("the scene has {0} reflectors; at most {MAX_REFLECTORS} are fitted to a recording")]
    TooMany(usize),
    /// The normal equations can't be solved.
    #[error("the gains of these reflectors can't be fitted: {0}")]
    Unsolvable(String),
}

/// Fits complex gains `g` of the echoes `a` of `scene`'s reflectors by least squares over all recorded samples `y`, and subtracts the echoes:
/// y = sum of `g_l a_l` + residual. The scene's reflectivities have no influence.
/// # Errors
/// [`ExplainError`] where the scene can't be seen by the recording's radar, or has too many reflectors.
pub fn explain(recording: &Recording, scene: &Scene) -> Result<Explanation, ExplainError> {
    let radar = &recording.radar;
    scene.validate(radar)?;
    let count = scene.reflector_count();
    if count > MAX_REFLECTORS {
        return Err(ExplainError::TooMany(count));
    }
    let reflectors = scene.reflectors();
    let (mut signal, elements) = whole_array(recording);
    let mut rows = signal.samples.select(Axis(0), &elements);
    let total_power = power(&rows);
    let gains = fit(radar, &reflectors, &elements, &rows)?;
    let model = EchoModel::new(radar);
    rows.axis_iter_mut(Axis(0)).into_par_iter().zip(&elements).for_each(|(mut row, element)| {
        let Some(samples) = row.as_slice_mut() else { return };
        for (reflector, gain) in reflectors.iter().zip(&gains) {
            let unit = Reflector { reflectivity: 1.0, ..*reflector };
            add_echo(&model, radar.pair(*element), &unit, -gain, samples);
        }
    });
    let explained = if total_power > 0.0 { (1.0 - power(&rows) / total_power).clamp(0.0, 1.0) } else { 0.0 };
    signal.samples.fill(Complex64::default());
    rows.outer_iter().zip(&elements).for_each(|(row, element)| signal.samples.row_mut(*element).assign(&row));
    let samples = match recording.samples {
        Recorded::All(_) => Recorded::All(signal),
        Recorded::Ends(_) => Recorded::Ends(signal.two_ends(radar)),
    };
    let residual = Recording { samples, ..recording.clone() };
    Ok(Explanation { gains, explained, residual })
}

fn power(samples: &Array2<Complex64>) -> f64 {
    samples.iter().map(Complex64::norm_sqr).sum()
}

/// The samples of the whole array, zeros where nothing was recorded, and the recorded elements.
fn whole_array(recording: &Recording) -> (BeatSignal, Vec<usize>) {
    let radar = &recording.radar;
    let (signal, recorded) = match &recording.samples {
        Recorded::All(signal) => (signal.clone(), (0..radar.elements).collect::<Vec<_>>()),
        Recorded::Ends(ends) => {
            let mut signal = BeatSignal::silence(radar);
            for end in End::BOTH {
                signal.samples.slice_mut(s![radar.end_range(end), ..]).assign(ends.end(end));
            }
            (signal, End::BOTH.into_iter().flat_map(|end| radar.end_range(end)).collect())
        }
    };
    (signal, recorded.into_iter().filter(|n| !recording.missing.contains(n)).collect())
}

/// The gains, by normal equations of the normalised echoes, whose inner products have a closed form.
fn fit(
    radar: &Radar,
    reflectors: &[Reflector],
    elements: &[usize],
    rows: &Array2<Complex64>,
) -> Result<Vec<Complex64>, ExplainError> {
    if reflectors.is_empty() {
        return Ok(Vec::new());
    }
    let pairs: Vec<Pair> = elements.iter().map(|n| radar.pair(*n)).collect();
    let echoes: Vec<ArrayEcho> = reflectors
        .par_iter()
        .map(|r| {
            let place = radar.polar_of(r.x_metres, r.y_metres);
            ArrayEcho::at_pairs(radar, &pairs, place.range_metres, place.cos_theta)
        })
        .collect();
    let y: Vec<Complex64> = rows.iter().copied().collect();
    let correlations: Vec<Complex64> = echoes.par_iter().map(|e| e.correlate(&y)).collect();
    let ridge = |i: usize, j: usize| if i == j { SHARED_GAIN_RIDGE } else { 0.0 };
    let gram = Mat::from_fn(echoes.len(), echoes.len(), |i, j| echoes[i].inner(&echoes[j]) + ridge(i, j));
    let factor = gram.llt(Side::Lower).map_err(|e| ExplainError::Unsolvable(format!("{e:?}")))?;
    let solved = factor.solve(Mat::from_fn(echoes.len(), 1, |i, _| correlations[i]));
    Ok(echoes.iter().enumerate().map(|(i, e)| solved[(i, 0)] / e.norm()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::signal::{Floor, simulate};

    fn radar() -> Radar {
        Radar { elements: 64, end_elements: 6, samples: 96, ..Radar::default() }
    }

    fn recorded() -> Recording {
        let scene = Scene::of_points([(0.0, 3.0), (1.5, 4.0), (-2.0, 5.0)]);
        let mut signal = simulate(&radar(), &scene, Floor::Exact, 0).unwrap();
        signal.samples.mapv_inplace(|v| v * Complex64::from_polar(7.0, 1.1));
        Recording::of_signal(radar(), signal)
    }

    #[test]
    fn all_reflectors_explain_everything() {
        let found = explain(&recorded(), &Scene::of_points([(0.0, 3.0), (1.5, 4.0), (-2.0, 5.0)])).unwrap();
        assert!(found.explained > 1.0 - 1e-12, "{}", found.explained);
        for gain in &found.gains {
            assert!((gain - Complex64::from_polar(7.0, 1.1)).norm() < 1e-6, "{gain}");
        }
        let left = found.residual.signal().unwrap().peak() / recorded().signal().unwrap().peak();
        assert!(left < 1e-8, "{left:e}");
    }

    #[test]
    fn missing_elements_do_not_change_what_is_explained() {
        let mut recording = recorded();
        recording.samples = Recorded::Ends(recording.two_ends());
        recording.missing = vec![2, 61];
        for element in [2, 61] {
            if let Recorded::Ends(ends) = &mut recording.samples {
                let end = if element < 6 { &mut ends.first } else { &mut ends.last };
                end.row_mut(element % 58).fill(Complex64::default());
            }
        }
        let scene = Scene::of_points([(0.0, 3.0), (1.5, 4.0), (-2.0, 5.0)]);
        let found = explain(&recording, &scene).unwrap();
        assert!(found.explained > 1.0 - 1e-12, "{}", found.explained);
        assert_eq!(found.residual.two_ends().first.row(2).iter().map(|v| v.norm()).sum::<f64>(), 0.0);
    }

    #[test]
    fn the_same_place_twice_shares_the_gain() {
        let twice = explain(&recorded(), &Scene::of_points([(0.0, 3.0), (0.0, 3.0)])).unwrap();
        assert!((twice.gains[0] - twice.gains[1]).norm() < 1e-3 * twice.gains[0].norm(), "{:?}", twice.gains);
        let nothing = explain(&recorded(), &Scene::default()).unwrap();
        assert_eq!((nothing.explained, nothing.residual), (0.0, recorded()));
        let silence = Recording::of_signal(radar(), BeatSignal::silence(&radar()));
        assert_eq!(explain(&silence, &Scene::of_points([(0.0, 3.0)])).unwrap().explained, 0.0);
        let many = Scene::of_points((0..513).map(|i| (0.0, 1.0 + f64::from(i))));
        assert!(explain(&silence, &many).unwrap_err().to_string().contains("513"));
    }
}
