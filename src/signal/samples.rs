//! The beat signal of the whole array, and of the two ends alone.

use crate::radar::{End, Radar};
use ndarray::{Array2, ArrayView2, Axis, s};
use num_complex::Complex64;

/// Sampled beat signal.
#[derive(Debug, Clone, PartialEq)]
pub struct BeatSignal {
    /// `[elements, samples]`.
    pub samples: Array2<Complex64>,
}

impl BeatSignal {
    /// Silence: the signal of an empty scene.
    pub fn silence(radar: &Radar) -> Self {
        BeatSignal { samples: Array2::zeros((radar.elements, radar.samples)) }
    }

    /// The rows of one end, `[end_elements, samples]`.
    pub fn end(&self, radar: &Radar, end: End) -> ArrayView2<'_, Complex64> {
        let range = radar.end_range(end);
        self.samples.slice(s![range, ..])
    }

    pub fn two_ends(&self, radar: &Radar) -> TwoEnds {
        TwoEnds { first: self.end(radar, End::First).to_owned(), last: self.end(radar, End::Last).to_owned() }
    }

    pub fn of_layout(&self, layout: &[usize]) -> LayoutSamples {
        LayoutSamples { layout: layout.to_vec(), samples: self.samples.select(Axis(0), layout) }
    }

    /// Largest magnitude of any sample; 0 for silence.
    pub fn peak(&self) -> f64 {
        self.samples.iter().fold(0.0, |m: f64, v| m.max(v.norm()))
    }
}

/// Beat signal of the elements of a layout.
#[derive(Debug, Clone, PartialEq)]
pub struct LayoutSamples {
    pub layout: Vec<usize>,
    /// `[elements of the layout, samples]`.
    pub samples: Array2<Complex64>,
}

/// Beat signal of the two ends alone: the samples that a reconstruction may use.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoEnds {
    /// First end, `[end_elements, samples]`.
    pub first: Array2<Complex64>,
    /// Last end, `[end_elements, samples]`.
    pub last: Array2<Complex64>,
}

impl TwoEnds {
    /// The samples of one end, `[end_elements, samples]`.
    pub fn end(&self, end: End) -> &Array2<Complex64> {
        match end {
            End::First => &self.first,
            End::Last => &self.last,
        }
    }

    /// Whether each element was measured, those of the first end first. The samples of dead and missing elements are zeros.
    pub fn measured_elements(&self) -> Vec<bool> {
        let elements = self.first.outer_iter().chain(self.last.outer_iter());
        elements.map(|samples| samples.iter().any(|v| v.norm_sqr() > 0.0)).collect()
    }

    /// The samples of both as one vector, element after element: `[2 * end_elements * samples]`.
    pub fn flat(&self) -> Vec<Complex64> {
        self.first.iter().chain(&self.last).copied().collect()
    }

    /// The inverse of [`TwoEnds::flat`] for the ends of `radar`.
    /// # Panics
    /// When there are fewer samples than `radar`'s ends have.
    pub fn of_flat(radar: &Radar, samples: &[Complex64]) -> Self {
        let (elements, per_element) = (radar.end_elements, radar.samples);
        let end = |from: usize| {
            Array2::from_shape_fn((elements, per_element), |(n, n1)| samples[(from + n) * per_element + n1])
        };
        TwoEnds { first: end(0), last: end(elements) }
    }
}
