//! Run time against error on this machine, measured while one watches.

use super::application::App;
use super::jobs;
use crate::benchmark::front::{Entrant, Front, FrontRequest, FrontRow, FrontTask, measure};
use crate::radar::Radar;
use crate::scene::SceneError;
use crate::signal::{Algorithm, Precision};
use crate::task::{Reply, Task, Worker};
use eframe::egui;
use eframe::egui::{Color32, ComboBox, Ui};
use egui_plot::{GridMark, HLine, Legend, MarkerShape, Plot, PlotPoints, Points};
use std::collections::BTreeSet;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Errors below this are drawn at this: a logarithmic axis has no zero.
const SMALLEST_ERROR: f64 = 1e-16;

struct Request {
    radar: Radar,
    front: FrontRequest,
    rows: Sender<FrontRow>,
}

/// The worker, and what it has measured so far.
pub(super) struct FrontPanel {
    worker: Worker<Request, Result<Front, SceneError>>,
    arriving: Option<Receiver<FrontRow>>,
    rows: Vec<FrontRow>,
    bare_fft_ms: Option<f64>,
    ended: Option<String>,
    thorough: bool,
    task: FrontTask,
    /// Number of reflectors whose rows are drawn; all where `None`.
    reflectors: Option<usize>,
}

impl FrontPanel {
    /// Starts the worker, which waits; `wake` is called from its thread.
    pub fn start(wake: impl Fn() + Clone + Send + 'static) -> std::io::Result<Self> {
        let each = wake.clone();
        let work = move |_: &mut (), request: Request, task: &Task| {
            let on_row = |part: f32, row: &FrontRow| {
                task.set_progress(part);
                // Nobody listens any more once another run has begun.
                let _superseded = request.rows.send(row.clone());
                each();
            };
            measure(&request.radar, &request.front, on_row, || task.is_cancelled())
        };
        Ok(FrontPanel {
            worker: Worker::spawn("front", || (), work, wake)?,
            arriving: None,
            rows: Vec::new(),
            bare_fft_ms: None,
            ended: None,
            thorough: false,
            task: FrontTask::Scratch,
            reflectors: None,
        })
    }

    /// Measures afresh.
    pub fn begin(&mut self, radar: Radar) {
        let front = if self.thorough { FrontRequest::full(vec![1, 10, 75, 300], 5) } else { FrontRequest::short() };
        let (rows, arriving) = channel();
        self.arriving = Some(arriving);
        self.rows.clear();
        (self.bare_fft_ms, self.ended, self.reflectors) = (None, None, None);
        self.worker.request(Request { radar, front, rows });
    }

    /// Stops after the row that is being measured.
    pub fn cancel(&mut self) {
        self.worker.cancel();
        self.ended = Some("cancelled; what was measured stays".to_owned());
    }

    /// The part that is done, while it measures.
    pub fn progress(&self) -> Option<f32> {
        self.worker.is_busy().then(|| self.worker.progress().unwrap_or(0.0))
    }

    /// Rows measured so far.
    pub fn rows(&self) -> &[FrontRow] {
        &self.rows
    }

    /// Takes in what was measured. Returns a message for the user.
    pub fn poll(&mut self) -> Option<String> {
        if let Some(arriving) = &self.arriving {
            self.rows.extend(arriving.try_iter());
        }
        let mut message = None;
        for reply in self.worker.replies() {
            match reply {
                Reply::Done { result: Ok(front), .. } => self.bare_fft_ms = Some(front.bare_fft_ms),
                Reply::Done { result: Err(error), .. } => self.ended = Some(error.to_string()),
                Reply::Panicked { message: said, .. } => {
                    self.ended = Some(format!("failed: {said}"));
                    message = Some(format!("The measurement failed ({said}). Measure again."));
                }
            }
        }
        message
    }
}

/// Draws the panel.
pub(super) fn show(app: &mut App, ui: &mut Ui) {
    egui::Frame::NONE.inner_margin(egui::Margin::symmetric(10, 6)).show(ui, |ui| {
        let panel = &mut app.front;
        ui.horizontal_wrapped(|ui| match panel.progress() {
            Some(part) => {
                if jobs::progress(ui, part, 180.0, "Stop after this measurement; what was measured stays") {
                    panel.cancel();
                }
            }
            None => {
                let tip = "Time how long three maps take, and how wrong they are, by algorithm and precision; leave the \
                           machine alone meanwhile";
                if ui.button("Measure").on_hover_text(tip).clicked() {
                    panel.begin(Radar { carrier: app.radar.carrier, ..Radar::default() });
                }
                ui.checkbox(&mut panel.thorough, "thorough")
                    .on_hover_text("Every algorithm, up to 300 reflectors, drags too: about a minute instead of seconds");
            }
        });
        if let Some(ended) = &panel.ended {
            ui.colored_label(ui.visuals().warn_fg_color, ended);
        }
        if panel.rows.is_empty() {
            if panel.progress().is_none() {
                ui.weak("Nothing measured yet.");
            }
            return;
        }
        filter(panel, ui);
        plot(panel, ui);
    });
}

fn filter(panel: &mut FrontPanel, ui: &mut Ui) {
    let counts: BTreeSet<usize> = panel.rows.iter().map(|r| r.reflectors).collect();
    ui.horizontal_wrapped(|ui| {
        let text = |count: Option<usize>| match count {
            None => "all".to_owned(),
            Some(count) => count.to_string(),
        };
        let label = ui.label("Reflectors");
        let combo = ComboBox::from_id_salt("reflectors").width(60.0).selected_text(text(panel.reflectors));
        let combo = combo.show_ui(ui, |ui| {
            for choice in std::iter::once(None).chain(counts.into_iter().map(Some)) {
                ui.selectable_value(&mut panel.reflectors, choice, text(choice));
            }
        });
        combo.response.labelled_by(label.id).on_hover_text("Draw the measurements of so many reflectors");
        if panel.rows.iter().any(|r| r.task == FrontTask::Drag) {
            ui.selectable_value(&mut panel.task, FrontTask::Scratch, "from scratch");
            ui.selectable_value(&mut panel.task, FrontTask::Drag, "one dragged");
        } else {
            panel.task = FrontTask::Scratch;
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

fn plot(panel: &FrontPanel, ui: &mut Ui) {
    let dark = ui.visuals().dark_mode;
    let shown: Vec<&FrontRow> = panel
        .rows
        .iter()
        .filter(|r| r.task == panel.task && panel.reflectors.is_none_or(|count| count == r.reflectors))
        .collect();
    let powers = |mark: GridMark| match (mark.value - mark.value.round()).abs() < 1e-6 {
        true => power_of_ten(mark.value.round() as i32),
        false => String::new(),
    };
    let places = |shown: &[&FrontRow]| -> Vec<[f64; 2]> {
        shown.iter().map(|r| [r.signal_error.max(SMALLEST_ERROR).log10(), r.median_ms.log10()]).collect()
    };
    Plot::new("front")
        .x_axis_label("largest error of a sample")
        .y_axis_label("three maps, ms")
        .x_grid_spacer(egui_plot::uniform_grid_spacer(|_| [8.0, 4.0, 2.0]))
        .y_grid_spacer(egui_plot::uniform_grid_spacer(|_| [10.0, 1.0, 0.5]))
        .x_axis_formatter(move |mark, _| powers(mark))
        .y_axis_formatter(move |mark, _| powers(mark))
        .legend(Legend::default().background_alpha(0.7))
        .include_x(SMALLEST_ERROR.log10())
        .include_x(-2.0)
        .include_y(0.0)
        .include_y(2.0)
        .allow_scroll(false)
        .y_axis_min_width(36.0)
        .show(ui, |plot| {
            if let Some(bare) = panel.bare_fft_ms {
                let line = HLine::new("one bare transform, one thread", bare.log10());
                plot.hline(line.color(Color32::GRAY).width(1.0).style(egui_plot::LineStyle::dashed_loose()));
            }
            let entrants = std::iter::once(Entrant::Planned).chain(Algorithm::ALL.map(Entrant::Forced));
            for entrant in entrants {
                for (precision, shape) in [(Precision::F32, MarkerShape::Circle), (Precision::F64, MarkerShape::Square)]
                {
                    let rows: Vec<&FrontRow> =
                        shown.iter().copied().filter(|r| r.algorithm == entrant && r.precision == precision).collect();
                    if rows.is_empty() {
                        continue;
                    }
                    let planned = entrant == Entrant::Planned;
                    plot.points(
                        Points::new(format!("{entrant}, {precision}"), PlotPoints::from(places(&rows)))
                            .shape(shape)
                            .filled(!planned)
                            .radius(if planned { 6.5 } else { 3.5 })
                            .color(colour(entrant, dark)),
                    );
                }
            }
        });
}

fn power_of_ten(exponent: i32) -> String {
    match exponent {
        -2..=4 => format!("{}", 10f64.powi(exponent)),
        _ => format!("1e{exponent}").replace('-', "−"),
    }
}
