//! Pages of help in a window: keys, origin of the figures, about the program.

use crate::app::state::{Command, HelpPage, WindowCommand, listed, shortcuts};
use eframe::egui::{self, Align2, Context, Grid, Key, Modifiers, RichText, ScrollArea, Ui, vec2};

/// Pointer actions, and keys that are no command of the list: action and explanation.
const POINTER: &[[&str; 2]] = &[
    ["Drag in the scene", "Move an object; its handles stretch, turn and spread it"],
    ["Drag a blob in a map", "Move the reflector behind it"],
    ["Drag over empty ground", "Select what is in the box; in a map, pan"],
    ["Double-click", "Add a point in the scene; in a map, show all of it"],
    ["Scroll or pinch", "Zoom at the pointer"],
    ["Right button", "Pan the scene; a click opens a menu"],
    ["Tab, Shift+Tab", "Next control, previous control"],
    [
        "Arrow keys",
        "Move the selection, or the handle that has the focus, by a range bin; with Shift ten, with Alt a tenth",
    ],
    ["Arrow keys in a map, scene or cut", "Pan, while nothing is selected; with Ctrl at any time"],
    ["+ and − in a map, scene or cut", "Zoom"],
];

/// Origin of each figure: its name and explanation.
const FIGURES: &[[&str; 2]] = &[
    [
        "Λ, normalised",
        "A cell's magnitude on a logarithmic scale: by min-max, 0 at the map's smallest cell and 1 at its largest. The units of \
         colour bars change to decibels relative to the peak with D.",
    ],
    [
        "Target",
        "The map of all elements: samples simulated from the scene, Hann window, two transforms (README, ARCHITECTURE).",
    ],
    ["Output", "The chosen method's map, from the samples of the two ends alone. It never sees the target."],
    [
        "P_D, P_FA, SE",
        "Cells of the target above η' are to be detected. P_D is the part of them where the output exceeds η, P_FA the part of all others, \
         SE the sum of squared differences of Λ. `apertura evaluate` computes the same numbers.",
    ],
    [
        "Tables 4.1 to 4.3",
        "Means over the test sets of the thesis. Evaluation shows the printed values beside those of this program; the scenes come from seeds \
         and are the same everywhere.",
    ],
    [
        "Bounds",
        "The Cramér–Rao bound of the radar on screen, for the elements and the noise that are chosen in the panel.",
    ],
    ["Times", "Measured on this machine, a map alone, while it is computed; the panel Timing has the stages."],
    [
        "Failures",
        "Each row names set, seed, number and method, and its scene is made again from these when it is opened.",
    ],
];

pub fn show(ctx: &Context, page: Option<HelpPage>) -> Vec<Command> {
    let Some(page) = page else { return Vec::new() };
    let mut open = true;
    let room = ctx.content_rect().size() - vec2(60.0, 120.0);
    egui::Window::new(page.name())
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .anchor(Align2::CENTER_CENTER, [0.0, 0.0])
        .fixed_size(vec2(room.x.clamp(200.0, 620.0), room.y.clamp(120.0, 480.0)))
        .show(ctx, |ui| {
            ScrollArea::vertical().auto_shrink([false, true]).show(ui, |ui| match page {
                HelpPage::Keys => keys(ui),
                HelpPage::Figures => rows(ui, "figures", FIGURES.iter().map(|row| row.map(String::from))),
                HelpPage::About => about(ui),
            });
        });
    let escaped = ctx.input_mut(|i| i.consume_key(Modifiers::NONE, Key::Escape));
    if open && !escaped { Vec::new() } else { vec![WindowCommand::CloseHelp.into()] }
}

/// A table of two columns: term and explanation. Explanations wrap.
fn rows(ui: &mut Ui, name: &str, rows: impl Iterator<Item = [String; 2]>) {
    let left = (0.32 * ui.available_width()).clamp(90.0, 200.0);
    let right = (ui.available_width() - left - 24.0).max(80.0);
    Grid::new(name).num_columns(2).spacing([12.0, 6.0]).striped(true).show(ui, |ui| {
        for [title, told] in rows {
            for (text, width) in [(RichText::new(title).strong(), left), (RichText::new(told), right)] {
                ui.scope(|ui| {
                    ui.set_width(width);
                    ui.add(egui::Label::new(text).wrap());
                });
            }
            ui.end_row();
        }
    });
}

fn keys(ui: &mut Ui) {
    ui.heading("Pointer and arrows");
    rows(ui, "pointer", POINTER.iter().map(|row| row.map(String::from)));
    ui.add_space(8.0);
    ui.heading("Keys");
    let ctx = ui.ctx().clone();
    let with_key = listed().iter().filter_map(|entry| {
        let key = entry.key.filter(|key| shortcuts().iter().any(|(listed, _)| listed == key))?;
        Some([ctx.format_shortcut(&key), entry.name.to_string()])
    });
    rows(ui, "keys", with_key);
}

fn about(ui: &mut Ui) {
    ui.heading(format!("apertura {}", env!("CARGO_PKG_VERSION")));
    ui.label(env!("CARGO_PKG_DESCRIPTION"));
    ui.label(format!("Licence: {}.", env!("CARGO_PKG_LICENSE")));
    ui.label(
        "A desktop program and a Rust library. README says how to begin, ARCHITECTURE how it is built, and `apertura --help` lists what the \
         command line does.",
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable, User};

    fn window(page: HelpPage, size: [f32; 2]) -> Harness<'static, Vec<Command>> {
        let mut window = seen::asking(size, move |ui| show(ui.ctx(), Some(page)));
        window.run_steps(4);
        window
    }

    #[test]
    fn every_page_is_readable_in_a_small_window_and_a_large_one() {
        for page in HelpPage::ALL {
            for size in [[512.0, 320.0], [1440.0, 900.0]] {
                let window = window(page, size);
                let texts = seen::texts(window.output());
                assert!(texts.iter().any(|t| t.text == page.name()), "{page:?}: {texts:?}");
                let wide = texts.iter().find(|t| t.rect.right() > t.clip.right() + 1.0);
                assert!(wide.is_none(), "{page:?} at {size:?}: {wide:?} is cut off");
            }
        }
    }

    #[test]
    fn a_command_is_listed_with_its_key_and_escape_closes_the_page() {
        let mut window = window(HelpPage::Keys, [900.0, 700.0]);
        assert!(window.query_by_label("Presentation").is_some() && window.query_by_label("F11").is_some());
        window.presses(&[Key::Escape]);
        assert!(window.state().contains(&WindowCommand::CloseHelp.into()));
    }
}
