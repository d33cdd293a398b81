//! The half plane ahead of the array from above, in metres: the scene, or a map projected onto it (thesis figure 2-12).

use super::canvas::{FAINT_INK, HAIRLINE, INK, PAPER, Painted, PanelArea, PictureError};
use super::text::{self, Weight};
use crate::maps::{RangeAngleMap, cartesian::project};
use crate::picture::ColourMap;
use crate::radar::{End, Radar};
use crate::scene::{Object, Scene};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use std::f64::consts::PI;

const ARRAY: RGBColor = RGBColor(120, 128, 138);
const END: RGBColor = RGBColor(200, 62, 40);

#[derive(Debug, Clone, Copy)]
pub(super) enum SceneContent<'a> {
    Scene(&'a Scene),
    Map(&'a RangeAngleMap, ColourMap),
}

/// Draws the half plane out to the maximum range, equal scale on both axes, with range rings, angle spokes and the array.
pub(super) fn draw<B: DrawingBackend>(area: &PanelArea<B>, radar: &Radar, title: &str, shown: SceneContent) -> Painted {
    text::line(area, (8, 0), title, 21, Weight::Bold, &INK)?;
    let max = radar.max_range_metres();
    let (width, height) = area.dim_in_pixel();
    let (labels_x, labels_y, top) = (52, 56, 34);
    // Metres a pixel from the width; the height follows, so that circles are circles.
    let metres = 2.0 * max / f64::from(width as i32 - labels_y - 2);
    let tall = metres * f64::from(height as i32 - labels_x - top);
    let behind = (tall - max).max(0.0) * 0.5;
    let mut chart = ChartBuilder::on(area)
        .margin_top(top)
        .margin_right(2)
        .x_label_area_size(labels_x)
        .y_label_area_size(labels_y)
        .build_cartesian_2d(-max..max, -behind..tall - behind)?;
    if let SceneContent::Map(map, colours) = shown {
        draw_map(&mut chart, radar, map, colours, metres)?;
    }
    chart
        .configure_mesh()
        .disable_mesh()
        .x_labels(9)
        .y_labels(6)
        .x_label_formatter(&|v| format!("{v:.0}"))
        .y_label_formatter(&|v| format!("{v:.0}"))
        .x_desc("x (m)")
        .y_desc("y (m)")
        .label_style(text::style(16, Weight::Normal, &FAINT_INK))
        .axis_desc_style(text::style(17, Weight::Normal, &INK))
        .axis_style(HAIRLINE)
        .draw()?;

    let line = match shown {
        SceneContent::Scene(_) => HAIRLINE.mix(1.0),
        SceneContent::Map(..) => HAIRLINE.mix(0.35),
    };
    draw_rings_and_spokes(&mut chart, max, line)?;
    draw_array(&mut chart, radar)?;
    if let SceneContent::Scene(scene) = shown {
        draw_objects(&mut chart, scene, max)?;
    }
    Ok(())
}

type Chart<'a, B> = ChartContext<'a, B, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

fn draw_map<B: DrawingBackend>(
    chart: &mut Chart<B>,
    radar: &Radar,
    map: &RangeAngleMap,
    colours: ColourMap,
    metres: f64,
) -> Painted {
    let max = radar.max_range_metres();
    let rows = (max / metres) as usize;
    let lambda = project(radar, map, rows).lambda;
    let paint = |v: f32| if v.is_nan() { [PAPER.0, PAPER.1, PAPER.2] } else { colours.colour(v) };
    let pixels = lambda.outer_iter().rev().flat_map(|row| row.iter().flat_map(|v| paint(*v)).collect::<Vec<u8>>());
    let bitmap: BitMapElement<_> =
        BitMapElement::with_owned_buffer((-max, max), (2 * rows as u32, rows as u32), pixels.collect())
            .ok_or_else(|| PictureError::new("a map has no room"))?;
    chart.draw_series(std::iter::once(bitmap))?;
    Ok(())
}

fn draw_rings_and_spokes<B: DrawingBackend>(chart: &mut Chart<B>, max: f64, line: RGBAColor) -> Painted {
    let arc = |range: f64, style: ShapeStyle| {
        let at = move |degree: i32| {
            let angle = f64::from(degree) * PI / 180.0;
            (range * angle.cos(), range * angle.sin())
        };
        LineSeries::new((0..=180).map(at), style)
    };
    for ring in (1..).map(|i| f64::from(i) * 10.0).take_while(|r| *r < 0.98 * max).take(40) {
        chart.draw_series(arc(ring, line.into()))?;
    }
    for cos in [-0.75f64, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75] {
        let end = (max * cos, max * (1.0 - cos * cos).sqrt());
        chart.draw_series(LineSeries::new([(0.0, 0.0), end], line))?;
    }
    chart.draw_series(arc(max, FAINT_INK.into()))?;
    Ok(())
}

fn draw_array<B: DrawingBackend>(chart: &mut Chart<B>, radar: &Radar) -> Painted {
    let element = |n: usize| (radar.element_x_metres(n), 0.0);
    let whole = LineSeries::new([element(0), element(radar.elements - 1)], ARRAY.stroke_width(5));
    chart.draw_series(whole)?;
    for end in End::BOTH {
        chart.draw_series([Circle::new((radar.end_centre_metres(end), 0.0), 4, END.filled())])?;
    }
    Ok(())
}

fn draw_objects<B: DrawingBackend>(chart: &mut Chart<B>, scene: &Scene, max: f64) -> Painted {
    for object in &scene.objects {
        let (radius, [red, green, blue]) = match object {
            Object::Point(_) => (5, [24, 92, 168]),
            Object::Line(_) => (2, [16, 124, 96]),
            Object::Gaussian(_) => (3, [150, 70, 160]),
            Object::Wall(_) | Object::Box(_) | Object::Post(_) | Object::Polygon(_) => (3, [110, 80, 40]),
        };
        let colour = RGBColor(red, green, blue);
        if let Some(body) = object.body() {
            let line = body.shape.line_around();
            chart.draw_series([Polygon::new(line.clone(), colour.mix(0.5))])?;
            chart.draw_series([PathElement::new(line, colour.stroke_width(2))])?;
        }
        // A line array sees y and -y alike: reflectors behind it are drawn ahead, hollow.
        chart.draw_series(object.reflectors().iter().filter(|r| r.x_metres.hypot(r.y_metres) <= max).map(|r| {
            let style = if r.y_metres < 0.0 { ShapeStyle::from(colour) } else { colour.filled() };
            Circle::new((r.x_metres, r.y_metres.abs()), radius, style)
        }))?;
    }
    Ok(())
}
