//! Tests of methods on the samples of other elements than the two ends.

use super::{Baseline, Fista, IAA, Omp, ReconstructError, Reconstructor, Request, SBL};
use crate::maps::focus::map_of;
use crate::maps::{Aperture, Normalisation};
use crate::radar::{BuiltArray, Radar};
use crate::scene::Scene;
use crate::signal::{BeatSignal, Floor, simulate};
use ndarray::Zip;
use std::sync::Arc;

/// Result of `method` for a point in the samples of the elements of `layout`: squared error, and P_D at its threshold.
fn of_layout(method: &dyn Reconstructor, radar: &Radar, layout: &[usize]) -> Result<(f64, f64), ReconstructError> {
    let scene = Scene::of_points([(2.0, 6.0), (-3.0, 4.0)]);
    let signal = simulate(radar, &scene, Floor::Thesis, 0).unwrap();
    let layout_samples = signal.of_layout(layout);
    let request = Request { layout_samples: Some(Arc::new(layout_samples)), ..Request::default() };
    let found = method.reconstruct(radar, &BeatSignal::silence(radar).two_ends(radar), &request)?;
    let target = map_of(radar, &BuiltArray::default(), &signal, Aperture::Full).log_magnitude();
    let target = target.normalise(Normalisation::MinMax).lambda;
    let squares = Zip::from(&target).and(&found.lambda.lambda).fold(0.0, |sum, t, o| sum + f64::from(t - o).powi(2));
    let eta = method.eta_of(&found);
    let bright = target.iter().zip(&found.lambda.lambda).filter(|(t, _)| **t > 0.9);
    let (seen, all) = bright.fold((0u32, 0u32), |(seen, all), (_, o)| (seen + u32::from(*o > eta), all + 1));
    Ok((squares, f64::from(seen) / f64::from(all)))
}

#[test]
fn methods_that_bear_gaps_hear_any_layout() {
    for elements in [64, 65] {
        let radar = Radar { elements, end_elements: 12, samples: 128, ..Radar::default() };
        // An array of 65 elements has one in its middle.
        let nested = [0, 1, 2, 3, 4, 5, 6, 13, 20, 27, 32, 34, 41, 48, 55];
        let random = [0, 1, 3, 5, 11, 15, 17, 28, 34, 40, 44, 49, 57, 63];
        // The penalty of fista weakens the reflectors that it finds.
        let methods: [(&dyn Reconstructor, f64); 4] =
            [(&IAA, 300.0), (&SBL, 300.0), (&Omp::default(), 300.0), (&Fista::default(), 700.0)];
        for (method, max_error) in methods {
            for layout in [&nested[..], &random] {
                let (error, detection) = of_layout(method, &radar, layout).unwrap();
                assert!(error < max_error && detection > 0.95, "{}, {elements}: {error}, {detection}", method.name());
            }
        }
    }
}

#[test]
fn layouts_that_a_method_cannot_hear_are_refused() {
    let radar = Radar { elements: 64, end_elements: 12, samples: 128, ..Radar::default() };
    let told =
        |method: &dyn Reconstructor, layout: &[usize]| of_layout(method, &radar, layout).unwrap_err().to_string();
    assert!(told(&Baseline, &[0, 63]).contains("it hears the two ends of an array"));
    assert!(told(&IAA, &[0, 1, 5]).contains("no element of the last half heard anything"));
    let wide = Radar { elements: 256, ..radar.clone() };
    let every: Vec<usize> = (0..128).map(|n| 2 * n).collect();
    let told = of_layout(&IAA, &wide, &every).unwrap_err().to_string();
    assert!(told.contains("at most 96 elements, and 128 are heard"), "{told}");
}
