//! The parts of an object that can be grabbed, and the effect of dragging each. Those of bodies are in [`super::body_grip`].
//!
//! ```text
//!     ↻  turn: the line turns about its middle; length and number kept
//!     |
//!     o  far end: more or fewer reflectors; direction and spacing kept
//!     :
//!     :◇ spacing: reflectors move apart, their number kept            ┌───────┐
//!     ●  body: moves the whole line                                   │   ●   ◇ spread in x
//!     :                                                               └───◇───┘
//!     o  near end: more or fewer reflectors, the far end stays          spread in y
//! ```

use super::{Grip, GripPlace, Place, body_grip};
use crate::scene::shape::extent;
use crate::scene::{Line, Object, Scene};

/// Most reflectors a line can be stretched to by hand.
pub const MAX_LINE_COUNT: usize = 2000;

const SPACING_GRIP_OFFSET_POINTS: f64 = 16.0;

/// Distance of the grip that turns a line from the line's far end, in points of the view.
const TURN_GRIP_OFFSET_POINTS: f64 = 26.0;

/// The grips of `object`, [`Grip::Body`] last, in a view where one point covers `metres_per_point`.
pub fn grips(object: &Object, metres_per_point: f64) -> Vec<GripPlace> {
    let at = |grip, x, y| GripPlace { grip, place: Place::new(x, y) };
    let body = GripPlace { grip: Grip::Body, place: object.centre_metres().into() };
    match object {
        Object::Point(_) => vec![body],
        Object::Line(l) => {
            let [x, y] = l.end_metres();
            let [spread_x, spread_y] = l.place_metres(0.75 * l.count.saturating_sub(1) as f64);
            // To the right of the line as it leads.
            let (sin, cos) = (l.direction_degrees - 90.0).to_radians().sin_cos();
            let beside = SPACING_GRIP_OFFSET_POINTS * metres_per_point;
            let (beyond, [along_x, along_y]) = (TURN_GRIP_OFFSET_POINTS * metres_per_point, along(l));
            vec![
                at(Grip::NearEnd, l.x_metres, l.y_start_metres),
                at(Grip::FarEnd, x, y),
                at(Grip::Spacing, spread_x + beside * cos, spread_y + beside * sin),
                at(Grip::Turn, x + beyond * along_x, y + beyond * along_y),
                body,
            ]
        }
        Object::Gaussian(g) => vec![
            at(Grip::SpreadX, g.x_metres + g.x_std_metres, g.y_metres),
            at(Grip::SpreadY, g.x_metres, g.y_metres + g.y_std_metres),
            body,
        ],
        Object::Wall(_) | Object::Box(_) | Object::Post(_) | Object::Polygon(_) => {
            let mut all = body_grip::grips(object, TURN_GRIP_OFFSET_POINTS * metres_per_point);
            all.push(body);
            all
        }
    }
}

/// `before` after `grip` is dragged to `to`.
pub fn move_grip(before: &Object, grip: Grip, to: Place) -> Object {
    let mut after = before.clone();
    match (&mut after, grip) {
        (_, Grip::Body) => {
            let centre = Place::from(before.centre_metres());
            after.translate(to.x_metres - centre.x_metres, to.y_metres - centre.y_metres);
        }
        (Object::Line(l), Grip::NearEnd) => {
            let far = Place::from(l.end_metres());
            stretch(l, -length_along(l, far, to));
            let [dx, dy] = l.step_metres();
            let steps = l.count.saturating_sub(1) as f64;
            (l.x_metres, l.y_start_metres) = (far.x_metres - steps * dx, far.y_metres - steps * dy);
        }
        (Object::Line(l), Grip::FarEnd) => {
            let length = length_along(l, Place::new(l.x_metres, l.y_start_metres), to);
            stretch(l, length);
        }
        (Object::Line(l), Grip::Turn) => turn(l, to),
        (Object::Line(l), Grip::Spacing) => {
            let steps = 0.75 * l.count.saturating_sub(1).max(1) as f64;
            let (sin, cos) = (l.direction_degrees - 90.0).to_radians().sin_cos();
            let along = (to.y_metres - l.y_start_metres) * cos - (to.x_metres - l.x_metres) * sin;
            l.spacing_metres = (along / steps).max(1e-3);
        }
        (Object::Gaussian(g), Grip::SpreadX) => g.x_std_metres = (to.x_metres - g.x_metres).abs(),
        (Object::Gaussian(g), Grip::SpreadY) => g.y_std_metres = (to.y_metres - g.y_metres).abs(),
        (body, grip) => body_grip::move_grip(body, grip, to),
    }
    after
}

/// The direction from a line's first reflector to its last, of length 1.
fn along(line: &Line) -> [f64; 2] {
    let sign = if line.spacing_metres < 0.0 { -1.0 } else { 1.0 };
    Line { spacing_metres: sign, ..line.clone() }.step_metres()
}

/// Length from `from` to `to` along the line, metres; negative against it.
fn length_along(line: &Line, from: Place, to: Place) -> f64 {
    let [x, y] = along(line);
    (to.x_metres - from.x_metres) * x + (to.y_metres - from.y_metres) * y
}

fn stretch(line: &mut Line, length_metres: f64) {
    if let Some(count) = count_over(length_metres, line.spacing_metres.abs()) {
        line.count = count;
    }
}

fn turn(line: &mut Line, to: Place) {
    let half_steps = line.count.saturating_sub(1) as f64 / 2.0;
    let [x, y] = line.place_metres(half_steps);
    let (dx, dy) = (to.x_metres - x, to.y_metres - y);
    if dx == 0.0 && dy == 0.0 {
        return;
    }
    let leads = 90.0 + (-dx).atan2(dy).to_degrees();
    line.direction_degrees = if line.spacing_metres < 0.0 { leads - 180.0 } else { leads };
    let [step_x, step_y] = line.step_metres();
    (line.x_metres, line.y_start_metres) = (x - half_steps * step_x, y - half_steps * step_y);
}

fn count_over(length: f64, spacing: f64) -> Option<usize> {
    let steps = (length / spacing).round();
    (spacing.abs() > 0.0 && steps.is_finite()).then(|| (steps.max(0.0) as usize + 1).min(MAX_LINE_COUNT))
}

/// Two opposite corners of the rectangle around an object.
fn corners(object: &Object) -> [[f64; 2]; 2] {
    match object {
        Object::Line(l) => [[l.x_metres, l.y_start_metres], l.end_metres()],
        Object::Gaussian(g) => {
            let (x, y) = (g.x_std_metres, g.y_std_metres);
            [[g.x_metres - x, g.y_metres - y], [g.x_metres + x, g.y_metres + y]]
        }
        other => other.body().map_or([other.centre_metres(); 2], |body| body.shape.extent().into()),
    }
}

pub(super) fn bounds(scene: &Scene) -> Option<(Place, Place)> {
    let corners = scene.objects.iter().flat_map(corners).filter(|[x, y]| x.is_finite() && y.is_finite());
    let corners: Vec<[f64; 2]> = corners.collect();
    let (low, high) = extent(&corners);
    (!corners.is_empty()).then(|| (low.into(), high.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::GaussianCluster;

    fn line() -> Object {
        Object::Line(Line::vertical(1.0, 10.0, 0.5, 11))
    }

    #[test]
    fn dragging_an_end_keeps_the_other() {
        let Object::Line(l) = move_grip(&line(), Grip::FarEnd, Place::new(1.0, 20.1)) else { panic!() };
        assert_eq!((l.count, l.y_start_metres, l.x_metres), (21, 10.0, 1.0));
        let Object::Line(l) = move_grip(&line(), Grip::NearEnd, Place::new(1.0, 12.6)) else { panic!() };
        assert_eq!((l.count, l.y_start_metres), (6, 12.5));
        let Object::Line(l) = move_grip(&line(), Grip::NearEnd, Place::new(1.0, 15.1)) else { panic!() };
        assert_eq!((l.count, l.y_start_metres), (1, 15.0), "a line keeps one reflector");
        let Object::Line(l) = move_grip(&line(), Grip::FarEnd, Place::new(1.0, 1e9)) else { panic!() };
        assert_eq!(l.count, MAX_LINE_COUNT);
    }

    fn is_at([x, y]: [f64; 2], wanted_x: f64, wanted_y: f64) -> bool {
        (x - wanted_x).hypot(y - wanted_y) < 1e-9
    }

    #[test]
    fn an_end_keeps_the_direction() {
        let Object::Line(l) = move_grip(&line(), Grip::FarEnd, Place::new(9.0, 12.0)) else { panic!() };
        assert_eq!((l.count, l.x_metres, l.direction_degrees), (5, 1.0, 90.0));
        let slanted = Object::Line(Line { direction_degrees: 0.0, ..Line::vertical(1.0, 10.0, 0.5, 11) });
        let Object::Line(l) = move_grip(&slanted, Grip::NearEnd, Place::new(-4.0, 17.0)) else { panic!() };
        assert!(is_at([l.x_metres, l.y_start_metres], -4.0, 10.0) && is_at(l.end_metres(), 6.0, 10.0), "{l:?}");
        let Object::Line(l) = move_grip(&slanted, Grip::FarEnd, Place::new(-4.0, 17.0)) else { panic!() };
        assert_eq!(l.count, 1, "behind the other end");
    }

    #[test]
    fn the_turning_grip_turns_the_line_about_its_middle() {
        let Object::Line(l) = move_grip(&line(), Grip::Turn, Place::new(9.0, 12.5)) else { panic!() };
        assert_eq!((l.count, l.spacing_metres), (11, 0.5));
        assert!(is_at([l.x_metres, l.y_start_metres], -1.5, 12.5) && is_at(l.end_metres(), 3.5, 12.5), "{l:?}");
        let turned = Object::Line(l);
        let Object::Line(back) = move_grip(&turned, Grip::Turn, Place::new(1.0, 99.0)) else { panic!() };
        assert_eq!(back.direction_degrees, 90.0, "exactly straight ahead");
        let Object::Line(spread) = move_grip(&turned, Grip::Spacing, Place::new(6.0, 9.0)) else { panic!() };
        assert!((spread.spacing_metres - 1.0).abs() < 1e-12, "{spread:?}");
    }

    #[test]
    fn the_turning_grip_stands_beyond_the_far_end() {
        for line in [line(), Object::Line(Line { spacing_metres: -0.5, ..Line::vertical(1.0, 15.0, 0.5, 11) })] {
            let handles = grips(&line, 0.1);
            let place = |grip| handles.iter().find(|g| g.grip == grip).unwrap().place;
            let (end, turn) = (place(Grip::FarEnd), place(Grip::Turn));
            let leads = end.y_metres - place(Grip::NearEnd).y_metres;
            let beyond = (turn.y_metres - end.y_metres) * leads.signum();
            assert!((beyond - 2.6).abs() < 1e-9 && (turn.x_metres - 1.0).abs() < 1e-9, "{end:?}, {turn:?}");
            let Object::Line(same) = move_grip(&line, Grip::Turn, turn) else { panic!() };
            assert!(is_at(same.end_metres(), end.x_metres, end.y_metres), "{same:?}");
        }
    }

    #[test]
    fn spacing_follows_its_grip() {
        let after = move_grip(&line(), Grip::Spacing, Place::new(1.0, 17.5));
        let Object::Line(l) = &after else { panic!() };
        assert_eq!((l.count, l.spacing_metres), (11, 1.0));
        let grip = grips(&after, 0.0).into_iter().find(|g| g.grip == Grip::Spacing).unwrap();
        assert_eq!(grip.place.y_metres, 17.5);
    }

    #[test]
    fn a_body_moves_whole() {
        let after = move_grip(&line(), Grip::Body, Place::new(0.0, 20.0));
        assert_eq!(after.centre_metres(), [0.0, 20.0]);
        assert_eq!(after.reflector_count(), 11);
    }

    #[test]
    fn spreads_are_never_negative() {
        let cluster = Object::Gaussian(GaussianCluster { seed: 1, ..GaussianCluster::new([0.0, 10.0], [1.0, 1.0], 5) });
        let Object::Gaussian(g) = move_grip(&cluster, Grip::SpreadX, Place::new(-2.0, 0.0)) else { panic!() };
        assert_eq!(g.x_std_metres, 2.0);
    }
}
