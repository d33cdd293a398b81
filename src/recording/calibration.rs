//! Calibration: gains and phases of the elements are removed from the samples.

use super::Fault;
use ndarray::Array2;
use num_complex::Complex64;
use serde::Deserialize;

/// Gain and phase of each element; empty lists mean an array without errors.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Calibration {
    pub gain_db: Vec<f64>,
    pub phase_degrees: Vec<f64>,
}

const MOST_GAIN_DB: f64 = 200.0;
const MOST_PHASE_DEGREES: f64 = 3600.0;

impl Calibration {
    /// Takes gain and phase off the samples, `[elements, samples]`.
    ///
    /// # Errors
    /// [`Fault::Key`] where a list fits another number of elements, or holds what is no gain or phase.
    pub fn take_off(&self, samples: &mut Array2<Complex64>) -> Result<(), Fault> {
        let elements = samples.nrows();
        let lists =
            [("gain_db", &self.gain_db, MOST_GAIN_DB), ("phase_degrees", &self.phase_degrees, MOST_PHASE_DEGREES)];
        for (list, values, most) in lists {
            let key = format!("recording.calibration.{list}");
            if !values.is_empty() && values.len() != elements {
                let expected = format!("{elements}, one for each element of the file");
                return Err(Fault::key(&key, format!("has {} numbers", values.len()), expected));
            }
            // NaN is not within the bounds either.
            if let Some((element, value)) = values.iter().enumerate().find(|(_, v)| v.is_nan() || v.abs() > most) {
                let found = format!("holds {value} for element {element}");
                return Err(Fault::key(&key, found, format!("a number from -{most} to {most}")));
            }
        }
        let of = |values: &[f64], element: usize| values.get(element).copied().unwrap_or(0.0);
        for (element, mut row) in samples.outer_iter_mut().enumerate() {
            let gain = 10f64.powf(of(&self.gain_db, element) / 20.0);
            let turned = Complex64::from_polar(gain, of(&self.phase_degrees, element).to_radians());
            row.iter_mut().for_each(|v| *v /= turned);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn what_the_elements_did_is_undone() {
        let mut samples = array![[Complex64::new(0.0, 10.0)], [Complex64::new(3.0, 0.0)]];
        let calibration = Calibration { gain_db: vec![20.0, 0.0], phase_degrees: vec![90.0, 0.0] };
        calibration.take_off(&mut samples).unwrap();
        assert!((samples[[0, 0]] - 1.0).norm() < 1e-12 && (samples[[1, 0]] - 3.0).norm() < 1e-12);
        let before = samples.clone();
        Calibration::default().take_off(&mut samples).unwrap();
        assert_eq!(samples, before);
    }

    #[test]
    fn lists_that_fit_nothing_are_told() {
        let told = |calibration: Calibration| calibration.take_off(&mut Array2::zeros((2, 1))).unwrap_err().to_string();
        let short = told(Calibration { gain_db: vec![1.0], ..Calibration::default() });
        assert!(short.contains("gain_db has 1 numbers; expected 2"), "{short}");
        let nan = told(Calibration { phase_degrees: vec![0.0, f64::NAN], ..Calibration::default() });
        assert!(nan.contains("phase_degrees holds NaN for element 1"), "{nan}");
    }
}
