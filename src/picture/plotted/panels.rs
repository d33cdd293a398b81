//! The picture of all panels, drawn by [`render`] and [`render_svg`].

use super::canvas::{FAINT_INK, INK, PAPER, Painted, PanelArea};
use super::lettering::Lettered;
use super::map_panel::{MapCells, MapPanel};
use super::scene_panel::{self, SceneContent};
use super::{Drawing, InputMap, PictureError, text};
use crate::evaluate::verdict::OutputVerdicts;
use crate::evaluate::{Metrics, eta_text, squared_error};
use crate::maps::cfar::{Cfar, CfarError, DETECTION_THRESHOLD};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::picture::{CellVerdict, ColourMap, finer, in_place, told_apart};
use crate::radar::Radar;
use crate::reconstruct::Detection;
use crate::scene::Scene;
use image::RgbImage;
use ndarray::{Array2, CowArray};
use plotters::prelude::*;

/// The contents of a picture.
#[derive(Debug, Clone, Copy)]
pub struct Panels<'a> {
    /// The scene; of a recording its name and notes, and the echoes found in it as objects.
    pub scene: &'a Scene,
    /// Of a recording the echoes that the method found, the strongest first, in place of the figures that need a known scene.
    pub found: Option<&'a [Detection]>,
    /// The radar of the maps.
    pub radar: &'a Radar,
    /// The maps' settings (reflectors, carrier, floor, normalisation), in words.
    pub about: &'a str,
    /// The input maps of both ends, or of a layout alone.
    pub inputs: &'a [InputMap],
    /// Lambda of the whole array ("target"), where it is known.
    pub target: Option<&'a RangeAngleMap>,
    pub output: &'a RangeAngleMap,
    pub method: &'a str,
    /// The threshold eta of either method.
    pub etas: [f32; 2],
    /// The verdicts on the scene's objects, and the false alarms; `None` of a recording.
    pub verdicts: Option<&'a OutputVerdicts>,
    /// The cells that a detector found, in the place of those above the thresholds.
    pub detected: Option<&'a DetectedCells>,
    pub colours: ColourMap,
}

/// Detected cells of target and output. A detected cell is 1 and any other 0; both maps are `[range bins, columns]`.
#[derive(Debug, Clone)]
pub struct DetectedCells {
    pub cfar: Cfar,
    pub target: RangeAngleMap,
    pub output: RangeAngleMap,
}

impl DetectedCells {
    /// Detects in both maps. `scale` is that of their Lambda.
    /// # Errors
    /// [`Cfar::check_map`].
    pub fn of(cfar: Cfar, scale: LambdaScale, [target, output]: [&RangeAngleMap; 2]) -> Result<Self, CfarError> {
        let detect = |map| Ok(cfar.detect_lambda(map, scale)?.as_map());
        Ok(DetectedCells { cfar, target: detect(target)?, output: detect(output)? })
    }
}

const WIDTH: u32 = 2180;
const HEIGHT: u32 = 1120;
const HEADER: i32 = 84;
const LEFT: i32 = 700;
const MARGIN: i32 = 24;

/// Draws a picture on a bitmap; the panels are 2180 x 1120 pixels.
/// # Errors
/// [`PictureError`] when plotters can't draw.
pub fn render(drawing: &impl Drawing) -> Result<RgbImage, PictureError> {
    let (width, height) = drawing.size();
    let mut buffer = vec![0; (width * height * 3) as usize];
    on_paper(drawing, BitMapBackend::with_buffer(&mut buffer, (width, height)))?;
    RgbImage::from_raw(width, height, buffer).ok_or_else(|| PictureError::new("its buffer is too small"))
}

/// Draws the same picture as SVG: lines and text stay sharp at any size, the maps are bitmaps in it.
/// # Errors
/// [`PictureError`] when plotters can't draw.
pub fn render_svg(drawing: &impl Drawing) -> Result<String, PictureError> {
    let mut svg = String::new();
    on_paper(drawing, SVGBackend::with_string(&mut svg, drawing.size()))?;
    // ImageMagick fills a line of a given opacity with black, and bitmaps need their media type.
    Ok(svg.replace(r#"fill="none" opacity="#, r#"fill="none" stroke-opacity="#).replace("data:png;", "data:image/png;"))
}

fn on_paper<B: DrawingBackend>(drawing: &impl Drawing, backend: B) -> Painted {
    // Legends of plotters measure their text by these fonts on every backend.
    text::register_fonts()?;
    let area = Lettered::new(backend)?.into_drawing_area();
    area.fill(&PAPER)?;
    drawing.draw(&area)?;
    Ok(area.present()?)
}

impl Drawing for Panels<'_> {
    fn size(&self) -> (u32, u32) {
        (WIDTH, HEIGHT)
    }

    fn draw<B: DrawingBackend>(&self, root: &PanelArea<B>) -> Painted {
        self.header(root)?;
        let (field_width, field_height) = (LEFT - MARGIN - 8, 396);
        let field = |row: i32| {
            root.clone().shrink((MARGIN, HEADER + 8 + row * (field_height + 12)), (field_width, field_height))
        };
        let objects = if self.found.is_some() { format!("Found by {}", self.method) } else { "Scene".to_owned() };
        scene_panel::draw(&field(0), self.radar, &objects, SceneContent::Scene(self.scene))?;
        let (title, map) = match self.target {
            Some(target) => ("Target, seen from above", target),
            None => ("Output, seen from above", self.output),
        };
        scene_panel::draw(&field(1), self.radar, title, SceneContent::Map(map, self.colours))?;
        let below = HEADER + 8 + 2 * (field_height + 12);
        let text = root.clone().shrink((MARGIN + 8, below), (field_width - 8, HEIGHT as i32 - below - 8));
        self.figures_and_notes(&text)?;

        let (width, height) = ((WIDTH as i32 - LEFT - MARGIN) / 3, (HEIGHT as i32 - HEADER - 16) / 2);
        for (index, panel) in self.map_panels().iter().enumerate() {
            // Without a second input the second panel's place stays free.
            let place = if index == 0 { 0 } else { index as i32 + 2 - self.inputs.len() as i32 };
            let (column, row) = (place % 3, place / 3);
            let area = root.clone().shrink((LEFT + column * width, HEADER + row * height), (width, height));
            panel.draw(&area, self.radar)?;
        }
        Ok(())
    }
}

impl<'a> Panels<'a> {
    fn header<B: DrawingBackend>(&self, root: &PanelArea<B>) -> Painted {
        let name = if self.scene.name.is_empty() { "Unnamed scene" } else { &self.scene.name };
        let name: String = name.chars().filter(|c| !c.is_control()).take(200).collect();
        let name = text::fitted(root, &name, 34, text::Weight::Bold, (LEFT - MARGIN) as u32)?;
        text::line(root, (MARGIN + 8, 16), &name, 34, text::Weight::Bold, &INK)?;
        text::line(root, (LEFT + 62, 30), self.about, 20, text::Weight::Normal, &FAINT_INK)
    }

    fn map_panels(&self) -> Vec<MapPanel<'a>> {
        let drawn = |map: &'a RangeAngleMap| self.radar.left_to_right(&map.lambda);
        let lambda = |title: String, map| {
            let cells = drawn(map);
            let cells = finer(self.radar, cells).map_or_else(|| CowArray::from(cells), CowArray::from);
            MapPanel { title, cells: MapCells::Lambda(cells, self.colours) }
        };
        let mut panels: Vec<_> = self.inputs.iter().map(|input| lambda(input.title.clone(), &input.lambda)).collect();
        let above = |title: String, map, eta| {
            let cells = drawn(map);
            let cells = in_place(self.radar, cells).map_or_else(|| CowArray::from(cells), CowArray::from);
            MapPanel { title, cells: MapCells::Above(cells, eta) }
        };
        let output = lambda(format!("Output: {}", self.method), self.output);
        let judged = self.judged();
        let [title, target_title] = [("Output", 0), ("Target", 1)].map(|(name, of)| match self.detected {
            Some(detected) => format!("{name}: {}", detected.cfar.statistic.short_name()),
            None => format!("{name} > {}", short(self.etas[of])),
        });
        let (Some(target), Some(judged_target)) = (self.target, judged.target) else {
            panels.extend([output, above(title, judged.output, judged.etas[0])]);
            return panels;
        };
        panels.extend([
            lambda(format!("Target: all {} elements", self.radar.elements), target),
            output,
            above(target_title, judged_target, judged.etas[1]),
        ]);
        panels.push(match self.found {
            Some(_) => above(title, judged.output, judged.etas[0]),
            None => MapPanel { title, cells: MapCells::Detections(self.told_apart(judged_target, &judged)) },
        });
        panels
    }

    /// The maps and thresholds by which hits and misses are counted.
    fn judged(&self) -> Judged<'a> {
        match self.detected {
            Some(cells) => {
                Judged { target: Some(&cells.target), output: &cells.output, etas: [DETECTION_THRESHOLD; 2] }
            }
            None => Judged { target: self.target, output: self.output, etas: self.etas },
        }
    }

    fn told_apart(&self, target: &RangeAngleMap, judged: &Judged<'_>) -> Array2<CellVerdict> {
        let ghosts = self.verdicts.map_or(&[][..], |verdicts| &verdicts.ghosts);
        let verdicts = told_apart(judged.output.lambda.view(), target.lambda.view(), judged.etas, ghosts);
        let drawn = self.radar.left_to_right(&verdicts);
        in_place(self.radar, drawn).unwrap_or_else(|| drawn.to_owned())
    }

    /// The verdict on the objects and the three figures of the tables for this scene, or the echoes found in a recording, then the notes.
    fn figures_and_notes<B: DrawingBackend>(&self, area: &PanelArea<B>) -> Painted {
        if let Some(found) = self.found {
            text::line(area, (0, 0), &strongest_of(found), 20, text::Weight::Bold, &INK)?;
            return text::paragraphs(area, (0, 40), &self.scene.notes, 18, &INK);
        }
        let Some(target) = self.target else { return text::paragraphs(area, (0, 0), &self.scene.notes, 18, &INK) };
        let judged = self.judged();
        let truth = self.detected.map_or(target, |cells| &cells.target);
        let metrics = Metrics {
            squared_error: squared_error(target, self.output),
            ..Metrics::of_echoes(!self.scene.is_silent(), truth, judged.output, judged.etas[0])
        };
        let percent = |part: f64| format!("{:.2} %", 100.0 * part);
        let figures = [
            ("SE", format!("{:.0}", metrics.squared_error)),
            ("P_D", metrics.detection.map_or_else(|| "none".to_owned(), percent)),
            ("P_FA", percent(metrics.false_alarm)),
        ];
        let verdict = self.verdicts.filter(|verdicts| !verdicts.objects.is_empty()).map(OutputVerdicts::headline);
        let below = if let Some(verdict) = verdict {
            text::line(area, (0, 0), &verdict, 23, text::Weight::Bold, &INK)?;
            32
        } else {
            0
        };
        for (column, (name, value)) in figures.iter().enumerate() {
            let x = column as i32 * 210;
            text::line(area, (x, below + 5), name, 18, text::Weight::Normal, &FAINT_INK)?;
            text::line(area, (x + 58, below), value, 23, text::Weight::Bold, &INK)?;
        }
        text::paragraphs(area, (0, below + 40), &self.scene.notes, 18, &INK)
    }
}

struct Judged<'a> {
    target: Option<&'a RangeAngleMap>,
    output: &'a RangeAngleMap,
    etas: [f32; 2],
}

/// A threshold with at most three digits after the point: the legend stands beside the title.
fn short(eta: f32) -> String {
    let exact = eta_text(eta);
    if exact.len() > "0.000".len() { format!("{eta:.3}") } else { exact }
}

fn strongest_of(found: &[Detection]) -> String {
    let Some(strongest) = found.first() else { return "no echo found".to_owned() };
    let Detection { range_metres, cos_theta, .. } = strongest;
    let plural = if found.len() == 1 { "" } else { "es" };
    format!("{} echo{plural} found, the strongest at {range_metres:.2} m, cos θ {cos_theta:.3}", found.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::verdict::ObjectVerdict;
    use crate::maps::{LogMaps, Normalisation};
    use crate::picture::{encode_png, is_our_png};
    use crate::radar::{BuiltArray, Decibels};
    use crate::scene::presets;
    use crate::signal::BeatSignal;

    #[test]
    fn drawn_pictures_are_known_as_ours() {
        let radar = Radar { samples: 32, elements: 64, ..Radar::default() };
        let maps = LogMaps::of_signal(&radar, &BeatSignal::silence(&radar));
        let flat = maps.full.normalise(Normalisation::MinMax);
        let file = presets::default_scene();
        let (array, ends) = (BuiltArray::default(), [&maps.first, &maps.last]);
        let (_, inputs) = InputMap::of(&radar, &array, None, ends, (None, Normalisation::MinMax)).unwrap();
        let found = file.scene.objects.iter().map(|_| ObjectVerdict::Found).collect();
        let verdicts = OutputVerdicts { objects: found, ..OutputVerdicts::default() };
        let panels = Panels {
            scene: &file.scene,
            radar: &radar,
            found: None,
            about: "exact floor",
            inputs: &inputs,
            target: Some(&flat),
            output: &flat,
            method: "baseline",
            etas: [0.8, 0.9],
            verdicts: Some(&verdicts),
            detected: None,
            colours: ColourMap::Grey,
        };
        let svg = render_svg(&panels).unwrap();
        assert!(svg.trim_end().ends_with("</svg>") && svg.contains("Target"));
        let place = |text: &str| svg.find(text).unwrap();
        assert!(place(&verdicts.headline()) < place(">\nSE\n"), "the headline comes before the cells' figures");
        assert_eq!(svg.matches("<image").count(), 7, "six maps and the one seen from above are one image each");
        let empty = render_svg(&Panels { scene: &Scene::default(), verdicts: None, ..panels }).unwrap();
        assert!(empty.contains(">\nnone\n"), "P_FA stands beside it");
        let without = render_svg(&Panels { target: None, ..panels }).unwrap();
        assert_eq!(without.matches("<image").count(), 5, "no target, no map of it and of its threshold");
        assert!(without.contains("Output, seen from above") && !without.contains("P_FA"));
        let echo = Detection { cos_theta: 0.3, range_metres: 4.0, relative_power: Decibels(0.0), confidence: None };
        let recorded = render_svg(&Panels { found: Some(&[echo]), ..panels }).unwrap();
        assert!(recorded.contains("1 echo found, the strongest at 4.00 m, cos θ 0.300"));
        assert!(!recorded.contains("P_FA") && !recorded.contains("false alarm"), "a recording has no truth");
        let mut cells = DetectedCells { cfar: Cfar::default(), target: flat.clone(), output: flat.clone() };
        cells.target.lambda.fill(0.0);
        cells.output.lambda.fill(0.0);
        cells.target.lambda[[3, 5]] = 1.0;
        let by_detector = render_svg(&Panels { detected: Some(&cells), ..panels }).unwrap();
        assert!(by_detector.contains("Target: CA-CFAR") && by_detector.contains("Output: CA-CFAR"));
        assert!(!svg.contains("CFAR") && svg.contains("Target &gt; 0.9") && svg.contains("Output &gt; 0.8"));
        let picture = render(&panels).unwrap();
        assert_eq!(picture.dimensions(), (WIDTH, HEIGHT));
        let bytes = encode_png(&picture).unwrap();
        assert!(is_our_png(&bytes));
        let mut foreign = Vec::new();
        picture.write_to(&mut std::io::Cursor::new(&mut foreign), image::ImageFormat::Png).unwrap();
        assert!(!is_our_png(&foreign) && !is_our_png(&bytes[..40]) && !is_our_png(b""));
    }
}
