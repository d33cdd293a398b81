//! Random actions of a hand on the window.

use super::{FILES, Monkey};
use crate::session::*;
use eframe::egui::{MouseWheelSource, MouseWheelUnit, TouchPhase, Vec2};
use rand::seq::IndexedRandom;

const POINT: &str = "[[object]]\nkind = \"point\"\nx_metres = 1.0\ny_metres = 9.0\n";
const NO_POINT: &str = "[[object]]\nkind = \"point\"\nx_metres = nan\ny_metres = 1.0\n";

impl Monkey {
    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        *of.choose(&mut self.rng).expect("something to choose from")
    }

    fn place(&mut self) -> Pos2 {
        pos2(self.rng.random_range(0.0..1440.0), self.rng.random_range(0.0..900.0))
    }

    fn offset(&mut self) -> Vec2 {
        vec2(self.rng.random_range(-120.0..120.0), self.rng.random_range(-120.0..120.0))
    }

    pub fn act(&mut self) {
        match self.rng.random_range(0..14) {
            0 | 1 => self.drag(),
            2 => {
                let at = self.place();
                self.s.app.hover_at(at);
            }
            3 | 4 => self.click(),
            5 => {
                use Key::{ArrowLeft, ArrowUp, Backspace, Delete, Enter, Escape, F1, F7, R, Space, Tab, V};
                let keys = [ArrowUp, ArrowLeft, Delete, Tab, Enter, Escape, Backspace, Space, R, V, F1, F7];
                let key = self.pick(&keys);
                self.s.app.key_press(key);
            }
            6 => {
                let key = self.pick(&[Key::Z, Key::Y, Key::A, Key::D, Key::S, Key::K, Key::Num1, Key::Num3]);
                self.s.app.key_press_modifiers(Modifiers::COMMAND, key);
            }
            7 => {
                let text = self.pick(&["1", "2.5", "-", "1e400", "nan", "add", "line", "ü", "preset"]);
                self.s.app.event(Event::Text(text.to_owned()));
            }
            8 => {
                let text = self.pick(&[POINT, "not a scene", "", NO_POINT]);
                self.s.app.event(Event::Paste(text.to_owned()));
            }
            9 => self.scroll(),
            _ => {
                let command = self.command();
                self.s.app.state_mut().ask(command);
            }
        }
        self.s.app.step();
    }

    fn drag(&mut self) {
        let (from, by) = (self.place(), self.offset());
        self.s.app.hover_at(from);
        self.s.app.step();
        self.s.app.drag_at(from);
        self.s.app.step();
        for part in [0.3, 0.7, 1.0] {
            self.s.app.hover_at(from + by * part);
            self.s.app.step();
        }
        if self.rng.random_bool(0.1) {
            self.s.app.key_press(Key::Escape);
        }
        self.s.app.drop_at(from + by);
    }

    fn click(&mut self) {
        let at = self.place();
        let button = self.pick(&[PointerButton::Primary, PointerButton::Primary, PointerButton::Secondary]);
        for _ in 0..self.rng.random_range(1..3) {
            for pressed in [true, false] {
                let modifiers = self.pick(&[Modifiers::NONE, Modifiers::NONE, Modifiers::SHIFT]);
                self.s.app.event(Event::PointerMoved(at));
                self.s.app.event(Event::PointerButton { pos: at, button, pressed, modifiers });
                self.s.app.step();
            }
        }
    }

    fn scroll(&mut self) {
        let (at, delta) = (self.place(), vec2(0.0, self.rng.random_range(-60.0..60.0)));
        self.s.app.hover_at(at);
        let (unit, phase, modifiers) = (MouseWheelUnit::Point, TouchPhase::Move, Modifiers::NONE);
        let source = MouseWheelSource::Unknown;
        self.s.app.event(Event::MouseWheel { unit, delta, phase, source, modifiers });
    }

    fn command(&mut self) -> Command {
        let named = self.s.editor().document().path().is_some();
        let left: Vec<u64> = self.s.editor().left().iter().map(|d| d.id()).collect();
        let files = ["bad.toml", "missing.toml"].into_iter().chain(FILES).collect::<Vec<_>>();
        let (any, own) = (self.pick(&files), self.pick(&FILES));
        let floors = [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(20.0)), Floor::Level(DecibelMilliwatts(-20.0))];
        let normalisations = [Normalisation::MinMax, Normalisation::DynamicRange(Decibels(60.0))];
        let large = [Panel::Scene, Panel::Map(MapKind::Target), Panel::Cuts, Panel::Guide];
        match self.rng.random_range(0..22) {
            0 => DocumentCommand::New.into(),
            1..=3 => DocumentCommand::OpenPath(self.s.path(any)).into(),
            4..=6 if named => DocumentCommand::Save.into(),
            7 => DocumentCommand::SaveTo(self.s.path(own)).into(),
            8 => EditCommand::Undo.into(),
            9 => EditCommand::Redo.into(),
            10 => EditCommand::SelectAll.into(),
            11 => EditCommand::Duplicate.into(),
            12 => RadarCommand::SetCarrier(self.pick(&[Carrier::OneWay, Carrier::TwoWay])).into(),
            13 => RadarCommand::SetWindow(self.pick(&[WindowFunction::Hann, WindowFunction::Hamming])).into(),
            14 => EditCommand::SetNoiseSeed(self.rng.random_range(0..9)).into(),
            15 => ViewCommand::SetFloor(self.pick(&floors)).into(),
            16 => ViewCommand::Normalise(self.pick(&normalisations)).into(),
            17 => WindowCommand::TogglePanel(self.pick(&Panel::all())).into(),
            18 => WindowCommand::Maximise(self.pick(&large)).into(),
            19 => DocumentCommand::Recover(if left.is_empty() { 0 } else { self.pick(&left) }).into(),
            20 if self.rng.random_bool(0.5) => LessonCommand::Begin(0).into(),
            20 => LessonCommand::Leave.into(),
            _ => EditCommand::Add(self.pick(&NewObject::ALL), None).into(),
        }
    }
}
