//! Figure 6-1, a cylinder and a cube.

use super::sheet::{Axis, Panel, Series, Sheet, Stroke};
use super::source::{FigureError, Seen, Source};
use crate::scene::{Object, Scene, Shape};
use std::f64::consts::TAU;

const PANEL: (u32, u32) = (520, 400);

/// Corners that a circle is drawn with.
const ROUND: usize = 48;

/// A cylinder and a cube at an angle, as both ends and the whole array see them.
pub fn cylinder_and_cube(source: &Source) -> Result<Sheet, FigureError> {
    let seen = source.preset("cylinder-and-cube")?;
    Ok(Sheet::of(2, PANEL, with_maps(source, &seen, "A cylinder and a cube")))
}

fn with_maps(source: &Source, seen: &Seen, title: &str) -> Vec<Panel> {
    let [first, last, full] = &seen.lambda;
    vec![
        outlines(source, title, &seen.scene),
        source.lambda_panel("Input 0", first),
        source.lambda_panel("Input 1", last),
        source.lambda_panel("Target", full),
    ]
}

/// Outlines of bodies, and points, over x and y.
fn outlines(source: &Source, title: &str, scene: &Scene) -> Panel {
    let extent = source.radar.max_range_metres();
    let pair = |p: [f64; 2]| (p[0], p[1]);
    let of_body = |object: &Object| match object.body()?.shape() {
        Shape::Wall(ends) => Some(ends.map(pair).to_vec()),
        Shape::Outline(corners) => Some(corners.iter().chain(corners.first()).map(|c| pair(*c)).collect()),
        Shape::Circle { centre_metres: [x, y], radius_metres } => {
            let on = |i: usize| (TAU * i as f64 / ROUND as f64).sin_cos();
            Some((0..=ROUND).map(|i| (x + radius_metres * on(i).1, y + radius_metres * on(i).0)).collect())
        }
    };
    let mut series: Vec<Series> = scene.objects.iter().filter_map(of_body).map(|line| Series::line("", line)).collect();
    let points = scene.reflectors().into_iter().map(|r| (r.x_metres, r.y_metres));
    series.push(Series::line("", points).with(Stroke::Dots));
    Panel::chart(title, Axis::new("x (m)", -extent, extent), Axis::new("y (m)", 0.0, extent), series)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_are_drawn_by_their_outlines() {
        let sheet = cylinder_and_cube(&Source::new()).unwrap();
        let super::super::sheet::Content::Chart(chart) = &sheet.panels[0].content else { panic!("a chart") };
        let counts: Vec<usize> = chart.series.iter().map(|s| s.points.len()).collect();
        assert_eq!(counts, [ROUND + 1, 5, 0]);
    }
}
