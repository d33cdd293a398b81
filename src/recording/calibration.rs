//! Calibration: samples are divided by gain and phase of their elements.

use super::Fault;
use ndarray::Array2;
use num_complex::Complex64;
use serde::Deserialize;

/// Gain and phase of each element; an empty list stands for 0 dB or 0 degrees.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Calibration {
    pub gain_db: Vec<f64>,
    pub phase_degrees: Vec<f64>,
}

const MAX_GAIN_DB: f64 = 200.0;
const MAX_PHASE_DEGREES: f64 = 3600.0;

impl Calibration {
    /// Divides the samples, `[elements, samples]`, by gain and phase of their element.
    /// # Errors
    /// [`Fault::Key`] where a list has another length than there are elements, or a value is NaN or too large.
    pub fn divide_out(&self, samples: &mut Array2<Complex64>) -> Result<(), Fault> {
        let elements = samples.nrows();
        let lists =
            [("gain_db", &self.gain_db, MAX_GAIN_DB), ("phase_degrees", &self.phase_degrees, MAX_PHASE_DEGREES)];
        for (list, values, max) in lists {
            let key = format!("recording.calibration.{list}");
            if !values.is_empty() && values.len() != elements {
                let expected = format!("{elements}, one for each element of the file");
                return Err(Fault::key(&key, format!("has {} numbers", values.len()), expected));
            }
            if let Some((element, value)) = values.iter().enumerate().find(|(_, v)| v.is_nan() || v.abs() > max) {
                let found = format!("holds {value} for element {element}");
                return Err(Fault::key(&key, found, format!("a number from -{max} to {max}")));
            }
        }
        let value_of = |values: &[f64], element: usize| values.get(element).copied().unwrap_or(0.0);
        for (element, mut row) in samples.outer_iter_mut().enumerate() {
            let gain = 10f64.powf(value_of(&self.gain_db, element) / 20.0);
            let factor = Complex64::from_polar(gain, value_of(&self.phase_degrees, element).to_radians());
            row.iter_mut().for_each(|v| *v /= factor);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn gain_and_phase_are_divided_out() {
        let mut samples = array![[Complex64::new(0.0, 10.0)], [Complex64::new(3.0, 0.0)]];
        let calibration = Calibration { gain_db: vec![20.0, 0.0], phase_degrees: vec![90.0, 0.0] };
        calibration.divide_out(&mut samples).unwrap();
        assert!((samples[[0, 0]] - 1.0).norm() < 1e-12 && (samples[[1, 0]] - 3.0).norm() < 1e-12);
        let before = samples.clone();
        Calibration::default().divide_out(&mut samples).unwrap();
        assert_eq!(samples, before);
    }

    #[test]
    fn lists_of_wrong_length_or_nan_are_refused() {
        let message =
            |calibration: Calibration| calibration.divide_out(&mut Array2::zeros((2, 1))).unwrap_err().to_string();
        let short = message(Calibration { gain_db: vec![1.0], ..Calibration::default() });
        assert!(short.contains("gain_db has 1 numbers; expected 2"), "{short}");
        let nan = message(Calibration { phase_degrees: vec![0.0, f64::NAN], ..Calibration::default() });
        assert!(nan.contains("phase_degrees holds NaN for element 1"), "{nan}");
    }
}
