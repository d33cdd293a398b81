//! The run-time panel: run time against error on this machine, drawn while it is measured.

use crate::app::content::{Content, Cx};
use crate::app::state::{Command, WorkCommand};
use crate::app::widgets::legend::{self, Entry, Sign};
use crate::app::widgets::{Axis, Chart, Tick, bar, choice, padded, scientific, start_or_cancel, warning};
use crate::benchmark::front::{Entrant, FrontRow, FrontTask};
use crate::radar::Radar;
use crate::signal::{Algorithm, Precision};
use eframe::egui::{self, Color32, Sense, Ui};
use egui_plot::{HLine, LineStyle, MarkerShape, Points};
use std::collections::BTreeSet;

/// Least error of the logarithmic axis; smaller ones are drawn there.
const MIN_DRAWN_ERROR: f64 = 1e-16;

/// The measurements, and the state of the current one.
pub struct Input<'a> {
    /// Radar of the measurements, or of the next one where there are none.
    pub radar: &'a Radar,
    /// Completed part of the measurement, 0 to 1, while it runs.
    pub progress: Option<f32>,
    pub rows: &'a [FrontRow],
    /// Time of one bare transform, milliseconds.
    pub bare_fft_ms: Option<f64>,
    /// Message of the last measurement, where it did not succeed.
    pub note: Option<&'a str>,
}

/// The chosen measurement, and the rows to draw.
#[derive(Default)]
pub struct RunTimeMemory {
    thorough: bool,
    /// Whether the rows of drags are drawn, and not those from scratch.
    drags: bool,
    /// Number of reflectors whose rows are drawn; all where `None`.
    reflectors: Option<usize>,
}

pub const PANEL: Content<RunTimeMemory> = Content::drawn(draw);

fn draw(ui: &mut Ui, cx: Cx<'_, RunTimeMemory>) -> Vec<Command> {
    let job = &cx.jobs.run_time;
    let input = Input {
        radar: job.plan().map_or(cx.state.radar(), |plan| &plan.radar),
        progress: job.progress(),
        rows: job.rows(),
        bare_fft_ms: job.end().copied(),
        note: job.note(),
    };
    show(ui, input, cx.memory)
}

pub fn show(ui: &mut Ui, input: Input<'_>, memory: &mut RunTimeMemory) -> Vec<Command> {
    padded(ui, |ui, asked| {
        ui.horizontal_wrapped(|ui| {
            let tip = "Time how long three maps take, and how wrong they are, by algorithm and precision; leave the \
                       machine alone meanwhile";
            let tips = [tip, "Stop after this measurement; what was measured stays"];
            let button = ("Measure", WorkCommand::CancelMeasurement);
            if start_or_cancel(ui, button, input.progress.is_some(), true, tips, asked) {
                memory.reflectors = None;
                asked.push(WorkCommand::Measure { thorough: memory.thorough }.into());
            }
            let thorough = egui::Checkbox::new(&mut memory.thorough, "thorough");
            ui.add_enabled(input.progress.is_none(), thorough)
                .on_hover_text("Every algorithm, up to 300 reflectors, drags too: about a minute instead of seconds");
            bar(ui, input.progress, 180.0);
        });
        let Radar { elements, samples, window, .. } = input.radar;
        ui.weak(format!("{elements} elements, {samples} samples, window {}", window.name()));
        warning(ui, input.note);
        if !input.rows.is_empty() {
            filter(ui, input.rows, memory);
            plot(ui, &input, memory);
        } else if input.progress.is_none() {
            ui.weak("Nothing measured yet.");
        }
    })
}

fn filter(ui: &mut Ui, rows: &[FrontRow], memory: &mut RunTimeMemory) {
    let counts: BTreeSet<usize> = rows.iter().map(|r| r.reflectors).collect();
    ui.horizontal_wrapped(|ui| {
        let text = |count: &Option<usize>| (count.map_or("all".to_owned(), |count| count.to_string()), "");
        let offered = std::iter::once(None).chain(counts.into_iter().map(Some));
        let tooltip = "Draw the measurements of so many reflectors";
        choice(ui, "Reflectors", tooltip, &mut memory.reflectors, offered, text);
        if rows.iter().any(|r| r.task == FrontTask::Drag) {
            ui.selectable_value(&mut memory.drags, false, "from scratch");
            ui.selectable_value(&mut memory.drags, true, "one dragged");
        } else {
            memory.drags = false;
        }
    });
}

fn colour(entrant: Entrant, dark: bool) -> Color32 {
    match entrant {
        Entrant::Planned if dark => Color32::from_rgb(225, 230, 238),
        Entrant::Planned => Color32::from_rgb(40, 46, 58),
        Entrant::Forced(Algorithm::Split) => Color32::from_rgb(64, 146, 246),
        Entrant::Forced(Algorithm::Gridded) => Color32::from_rgb(240, 130, 40),
        Entrant::Forced(Algorithm::ClosedForm) => Color32::from_rgb(230, 70, 90),
        Entrant::Forced(Algorithm::Exact) => Color32::from_rgb(60, 170, 90),
        Entrant::Forced(Algorithm::Direct) => Color32::from_rgb(180, 90, 200),
    }
}

struct Series {
    entry: Entry,
    /// Decimal logarithms of error and milliseconds.
    places: Vec<[f64; 2]>,
    is_planned: bool,
}

/// The drawn measurements, algorithm by algorithm.
fn series(rows: &[FrontRow], memory: &RunTimeMemory, dark: bool) -> Vec<Series> {
    let task = if memory.drags { FrontTask::Drag } else { FrontTask::Scratch };
    let drawn = |r: &&FrontRow| r.task == task && memory.reflectors.is_none_or(|count| count == r.reflectors);
    let shown: Vec<&FrontRow> = rows.iter().filter(drawn).collect();
    let place = |r: &&&FrontRow| [r.signal_error.max(MIN_DRAWN_ERROR).log10(), r.median_ms.log10()];
    let entrants = std::iter::once(Entrant::Planned).chain(Algorithm::ALL.map(Entrant::Forced));
    let each = entrants.flat_map(|entrant| [Precision::F32, Precision::F64].map(|precision| (entrant, precision)));
    let of = |(entrant, precision): (Entrant, Precision)| {
        let is_planned = entrant == Entrant::Planned;
        let sign = match precision {
            Precision::F32 => Sign::Circle { filled: !is_planned },
            Precision::F64 => Sign::Square { filled: !is_planned },
        };
        let own = shown.iter().filter(|r| r.algorithm == entrant && r.precision == precision);
        let entry = (sign, colour(entrant, dark), format!("{entrant}, {precision}"));
        Series { entry, places: own.map(|r| place(&r)).collect(), is_planned }
    };
    each.map(of).filter(|series| !series.places.is_empty()).collect()
}

fn plot(ui: &mut Ui, input: &Input<'_>, memory: &RunTimeMemory) {
    let drawn = series(input.rows, memory, ui.visuals().dark_mode);
    legend::row(ui, &drawn.iter().map(|series| series.entry.clone()).collect::<Vec<_>>());
    let places = || drawn.iter().flat_map(|series| &series.places);
    let span = |axis: usize, low: f64, high: f64| {
        let (low, high) = places().fold((low, high), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        let room = 0.05 * (high - low);
        [low - room, high + room]
    };
    let powers = |[low, high]: [f64; 2], step: usize| -> Vec<Tick> {
        let within = (low.ceil() as i32..=high.floor() as i32).filter(|power| power.rem_euclid(step as i32) == 0);
        within.map(|power| Tick { value: f64::from(power), text: power_of_ten(power) }).collect()
    };
    let (x, y) = (span(0, MIN_DRAWN_ERROR.log10(), -2.0), span(1, 0.0, 2.0));
    let (x_marks, y_marks) = (powers(x, 4), powers(y, 1));
    let x = Axis { ticks: Some(&x_marks), ..Axis::new(x[0], x[1], "largest error of a sample") };
    let y = Axis { ticks: Some(&y_marks), ..Axis::new(y[0], y[1], "three maps, ms") };
    let mut chart = Chart::new("Run time against error", x, y).with_zoom();
    if let Some(bare) = input.bare_fft_ms {
        let line = HLine::new("", bare.log10()).color(Color32::GRAY).width(1.0);
        chart.add(line.style(LineStyle::dashed_loose()));
    }
    for Series { entry: (sign, colour, name), places, is_planned } in drawn {
        let shape = if matches!(sign, Sign::Circle { .. }) { MarkerShape::Circle } else { MarkerShape::Square };
        let points = Points::new(name, places).shape(shape).filled(!is_planned);
        chart.add(points.radius(if is_planned { 6.5 } else { 3.5 }).color(colour));
    }
    let drawn = chart.show(ui, ui.available_rect_before_wrap(), Sense::click_and_drag());
    drawn.tell(|[error, time]| Some(format!("error {}\n{:.3} ms", scientific(10f64.powf(error), 1), 10f64.powf(time))));
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        -2..=4 => format!("{}", 10f64.powi(exponent)),
        _ => format!("1e{exponent}").replace('-', "−"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::widgets::seen::{self, Queryable, User};

    /// Commands that clicks on these labels send, while the measurement has this progress.
    fn asked(progress: Option<f32>, labels: &[&str]) -> Vec<Command> {
        let radar = Radar { elements: 128, ..Radar::default() };
        let mut run_time = seen::asking_with([500.0, 300.0], RunTimeMemory::default(), |ui, memory| {
            show(ui, Input { radar: &radar, progress, rows: &[], bare_fft_ms: None, note: None }, memory)
        });
        let _told = run_time.get_by_label_contains("128 elements");
        run_time.clicks(labels);
        run_time.state().1.clone()
    }

    #[test]
    fn a_thorough_measurement_is_asked_for_and_can_be_cancelled() {
        for (progress, labels, command) in [
            (None, &["thorough", "Measure"][..], WorkCommand::Measure { thorough: true }),
            (Some(0.5), &["Cancel"], WorkCommand::CancelMeasurement),
        ] {
            assert_eq!(asked(progress, labels), [Command::Work(command)]);
        }
    }
}
