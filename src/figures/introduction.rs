//! Figures 1-2 to 1-4: sparse bands, random elements, virtual elements.

use super::sheet::{Ink, Series, Sheet, SheetAxis, SheetPanel, SketchShape, Stroke};
use super::source::{FigureError, SceneSource};
use crate::maps::range_transform;
use crate::radar::Layout;
use crate::scene::{Object, Point, Scene};
use crate::signal::Floor;

/// Elements of the random layout, and the seed of its places.
const RANDOM_LAYOUT: (usize, u64) = (24, 1);

/// A signal that is non-zero in a few bands: one element's beat signal of three groups of points.
pub fn band_sparsity(source: &SceneSource) -> Result<Sheet, FigureError> {
    let groups = [(7.0, 3), (18.0, 6), (31.0, 4)];
    let points = groups.iter().flat_map(|(start, count)| (0..*count).map(move |i| start + 0.4 * f64::from(i)));
    // Reflectivities undo the fall of 1/R^2, so that all bands are equally high.
    let object = |range: f64| Object::Point(Point { reflectivity: range * range / 100.0, ..Point::new(0.0, range) });
    let scene = Scene { objects: points.map(object).collect(), ..Scene::default() };
    let seen = source.see_over(scene, Floor::Exact)?;
    let profiles = range_transform(&source.radar, &seen.signal).profiles;
    let middle = source.radar.elements / 2;
    let peak = profiles.row(middle).iter().map(|v| v.norm()).fold(0.0, f64::max);
    let samples = source.radar.samples as f64;
    let spectrum =
        profiles.row(middle).iter().enumerate().map(|(k, v)| (k as f64 / samples, v.norm() / peak)).collect::<Vec<_>>();
    let x = SheetAxis::new("frequency, in parts of the sampling rate", 0.0, 1.0);
    let y = SheetAxis::new("magnitude", 0.0, 1.1);
    let title = "Beat signal of three groups of points: three bands";
    Ok(Sheet::of(1, (760, 380), vec![SheetPanel::chart(title, x, y, vec![Series::line("", spectrum)])]))
}

/// Nearly random element placement on the aperture, above it the two ends of as many elements.
pub fn random_elements(source: &SceneSource) -> Result<Sheet, FigureError> {
    let random = Layout::random(&source.radar, RANDOM_LAYOUT.0, RANDOM_LAYOUT.1)
        .map_err(|e| FigureError::Missing(e.to_string()))?;
    let row = |name, layout: Layout, height: f64| {
        Series::line(name, layout.x_metres.into_iter().map(|x| (x, height))).with(Stroke::Dots)
    };
    let series = vec![
        row("24 elements at random places", random, 1.0),
        row("two ends of 12 elements", Layout::two_ends(&source.radar), 2.0),
        row("all 1024 elements", Layout::uniform(&source.radar), 3.0),
    ];
    let half = 0.55 * source.radar.aperture_metres();
    let (x, y) = (SheetAxis::new("x (m)", -half, half), SheetAxis::new("", 0.0, 5.5));
    Ok(Sheet::of(1, (760, 340), vec![SheetPanel::chart("Elements on the aperture", x, y, series)]))
}

pub fn virtual_elements(_: &SceneSource) -> Result<Sheet, FigureError> {
    // In element spacings.
    let (transmitters, receivers) = ([-4.0, 0.0, 4.0], [-1.5, -0.5, 0.5, 1.5]);
    let names = [("transmitters", 3.0), ("receivers", 2.0), ("virtual elements", 0.6)];
    let mut shapes = names.map(|(name, y)| SketchShape::Words((-8.6, y), name.to_owned(), Ink::Dark)).to_vec();
    shapes.extend(transmitters.map(|x| SketchShape::Dot((x, 3.0), 9, Ink::Accent)));
    shapes.extend(receivers.map(|x| SketchShape::Dot((x, 2.0), 9, Ink::Second)));
    for (t, transmitter) in transmitters.into_iter().enumerate() {
        for (r, receiver) in receivers.into_iter().enumerate() {
            let at = (transmitter + receiver, 0.6);
            shapes.push(SketchShape::Line(vec![(transmitter, 3.0), at], Ink::Pale));
            shapes.push(SketchShape::Dot(at, 8, Ink::Dark));
            shapes.push(SketchShape::Words((at.0, 0.2), format!("{}+{}", t + 1, r + 1), Ink::Dark));
        }
    }
    let title = "3 transmitters × 4 receivers = 12 virtual elements, half a wavelength apart";
    let panel = SheetPanel::sketch(title, -10.5..7.0, 0.0..3.5, shapes);
    Ok(Sheet::of(1, (820, 340), vec![panel]))
}
