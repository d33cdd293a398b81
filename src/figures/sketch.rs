//! Sketches: lines, dots, boxes and words in a plane without axes.

use super::sheet::{Ink, Sketch, SketchShape};
use crate::picture::PanelArea;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub(super) type SheetDrawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

pub(super) fn words(size: f64, colour: &RGBColor) -> TextStyle<'static> {
    FontDesc::new(FontFamily::SansSerif, size, FontStyle::Normal).color(colour)
}

fn colour(ink: Ink) -> RGBColor {
    match ink {
        Ink::Dark => RGBColor(30, 30, 34),
        Ink::Pale => RGBColor(160, 166, 172),
        Ink::Accent => RGBColor(200, 70, 10),
        Ink::Second => RGBColor(20, 90, 180),
    }
}

struct Scale {
    left: f64,
    bottom: f64,
    across: f64,
    up: f64,
    corner: (f64, f64),
}

impl Scale {
    fn new(sketch: &Sketch, (width, height): (u32, u32)) -> Self {
        let (width, height) = (f64::from(width), f64::from(height));
        Scale {
            left: 16.0,
            bottom: height - 16.0,
            across: (width - 32.0) / (sketch.x.end - sketch.x.start),
            up: (height - 32.0) / (sketch.y.end - sketch.y.start),
            corner: (sketch.x.start, sketch.y.start),
        }
    }

    fn pixel(&self, (x, y): (f64, f64)) -> (i32, i32) {
        let across = self.left + (x - self.corner.0) * self.across;
        let up = self.bottom - (y - self.corner.1) * self.up;
        (across.round() as i32, up.round() as i32)
    }
}

pub(super) fn draw<B: DrawingBackend>(sketch: &Sketch, area: &PanelArea<B>) -> SheetDrawn<B> {
    let scale = Scale::new(sketch, area.dim_in_pixel());
    sketch.shapes.iter().try_for_each(|shape| draw_shape(shape, &scale, area))
}

fn draw_shape<B: DrawingBackend>(shape: &SketchShape, scale: &Scale, area: &PanelArea<B>) -> SheetDrawn<B> {
    let centred = |size, ink| words(size, &colour(ink)).pos(Pos::new(HPos::Center, VPos::Center));
    match shape {
        SketchShape::Line(places, ink) => {
            let pixels: Vec<_> = places.iter().map(|p| scale.pixel(*p)).collect();
            area.draw(&PathElement::new(pixels, colour(*ink).stroke_width(2)))
        }
        SketchShape::Arrow(from, to, ink) => {
            let [from, to] = [from, to].map(|p| scale.pixel(*p));
            area.draw(&Polygon::new(arrow_head(from, to), colour(*ink).filled()))?;
            area.draw(&PathElement::new(vec![from, to], colour(*ink).stroke_width(2)))
        }
        SketchShape::Dot(at, pixels, ink) => area.draw(&Circle::new(scale.pixel(*at), *pixels, colour(*ink).filled())),
        SketchShape::Area(corners, ink) => {
            let corners: Vec<_> = corners.iter().map(|p| scale.pixel(*p)).collect();
            area.draw(&Polygon::new(corners, colour(*ink).mix(0.22).filled()))
        }
        SketchShape::Block(low, high, text) => {
            let corners = [scale.pixel(*low), scale.pixel(*high)];
            area.draw(&Rectangle::new(corners, RGBColor(238, 241, 244).filled()))?;
            area.draw(&Rectangle::new(corners, colour(Ink::Pale)))?;
            let middle = ((corners[0].0 + corners[1].0) / 2, (corners[0].1 + corners[1].1) / 2);
            let lines: Vec<&str> = text.lines().collect();
            for (i, line) in lines.iter().enumerate() {
                let down = (2 * i as i32 - lines.len() as i32 + 1) * 9;
                area.draw(&Text::new((*line).to_owned(), (middle.0, middle.1 + down), centred(14.0, Ink::Dark)))?;
            }
            Ok(())
        }
        SketchShape::Words(at, text, ink) => area.draw(&Text::new(text.clone(), scale.pixel(*at), centred(15.0, *ink))),
    }
}

fn arrow_head(before: (i32, i32), end: (i32, i32)) -> Vec<(i32, i32)> {
    let (dx, dy) = (f64::from(end.0 - before.0), f64::from(end.1 - before.1));
    let length = dx.hypot(dy).max(1.0);
    let (ux, uy) = (dx / length, dy / length);
    let corner = |side: f64| {
        let (x, y) = (f64::from(end.0) - 11.0 * ux - side * uy, f64::from(end.1) - 11.0 * uy + side * ux);
        (x.round() as i32, y.round() as i32)
    };
    vec![end, corner(5.0), corner(-5.0)]
}
