//! Distance of found points from their true places, and its Cramér-Rao bound.

use super::estimate::upper_median;
use super::verdict::{ObjectVerdict, OutputVerdicts};
use crate::bounds::cramer_rao;
use crate::radar::{Layout, Radar};
use crate::scattering::EchoSources;
use crate::scene::{Object, Point, Reflector, Scene};
use crate::signal::Floor;
use crate::signal::floor::noise_variance;

/// The median distance, in metres, of points that are found to the nearest of the `found` reflectors; `None` where no point is found, or
/// the method names no reflectors. A point behind the array is looked for in front of it, where the maps show it.
pub fn median_offset_metres(scene: &Scene, verdicts: &OutputVerdicts, found: &[Reflector]) -> Option<f64> {
    let nearest = |point: &Point| {
        let distances =
            found.iter().map(|r| (r.x_metres - point.x_metres).hypot(r.y_metres.abs() - point.y_metres.abs()));
        distances.min_by(f64::total_cmp)
    };
    upper_median(found_points(scene, verdicts).filter_map(nearest))
}

/// The median Cramér-Rao bound, metres, of these points, each alone before `layout` over `floor`; `None` without a found point or noise.
pub fn median_bound_metres(
    (radar, layout): (&Radar, &Layout),
    scene: &Scene,
    verdicts: &OutputVerdicts,
    floor: Floor,
) -> Option<f64> {
    let variances = noise_variance(radar, &EchoSources::of(radar, scene), floor)?;
    let variance = variances.iter().sum::<f64>() / variances.len().max(1) as f64;
    let bound = |point: &Point| {
        let Point { x_metres, y_metres, reflectivity, .. } = *point;
        let bounds = cramer_rao(radar, layout, &[Reflector { x_metres, y_metres, reflectivity }], variance).ok()?;
        bounds.first().map(|bound| bound.position_metres()).filter(|metres| metres.is_finite())
    };
    upper_median(found_points(scene, verdicts).filter_map(bound))
}

fn found_points<'a>(scene: &'a Scene, verdicts: &'a OutputVerdicts) -> impl Iterator<Item = &'a Point> {
    scene.objects.iter().zip(&verdicts.objects).filter_map(|(object, verdict)| match object {
        Object::Point(point) if *verdict == ObjectVerdict::Found => Some(point),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_points_that_are_found_count() {
        let scene = Scene::of_points([(0.0, 10.0), (4.0, 10.0), (8.0, 10.0)]);
        let verdicts = vec![ObjectVerdict::Found, ObjectVerdict::Found, ObjectVerdict::Missed];
        let verdicts = OutputVerdicts { objects: verdicts, covered: vec![1.0, 1.0, 0.0], ghosts: Vec::new() };
        let reflector = |x_metres: f64| Reflector { x_metres, y_metres: 10.0, reflectivity: 1.0 };
        let offset = median_offset_metres(&scene, &verdicts, &[reflector(0.01), reflector(4.05)]);
        assert!(offset.is_some_and(|offset| (offset - 0.05).abs() < 1e-9), "{offset:?}");
        assert_eq!(median_offset_metres(&scene, &verdicts, &[]), None);
    }

    #[test]
    fn the_bound_grows_tenfold_with_20_db_more_noise() {
        let radar = Radar { elements: 64, samples: 64, ..Radar::default() };
        let scene = Scene::of_points([(0.0, 3.0)]);
        let verdicts = OutputVerdicts { objects: vec![ObjectVerdict::Found], covered: vec![1.0], ghosts: Vec::new() };
        let layout = Layout::two_ends(&radar);
        let bound = |floor| median_bound_metres((&radar, &layout), &scene, &verdicts, floor);
        let [near, far] = [40.0, 20.0].map(|db| bound(Floor::Snr(crate::radar::Decibels(db))).unwrap());
        assert!(near > 0.0 && (far / near - 10.0).abs() < 1e-6, "{near} and {far} m");
        assert_eq!(bound(Floor::Exact), None, "nothing limits it without noise");
    }
}
