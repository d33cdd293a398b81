//! Figures 3-1, 3-3, 3-8 and 5-6: the networks, from their modules' own sizes, the flow of data, and the fields of view of both ends.

use super::sheet::{Ink, Sheet, SheetPanel, SketchShape};
use super::source::{FigureError, SceneSource};
use crate::network::thesis::ThesisConfig;
use crate::network::unet::UnetConfig;

pub fn unet(_: &SceneSource) -> Result<Sheet, FigureError> {
    let UnetConfig { channels, levels, rows } = UnetConfig::default();
    let size = |level: usize| format!("{} × {} × {}", channels << level, rows >> level, (2 * rows) >> level);
    let height = |level: usize| 3.0 * (levels - level) as f64;
    let mut shapes = Vec::new();
    let block = |x: f64, y: f64, text: String| SketchShape::Block((x - 2.0, y), (x + 2.0, y + 1.6), text);
    for level in 0..levels {
        let (x, y) = (2.6 * level as f64, height(level));
        let right = 2.6 * (2 * levels - level) as f64;
        shapes.push(SketchShape::Arrow((x + 2.0, y + 0.8), (right - 2.0, y + 0.8), Ink::Pale));
        shapes.push(SketchShape::Arrow((x + 1.0, y), (x + 1.6, y - 1.4), Ink::Dark));
        shapes.push(SketchShape::Arrow((right - 1.6, y - 1.4), (right - 1.0, y), Ink::Dark));
        shapes.push(block(x, y, format!("2 conv 3×3\n{}", size(level))));
        shapes.push(block(right, y, format!("join, 2 conv 3×3\n{}", size(level))));
    }
    shapes.push(block(2.6 * levels as f64, 0.0, format!("2 conv 3×3\n{}", size(levels))));
    shapes.push(SketchShape::Words((-0.2, height(0) + 2.1), format!("in: 2 × {rows} × {}", 2 * rows), Ink::Accent));
    let right = 5.2 * levels as f64;
    shapes.push(SketchShape::Words((right, height(0) + 2.1), format!("out: 1 × {rows} × {}", 2 * rows), Ink::Accent));
    let panel =
        SheetPanel::sketch("U-Net on thresholded Cartesian maps", -2.6..right + 2.8, -0.4..height(0) + 2.6, shapes);
    Ok(Sheet::of(1, (980, 480), vec![panel]))
}

pub fn encoder_decoder(source: &SceneSource) -> Result<Sheet, FigureError> {
    let ThesisConfig { filters, levels, .. } = ThesisConfig::default();
    let (rows, columns) = (source.radar.samples, source.radar.elements);
    let size = |channels: usize, level: usize| format!("{channels} × {} × {}", rows >> level, columns >> level);
    let mut shapes = vec![SketchShape::Block((-2.2, 2.2), (1.4, 3.8), format!("input\n{}", size(4, 0)))];
    for (kernel, y) in [(3, 4.6), (5, 0.0)] {
        for level in 1..=levels {
            let x = 4.0 * level as f64;
            let from = if level == 1 { (1.4, 3.0) } else { (x - 2.2, y + 0.8) };
            shapes.push(SketchShape::Arrow(from, (x - 1.8, y + 0.8), Ink::Dark));
            let text = format!("conv {kernel}×{kernel}, pool\n{}", size(filters, level));
            shapes.push(SketchShape::Block((x - 1.8, y), (x + 1.8, y + 1.6), text));
        }
        let x = 4.0 * levels as f64;
        shapes.push(SketchShape::Arrow((x + 1.8, y + 0.8), (x + 2.6, 3.0), Ink::Dark));
    }
    for step in 0..levels {
        let (x, level) = (4.0 * (levels + step) as f64 + 4.4, levels - step - 1);
        let channels = if level == 0 { 1 } else { 2 * filters };
        let text = format!("up conv 4×4\n{}", size(channels, level));
        shapes.push(SketchShape::Block((x - 1.8, 2.2), (x + 1.8, 3.8), text));
        if step > 0 {
            shapes.push(SketchShape::Arrow((x - 2.2, 3.0), (x - 1.8, 3.0), Ink::Dark));
        }
    }
    let right = 4.0 * (2 * levels) as f64 + 3.0;
    let panel =
        SheetPanel::sketch("Two towers, joined, and transposed convolutions back up", -2.6..right, -0.4..6.6, shapes);
    Ok(Sheet::of(1, (1500, 330), vec![panel]))
}

pub fn flow(_: &SceneSource) -> Result<Sheet, FigureError> {
    let boxes = [
        ((0.0, 2.0), "scene"),
        ((4.0, 2.0), "simulation:\nequation 3.1"),
        ((8.0, 3.6), "both ends\n2 × 12 × 512"),
        ((8.0, 0.4), "whole array\n1024 × 512"),
        ((12.0, 3.6), "windows, transforms:\nΛ cos φ, Λ sin φ"),
        ((12.0, 0.4), "windows, transforms:\nΛ"),
        ((16.0, 3.6), "network:\noutput"),
        ((16.0, 0.4), "target"),
        ((20.0, 2.0), "loss"),
    ];
    let arrows = [(0, 1), (1, 2), (1, 3), (2, 4), (3, 5), (4, 6), (5, 7), (6, 8), (7, 8)];
    let side = |i: usize, right: bool| {
        let (x, y) = boxes[i].0;
        (if right { x + 1.6 } else { x - 1.6 }, y)
    };
    let mut shapes: Vec<SketchShape> =
        arrows.iter().map(|(a, b)| SketchShape::Arrow(side(*a, true), side(*b, false), Ink::Dark)).collect();
    shapes.extend(
        boxes
            .iter()
            .map(|((x, y), text)| SketchShape::Block((x - 1.6, y - 0.7), (x + 1.6, y + 0.7), (*text).to_owned())),
    );
    Ok(Sheet::of(1, (1240, 330), vec![SheetPanel::sketch("From a scene to the loss", -2.0..22.0, -0.8..4.8, shapes)]))
}

const HALF_ANGLE_DEGREES: f64 = 50.0;

/// Fields of view of both ends, the distance between them drawn forty times too large.
pub fn fields_of_view(_: &SceneSource) -> Result<Sheet, FigureError> {
    let (half_base, reach) = (10.0, 38.0);
    let sector = |x: f64| {
        let arc = (0..=40).map(move |i| (f64::from(i) / 20.0 - 1.0) * HALF_ANGLE_DEGREES.to_radians());
        let mut corners = vec![(x, 0.0)];
        corners.extend(arc.map(|a| (x + reach * a.sin(), reach * a.cos())));
        corners
    };
    let mut shapes = Vec::new();
    for (x, ink, name) in [(-half_base, Ink::Accent, "first end"), (half_base, Ink::Second, "last end")] {
        shapes.push(SketchShape::Area(sector(x), ink));
        shapes.push(SketchShape::Dot((x, 0.0), 7, ink));
        shapes.push(SketchShape::Words((x, -2.6), name.to_owned(), ink));
    }
    shapes.push(SketchShape::Words((0.0, 24.0), "seen by both".to_owned(), Ink::Dark));
    shapes.push(SketchShape::Words((-26.0, 21.0), "first end alone".to_owned(), Ink::Dark));
    shapes.push(SketchShape::Words((26.0, 21.0), "last end alone".to_owned(), Ink::Dark));
    shapes.push(SketchShape::Words((0.0, 4.0), "neither".to_owned(), Ink::Dark));
    let panel = SheetPanel::sketch("Fields of view of the two ends", -46.0..46.0, -4.5..40.0, shapes);
    Ok(Sheet::of(1, (820, 440), vec![panel]))
}
