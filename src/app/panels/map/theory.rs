//! Predictions of the formulas for one reflector, drawn over a map with their numbers.

use super::clear::clear_patch;
use super::frame::Frame;
use crate::app::widgets::{angle_degrees, edged, plain, signed};
use crate::radar::Decibels;
use crate::scene::Reflector;
use crate::theory::overlay::STREAK_DEPTH;
use crate::theory::{Ellipse, MapPlace, Overlay, blob_cell};
use eframe::egui::{Color32, FontId, Painter, Pos2, Rect, Vec2, vec2};

/// The predictions to draw, and the position bound.
#[derive(Clone, Copy)]
pub struct Theory<'a> {
    pub name: &'a str,
    /// Blob, lobes, streak and comb of the reflector that the formulas predict for this map.
    pub overlay: &'a Overlay,
    pub reflector: Reflector,
    /// Ellipse of the position bound, where it is drawn.
    pub ellipse: Option<Ellipse>,
    pub listening: &'static str,
    /// Signal-to-noise ratio of a sample that the bound is for.
    pub snr: Decibels,
    /// Whether the comb of the two ends belongs on the map.
    pub comb: bool,
}

/// Colours of the drawn items and of their lines of text.
const BIN_COLOUR: Color32 = Color32::WHITE;
const BEAM: Color32 = Color32::from_rgb(120, 220, 255);
const LOBE_COLOUR: Color32 = Color32::from_rgb(255, 224, 100);
const STREAK_COLOUR: Color32 = Color32::from_rgb(255, 170, 90);
const COMB_COLOUR: Color32 = Color32::from_rgb(255, 140, 220);
const BOUND_COLOUR: Color32 = Color32::from_rgb(150, 255, 160);
const ALIAS_COLOUR: Color32 = Color32::from_rgb(205, 190, 255);

const TICK_LENGTH_POINTS: f32 = 7.0;
/// Least size of the drawn ellipse, points.
const MIN_ELLIPSE_POINTS: f32 = 9.0;
/// Least size of a map that has room for the numbers, points.
const MIN_NUMBERS_MAP_POINTS: Vec2 = vec2(250.0, 130.0);

/// Lines of numbers that are not crowded out by the marks of other reflectors.
const MAX_PRIORITY_LINES: usize = 4;

impl Theory<'_> {
    pub fn draw(&self, painter: &Painter, frame: Frame<'_>) {
        let Overlay { blob, streak, teeth, .. } = self.overlay;
        let at = |bin: f64, column: f64| {
            frame.cell(MapPlace { bin: blob.peak.bin + bin, column: blob.peak.column + column })
        };
        let path: Vec<Pos2> = streak.path.iter().map(|cell| frame.cell(*cell)).collect();
        line(painter, &path, frame.rect, STREAK_COLOUR);
        let [low, high] = streak.columns.map(|columns| columns as f64);
        let across: Vec<Pos2> = (0..=24).map(|i| at(0.0, -low + (low + high) * f64::from(i) / 24.0)).collect();
        let below: Vec<Pos2> = across.iter().map(|p| *p + vec2(0.0, 2.0 * TICK_LENGTH_POINTS)).collect();
        line(painter, &below, frame.rect, STREAK_COLOUR);
        for end in [below.first(), below.last()].into_iter().flatten() {
            tick(painter, *end, STREAK_COLOUR);
        }
        for (sign, lobe) in [-1.0, 1.0].into_iter().zip(blob.side_lobes) {
            lobe.into_iter().for_each(|lobe| tick(painter, at(0.0, sign * lobe.columns), LOBE_COLOUR));
        }
        line(painter, &self.half_power(frame), frame.rect, BEAM);
        if self.comb {
            teeth
                .iter()
                .for_each(|tooth| tick(painter, frame.cell(*tooth) + vec2(0.0, TICK_LENGTH_POINTS), COMB_COLOUR));
        }
        if let Some((outline, _)) = self.outline(frame) {
            line(painter, &outline, frame.rect, BOUND_COLOUR);
        }
    }

    /// Places on screen of the reflector's peak, its streak and the corners of its half-power box.
    fn places(&self, frame: Frame<'_>) -> Vec<Pos2> {
        let streak = self.overlay.streak.path.iter().map(|cell| frame.cell(*cell));
        std::iter::once(frame.cell(self.overlay.blob.peak)).chain(streak).chain(self.half_power(frame)).collect()
    }

    /// The half-power widths as a box around the peak, closed.
    fn half_power(&self, frame: Frame<'_>) -> Vec<Pos2> {
        let blob = &self.overlay.blob;
        let ([left, right], [near, far]) = (blob.columns, blob.bins);
        let corners = [(-near, -left), (-near, right), (far, right), (far, -left), (-near, -left)];
        let cell = |(bin, column): (f64, f64)| MapPlace { bin: blob.peak.bin + bin, column: blob.peak.column + column };
        corners.map(|corner| frame.cell(cell(corner))).to_vec()
    }

    /// The ellipse of the bound around the reflector's predicted place, and the factor by which it is drawn larger.
    fn outline(&self, frame: Frame<'_>) -> Option<(Vec<Pos2>, f64)> {
        let ellipse = self.ellipse?;
        let Reflector { x_metres, y_metres, .. } = self.reflector;
        let aperture = crate::maps::Aperture::Full;
        let cell = |x: f64, y: f64| frame.cell(blob_cell(frame.radar, x, y, aperture));
        let outline = |times: f64| -> Vec<Pos2> {
            let points = ellipse.outline(48).into_iter().map(|[x, y]| cell(x_metres + times * x, y_metres + times * y));
            let points: Vec<Pos2> = points.collect();
            points.iter().chain(points.first()).copied().collect()
        };
        let middle = cell(x_metres, y_metres);
        let reach = |times: f64| outline(times).iter().map(|p| p.distance(middle)).fold(0.0f32, f32::max);
        let round = |i: usize| [1.0, 2.0, 5.0][i % 3] * 10f64.powi(i as i32 / 3);
        let times = (0..=27).map(round).find(|times| reach(*times) > MIN_ELLIPSE_POINTS)?;
        Some((outline(times), times))
    }

    fn lines(&self, frame: Frame<'_>) -> Vec<(Color32, String)> {
        let radar = frame.radar;
        let Overlay { place, blob, streak, .. } = self.overlay;
        let bin_metres = radar.range_resolution_metres();
        let columns = blob.columns[0] + blob.columns[1];
        let along = length((blob.bins[0] + blob.bins[1]) * bin_metres);
        let column_cos = radar.fold_period_cos() / radar.elements as f64;
        let mut lines = vec![
            (Color32::WHITE, format!("Theory of {}, as a point", self.name)),
            (BIN_COLOUR, format!("range bin c/2B {}", length(bin_metres))),
            (BEAM, format!("half power {along} × {columns:.1} columns (cos θ {:.4})", columns * column_cos)),
        ];
        if let Some(lobe) = blob.side_lobes.iter().flatten().max_by(|a, b| a.level.0.total_cmp(&b.level.0)) {
            let level = plain(lobe.level.0, 1);
            lines.push((LOBE_COLOUR, format!("first side lobe {level} dB, {:.1} columns off", lobe.columns)));
        }
        let [across, along] = [streak.columns, streak.bins].map(|[low, high]| low + high + 1);
        lines.push((
            STREAK_COLOUR,
            format!("smeared over {across} columns and {along} bins (at −{:.0} dB)", STREAK_DEPTH.0),
        ));
        if self.comb {
            let spacing = crate::theory::comb::tooth_spacing_cos(radar, *place) / column_cos;
            lines.push((COMB_COLOUR, format!("comb of the two ends: a tooth every {spacing:.2} columns")));
        }
        if let (Some(ellipse), Some((_, times))) = (self.ellipse, self.outline(frame)) {
            let (minor, major) = (length(ellipse.minor_metres), length(ellipse.major_metres));
            let shown = if times > 1.0 { format!(", drawn × {times:.0}") } else { String::new() };
            lines.push((
                BOUND_COLOUR,
                format!("σ ≥ {minor} × {major} for {} at {:.0} dB{shown}", self.listening, self.snr.0),
            ));
        }
        // The longest line: the first that a small map leaves out.
        lines.push((ALIAS_COLOUR, self.aliases(frame)));
        lines
    }

    fn aliases(&self, frame: Frame<'_>) -> String {
        let Overlay { place, fold_partners, wrap_partners_metres, .. } = self.overlay;
        let max = frame.radar.max_range_metres();
        let wrapped =
            if place.range_metres >= max { format!(" (stands at {:.1} m)", place.range_metres) } else { String::new() };
        let ranges: Vec<String> = wrap_partners_metres.iter().map(|r| format!("{r:.1}")).collect();
        let told = |cos: &f64| format!("{}° (cos θ {})", signed(angle_degrees(*cos), 0), signed(*cos, 2));
        let folds: Vec<String> = fold_partners.iter().map(told).collect();
        let period = frame.radar.fold_period_cos();
        let folds = match folds.is_empty() {
            true => format!("no grating lobe (every {period:.2} in cos θ)"),
            false => format!("grating lobes at {}, every {period:.2} in cos θ", folds.join(", ")),
        };
        format!("same cell: {} m{wrapped}; {folds}", ranges.join(", "))
    }

    /// Writes the numbers in a corner, clear of the blob and, where there is room, of the `taken` places. Under the `pointer` only the name stays.
    pub fn tell(&self, painter: &Painter, frame: Frame<'_>, pointer: Option<Pos2>, taken: &[Pos2]) {
        let rect = frame.rect;
        if rect.width() < MIN_NUMBERS_MAP_POINTS.x || rect.height() < MIN_NUMBERS_MAP_POINTS.y {
            return;
        }
        let font = FontId::proportional(10.5);
        let layout = |(colour, text)| painter.layout(text, font.clone(), colour, rect.width() - 28.0);
        let galleys: Vec<_> = self.lines(frame).into_iter().map(layout).collect();
        let sizes: Vec<Vec2> = galleys.iter().map(|g| g.size()).collect();
        let own = self.places(frame);
        let apart = clear_patch(rect, &[own.as_slice(), taken].concat(), &sizes);
        let over = clear_patch(rect, &own, &sizes);
        let (mut patch, mut count) = if apart.1 < over.1.min(MAX_PRIORITY_LINES) { over } else { apart };
        if pointer.is_some_and(|p| patch.contains(p)) {
            // The pointer refers to the map beneath.
            count = 1;
            patch.set_height(sizes[0].y + 6.0);
        }
        painter.rect_filled(patch, 3.0, Color32::from_black_alpha(190));
        let mut at = patch.min + vec2(5.0, 3.0);
        for galley in galleys.into_iter().take(count) {
            let height = galley.size().y;
            painter.galley(at, galley, Color32::WHITE);
            at.y += height;
        }
    }
}

fn length(metres: f64) -> String {
    match metres {
        m if m >= 1.0 => format!("{m:.2} m"),
        m if m >= 0.01 => format!("{:.1} cm", m * 100.0),
        m if m >= 1e-4 => format!("{:.2} mm", m * 1e3),
        m => format!("{:.2} µm", m * 1e6),
    }
}

/// Draws a line over any picture, without the pieces that would cross the map where places wrap around.
fn line(painter: &Painter, points: &[Pos2], rect: Rect, colour: Color32) {
    let whole = points
        .windows(2)
        .filter(|p| (p[0].x - p[1].x).abs() < rect.width() / 2.0 && (p[0].y - p[1].y).abs() < rect.height() / 2.0);
    let segments: Vec<[Pos2; 2]> = whole.map(|p| [p[0], p[1]]).collect();
    edged([2.6, 1.2], colour, |stroke| segments.iter().for_each(|ends| _ = painter.line_segment(*ends, stroke)));
}

fn tick(painter: &Painter, at: Pos2, colour: Color32) {
    edged([2.6, 1.2], colour, |stroke| {
        painter.vline(at.x, at.y - TICK_LENGTH_POINTS..=at.y + TICK_LENGTH_POINTS, stroke)
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::state::{MapView, Projection};
    use crate::maps::{Aperture, angle_transform, range_transform};
    use crate::radar::Radar;
    use crate::signal::exact;
    use eframe::egui::pos2;

    const RECT: Rect = Rect { min: Pos2::ZERO, max: pos2(1280.0, 640.0) };

    fn frame(radar: &Radar) -> Frame<'_> {
        let view = MapView::default();
        Frame::of(RECT, view, radar, Projection::RangeAngle, 0.0)
    }

    fn theory<'a>(overlay: &'a Overlay, reflector: Reflector) -> Theory<'a> {
        let ellipse = Some(Ellipse { major_metres: 0.003, minor_metres: 0.0002, angle_radians: 0.3 });
        Theory {
            name: "middle of line 1",
            overlay,
            reflector,
            ellipse,
            listening: "the two ends",
            snr: Decibels(20.0),
            comb: true,
        }
    }

    /// A reflector and its overlay in the map of the whole array.
    fn of(radar: &Radar, x_metres: f64, y_metres: f64) -> (Reflector, Overlay) {
        let reflector = Reflector { x_metres, y_metres, reflectivity: 1.0 };
        (reflector, Overlay::of(radar, &reflector, Aperture::Full).unwrap())
    }

    #[test]
    fn the_box_is_drawn_around_what_the_map_has_above_half_power() {
        for (x_metres, y_metres) in [(0.6, 2.6), (-2.0, 3.0), (1.0, 9.0)] {
            let radar = Radar { elements: 128, samples: 64, ..Radar::default() };
            let (reflector, overlay) = of(&radar, x_metres, y_metres);
            let profiles = range_transform(&radar, &exact::beat_signal(&radar, &[reflector]));
            let map = angle_transform(&radar, &profiles, Aperture::Full).cells.mapv(|v| v.norm());
            let frame = frame(&radar);
            let drawn = theory(&overlay, reflector).half_power(frame);
            let within = Rect::from_points(&drawn);
            let ((bin, column), peak) = map.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            let pixel = |bin: usize, column: usize| {
                pos2((column as f32 + 0.5) * 10.0, RECT.bottom() - (bin as f32 + 0.5) * 10.0)
            };
            // The tolerance is half a cell of ten points.
            assert!(within.expand(5.0).contains(pixel(bin, column)), "the peak");
            for side in [-1, 1] {
                let columns = (1..40).map(|i| (column as i64 + side * i).rem_euclid(128) as usize);
                // A streak ripples beyond its first fall to half power.
                for c in columns {
                    let (part, at) = (map[[bin, c]] / peak, pixel(bin, c));
                    assert!(part < 0.75 || within.expand(5.0).contains(at), "column {c} at ({x_metres}, {y_metres})");
                    if part < 0.65 {
                        assert!(!within.shrink(5.0).contains(at), "column {c} at ({x_metres}, {y_metres})");
                        break;
                    }
                }
            }
        }
    }

    #[test]
    fn the_numbers_are_those_of_table_3_1_and_say_whose_they_are() {
        let radar = Radar::default();
        let (reflector, overlay) = of(&radar, 0.0, 20.0);
        let text: Vec<String> = theory(&overlay, reflector).lines(frame(&radar)).into_iter().map(|(_, t)| t).collect();
        let all = text.join("\n");
        // The comb of 1.04 columns at true directions is squinted with everything else.
        let lobes = ["c/2B 7.5 cm", "at −20 dB", "every 1.01 columns", "first side lobe −84.4 dB", "58.4"];
        let others = ["Theory of middle of line 1, as a point", "no grating lobe (every 2.05", "at 20 dB, drawn × "];
        for part in lobes.iter().chain(&others) {
            assert!(all.contains(*part), "{part} in:\n{all}");
        }
        let radar = Radar { carrier: crate::radar::Carrier::TwoWay, ..Radar::default() };
        let (reflector, overlay) = of(&radar, 10.0, 17.32);
        let told = theory(&overlay, reflector).aliases(frame(&radar));
        assert!(told.contains("grating lobes at −") && told.contains("° (cos θ −0."), "{told}");
    }

    #[test]
    fn the_numbers_leave_the_whole_blob_in_sight() {
        let radar = Radar::default();
        for (x_metres, y_metres) in [(0.0, 5.0), (-10.0, 5.0), (10.0, 25.0), (-20.0, 20.0)] {
            let (reflector, overlay) = of(&radar, x_metres, y_metres);
            let (theory, frame) = (theory(&overlay, reflector), frame(&radar));
            let lines = vec![vec2(330.0, 13.0); theory.lines(frame).len()];
            let (patch, count) = clear_patch(RECT, &theory.places(frame), &lines);
            assert!(count > 3, "{count} lines at ({x_metres}, {y_metres})");
            let hidden = theory.places(frame).into_iter().find(|p| patch.contains(*p));
            assert_eq!(hidden, None, "{patch:?} at ({x_metres}, {y_metres})");
        }
    }

    #[test]
    fn the_ellipse_is_drawn_large_enough_to_be_seen() {
        let radar = Radar::default();
        let (reflector, overlay) = of(&radar, 3.0, 20.0);
        let theory = theory(&overlay, reflector);
        let (outline, times) = theory.outline(frame(&radar)).unwrap();
        let size = Rect::from_points(&outline).size();
        assert!(size.max_elem() > MIN_ELLIPSE_POINTS && size.max_elem() < 5.1 * MIN_ELLIPSE_POINTS, "{size:?}");
        let leading = times / 10f64.powf(times.log10().floor());
        assert!(times >= 10.0 && [1.0, 2.0, 5.0].contains(&leading), "{times}");
    }
}
