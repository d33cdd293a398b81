//! Bounds of one reflector, computed off the UI thread: how well any estimator could place it, and what looks like it.

use crate::bounds::{Ambiguity, BoundsError, PositionBound, ambiguity, cramer_rao, noise_variance};
use crate::picture::ColourMap;
use crate::radar::{Decibels, End, Layout, LayoutError, Mimo, Polar, Radar};
use crate::scene::Reflector;
use crate::task::{Reply, Task, Worker};
use eframe::egui::{ColorImage, TextureHandle};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Which elements listen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Elements {
    /// Both ends of the array.
    #[default]
    TwoEnds,
    /// The first end alone.
    OneEnd,
    /// So many elements at random places of the aperture.
    Random(usize),
    /// The 12 virtual elements of 3 transmitters and 4 receivers.
    Mimo,
    /// Every element.
    All,
}

impl Elements {
    /// Name of the choice.
    pub fn name(self) -> &'static str {
        match self {
            Elements::TwoEnds => "the two ends",
            Elements::OneEnd => "the first end alone",
            Elements::Random(_) => "random elements",
            Elements::Mimo => "3 × 4 MIMO",
            Elements::All => "the whole array",
        }
    }

    /// Where they stand.
    ///
    /// # Errors
    /// [`LayoutError`] for more random elements than the array has.
    pub fn layout(self, radar: &Radar, seed: u64) -> Result<Layout, LayoutError> {
        Ok(match self {
            Elements::TwoEnds => Layout::two_ends(radar),
            Elements::OneEnd => Layout::one_end(radar, End::First),
            Elements::Random(count) => return Layout::random(radar, count, seed),
            Elements::Mimo => Mimo::filled(radar, 3, 4).layout(),
            Elements::All => Layout::uniform(radar),
        })
    }
}

/// What is looked at.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct BoundsRequest {
    pub radar: Radar,
    pub elements: Elements,
    pub seed: u64,
    pub reflector: Reflector,
    pub snr: Decibels,
    /// Half of what the picture spans, columns and range bins.
    pub columns: f64,
    pub bins: f64,
}

/// What came of it.
pub(super) struct BoundsResult {
    pub request: BoundsRequest,
    pub layout: Layout,
    pub centre: Polar,
    pub bound: Result<PositionBound, BoundsError>,
    pub ambiguity: Ambiguity,
    pub image: Arc<ColorImage>,
}

/// Echoes compared for one picture: what takes a few tenths of a second.
const BUDGET: f64 = 2.0e6;

fn work(request: BoundsRequest) -> Result<BoundsResult, LayoutError> {
    let BoundsRequest { radar, elements, seed, reflector, snr, columns, bins } = &request;
    let layout = elements.layout(radar, *seed)?;
    let centre = radar.polar_of(reflector.x_metres, reflector.y_metres.abs());
    let variance = noise_variance(radar, &layout, reflector, *snr);
    let bound = cramer_rao(radar, &layout, std::slice::from_ref(reflector), variance).map(|bounds| bounds[0]);
    let cells = (BUDGET / layout.len().max(1) as f64).clamp(1e3, 8e4);
    // Odd numbers, so that the reflector itself is a cell.
    let across = 2 * ((cells * 2.0).sqrt() / 2.0) as i32 + 1;
    let up = 2 * ((cells / 2.0).sqrt() / 2.0) as i32 + 1;
    let around =
        |half: f64, count: i32| (0..count).map(move |i| half * (2.0 * f64::from(i) / f64::from(count - 1) - 1.0));
    let column = 2.0 / radar.elements as f64;
    let ranges: Vec<f64> = around(bins * radar.range_resolution_metres(), up)
        .map(|d| (centre.range_metres + d).max(radar.aperture_metres() / 100.0))
        .collect();
    let cosines: Vec<f64> = around(columns * column, across).map(|d| centre.cos_theta + d).collect();
    let mut found = ambiguity(radar, &layout, centre, &ranges, &cosines);
    // There is no direction beyond end-fire.
    for (mut cells, cos) in found.likeness.columns_mut().into_iter().zip(&cosines) {
        if cos.abs() > 1.0 {
            cells.fill(f64::NAN);
        }
    }
    let table = super::pictures::table(ColourMap::Viridis);
    let paint = |v: &f64| match v.is_nan() {
        true => eframe::egui::Color32::TRANSPARENT,
        false => table[(v * 255.0) as usize],
    };
    // The top row is the farthest.
    let pixels = found.likeness.rows().into_iter().rev().flat_map(|row| row.into_iter().map(paint).collect::<Vec<_>>());
    let image = Arc::new(ColorImage::new([across as usize, up as usize], pixels.collect()));
    Ok(BoundsResult { layout, centre, bound, ambiguity: found, image, request })
}

/// The worker, what it was asked last, and what it found last.
pub(super) struct Bounds {
    worker: Worker<BoundsRequest, Result<BoundsResult, LayoutError>>,
    asked: Option<BoundsRequest>,
    pub result: Option<BoundsResult>,
    pub error: Option<String>,
    pub texture: Option<(Arc<ColorImage>, TextureHandle)>,
    /// Requests so far: a test asks that a hidden panel makes none.
    pub requests: u64,
}

impl Bounds {
    /// Starts the worker, which waits; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Send + 'static) -> std::io::Result<Bounds> {
        let work = |_: &mut (), request: BoundsRequest, _: &Task| work(request);
        let worker = Worker::spawn("bounds", || (), work, wake)?;
        Ok(Bounds { worker, asked: None, result: None, error: None, texture: None, requests: 0 })
    }

    /// Asks for `request`, unless that was asked for last.
    pub fn ask(&mut self, request: BoundsRequest) {
        if self.asked.as_ref() != Some(&request) {
            self.requests += 1;
            self.worker.request(request.clone());
            self.asked = Some(request);
        }
    }

    /// Whether it computes.
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// Takes in what was found. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: Ok(result), .. } => (self.result, self.error) = (Some(result), None),
                Reply::Done { result: Err(error), .. } => self.error = Some(error.to_string()),
                Reply::Panicked { message: said, .. } => {
                    self.error = Some(said.clone());
                    message = Some(format!("Computing the bounds failed ({said}). Move the reflector to try again."));
                }
            }
        }
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_brightest_at_the_reflector_and_empty_beyond_end_fire() {
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let request = BoundsRequest {
            reflector: Reflector { x_metres: 1.5, y_metres: 0.2, reflectivity: 1.0 },
            elements: Elements::OneEnd,
            seed: 0,
            snr: Decibels(20.0),
            columns: 16.0,
            bins: 3.0,
            radar,
        };
        let found = work(request).unwrap();
        let (rows, columns) = found.ambiguity.likeness.dim();
        assert!((found.ambiguity.likeness[[rows / 2, columns / 2]] - 1.0).abs() < 1e-9);
        assert!(found.ambiguity.likeness[[0, columns - 1]].is_nan());
        assert_eq!(found.image.size, [columns, rows]);
        assert!(found.bound.unwrap().x_metres > 0.0);
    }
}
