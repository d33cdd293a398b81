//! Kinds of failure on a map: a mark for the verdict on every object and for every ghost, distinct by shape as well as by hue.

use super::frame::Frame;
use crate::app::jobs::{JudgedOutput, VerdictMark};
use crate::app::widgets::{axes, edged};
use crate::evaluate::eta_text;
use crate::evaluate::verdict::ObjectVerdict;
use crate::maps::Aperture;
use crate::radar::{Radar, counted};
use crate::scene::Reflector;
use crate::theory::{MapPlace, blob_cell};
use eframe::egui::{Align2, Color32, Painter, Pos2, Shape, Vec2, vec2};

/// Largest distance of the pointer from a mark to show its tooltip, points.
const MARK_REACH_POINTS: f32 = 10.0;

const MAX_KIND_MARKS: usize = 400;

/// Verdicts on all objects that the map should show.
#[derive(Clone, Copy)]
pub struct Kinds<'a> {
    pub judged: &'a JudgedOutput,
    /// Whether the verdicts are of the output on screen, and not of an earlier one.
    pub current: bool,
}

/// The shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sign {
    Found,
    /// A cross in a ring.
    Missed,
    /// Two rings that overlap; a line leads to the other object.
    Merged,
    /// A triangle that points to the object's place in the output.
    WrongTooth,
    /// Four corners of a square.
    Ghost,
    /// Three dots.
    Hidden,
}

impl Sign {
    /// All of them, in the order of a legend.
    pub const ALL: [Sign; 6] = [Sign::Found, Sign::Missed, Sign::Merged, Sign::WrongTooth, Sign::Ghost, Sign::Hidden];

    fn of(mark: &VerdictMark, judged: &JudgedOutput) -> Sign {
        let verdict = mark.object.and_then(|object| judged.verdicts.objects.get(object));
        match verdict {
            None => Sign::Ghost,
            Some(ObjectVerdict::Found) => Sign::Found,
            Some(ObjectVerdict::Missed) => Sign::Missed,
            Some(ObjectVerdict::Merged { .. }) => Sign::Merged,
            Some(ObjectVerdict::WrongTooth { .. }) => Sign::WrongTooth,
            Some(ObjectVerdict::Hidden) => Sign::Hidden,
        }
    }

    /// Name and colour of the kind. The colours are those of Okabe and Ito, which differ for the colour-blind, too.
    fn look(self) -> (&'static str, Color32) {
        match self {
            Sign::Found => ("found", Color32::from_rgb(86, 180, 233)),
            Sign::Missed => ("missed", Color32::from_rgb(255, 122, 60)),
            Sign::Merged => ("merged", Color32::from_rgb(240, 228, 66)),
            Sign::WrongTooth => ("wrong tooth", Color32::from_rgb(232, 150, 200)),
            Sign::Ghost => ("false alarm", Color32::WHITE),
            Sign::Hidden => ("hidden", Color32::from_gray(176)),
        }
    }

    /// The number of marks of the kind as text.
    pub fn counted(self, count: usize) -> String {
        let plural = if self == Sign::Ghost && count != 1 { "s" } else { "" };
        format!("{count} {}{plural}", self.look().0)
    }

    /// Lines of the mark around a place, as large as a ring around a reflector; `way` is the direction of a triangle.
    fn lines(self, at: Pos2, way: Vec2) -> Vec<Vec<Pos2>> {
        let ring = |centre: Pos2, radius: f32| -> Vec<Pos2> {
            (0..=20).map(|i| centre + radius * Vec2::angled(i as f32 * std::f32::consts::TAU / 20.0)).collect()
        };
        let path = |points: &[(f32, f32)]| points.iter().map(|&(x, y)| at + vec2(x, y)).collect::<Vec<_>>();
        match self {
            Sign::Found => vec![path(&[(-6.0, 0.0), (-2.0, 5.0), (6.5, -6.0)])],
            Sign::Missed => {
                vec![ring(at, 7.0), path(&[(-3.0, -3.0), (3.0, 3.0)]), path(&[(-3.0, 3.0), (3.0, -3.0)])]
            }
            Sign::Merged => vec![ring(at - vec2(3.5, 0.0), 5.5), ring(at + vec2(3.5, 0.0), 5.5)],
            Sign::WrongTooth => {
                let (way, side) = (8.0 * way, 6.0 * way.rot90());
                let back = at - 0.5 * way;
                vec![vec![at + way, back + side, back - side, at + way]]
            }
            Sign::Ghost => [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
                .into_iter()
                .map(|(x, y)| path(&[(3.0 * x, 7.0 * y), (7.0 * x, 7.0 * y), (7.0 * x, 3.0 * y)]))
                .collect(),
            Sign::Hidden => [-5.0, 0.0, 5.0].into_iter().map(|x| ring(at + vec2(x, 0.0), 1.0)).collect(),
        }
    }

    /// Draws the mark, with an edge that makes it readable over any picture.
    pub fn draw(self, painter: &Painter, at: Pos2, way: Vec2, current: bool) {
        let colour = if current { self.look().1 } else { Color32::from_gray(140) };
        edged([4.0, 1.8], colour, |stroke| {
            painter.extend(self.lines(at, way).into_iter().map(|line| Shape::line(line, stroke)));
        });
    }
}

impl Kinds<'_> {
    /// Number of marks of each kind that occurs.
    pub fn counts(&self) -> Vec<(Sign, usize)> {
        let signs: Vec<Sign> = self.judged.marks.iter().map(|v| Sign::of(v, self.judged)).collect();
        let count = |sign: Sign| (sign, signs.iter().filter(|s| **s == sign).count());
        Sign::ALL.into_iter().map(count).filter(|(_, count)| *count > 0).collect()
    }

    /// Draws the marks. The one under the pointer shows its object, the verdict and the reason.
    pub fn draw(&self, painter: &Painter, frame: Frame<'_>, pointer: Option<Pos2>, above: f32) {
        let mut nearest: Option<(&VerdictMark, f32)> = None;
        for mark in self.judged.marks.iter().take(MAX_KIND_MARKS) {
            let Some(at) = self.place(frame, mark) else { continue };
            self.draw_one(painter, frame, mark, at);
            let distance = pointer.map_or(f32::INFINITY, |p| p.distance(at));
            if distance < nearest.map_or(MARK_REACH_POINTS, |(_, d)| d) {
                nearest = Some((mark, distance));
            }
        }
        if let Some((mark, _)) = nearest {
            let corner = frame.rect.left_bottom() + vec2(8.0, -8.0 - above);
            axes::text_on_patch(painter, corner, Align2::LEFT_BOTTOM, &self.why(frame.radar, mark));
        }
    }

    fn draw_one(&self, painter: &Painter, frame: Frame<'_>, mark: &VerdictMark, at: Pos2) {
        let sign = Sign::of(mark, self.judged);
        let verdict = mark.object.and_then(|object| self.judged.verdicts.objects.get(object));
        let to = match verdict {
            Some(ObjectVerdict::Merged { with }) => self.centre(*with).map(|other| frame.blob(&other)),
            Some(ObjectVerdict::WrongTooth { columns }) => self.shifted(frame, mark, *columns),
            _ => None,
        };
        if let Some(to) = to {
            edged([3.0, 1.2], sign.look().1, |stroke| painter.line_segment([at, to], stroke));
        }
        let way = to.map_or(Vec2::ZERO, |to| (to - at).normalized());
        sign.draw(painter, at, if way == Vec2::ZERO { vec2(1.0, 0.0) } else { way }, self.current);
    }

    fn centre(&self, object: usize) -> Option<Reflector> {
        let [x_metres, y_metres] = self.judged.scene.objects.get(object)?.centre_metres();
        Some(Reflector { x_metres, y_metres, reflectivity: 1.0 })
    }

    /// Place of a mark: the object's place in the map, or the brightest cell of a body or a ghost.
    fn place(&self, frame: Frame<'_>, mark: &VerdictMark) -> Option<Pos2> {
        let is_body = |object: usize| self.judged.scene.objects.get(object).is_some_and(|o| o.body().is_some());
        let brightest = mark.brightest.map(|[bin, column]| MapPlace { bin: bin as f64, column: column as f64 });
        match (mark.object, brightest) {
            // A body has its echoes at its ends, its corners and its glint, and seldom at its middle.
            (Some(object), Some(cell)) if is_body(object) => Some(frame.cell(cell)),
            (Some(object), _) => self.centre(object).map(|centre| frame.blob(&centre)),
            (None, cell) => cell.map(|cell| frame.cell(cell)),
        }
    }

    /// Place of an object in the output, where that is on the wrong tooth.
    fn shifted(&self, frame: Frame<'_>, mark: &VerdictMark, columns: i32) -> Option<Pos2> {
        let centre = self.centre(mark.object?)?;
        let cell = blob_cell(frame.radar, centre.x_metres, centre.y_metres, Aperture::Full);
        Some(frame.cell(MapPlace { column: cell.column + f64::from(columns), ..cell }))
    }

    /// Text of a mark: its object, the verdict and the reason.
    fn why(&self, radar: &Radar, mark: &VerdictMark) -> String {
        let JudgedOutput { scene, verdicts, eta, .. } = self.judged;
        let eta = eta_text(*eta);
        let cells = mark.cells;
        let Some(index) = mark.object else {
            return format!(
                "false alarm: {} above η = {eta}\nwhere the scene has nothing",
                counted(cells, "cell", "cells")
            );
        };
        let unknown = |index: usize| format!("object {}", index + 1);
        let named = |index: usize| scene.objects.get(index).map_or_else(|| unknown(index), |o| o.called(index));
        let part = verdicts.covered.get(index).copied().unwrap_or(0.0);
        let of_what = match scene.objects.get(index).is_some_and(|object| object.body().is_some()) {
            true => "ends, corners and glints".to_owned(),
            false => format!("{cells} cells"),
        };
        let detected = format!("{:.0} % of its {of_what} exceed η = {eta}", 100.0 * part);
        let reason = match verdicts.objects.get(index).copied().unwrap_or(ObjectVerdict::Hidden) {
            ObjectVerdict::Found if cells == 0 => "the target itself does not show it, but the output does".to_owned(),
            ObjectVerdict::Found => detected,
            ObjectVerdict::Missed => format!("{detected}: less than half"),
            ObjectVerdict::Merged { with } => format!("one blob covers it and {};\nthe target shows two", named(with)),
            ObjectVerdict::WrongTooth { columns } => {
                let (by, way) = (columns.abs(), if (columns < 0) != radar.columns_fall() { "left" } else { "right" });
                let plural = if by == 1 { "" } else { "s" };
                format!("the output has it {by} column{plural} to the {way};\n{detected}")
            }
            ObjectVerdict::Hidden => "the target itself does not show it".to_owned(),
        };
        let verdict = verdicts.objects.get(index).map_or("hidden", |verdict| verdict.name());
        format!("{}: {verdict}\n{reason}", named(index))
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::app::state::{MapView, Projection};
    use crate::radar::Convention;
    use crate::scene::Scene;
    use eframe::egui::{Rect, pos2};

    /// Objects with one of each verdict, and a ghost.
    pub fn judged() -> JudgedOutput {
        use ObjectVerdict::{Found, Hidden, Merged, Missed, WrongTooth};
        let scene = Scene::of_points([(-8.0, 12.0), (-4.0, 16.0), (0.0, 20.0), (3.0, 24.0), (6.0, 28.0)]);
        let objects = [Found, Missed, Merged { with: 3 }, WrongTooth { columns: -3 }, Hidden];
        JudgedOutput::made_up(scene, &objects, &[[100, 300]])
    }

    #[test]
    fn every_kind_has_a_shape_of_its_own() {
        let of = |sign: Sign| sign.lines(pos2(0.0, 0.0), vec2(1.0, 0.0));
        for a in Sign::ALL {
            assert!(of(a).iter().flatten().all(|p| p.to_vec2().length() < 11.0), "{a:?} is no larger than a ring");
            for b in Sign::ALL {
                assert!(a == b || (of(a) != of(b) && a.look().1 != b.look().1), "{a:?} and {b:?}");
            }
        }
    }

    #[test]
    fn a_mark_says_the_reason_of_its_verdict() {
        let judged = judged();
        let kinds = Kinds { judged: &judged, current: true };
        let radar = Radar::default();
        let said: Vec<String> = judged.marks.iter().map(|v| kinds.why(&radar, v)).collect();
        assert_eq!(said[0], "point 1: found\n100 % of its 40 cells exceed η = 0.80");
        assert_eq!(said[1], "point 2: missed\n0 % of its 40 cells exceed η = 0.80: less than half");
        assert_eq!(said[2], "point 3: merged\none blob covers it and point 4;\nthe target shows two");
        assert!(said[3].starts_with("point 4: wrong tooth\nthe output has it 3 columns to the left;\n"), "{}", said[3]);
        let told = kinds.why(&radar.in_convention(Convention::Physical), &judged.marks[3]);
        assert!(told.contains("3 columns to the right"), "lower columns are drawn farther right: {told}");
        assert_eq!(said[4], "point 5: hidden\nthe target itself does not show it");
        assert_eq!(said[5], "false alarm: 12 cells above η = 0.80\nwhere the scene has nothing");
        assert_eq!(kinds.counts().len(), Sign::ALL.len(), "every kind is counted");
    }

    #[test]
    fn a_ghost_is_marked_at_its_brightest_cell() {
        let (judged, radar) = (judged(), Radar::default());
        let rect = Rect::from_min_size(pos2(0.0, 0.0), vec2(1024.0, 512.0));
        let (view, projection) = (MapView::default(), Projection::RangeAngle);
        let frame = Frame::of(rect, view, &radar, projection, 0.0);
        let ghost = Kinds { judged: &judged, current: true }.place(frame, &judged.marks[5]).unwrap();
        assert!((ghost - pos2(300.5, 512.0 - 100.5)).length() < 0.1, "{ghost:?}");
    }
}
