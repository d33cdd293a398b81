//! Pictures of a scene and its maps, drawn without a display.
//!
//! [`render`] draws what the app shows: the scene on the left, the maps of both ends, of the whole array and of a reconstruction on
//! the right, and what both thresholds make of them.

mod canvas;
pub mod colour;
mod compose;
mod map_panel;
mod png;
mod scene_panel;
mod text;

pub(crate) use text::register_fonts;

pub use canvas::PictureError;
pub use colour::ColourMap;
pub use compose::{ComposeError, Format, Style, compose};
pub use png::{encode_png, is_our_png};

use crate::evaluate::{Metrics, TARGET_ETA};
use crate::maps::RangeAngleMap;
use crate::radar::{Carrier, End, Radar};
use crate::scene::Scene;
use canvas::{Area, FAINT_INK, INK, PAPER};
use image::RgbImage;
use map_panel::{Cells, MapPanel};
use plotters::prelude::*;
use scene_panel::Content;

/// Everything a picture shows.
#[derive(Debug, Clone, Copy)]
pub struct Panels<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The radar that looks at it.
    pub radar: &'a Radar,
    /// What the maps were made with (floor, normalisation), in words.
    pub conditions: &'a str,
    /// Lambda of the first end ("input 0").
    pub first: &'a RangeAngleMap,
    /// Lambda of the last end ("input 1").
    pub last: &'a RangeAngleMap,
    /// Lambda of the whole array ("target").
    pub target: &'a RangeAngleMap,
    /// What a method makes of the two ends.
    pub output: &'a RangeAngleMap,
    /// Name of the method.
    pub method: &'a str,
    /// The method's threshold.
    pub eta: f32,
    /// Colours of the maps.
    pub colours: ColourMap,
}

const WIDTH: u32 = 2180;
const HEIGHT: u32 = 1120;
const HEADER: i32 = 84;
const LEFT: i32 = 700;
const MARGIN: i32 = 24;

/// Draws the picture, 2180 x 1120 pixels.
///
/// # Errors
/// [`PictureError`] when plotters can't draw.
pub fn render(panels: &Panels) -> Result<RgbImage, PictureError> {
    text::register_fonts()?;
    let mut buffer = vec![0; (WIDTH * HEIGHT * 3) as usize];
    {
        let root = BitMapBackend::with_buffer(&mut buffer, (WIDTH, HEIGHT)).into_drawing_area();
        panels.draw(&root)?;
    }
    RgbImage::from_raw(WIDTH, HEIGHT, buffer).ok_or_else(|| PictureError::new("its buffer is too small"))
}

/// Draws the same picture as SVG: lines and text stay sharp at any size, the maps are bitmaps in it.
///
/// # Errors
/// [`PictureError`] when plotters can't draw.
pub fn render_svg(panels: &Panels) -> Result<String, PictureError> {
    text::register_fonts()?;
    let mut svg = String::new();
    panels.draw(&SVGBackend::with_string(&mut svg, (WIDTH, HEIGHT)).into_drawing_area())?;
    Ok(svg)
}

impl Panels<'_> {
    fn draw<B: DrawingBackend>(&self, root: &Area<B>) -> Result<(), PictureError> {
        root.fill(&PAPER).map_err(PictureError::new)?;
        self.header(root)?;
        let (field_width, field_height) = (LEFT - MARGIN - 8, 396);
        let field = |row: i32| {
            root.clone().shrink((MARGIN, HEADER + 8 + row * (field_height + 12)), (field_width, field_height))
        };
        scene_panel::draw(&field(0), self.radar, "Scene", Content::Scene(self.scene))?;
        let target = Content::Map(self.target, self.colours);
        scene_panel::draw(&field(1), self.radar, "Target, seen from above", target)?;
        let below = HEADER + 8 + 2 * (field_height + 12);
        let text = root.clone().shrink((MARGIN + 8, below), (field_width - 8, HEIGHT as i32 - below - 8));
        self.figures_and_notes(&text)?;

        let (width, height) = ((WIDTH as i32 - LEFT - MARGIN) / 3, (HEIGHT as i32 - HEADER - 16) / 2);
        for (index, panel) in self.map_panels().iter().enumerate() {
            let (column, row) = (index as i32 % 3, index as i32 / 3);
            let area = root.clone().shrink((LEFT + column * width, HEADER + row * height), (width, height));
            panel.draw(&area, self.radar)?;
        }
        root.present().map_err(PictureError::new)
    }

    fn header<B: DrawingBackend>(&self, root: &Area<B>) -> Result<(), PictureError> {
        let name = if self.scene.name.is_empty() { "Unnamed scene" } else { &self.scene.name };
        let name: String = name.chars().filter(|c| !c.is_control()).take(200).collect();
        let name = text::fitted(root, &name, 34, text::Weight::Bold, (LEFT - MARGIN) as u32)?;
        text::line(root, (MARGIN + 8, 16), &name, 34, text::Weight::Bold, &INK)?;
        let carrier = match self.radar.carrier {
            Carrier::OneWay => "one-way carrier",
            Carrier::TwoWay => "two-way carrier",
        };
        let reflectors = match self.scene.reflector_count() {
            0 => "no reflector".to_owned(),
            1 => "1 reflector".to_owned(),
            n => format!("{n} reflectors"),
        };
        let about = format!("{reflectors}, {carrier}, {}", self.conditions);
        text::line(root, (LEFT + 62, 30), &about, 20, text::Weight::Normal, &FAINT_INK)
    }

    fn map_panels(&self) -> [MapPanel<'_>; 6] {
        let elements = |end| {
            let range = self.radar.end_range(end);
            format!("elements {} to {}", range.start, range.end - 1)
        };
        let lambda = |title: String, map| MapPanel { title, cells: Cells::Lambda(map, self.colours) };
        [
            lambda(format!("Input 0: {}", elements(End::First)), self.first),
            lambda(format!("Input 1: {}", elements(End::Last)), self.last),
            lambda(format!("Target: all {} elements", self.radar.elements), self.target),
            lambda(format!("Output: {}", self.method), self.output),
            MapPanel { title: format!("Target > {TARGET_ETA}"), cells: Cells::Above(self.target, TARGET_ETA) },
            MapPanel {
                title: format!("Output > {:.2}", self.eta),
                cells: Cells::Detections { target: self.target, output: self.output, eta: self.eta },
            },
        ]
    }

    /// The three figures of the tables for this scene, then the scene's notes.
    fn figures_and_notes<B: DrawingBackend>(&self, area: &Area<B>) -> Result<(), PictureError> {
        let metrics = Metrics::of(self.target, self.output, self.eta);
        let percent = |part: f64| format!("{:.2} %", 100.0 * part);
        let figures = [
            ("SE", format!("{:.0}", metrics.squared_error)),
            ("P_D", metrics.detection.map_or_else(|| "no target cell".to_owned(), percent)),
            ("P_FA", percent(metrics.false_alarm)),
        ];
        for (column, (name, value)) in figures.iter().enumerate() {
            let x = column as i32 * 210;
            text::line(area, (x, 5), name, 18, text::Weight::Normal, &FAINT_INK)?;
            text::line(area, (x + 58, 0), value, 23, text::Weight::Bold, &INK)?;
        }
        text::paragraphs(area, (0, 40), &self.scene.notes, 18, &INK)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{LogMaps, Normalisation};
    use crate::scene::presets;
    use crate::signal::BeatSignal;

    #[test]
    fn pictures_are_drawn_and_known_as_ours() {
        let radar = Radar { samples: 32, elements: 64, ..Radar::default() };
        let maps = LogMaps::of_signal(&radar, &BeatSignal::silence(&radar));
        let flat = maps.full.normalise(Normalisation::MinMax);
        let file = presets::default_scene();
        let panels = Panels {
            scene: &file.scene,
            radar: &radar,
            conditions: "exact floor",
            first: &flat,
            last: &flat,
            target: &flat,
            output: &flat,
            method: "baseline",
            eta: 0.9,
            colours: ColourMap::Grey,
        };
        let svg = render_svg(&panels).unwrap();
        assert!(svg.trim_end().ends_with("</svg>") && svg.contains("Target"));
        assert_eq!(svg.matches("<image").count(), 7, "six maps and the one seen from above are one image each");
        let picture = render(&panels).unwrap();
        assert_eq!(picture.dimensions(), (WIDTH, HEIGHT));
        let bytes = encode_png(&picture).unwrap();
        assert!(is_our_png(&bytes));
        let mut foreign = Vec::new();
        picture.write_to(&mut std::io::Cursor::new(&mut foreign), image::ImageFormat::Png).unwrap();
        assert!(!is_our_png(&foreign) && !is_our_png(&bytes[..40]) && !is_our_png(b""));
    }
}
