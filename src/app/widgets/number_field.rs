//! A field for a number to type or to drag. Every field of the window for a number is one.
//!
//! A typed number counts once Enter, Tab or a click elsewhere ends it. A wrong entry changes nothing: it stays in the field, in red, with a message about the
//! expected number beside it. After Enter the field keeps the focus, so that the next key goes to it.

use eframe::egui::{self, DragValue, Id, Key, Popup, PopupKind, RectAlign, Response, RichText, Ui, Widget, emath};
use std::cell::RefCell;
use std::ops::RangeInclusive;
use std::rc::Rc;

/// A bound of a range beyond this is not shown in messages.
const MAX_PRINTED_BOUND: f64 = 1e15;

/// The numbers that a field accepts.
#[derive(Debug, Clone, PartialEq)]
pub struct Wanted {
    pub range: RangeInclusive<f64>,
    /// Whether only whole numbers are accepted.
    pub is_whole: bool,
    /// Unit behind the number, with the space before it.
    pub unit: String,
}

impl Wanted {
    pub fn any() -> Self {
        Wanted { range: f64::NEG_INFINITY..=f64::INFINITY, is_whole: false, unit: String::new() }
    }

    /// Reads a typed number. A comma may stand for the decimal point, and the unit may follow.
    ///
    /// # Errors
    /// A sentence for the user with the error and the expected number.
    pub fn read(&self, text: &str) -> Result<f64, String> {
        let wrong = |what: &str| format!("{} {what}. {}", shortened(text), self.told());
        let letters: String =
            text.chars().filter(|c| !c.is_whitespace()).map(|c| if c == '−' { '-' } else { c }).collect();
        let unit: String = self.unit.chars().filter(|c| !c.is_whitespace()).collect();
        let (number, times) = match letters.strip_suffix(unit.as_str()) {
            Some(number) if !number.ends_with(char::is_alphabetic) => (number, 1.0),
            _ => in_other_unit(&letters, &unit).unwrap_or((letters.as_str(), 1.0)),
        };
        let number = match number.matches(',').count() == 1 && !number.contains('.') {
            true => number.replace(',', "."),
            false => number.to_owned(),
        };
        // The standard library also reads "nan" and "infinity".
        let is_number = number.chars().all(|c| c.is_ascii_digit() || "+-.eE".contains(c));
        let Some(value) = number.parse::<f64>().ok().filter(|_| is_number).map(|value| times * value) else {
            return Err(wrong("is not a number"));
        };
        if !value.is_finite() || !self.range.contains(&value) {
            return Err(wrong("is out of range"));
        }
        match self.is_whole && value.fract() != 0.0 {
            true => Err(wrong("is not a whole number")),
            false => Ok(value),
        }
    }

    fn told(&self) -> String {
        let number = if self.is_whole { "a whole number" } else { "a number" };
        let bound =
            |value: f64| Some(value).filter(|v| v.abs() < MAX_PRINTED_BOUND).map(|v| format!("{v}").replace('-', "−"));
        let unit = self.unit.trim();
        let unit = if unit.is_empty() || unit == "°" { unit.to_owned() } else { format!(" {unit}") };
        match (bound(*self.range.start()), bound(*self.range.end())) {
            (Some(low), Some(high)) => format!("Enter {number} from {low} to {high}{unit}."),
            (Some(low), None) => format!("Enter {number}, {low}{unit} or more."),
            (None, Some(high)) => format!("Enter {number}, {high}{unit} or less."),
            (None, None) => format!("Enter {number}."),
        }
    }
}

/// Units by quantity with their sizes. A number may be entered in another unit of the field's row.
const UNITS: [&[(&str, f64)]; 4] = [
    &[("km", 1e3), ("cm", 1e-2), ("mm", 1e-3), ("µm", 1e-6), ("m", 1.0)],
    &[("GHz", 1e9), ("MHz", 1e6), ("kHz", 1e3), ("Hz", 1.0)],
    &[("ms", 1e-3), ("µs", 1e-6), ("us", 1e-6), ("ns", 1e-9), ("s", 1.0)],
    &[("km/h", 1.0 / 3.6), ("cm/s", 1e-2), ("m/s", 1.0)],
];

/// The digits of a number in another unit of the quantity, and the size of that unit in the field's unit.
fn in_other_unit<'a>(letters: &'a str, unit: &str) -> Option<(&'a str, f64)> {
    let row = UNITS.iter().find(|row| row.iter().any(|(name, _)| *name == unit))?;
    let wanted = row.iter().find(|(name, _)| *name == unit)?.1;
    row.iter().find_map(|(name, size)| Some((letters.strip_suffix(name)?, size / wanted)))
}

/// The entry in quotation marks, cut to fit a message.
fn shortened(text: &str) -> String {
    let text = text.trim();
    match text.chars().count() > 24 {
        true => format!("“{}…”", text.chars().take(24).collect::<String>()),
        false if text.is_empty() => "Nothing".to_owned(),
        false => format!("“{text}”"),
    }
}

/// An entry that the field refused.
#[derive(Debug, Clone, PartialEq)]
struct Wrong {
    text: String,
    message: String,
    /// The value that the field kept. Another value drops the entry.
    kept: f64,
    /// The pass in which the field was last drawn. An entry of a field that went away is dropped.
    drawn: u64,
}

/// The shown text of a field, and the result of reading it.
#[derive(Default)]
struct Reading {
    shown: String,
    wrong: Option<(String, String)>,
    taken: bool,
}

/// A field for a number; a builder like [`DragValue`], which it draws.
#[must_use = "ui.add(field)"]
pub struct NumberField<'a> {
    drag: DragValue<'a>,
    /// The number before this frame.
    value: f64,
    wanted: Wanted,
    /// Text shown in place of the number.
    standing_for: Option<&'a str>,
}

impl<'a> NumberField<'a> {
    pub fn new<Num: emath::Numeric>(value: &'a mut Num) -> Self {
        let field = Self::from_get_set(move |new| {
            if let Some(new) = new {
                *value = Num::from_f64(new);
            }
            value.to_f64()
        });
        match Num::INTEGRAL {
            true => field.max_decimals(0).range(Num::MIN..=Num::MAX).speed(0.25),
            false => field,
        }
    }

    /// A field for a value that a function reads and writes.
    pub fn from_get_set(mut get_set: impl 'a + FnMut(Option<f64>) -> f64) -> Self {
        let value = get_set(None);
        let drag = DragValue::from_get_set(get_set).update_while_editing(false);
        NumberField { drag, value, wanted: Wanted::any(), standing_for: None }
    }

    /// Sets the accepted numbers; a drag stops at the ends.
    pub fn range<Num: emath::Numeric>(mut self, range: RangeInclusive<Num>) -> Self {
        self.wanted.range = range.start().to_f64()..=range.end().to_f64();
        self.drag = self.drag.range(range);
        self
    }

    /// Sets whether an existing value out of range is moved into it.
    pub fn clamp_existing_to_range(mut self, clamps: bool) -> Self {
        self.drag = self.drag.clamp_existing_to_range(clamps);
        self
    }

    /// Sets the change of the number for each point of a drag.
    pub fn speed(mut self, speed: f64) -> Self {
        self.drag = self.drag.speed(speed);
        self
    }

    pub fn min_decimals(mut self, decimals: usize) -> Self {
        self.drag = self.drag.min_decimals(decimals);
        self
    }

    /// Sets the most decimals shown; with 0 only whole numbers are accepted.
    pub fn max_decimals(mut self, decimals: usize) -> Self {
        (self.drag, self.wanted.is_whole) = (self.drag.max_decimals(decimals), decimals == 0);
        self
    }

    /// Sets the unit, with the space before it.
    pub fn suffix(mut self, unit: impl Into<String>) -> Self {
        self.wanted.unit = unit.into();
        self
    }

    /// Shows `text` in place of the number, until another is entered.
    pub fn standing_for(mut self, text: &'a str) -> Self {
        self.standing_for = Some(text);
        self
    }
}

impl Widget for NumberField<'_> {
    fn ui(self, ui: &mut Ui) -> Response {
        let id = ui.next_auto_id();
        let value = self.value;
        let before = wrong_of(ui, id, value);
        let reading = Rc::new(RefCell::new(Reading::default()));
        let unit = if self.standing_for.is_some() || before.is_some() { "" } else { self.wanted.unit.as_str() };
        let drag = self.drag.suffix(unit.to_owned());
        let (shows, text, formatter) =
            (reading.clone(), before.as_ref().map(|b| b.text.clone()), ui.style().number_formatter.clone());
        let drag = drag.custom_formatter(move |value, decimals| {
            let shown = text.clone().or(self.standing_for.map(str::to_owned));
            let shown = shown.unwrap_or_else(|| formatter.format(value, decimals));
            shows.borrow_mut().shown.clone_from(&shown);
            shown
        });
        let (reads, wanted, is_wrong) = (reading.clone(), self.wanted.clone(), before.is_some());
        let gave_up = was_given_up(ui, id);
        let drag = drag.custom_parser(move |text| {
            let mut reading = reads.borrow_mut();
            if gave_up {
                return None;
            }
            if !is_wrong && text == reading.shown {
                // An unedited text keeps the value's hidden decimals.
                return None;
            }
            let read = wanted.read(text);
            reading.taken |= read.is_ok();
            reading.wrong = read.as_ref().err().map(|message| (text.to_owned(), message.clone()));
            read.ok()
        });
        let ink = ui.visuals().override_text_color;
        if before.is_some() {
            ui.visuals_mut().override_text_color = Some(ui.visuals().error_fg_color);
        }
        let response = ui.add(drag);
        if before.is_some() {
            ui.visuals_mut().override_text_color = ink;
        }
        let reading = reading.take();
        keep(ui, id, value, before, reading, &response);
        if let Some(wrong) = wrong_of(ui, id, value) {
            tell(ui, &response, &wrong);
        }
        response
    }
}

fn key(id: Id) -> Id {
    id.with("wrong entry")
}

/// Whether Escape ended the entry in the last passes. egui reads the text once more in the next pass, as if the focus had gone elsewhere.
fn was_given_up(ui: &Ui, id: Id) -> bool {
    let pass = ui.ctx().cumulative_pass_nr();
    ui.data(|d| d.get_temp::<u64>(id.with("given up"))).is_some_and(|given_up| given_up + 2 >= pass)
}

/// The refused entry that is still in the field, if any.
fn wrong_of(ui: &Ui, id: Id, value: f64) -> Option<Wrong> {
    let pass = ui.ctx().cumulative_pass_nr();
    let wrong: Option<Wrong> = ui.data(|d| d.get_temp(key(id)));
    wrong.filter(|w| w.kept == value && w.drawn + 1 >= pass)
}

/// Keeps a refused entry for the next frame; drops it after an accepted entry, Escape or a drag.
fn keep(ui: &Ui, id: Id, kept: f64, before: Option<Wrong>, reading: Reading, response: &Response) {
    let drawn = ui.ctx().cumulative_pass_nr();
    let (escaped, entered) = ui.input(|i| (i.key_pressed(Key::Escape), i.key_pressed(Key::Enter)));
    let given_up = escaped && response.lost_focus();
    if given_up {
        ui.data_mut(|d| d.insert_temp(id.with("given up"), drawn));
    }
    let is_over = reading.taken || given_up || response.changed();
    let wrong = match reading.wrong {
        Some((text, message)) => {
            if entered {
                // The next typed text is meant for the field.
                response.request_focus();
            }
            Some(Wrong { text, message, kept, drawn })
        }
        None => before.clone().filter(|_| !is_over).map(|wrong| Wrong { drawn, ..wrong }),
    };
    let text = |wrong: &Option<Wrong>| wrong.as_ref().map(|w| w.text.clone());
    if text(&wrong) != text(&before) {
        // This frame still showed the earlier text.
        ui.request_repaint();
    }
    ui.data_mut(|d| match wrong {
        Some(wrong) => _ = d.insert_temp(key(id), wrong),
        None => d.remove::<Wrong>(key(id)),
    });
}

/// Shows the message beside the field, without moving other widgets.
fn tell(ui: &Ui, response: &Response, wrong: &Wrong) {
    if !ui.is_rect_visible(response.rect) {
        return;
    }
    let text =
        RichText::new(format!("{} Esc brings the number back.", wrong.message)).color(ui.visuals().error_fg_color);
    Popup::from_response(response)
        .id(response.id.with("what is wanted"))
        .kind(PopupKind::Tooltip)
        .open(true)
        .interactable(false)
        .align(RectAlign::RIGHT)
        .align_alternatives(&[RectAlign::BOTTOM_START, RectAlign::TOP_START])
        .close_behavior(egui::PopupCloseBehavior::IgnoreClicks)
        .width(260.0)
        .show(|ui| ui.add(egui::Label::new(text).wrap()));
}

#[cfg(test)]
mod tests;
