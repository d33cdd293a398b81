//! The guide panel: chapters on the maps, with buttons that set up their examples.

use crate::app::content::Content;
use crate::app::state::{
    Command, DocumentCommand, MapKind, Panel, Projection, RadarCommand, ViewCommand, WindowCommand,
};
use crate::app::widgets::{inline, padded};
use crate::maps::Normalisation;
use crate::radar::{Carrier, Decibels, WindowFunction};
use crate::scene::presets;
use crate::signal::Floor;
use eframe::egui::{self, ScrollArea, Ui};

/// The text: chapters that begin with a heading, in the order of [`CHAPTERS`].
const GUIDE_TEXT: &str = include_str!("../../../assets/guide.md");

type Step = (&'static str, fn() -> Vec<Command>);

/// The buttons below each chapter of the text.
const CHAPTERS: &[&[Step]] = &[
    &[("Open the street", || scene("street", thesis()))],
    &[
        ("One reflector at 20 m", || scene("one-at-20-m", thesis())),
        ("A tenth of a radian off", || scene("one-at-20-m-a-tenth-of-a-radian-off", thesis())),
    ],
    &[("Rings around four blobs", || {
        scene("four-reflectors", [thesis(), vec![ViewCommand::MarkReflectors.into()]].concat())
    })],
    &[
        ("Four reflectors, Hann", || scene("four-reflectors", window(WindowFunction::Hann))),
        ("No window", || scene("four-reflectors", window(WindowFunction::Rectangular))),
        ("Hamming", || scene("four-reflectors", window(WindowFunction::Hamming))),
    ],
    &[
        ("Points by a line", || scene("points-by-a-line", thesis())),
        ("A point behind a line", || scene("point-behind-a-line", thesis())),
    ],
    &[
        ("Two points, two bins apart", || scene("two-close-in-range", thesis())),
        ("Show the bounds", || open(Panel::Bounds)),
    ],
    &[
        ("One-way", || scene("four-reflectors", vec![RadarCommand::SetCarrier(Carrier::OneWay).into()])),
        ("Two-way", || scene("four-reflectors", vec![RadarCommand::SetCarrier(Carrier::TwoWay).into()])),
    ],
    &[
        ("Beyond the range", || scene("beyond-the-range", thesis())),
        ("The same, Cartesian", || {
            scene("beyond-the-range", vec![ViewCommand::SetProjection(Projection::Cartesian).into()])
        }),
    ],
    &[
        ("Thesis floor", || floor(Floor::Thesis, Normalisation::MinMax)),
        ("No floor", || floor(Floor::Exact, Normalisation::MinMax)),
        ("100 dB below the peak", || floor(Floor::Exact, Normalisation::DynamicRange(Decibels(100.0)))),
        ("SNR 20 dB", || floor(Floor::Snr(Decibels(20.0)), Normalisation::MinMax)),
    ],
    &[
        ("Difference", || scene("test-set-3", open(Panel::Map(MapKind::Difference)))),
        ("ROC", || open(Panel::Roc)),
        ("Tables", || open(Panel::Evaluation)),
    ],
    &[
        ("The failing U-Net", || output_by("unet")),
        ("The thesis' network", || output_by("thesis")),
        ("The live network", || output_by("live")),
        ("A search for reflectors", || output_by("hybrid")),
    ],
    &[
        ("Failures", || open(Panel::Failures)),
        ("live: missed", || failure("live-missed", "live")),
        ("live: merged", || failure("live-merged", "live")),
        ("live: false alarm", || failure("live-ghost", "live")),
        ("live: wrong tooth", || failure("live-wrong-tooth", "live")),
        ("hybrid: merged", || failure("hybrid-merged", "hybrid")),
        ("thesis: missed", || failure("thesis-missed", "thesis")),
        ("thesis: merged", || failure("thesis-merged", "thesis")),
        ("thesis: false alarm", || failure("thesis-ghost", "thesis")),
        ("thesis: wrong tooth", || failure("thesis-wrong-tooth", "thesis")),
        ("Compare two methods", || open(Panel::Compare)),
    ],
];

fn open(panel: Panel) -> Vec<Command> {
    vec![WindowCommand::OpenPanel(panel).into()]
}

/// Commands that open a preset, followed by `then`.
fn scene(id: &str, then: Vec<Command>) -> Vec<Command> {
    let Some(index) = presets::ALL.iter().position(|p| p.id == id) else { return then };
    // The chapters describe the default radar.
    let radar = (!presets::ALL[index].has_radar()).then(|| Command::Radar(RadarCommand::Set(Box::default())));
    let preset = Command::Document(DocumentCommand::Preset(index));
    [preset].into_iter().chain(radar).chain(then).collect()
}

/// Commands for a scene on which a method fails, with its output in sight and the kinds of failure marked.
fn failure(which: &str, method: &'static str) -> Vec<Command> {
    let mut then = thesis();
    then.extend(output_by(method));
    then.extend([Command::View(ViewCommand::SetMethodEta(method, None)), Command::View(ViewCommand::MarkKinds)]);
    scene(&format!("failure-{which}"), then)
}

fn output_by(method: &'static str) -> Vec<Command> {
    [open(Panel::Map(MapKind::Output)), vec![ViewCommand::Method(method).into()]].concat()
}

fn thesis() -> Vec<Command> {
    vec![
        Command::View(ViewCommand::SetFloor(Floor::Thesis)),
        Command::View(ViewCommand::Normalise(Normalisation::MinMax)),
        Command::Radar(RadarCommand::SetWindow(WindowFunction::Hann)),
        Command::Radar(RadarCommand::SetCarrier(Carrier::OneWay)),
    ]
}

/// Commands for a window without a floor, so that its side lobes are all there is to see.
fn window(window: WindowFunction) -> Vec<Command> {
    vec![
        Command::View(ViewCommand::SetFloor(Floor::Exact)),
        Command::View(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(100.0)))),
        Command::Radar(RadarCommand::SetWindow(window)),
    ]
}

fn floor(floor: Floor, normalisation: Normalisation) -> Vec<Command> {
    let commands = [ViewCommand::SetFloor(floor), ViewCommand::Normalise(normalisation)].map(Command::View);
    scene("one-at-20-m", commands.to_vec())
}

fn chapters() -> impl Iterator<Item = &'static str> {
    GUIDE_TEXT.split("\n## ")
}

fn heading(chapter: &str) -> &str {
    chapter.lines().next().unwrap_or_default().trim_start_matches('#').trim()
}

/// Remembers the number of the open chapter.
pub const PANEL: Content<usize> = Content::drawn(|ui, cx| show(ui, cx.memory));

pub fn show(ui: &mut Ui, open: &mut usize) -> Vec<Command> {
    padded(ui, |ui, asked| {
        turn(ui, open);
        ui.separator();
        let Some((chapter, steps)) = chapters().zip(CHAPTERS).nth(*open) else { return };
        // Each chapter keeps its own scroll position.
        let area = ScrollArea::vertical().id_salt(("chapter", *open)).auto_shrink([false, false]);
        area.show(ui, |ui| {
            ui.set_max_width(ui.available_width().min(620.0));
            ui.heading(heading(chapter));
            ui.label(inline(ui, chapter.split_once('\n').map_or("", |(_, text)| text), 1.0));
            ui.horizontal_wrapped(|ui| {
                for (label, commands) in *steps {
                    let button = ui.button(*label);
                    if button.on_hover_text("Set it up; undo brings your scene and your settings back").clicked() {
                        asked.push(Command::Guided(commands()));
                    }
                }
            });
        });
    })
}

fn turn(ui: &mut Ui, open: &mut usize) {
    let last = CHAPTERS.len().saturating_sub(1);
    *open = (*open).min(last);
    ui.horizontal(|ui| {
        if ui.add_enabled(*open > 0, egui::Button::new("Previous")).clicked() {
            *open -= 1;
        }
        if ui.add_enabled(*open < last, egui::Button::new("Next")).clicked() {
            *open += 1;
        }
        ui.weak(format!("{} of {}", *open + 1, CHAPTERS.len()));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.menu_button("Contents", |ui| {
                for (index, chapter) in chapters().enumerate() {
                    if ui.selectable_label(index == *open, heading(chapter)).clicked() {
                        *open = index;
                        ui.close();
                    }
                }
            });
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Harness, Queryable};

    #[test]
    fn a_button_asks_for_its_preset_and_its_conventions() {
        let mut guide = seen::asking_with([640.0, 2000.0], 3, show);
        guide.run();
        guide.get_by_role_and_label(egui::accesskit::Role::Button, "Hamming").click();
        guide.step();
        let steps = scene("four-reflectors", window(WindowFunction::Hamming));
        assert_eq!(guide.state().1, [Command::Guided(steps)]);
    }

    #[test]
    fn previous_next_and_contents_lead_to_every_chapter() {
        let draw = |ui: &mut Ui, open: &mut usize| _ = show(ui, open);
        let mut guide = Harness::builder().with_size([360.0, 600.0]).build_ui_state(draw, 0);
        let button = |guide: &mut Harness<'_, usize>, name: &str| {
            guide.get_by_role_and_label(egui::accesskit::Role::Button, name).click();
            guide.run();
        };
        let titles: Vec<&str> = chapters().map(heading).collect();
        assert!(titles.iter().all(|t| !t.is_empty()));
        button(&mut guide, "Previous");
        assert_eq!(*guide.state(), 0, "there is none before the first");
        for chapter in 1..titles.len() {
            button(&mut guide, "Next");
            assert_eq!(*guide.state(), chapter);
        }
        button(&mut guide, "Next");
        assert_eq!(*guide.state(), titles.len() - 1, "nor one after the last");
        button(&mut guide, "Contents");
        button(&mut guide, titles[2]);
        assert_eq!(*guide.state(), 2);
        button(&mut guide, "Previous");
        assert_eq!(*guide.state(), 1);
    }

    #[test]
    fn every_chapter_has_buttons_that_open_something_first() {
        assert_eq!(chapters().count(), CHAPTERS.len());
        for (chapter, steps) in chapters().zip(CHAPTERS) {
            assert!(chapter.lines().count() > 1 && !steps.is_empty(), "{chapter}");
            for (label, commands) in *steps {
                use Command::{Document, Window};
                let first = commands().into_iter().next();
                let opens =
                    matches!(first, Some(Document(DocumentCommand::Preset(_)) | Window(WindowCommand::OpenPanel(_))));
                assert!(opens, "{label}: a preset of that name");
            }
        }
    }
}
