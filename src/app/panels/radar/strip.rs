//! Drawing of transmitters, receivers and the elements that their pairs make, to one scale.
//!
//! The mouse drags an antenna along the line and off it. The arrow keys choose one, and Shift with an arrow moves it.

use crate::app::widgets::{Inks, keep_arrows};
use crate::radar::{Antennas, Radar};
use eframe::egui::{
    self, Align2, CursorIcon, Id, Key, Modifiers, Pos2, Rect, Response, Sense, Stroke, TextStyle, Ui, WidgetInfo, pos2,
    vec2,
};

const STRIP_HEIGHT_POINTS: f32 = 54.0;

const NAMES_WIDTH_POINTS: f32 = 84.0;

/// Room beside the antennas for dragging, as a part of the line on which they stand.
const MARGIN_PART: f64 = 0.15;

/// Largest distance of the pointer from an antenna, points.
const MAX_POINTER_DISTANCE_POINTS: f32 = 8.0;

/// Step of an antenna off the line, metres.
const FORWARD_STEP_METRES: f64 = 1e-3;

/// Pointer travel for such a step, points. The first step takes twice as much, so that a drag along the line stays on it.
const FORWARD_STEP_POINTS: f32 = 4.0;

/// Largest drawn distance of an antenna from its row's middle, points.
const FORWARD_POINTS: f64 = 5.0;

const ROW_NAMES: [&str; 3] = ["transmitters", "receivers", "elements"];

/// One antenna: a row, 0 the transmitters and 1 the receivers, and its number there.
type One = (usize, usize);

/// Places of the antennas, and the part of the line that is drawn.
#[derive(Clone)]
struct Drawn {
    rect: Rect,
    /// Places of transmitters and receivers along the line.
    x_metres: [Vec<f64>; 2],
    /// Distances of transmitters and receivers off the line.
    y_metres: [Vec<f64>; 2],
    /// Left and right edge of the drawing.
    span_metres: [f64; 2],
}

#[derive(Clone)]
struct Drag {
    radar: Radar,
    drawn: Drawn,
    one: One,
    from: Pos2,
}

impl Drawn {
    fn of(antennas: &Antennas, rect: Rect) -> Self {
        let [low, high] = antennas.span_metres();
        let beside = MARGIN_PART * (high - low);
        let x_metres = [antennas.transmitter_x_metres().to_vec(), antennas.receiver_x_metres().to_vec()];
        let y_metres = [antennas.transmitter_y_metres().to_vec(), antennas.receiver_y_metres().to_vec()];
        let rect = Rect::from_min_max(rect.min + vec2(NAMES_WIDTH_POINTS, 0.0), rect.max - vec2(6.0, 0.0));
        Drawn { rect, x_metres, y_metres, span_metres: [low - beside, high + beside] }
    }

    /// The antennas with one of them `along` metres farther to the right and `forward` metres nearer to the scene.
    fn moved(&self, (row, number): One, [along, forward]: [f64; 2]) -> Self {
        let mut moved = self.clone();
        if let Some(x) = moved.x_metres[row].get_mut(number) {
            *x += along;
        }
        if let Some(y) = moved.y_metres[row].get_mut(number).filter(|_| forward != 0.0) {
            // Whole steps bring an antenna back to the line exactly, to the bit.
            *y = ((*y + forward) / FORWARD_STEP_METRES).round() * FORWARD_STEP_METRES;
        }
        moved
    }

    fn antennas(&self) -> Option<Antennas> {
        let antennas = Antennas::new(&self.x_metres[0], &self.x_metres[1]).ok()?;
        antennas.off_line(&self.y_metres[0], &self.y_metres[1]).ok()
    }

    fn metres_per_point(&self) -> f64 {
        (self.span_metres[1] - self.span_metres[0]) / f64::from(self.rect.width().max(1.0))
    }

    /// Place on screen in a row; `forward` is the distance off the line, as a part of the largest.
    fn at(&self, row: usize, x_metres: f64, forward: f64) -> Pos2 {
        let along = ((x_metres - self.span_metres[0]) / self.metres_per_point()) as f32;
        let middle = STRIP_HEIGHT_POINTS * (row as f32 + 0.5) / ROW_NAMES.len() as f32;
        self.rect.min + vec2(along, middle - (FORWARD_POINTS * forward) as f32)
    }

    /// The antenna under the pointer.
    fn nearest(&self, pos: Pos2) -> Option<One> {
        let row = ((pos.y - self.rect.top()) / STRIP_HEIGHT_POINTS * ROW_NAMES.len() as f32).floor().max(0.0) as usize;
        let distances = self.x_metres.get(row)?.iter().map(|x| (self.at(row, *x, 0.0).x - pos.x).abs());
        let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.filter(|(_, distance)| *distance <= MAX_POINTER_DISTANCE_POINTS).map(|(number, _)| (row, number))
    }

    fn draw(&self, ui: &Ui, made: &Antennas, chosen: Option<One>) {
        let painter = ui.painter();
        let (ink, font) = (ui.visuals().text_color(), TextStyle::Small.resolve(ui.style()));
        let upright = |at: Pos2, half: f32, stroke: Stroke| painter.vline(at.x, at.y - half..=at.y + half, stroke);
        for (row, name) in ROW_NAMES.iter().enumerate() {
            let at = pos2(self.rect.left() - NAMES_WIDTH_POINTS, self.at(row, 0.0, 0.0).y);
            painter.text(at, Align2::LEFT_CENTER, name, font.clone(), ink);
        }
        // A straight line has nothing to divide by.
        let deepest = |y: f64| if y > 0.0 { y } else { 1.0 };
        let most = deepest(self.y_metres.iter().flatten().fold(0.0, |most: f64, y| most.max(y.abs())));
        for (row, places) in self.x_metres.iter().enumerate() {
            for (number, x) in places.iter().enumerate() {
                let at = self.at(row, *x, self.y_metres[row].get(number).map_or(0.0, |y| y / most));
                match chosen == Some((row, number)) {
                    true => upright(at, 8.0, Stroke::new(3.0, Inks::of(ui.visuals()).selected)),
                    false => upright(at, 6.0, Stroke::new(1.4, ink)),
                };
            }
        }
        let most = deepest(made.depth_metres().into_iter().fold(0.0, |most: f64, y| most.max(y.abs())));
        // The array's middle is at x = 0; the drawing stays where it was when a drag began.
        let shift = self.x_metres[0].first().zip(made.transmitter_x_metres().first()).map_or(0.0, |(a, b)| a - b);
        let middle = (made.pairs().len() as f64 - 1.0) / 2.0;
        for (n, pair) in made.pairs().iter().enumerate() {
            let forward = made.pair(n).map_or(0.0, |pair| pair.forward_metres());
            let at = self.at(2, (n as f64 - middle) * made.spacing_metres() + shift, forward / most);
            match pair {
                Some(_) => _ = upright(at, 5.0, Stroke::new(1.2, ink)),
                None => _ = painter.circle_filled(at, 1.0, ui.visuals().weak_text_color()),
            }
        }
    }
}

/// Step of an antenna along the line, metres: two spacings of the filled array, which move its elements by one.
fn step_metres(radar: &Radar) -> f64 {
    let times = radar.element_spacing_metres / radar.filled_spacing_metres();
    let on_filled = times > 0.5 && (times - times.round()).abs() < 1e-6 * times;
    2.0 * if on_filled { radar.filled_spacing_metres() } else { radar.element_spacing_metres }
}

/// Draws the antennas of `radar`, if it has some, and moves one where it is dragged.
pub(super) fn show(ui: &mut Ui, radar: &mut Radar, is_free: bool) {
    let Some(antennas) = radar.antennas.clone() else {
        return;
    };
    let sense = if is_free { Sense::click_and_drag() } else { Sense::hover() };
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width().min(560.0), STRIP_HEIGHT_POINTS), sense);
    response.widget_info(|| WidgetInfo::labeled(egui::Role::Image, is_free, "Antennas"));
    let chosen = ui.data(|d| d.get_temp::<One>(response.id.with("chosen")));
    let at_rest = Drawn::of(&antennas, rect);
    let in_progress = if is_free { drag(ui, &response, radar, &at_rest) } else { None };
    let (drawn, asked) = match in_progress {
        Some(drag) => dragged_to(&response, drag),
        None => {
            let moved = if is_free { by_keys(ui, &response, &at_rest, step_metres(radar)) } else { None };
            tell(response, &antennas, is_free);
            let asked = moved.and_then(|moved| Some(radar.clone().with_antennas(moved.antennas()?)));
            (at_rest, asked)
        }
    };
    let made = asked.as_ref().and_then(|radar| radar.antennas.as_ref()).unwrap_or(&antennas);
    drawn.draw(ui, made, chosen.filter(|_| is_free));
    if let Some(asked) = asked {
        *radar = asked;
    }
}

/// Sets the tooltip of the drawing: the places of the antennas, and how they are dragged.
fn tell(response: Response, antennas: &Antennas, is_free: bool) {
    let [low, high] = antennas.span_metres();
    let how =
        " Drag a transmitter or a receiver along the line, or up towards the scene and down; undo brings it back.";
    let how = if is_free { how } else { "" };
    let [hind, fore] = antennas.depth_metres();
    let depth = match antennas.is_on_line() {
        true => String::new(),
        false => format!(", {:.1} to {:.1} mm off the line towards the scene", hind * 1e3, fore * 1e3),
    };
    response.on_hover_text(format!("From {:.1} to {:.1} mm along x{depth}.{how}", low * 1e3, high * 1e3));
}

/// The drag in progress. A press on an antenna begins one; a click chooses the antenna.
fn drag(ui: &Ui, response: &Response, radar: &Radar, drawn: &Drawn) -> Option<Drag> {
    let (id, chosen) = (response.id.with("drag"), response.id.with("chosen"));
    let under = |pos: Pos2| drawn.nearest(pos);
    if response.hover_pos().and_then(under).is_some() {
        ui.set_cursor_icon(CursorIcon::Move);
    }
    if let Some(one) = response.interact_pointer_pos().filter(|_| response.clicked()).and_then(under) {
        ui.data_mut(|d| d.insert_temp(chosen, one));
        response.request_focus();
    }
    if response.drag_started() {
        let from = ui.input(|i| i.pointer.press_origin());
        if let Some((from, one)) = from.and_then(|from| Some((from, under(from)?))) {
            let drag = Drag { radar: radar.clone(), drawn: drawn.clone(), one, from };
            ui.data_mut(|d| {
                d.insert_temp(id, drag);
                d.insert_temp(chosen, one);
            });
        }
    }
    if !response.dragged() {
        ui.data_mut(|d| d.remove::<Drag>(id));
    }
    ui.data(|d| d.get_temp::<Drag>(id))
}

/// The antennas where a drag has moved them, and the radar that they make. Antennas that make no array stay where they were.
fn dragged_to(response: &Response, drag: Drag) -> (Drawn, Option<Radar>) {
    let moved = response.interact_pointer_pos().map_or(vec2(0.0, 0.0), |at| at - drag.from);
    let metres = f64::from(moved.x) * drag.drawn.metres_per_point();
    let step_metres = step_metres(&drag.radar);
    let steps = -moved.y / FORWARD_STEP_POINTS;
    let forward = f64::from((steps - steps.clamp(-1.0, 1.0)).round()) * FORWARD_STEP_METRES;
    let moved = drag.drawn.moved(drag.one, [(metres / step_metres).round() * step_metres, forward]);
    match moved.antennas() {
        Some(antennas) => (moved, Some(drag.radar.with_antennas(antennas))),
        None => (drag.drawn, Some(drag.radar)),
    }
}

/// Handles the arrow keys: an arrow chooses an antenna, Shift with an arrow moves it. Returns the antennas once one has moved.
fn by_keys(ui: &Ui, response: &Response, drawn: &Drawn, step_metres: f64) -> Option<Drawn> {
    if !response.has_focus() {
        return None;
    }
    keep_arrows(response, [true; 2]);
    let id: Id = response.id.with("chosen");
    let (row, number) = ui.data(|d| d.get_temp::<One>(id)).unwrap_or_default();
    let pressed = |with, key| ui.input_mut(|i| i.count_and_consume_key(with, key)) as f64;
    let steps = pressed(Modifiers::SHIFT, Key::ArrowRight) - pressed(Modifiers::SHIFT, Key::ArrowLeft);
    let forward = pressed(Modifiers::SHIFT, Key::ArrowUp) - pressed(Modifiers::SHIFT, Key::ArrowDown);
    let along = pressed(Modifiers::NONE, Key::ArrowRight) - pressed(Modifiers::NONE, Key::ArrowLeft);
    let row = match pressed(Modifiers::NONE, Key::ArrowDown) - pressed(Modifiers::NONE, Key::ArrowUp) {
        0.0 => row,
        down => usize::from(down > 0.0),
    };
    let last = drawn.x_metres[row].len().saturating_sub(1) as f64;
    let one = (row, (number as f64 + along).clamp(0.0, last) as usize);
    ui.data_mut(|d| d.insert_temp(id, one));
    (steps != 0.0 || forward != 0.0).then(|| drawn.moved(one, [steps * step_metres, forward * FORWARD_STEP_METRES]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    fn panel() -> Harness<'static, Radar> {
        let radar = Radar { elements: 6, ..Radar::default() }.of_pairs(3, 4).unwrap();
        let draw = |ui: &mut Ui, radar: &mut Radar| show(ui, radar, true);
        let mut panel = Harness::builder().with_size([600.0, 80.0]).build_ui_state(draw, radar);
        panel.run();
        panel
    }

    fn at(panel: &Harness<'_, Radar>, (row, number): One) -> Pos2 {
        let rect = panel.get_by_label("Antennas").rect();
        let drawn = Drawn::of(panel.state().antennas.as_ref().unwrap(), rect);
        drawn.at(row, drawn.x_metres[row][number], 0.0)
    }

    /// The panel while one antenna is held, the radar before, and the place of the antenna.
    fn held(one: One) -> (Harness<'static, Radar>, Radar, Pos2) {
        let mut panel = panel();
        let (before, at) = (panel.state().clone(), at(&panel, one));
        panel.drag_at(at);
        panel.run();
        (panel, before, at)
    }

    fn move_to(panel: &mut Harness<'_, Radar>, at: Pos2) {
        panel.hover_at(at);
        panel.run();
    }

    fn assert_it_goes_back(mut panel: Harness<'_, Radar>, at: Pos2, before: &Radar) {
        move_to(&mut panel, at);
        panel.drop_at(at);
        panel.run();
        assert_eq!(panel.state(), before);
        seen::assert_readable(panel.output());
    }

    #[test]
    fn a_transmitter_that_is_dragged_leaves_a_gap() {
        let (mut panel, before, last) = held((0, 2));
        move_to(&mut panel, last + vec2(30.0, 0.0));
        let steps = (panel.state().antennas.as_ref().unwrap().gaps(), panel.state().elements);
        assert!(steps.0 > 0 && steps.1 > 12, "{steps:?}");
        move_to(&mut panel, last - vec2(60.0, 0.0));
        assert!(panel.state().end_elements < before.end_elements, "fewer elements have shorter ends");
        assert_it_goes_back(panel, last, &before);
    }

    #[test]
    fn a_receiver_that_is_dragged_up_stands_nearer_to_the_scene() {
        let (mut panel, before, third) = held((1, 2));
        move_to(&mut panel, third + vec2(0.0, FORWARD_STEP_POINTS));
        assert_eq!(*panel.state(), before, "a hand that trembles bends nothing");
        move_to(&mut panel, third - vec2(0.0, 4.0 * FORWARD_STEP_POINTS));
        let antennas = panel.state().antennas.clone().unwrap();
        let expected = [0.0, 0.0, 3.0 * FORWARD_STEP_METRES, 0.0];
        let x_metres = before.antennas.as_ref().unwrap().receiver_x_metres();
        assert_eq!((antennas.receiver_y_metres(), antennas.receiver_x_metres()), (&expected[..], x_metres));
        assert_it_goes_back(panel, third, &before);
    }

    #[test]
    fn shift_with_an_arrow_moves_the_chosen_antenna() {
        let mut panel = panel();
        panel.get_by_label("Antennas").focus();
        panel.run();
        for _ in 0..2 {
            panel.key_press_modifiers(Modifiers::SHIFT, Key::ArrowUp);
            panel.run();
        }
        assert_eq!(panel.state().antennas.as_ref().unwrap().transmitter_y_metres(), [0.002, 0.0, 0.0]);
        panel.presses(&[Key::ArrowDown, Key::ArrowRight, Key::ArrowRight, Key::ArrowRight]);
        let before = panel.state().antennas.clone().unwrap();
        panel.key_press_modifiers(Modifiers::SHIFT, Key::ArrowRight);
        panel.run();
        let after = panel.state().antennas.clone().unwrap();
        let apart = |a: &Antennas| a.receiver_x_metres()[3] - a.receiver_x_metres()[2];
        let moved = apart(&after) - apart(&before);
        assert!((moved / (2.0 * panel.state().filled_spacing_metres()) - 1.0).abs() < 1e-9, "{moved}");
    }
}
