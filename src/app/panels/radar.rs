//! The radar panel: every constant of the radar, and its consequences.

mod antennas;
mod budget;
mod places;
mod strip;
mod table;

use crate::app::content::{Content, Cx};
use crate::app::state::{Command, RadarCommand, State};
use crate::app::widgets::{Quantity, headings, labelled, scrolled_both};
use crate::lesson::Step;
use crate::radar::{Carrier, Convention, Radar, WindowFunction, presets};
use crate::scene::Object;
use crate::theory::Consequences;
use eframe::egui::text::LayoutJob;
use eframe::egui::{ComboBox, Label, TextStyle, Ui};
use table::{Table, number};

/// Kinds of fields that can be edited.
#[derive(Clone, Copy)]
struct Free {
    constants: bool,
    ends: bool,
}

/// Remembers lesson and step of the challenge whose constant was scrolled into sight.
pub const PANEL: Content<Option<(String, usize)>> = Content { tells_answers: true, ..Content::drawn(draw) };

fn draw(ui: &mut Ui, cx: Cx<'_, Option<(String, usize)>>) -> Vec<Command> {
    let run = cx.state.lesson.as_ref().filter(|run| !run.is_predicting());
    let step = run.map(|run| (run.id.clone(), run.step));
    let is_new = std::mem::replace(cx.memory, step.clone()) != step;
    let sought = run.filter(|_| is_new).and_then(|run| solved_by(run.current()?));
    show(ui, cx.state, sought)
}

/// The constant or the group by which the challenge of a lesson's step is solved: the first that its solution changes.
fn solved_by(step: &Step) -> Option<&'static str> {
    let (before, after) = (&step.radar, step.challenge.as_ref()?.solution.radar.as_ref()?);
    let changes = [
        (CARRIER.name, before.carrier_hz != after.carrier_hz),
        (BANDWIDTH.name, before.bandwidth_hz != after.bandwidth_hz),
        (SAMPLES.name, before.samples != after.samples),
        (ELEMENTS.name, before.elements != after.elements),
        (END_ELEMENTS.name, before.end_elements != after.end_elements),
        (SPACING_MILLIMETRES.name, before.element_spacing_metres != after.element_spacing_metres),
        (POWER.name, before.transmit_power_watts != after.transmit_power_watts),
        (WINDOWS, before.window != after.window),
        (budget::HEADING, before.budget != after.budget),
    ];
    changes.into_iter().find(|(_, is_changed)| *is_changed).map(|(name, _)| name)
}

/// The selected object, where it is a single one and made of points.
fn selected(state: &State) -> Option<(String, Object)> {
    let index = state.editor.selection().single()?;
    let object = state.editor.scene().objects.get(index).filter(|o| o.body().is_none())?;
    let name = object.called(index);
    let name = if object.reflector_count() == 1 { name } else { format!("a reflector of {name}") };
    Some((name, object.clone()))
}

/// Draws the panel; `sought` is the constant or the group that is to be brought into sight.
pub fn show(ui: &mut Ui, state: &State, sought: Option<&'static str>) -> Vec<Command> {
    let recording = state.editor.document().recording();
    let has_all_elements = recording.is_some_and(|r| r.signal().is_some());
    let free = Free { constants: recording.is_none(), ends: recording.is_none() || has_all_elements };
    scrolled_both(ui, |ui, asked| {
        match free {
            Free { constants: true, .. } => preset(ui, state.radar(), asked),
            Free { ends: true, .. } => {
                _ = ui.weak("Recorded radar: only the size of the ends and the windows can be changed.")
            }
            _ => _ = ui.weak("Recorded radar, two ends alone: only the windows can be changed."),
        }
        ui.add_space(4.0);
        let mut radar = state.radar().clone();
        let follows = Consequences::of(&radar);
        let table = Table::that_fits(ui, NAMES, sought);
        table.show(ui, "radar", |ui| {
            if table.consequence_width.is_some() {
                headings(ui, ["Constant", "Value", "Consequence"].map(|heading| (heading, "")));
            }
            rows(ui, table, &mut radar, &follows, free);
        });
        strip::show(ui, &mut radar, free.constants);
        places::show(ui, &mut radar, free.constants);
        budget::show(ui, table, &mut radar, selected(state).as_ref());
        radar.end_elements = radar.end_elements.min(radar.most_end_elements());
        if radar != *state.radar() {
            asked.push(RadarCommand::Set(Box::new(radar)).into());
        }
    })
}

fn preset(ui: &mut Ui, radar: &Radar, asked: &mut Vec<Command>) {
    let chosen = presets::ALL.iter().find(|p| p.radar == *radar);
    ui.horizontal(|ui| {
        let name = chosen.map_or("a radar of your own", |p| p.name);
        let menu = |ui: &mut Ui| {
            ComboBox::from_id_salt("radar preset")
                .width(230.0)
                .selected_text(name)
                .show_ui(ui, |ui| {
                    for (index, preset) in presets::ALL.iter().enumerate() {
                        let is_chosen = chosen.is_some_and(|c| c.id == preset.id);
                        if ui.selectable_label(is_chosen, preset.name).on_hover_text(preset.about).clicked()
                            && !is_chosen
                        {
                            asked.push(RadarCommand::Preset(index).into());
                        }
                    }
                })
                .response
        };
        labelled(ui, "Start from", "Radars that are built, and radars that show what a constant does", menu);
    });
    // As many lines for every radar, so that the table below stays in place. The tooltip has the rest of a longer text.
    let about = chosen.map_or(OWN_RADAR_TEXT, |preset| preset.about);
    let (font, ink) = (TextStyle::Body.resolve(ui.style()), ui.visuals().weak_text_color());
    let mut lines = LayoutJob::simple(about.to_owned(), font, ink, f32::INFINITY);
    lines.wrap.max_rows = DESCRIPTION_LINES;
    ui.scope(|ui| {
        ui.set_min_height(DESCRIPTION_LINES as f32 * ui.text_style_height(&TextStyle::Body) + 2.0);
        ui.add(Label::new(lines).wrap());
    });
}

const DESCRIPTION_LINES: usize = 2;

const OWN_RADAR_TEXT: &str = "Its constants are those of no radar in the list.";

const CARRIER: Quantity = Quantity::metres(
    "carrier",
    "Frequency at which the chirp begins (half of it in the thesis' convention): with the spacing it decides how wide beams are",
)
.with(" GHz", [0.1, 1000.0], 0.05, 3);
const BANDWIDTH: Quantity =
    Quantity::metres("bandwidth", "How far a chirp sweeps. A range bin is the speed of light over twice the bandwidth")
        .with(" MHz", [1.0, 20_000.0], 2.0, 1);
const SAMPLES: Quantity =
    Quantity::metres("samples", "Samples of a chirp, and range bins of a map").with("", [1.0, 2048.0], 1.0, 0);
const ELEMENTS: Quantity =
    Quantity::metres("elements", "Elements of the whole array, and columns of a map").with("", [6.0, 2048.0], 1.0, 0);
const END_ELEMENTS: Quantity = Quantity::metres(
    "elements of an end",
    "Elements of each of the two ends that a reconstruction may look at",
)
.with("", [3.0, 1024.0], 0.1, 0);
const SPACING_MILLIMETRES: Quantity =
    Quantity::metres("spacing", "Distance between neighbouring elements").with(" mm", [0.01, 1000.0], 0.01, 3);
const SPACING_WAVELENGTHS: Quantity = Quantity::metres(
    "spacing / λ",
    "Above half a wavelength (a quarter, for the two-way carrier) a direction has grating lobes",
)
.with(" λ", [0.01, 10.0], 0.005, 3);
const POWER: Quantity = Quantity::metres(
    "power",
    "Transmit power: with reflectivity and range it decides how strong an echo is",
)
.with(" W", [0.001, 100_000.0], 0.5, 3);

const WINDOWS: &str = "windows";

const NAMES: [&str; 14] = [
    CARRIER.name,
    BANDWIDTH.name,
    SAMPLES.name,
    ELEMENTS.name,
    END_ELEMENTS.name,
    SPACING_MILLIMETRES.name,
    SPACING_WAVELENGTHS.name,
    POWER.name,
    antennas::NAME,
    "convention",
    "phase",
    WINDOWS,
    "off the line",
    "range migration",
];

const NO_RANGE_TEXT: &str = "one sample has no range resolution";

fn rows(ui: &mut Ui, table: Table, radar: &mut Radar, follows: &Consequences, free: Free) {
    let is_free = free.constants;
    let wavelength = radar.wavelength_metres();
    let text = format!("wavelength {:.3} mm", wavelength * 1e3);
    number(ui, table, &CARRIER, (&mut radar.carrier_hz, 1e9), &text, is_free);
    let is_snapshot = radar.samples == 1;
    if is_snapshot && !is_free {
        table.row(ui, (BANDWIDTH.name, BANDWIDTH.tooltip), NO_RANGE_TEXT, |ui, _| ui.weak("not known"));
    } else {
        let bin = format!("range bin {}", metres(follows.range_bin_metres));
        let text = if is_snapshot { NO_RANGE_TEXT } else { &bin };
        number(ui, table, &BANDWIDTH, (&mut radar.bandwidth_hz, 1e6), text, is_free);
    }
    let text = match is_snapshot {
        true => "a snapshot: one range bin".to_owned(),
        false => format!("maximum range {}", metres(follows.max_range_metres)),
    };
    count(ui, table, &SAMPLES, &mut radar.samples, &text, is_free);
    let beam = follows.full_beam;
    let text = format!("beam {:.2}°, {:.2} columns", beam.radians.to_degrees(), beam.columns);
    let has_pairs = !radar.is_monostatic();
    count(ui, table, &ELEMENTS, &mut radar.elements, &text, is_free && !has_pairs);
    let beam = follows.end_beam;
    let text = format!("beam of an end {:.1}°, {:.0} columns", beam.radians.to_degrees(), beam.columns);
    count(ui, table, &END_ELEMENTS, &mut radar.end_elements, &text, free.ends);
    let far = metres(follows.full_far_field_metres);
    let text = format!("far field beyond {far}; of an end, {}", metres(follows.end_far_field_metres));
    let mut spacing = radar.element_spacing_metres;
    if number(ui, table, &SPACING_MILLIMETRES, (&mut spacing, 1e-3), &text, is_free)
        | number(ui, table, &SPACING_WAVELENGTHS, (&mut spacing, wavelength), &grating(follows), is_free)
    {
        *radar = radar.clone().with_spacing(spacing);
    }
    let text = format!("an echo from 10 m has amplitude {:.3}", radar.transmit_power_watts / 100.0);
    number(ui, table, &POWER, (&mut radar.transmit_power_watts, 1.0), &text, is_free);
    table.row(ui, (antennas::NAME, antennas::ANTENNAS_TOOLTIP), &antennas::follows(radar), |ui, label| {
        ui.add_enabled_ui(is_free, |ui| ui.vertical(|ui| antennas::choices(ui, radar, label)));
    });
    choices(ui, table, radar, follows, is_free);
}

fn count(ui: &mut Ui, table: Table, field: &Quantity, value: &mut usize, consequence: &str, is_free: bool) {
    let mut shown = *value as f64;
    number(ui, table, field, (&mut shown, 1.0), consequence, is_free);
    *value = shown as usize;
}

/// Text of the number of columns between a blob and its first grating lobe, and whether that lobe is visible.
fn grating(follows: &Consequences) -> String {
    let columns = follows.grating_columns;
    if follows.grating_cos < 2.0 {
        let cos = follows.grating_cos;
        format!("first grating lobe {columns:.0} columns away, cos θ {cos:.2}: some directions are indistinguishable")
    } else {
        "the first grating lobe is outside the visible directions".to_owned()
    }
}

/// Draws the choice of convention. Choosing one sets the element spacing that belongs to it.
fn convention(ui: &mut Ui, table: Table, radar: &mut Radar, is_free: bool) {
    let tooltip = "How the phases of echoes follow their ranges. Choosing a convention sets the phase and the spacing that belong to it";
    let own = radar.convention();
    let is_filled = radar.element_spacing_metres == radar.filled_spacing_metres();
    let squint = 100.0 * (radar.squint() - 1.0);
    let text = match is_filled {
        true if squint < 0.0 => format!("blobs stand {:.1} % nearer to broadside", -squint),
        true => format!("blobs stand {squint:.1} % farther from broadside"),
        false => format!("the spacing is another than its own, {:.3} mm", 1e3 * radar.filled_spacing_metres()),
    };
    table.row(ui, ("convention", tooltip), &text, |ui, label| {
        ui.add_enabled_ui(is_free, |ui| {
            ui.horizontal(|ui| {
                for convention in Convention::ALL {
                    let is_chosen = convention == own && is_filled;
                    let choice = ui.selectable_label(is_chosen, convention.name());
                    let choice = if convention == Convention::ALL[0] { choice.labelled_by(label) } else { choice };
                    if choice.clicked() && !is_chosen {
                        *radar = radar.clone().in_convention(convention);
                    }
                }
            });
        });
    });
}

fn choices(ui: &mut Ui, table: Table, radar: &mut Radar, follows: &Consequences, is_free: bool) {
    convention(ui, table, radar, is_free);
    let text = match radar.carrier {
        Carrier::OneWay => "one phase cycle per wavelength of range (the thesis' convention)".to_owned(),
        Carrier::TwoWay => {
            format!("two phase cycles per wavelength of range: cos θ repeats after {:.2}", follows.grating_cos)
        }
    };
    table.row(ui, ("phase", "How the carrier's phase follows the distance"), &text, |ui, label| {
        ui.add_enabled_ui(is_free, |ui| {
            ui.horizontal(|ui| {
                let first = ui.selectable_value(&mut radar.carrier, Carrier::OneWay, "one-way");
                first.labelled_by(label);
                ui.selectable_value(&mut radar.carrier, Carrier::TwoWay, "two-way");
            });
        });
    });
    let text = match follows.range_width_metres {
        Some(width) => format!("range resolution (−3 dB): {}", metres(width)),
        None => "no range resolution".to_owned(),
    };
    table.row(ui, (WINDOWS, "Weights of samples and elements in the two transforms"), &text, |ui, label| {
        // In pairs: all names in one row would push the consequences out of a narrow panel.
        ui.vertical(|ui| {
            for pair in WindowFunction::ALL.chunks(2) {
                ui.horizontal(|ui| {
                    for &window in pair {
                        let choice = ui.selectable_value(&mut radar.window, window, window.name());
                        if window == WindowFunction::ALL[0] {
                            choice.labelled_by(label);
                        }
                    }
                });
            }
        });
    });
    let tooltip = "Maps bring elements that stand off the array's line into phase towards the direction of each column. Else they take each for the \
                   nearest place on the line, and a bent array is out of focus";
    let text = match radar.focus_off_line {
        true => "maps focus elements that stand off the line",
        false => "maps take each element for the nearest place on the line",
    };
    table.row(ui, ("off the line", tooltip), text, |ui, label| {
        ui.checkbox(&mut radar.focus_off_line, "focus").labelled_by(label).on_hover_text(tooltip);
    });
    let tooltip = "How much a range differs between both sides of the array, at most";
    let text = format!("up to {:.1} bins from side to side; half with a common transmitter", follows.migration_bins);
    table.row(ui, ("range migration", tooltip), &text, |ui, label| _ = ui.label("").labelled_by(label));
}

fn metres(metres: f64) -> String {
    match metres {
        m if m < 1.0 => format!("{:.2} cm", m * 100.0),
        m if m < 1000.0 => format!("{m:.2} m"),
        m => format!("{:.2} km", m / 1000.0),
    }
}

#[cfg(test)]
mod tests;
