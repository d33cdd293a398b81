//! A Python function as a method of this process.

use crate::arrays::{both_ends, numbers, owned};
use crate::errors::value;
use crate::radar::Radar;
use apertura::maps::{LogMap, RangeAngleMap};
use apertura::reconstruct::{MethodInfo, Family, LayoutSupport, ReconstructError, Reconstruction, Reconstructor, Request, Weights};
use apertura::signal::TwoEnds;
use ndarray::Array2;
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};

/// Longest name, characters.
const MAX_NAME: usize = 40;

/// Range of values outside which a map can't be Lambda.
const LAMBDA: [f64; 2] = [-1.0, 2.0];

/// A Python function that makes maps of the samples of two ends.
pub struct Function {
    info: MethodInfo,
    weights: Option<Weights>,
    is_decades: bool,
    /// `apertura.serve.called` with the function bound to it.
    called: Py<PyAny>,
    /// The exception that the function raised last.
    raised: Mutex<Option<PyErr>>,
}

/// Name, description and settings of a function.
pub struct Said<'a> {
    pub name: &'a str,
    pub description: &'a str,
    pub told: &'a str,
    pub eta: f32,
    pub answers: &'a str,
    pub weights: &'a str,
}

impl Function {
    /// `function` as a method. Its texts live as long as the program.
    pub fn new(function: &Bound<'_, PyAny>, said: &Said<'_>) -> PyResult<Self> {
        let Said { name, description, told, eta, answers, weights } = *said;
        if !is_name(name) {
            return Err(value(format!(
                "name is \"{name}\"; expected 1 to {MAX_NAME} letters, digits, \"-\", \"_\" or \".\", which Method.of_function(function, name=...) gives it"
            )));
        }
        if apertura::methods::by_name(name).is_ok() {
            return Err(value(format!(
                "name is \"{name}\", as a method of this package is called; expected another name"
            )));
        }
        if !(0.0..=1.0).contains(&eta) {
            return Err(value(format!("eta is {eta}; expected 0 to 1")));
        }
        if !matches!(answers, "lambda" | "decades") {
            return Err(value(format!("answers is \"{answers}\"; expected lambda or decades")));
        }
        if weights.len() > MAX_NAME || !weights.chars().all(|c| c.is_ascii_hexdigit()) {
            return Err(value(format!("weights is \"{weights}\"; expected hexadecimal digits, at most {MAX_NAME}")));
        }
        let text = |text: &str, otherwise: &'static str| match text.trim() {
            "" => otherwise,
            text => &*text.to_owned().leak(),
        };
        let info = MethodInfo {
            name: name.to_owned().leak(),
            description: text(description, "a function of your own"),
            prior_knowledge: text(told, "its author doesn't say"),
            eta,
        };
        let weights = (!weights.is_empty()).then(|| Weights { sha256: weights.to_owned(), optimiser: String::new() });
        let partial = function.py().import("functools")?.getattr("partial")?;
        let called = function.py().import("apertura.serve")?.getattr("called")?;
        let called = partial.call1((called, function))?.unbind();
        Ok(Function { info, weights, is_decades: answers == "decades", called, raised: Mutex::new(None) })
    }

    /// Whether rows tell its weights from others.
    pub fn has_weights(&self) -> bool {
        self.weights.is_some()
    }

    /// The exception that the function raised last, taken.
    pub fn take_raised(&self) -> Option<PyErr> {
        self.raised.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn asked(
        &self,
        py: Python<'_>,
        radar: &apertura::radar::Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> PyResult<(Array2<f64>, Option<f32>)> {
        let told = (request.noise.to_string(), request.normalisation.to_string(), request.snapshot_range_metres);
        let radar = Radar(radar.of_one_chirp());
        let heard = match &request.layout_samples {
            Some(heard) => owned(py, heard.samples.clone()).into_any(),
            None => owned(py, both_ends(ends)).into_any(),
        };
        let answer = self.called.bind(py).call1((heard, radar.clone(), told))?;
        let (cells, eta): (Bound<'_, PyAny>, Option<f32>) = answer.extract()?;
        let expected = (radar.0.samples, radar.0.elements);
        let shape = format!("[{}, {}]", expected.0, expected.1);
        let cells: Array2<f64> = numbers(&cells, "its map", &shape)?;
        if cells.dim() != expected {
            return Err(value(format!(
                "its map has shape {:?}; expected {shape}, range bins and columns",
                cells.shape()
            )));
        }
        let is_usable = |v: f64| v.is_finite() && (self.is_decades || (LAMBDA[0]..=LAMBDA[1]).contains(&v));
        if let Some((cell, v)) = cells.indexed_iter().find(|(_, v)| !is_usable(**v)) {
            let expected =
                if self.is_decades { "finite numbers" } else { "Lambda, 0 to 1 (answers=\"decades\" takes others)" };
            return Err(value(format!("its map is {v} at {cell:?}; expected {expected}")));
        }
        if let Some(eta) = eta.filter(|eta| !(0.0..=1.0).contains(eta)) {
            return Err(value(format!("its threshold is {eta}; expected 0 to 1")));
        }
        Ok((cells, eta))
    }
}

pub fn is_name(name: &str) -> bool {
    (1..=MAX_NAME).contains(&name.len()) && name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
}

impl Reconstructor for Function {
    fn info(&self) -> MethodInfo {
        self.info
    }

    fn family(&self) -> Family {
        Family::Own
    }

    fn layout_support(&self) -> LayoutSupport {
        LayoutSupport::AnyLayout
    }

    fn weights(&self, _radar: &apertura::radar::Radar) -> Option<Weights> {
        self.weights.clone()
    }

    fn estimate(
        &self,
        radar: &apertura::radar::Radar,
        ends: &TwoEnds,
        request: &Request,
    ) -> Result<Reconstruction, ReconstructError> {
        let (cells, eta) = Python::attach(|py| {
            self.asked(py, radar, ends, request).map_err(|error| {
                let told = error.to_string();
                *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                self.unusable(told)
            })
        })?;
        let lambda = match self.is_decades {
            true => LogMap::new(cells).normalise(request.normalisation),
            false => RangeAngleMap { lambda: cells.mapv(|v| v.clamp(0.0, 1.0) as f32) },
        };
        Ok(Reconstruction { lambda, eta, ..Reconstruction::silence(radar) })
    }
}
