//! The link budget in the radar panel: its numbers, SNR against range, and the SNR of the selected object.

use super::table::{Table, number};
use crate::app::widgets::{Axis, Chart, Inks, NumberField, Quantity, labelled, plain};
use crate::radar::budget::{DETECTION_SNR, cross_section_dbsm, range_of_snr_metres};
use crate::radar::{LinkBudget, Radar};
use crate::scene::Object;
use eframe::egui::{Align, CollapsingHeader, Label, Sense, Stroke, Ui, vec2};
use egui_plot::{HLine, LineStyle};

pub(super) const HEADING: &str = "Link budget";

/// Height and largest width of the chart, points.
const CHART_SIZE_POINTS: [f32; 2] = [170.0, 560.0];

/// Cross section for which SNR is drawn at first, dBsm: about that of a car from behind.
const CAR_CROSS_SECTION_DBSM: f64 = 10.0;

/// Least SNR that is drawn, dB.
const MIN_DRAWN_SNR_DB: f64 = -30.0;

const CURVE_POINTS: u32 = 120;

/// Width of an element's pattern when one is switched on, degrees.
const USUAL_WIDTH_DEGREES: f64 = 80.0;

/// Text in place of the numbers, without a link budget.
const NO_BUDGET_TEXT: &str = "None: the thesis' convention. A sample's amplitude is P σ / R², levels in dBm are those of samples, and elements are \
                       isotropic. The floor Receiver takes the usual budget: 12 dBm, 10 dBi, 12 dB.";

/// Text of the losses that the figures leave out.
const LOSSES_TEXT: &str = "Ends and array add their elements in phase, as a map does beyond the far field. The loss of an echo between two cells is left out.";

const TRANSMIT_POWER: Quantity = Quantity::metres(
    "transmit power",
    "Power that a transmitter sends. No sample depends on it: it sets the noise beneath them",
)
.with(" dBm", [-100.0, 150.0], 0.2, 1);
const ANTENNA_GAIN: Quantity = Quantity::metres(
    "antenna gain",
    "Of one element straight ahead, for sending and for hearing",
)
.with(" dBi", [-50.0, 100.0], 0.1, 1);
const NOISE_FIGURE: Quantity = Quantity::metres(
    "noise figure",
    "Noise that a receiver adds to that of its input. Below 0 dB it would take some away",
)
.with(" dB", [0.0, 100.0], 0.1, 1);
const CHIRP: Quantity = Quantity::metres(
    "chirp",
    "Time that the samples span. The receiver's bandwidth is the rate at which they are taken",
)
.with(" µs", [0.1, 1e5], 0.1, 2);

pub(super) fn show(ui: &mut Ui, table: Table, radar: &mut Radar, selected: Option<&(String, Object)>) {
    let is_sought = table.sought == Some(HEADING);
    let group = CollapsingHeader::new(HEADING).id_salt(HEADING).open(is_sought.then_some(true));
    let shown = group.show_unindented(ui, |ui| {
        let mut has = radar.budget.is_some();
        let tooltip = "Noise and SNR by the radar equation. Reflectivity 1 is a radar cross section of 1 m²: 0 dBsm";
        if ui.checkbox(&mut has, "Use a link budget").on_hover_text(tooltip).changed() {
            radar.budget = has.then(LinkBudget::default);
        }
        let Some(budget) = radar.budget else {
            ui.add(Label::new(NO_BUDGET_TEXT).wrap());
            return;
        };
        table.show(ui, HEADING, |ui| numbers(ui, table, radar, budget));
        curve(ui, radar);
        if let Some((name, object)) = selected {
            ui.add(Label::new(told(radar, name, object)).wrap());
        }
        ui.weak(LOSSES_TEXT);
    });
    if is_sought {
        shown.header_response.scroll_to_me(Some(Align::Min));
    }
}

fn numbers(ui: &mut Ui, table: Table, radar: &mut Radar, mut budget: LinkBudget) {
    let text = format!("1 m² at 10 m is received with {} dBm", plain(radar.received(0.0, 10.0).0, 1));
    number(ui, table, &TRANSMIT_POWER, (&mut budget.transmit_power_dbm, 1.0), &text, true);
    let text = format!("{} dB on the way there and back", plain(2.0 * budget.antenna_gain_dbi, 1));
    number(ui, table, &ANTENNA_GAIN, (&mut budget.antenna_gain_dbi, 1.0), &text, true);
    pattern(ui, table, &mut budget);
    let text = format!("noise of {} dBm in a sample", plain(radar.receiver_noise().0, 1));
    number(ui, table, &NOISE_FIGURE, (&mut budget.noise_figure_db, 1.0), &text, true);
    let text = format!("{:.2} MHz of noise: samples a second", radar.sample_rate_hz() * 1e-6);
    number(ui, table, &CHIRP, (&mut radar.chirp_seconds, 1e-6), &text, true);
    radar.budget = Some(budget);
}

fn pattern(ui: &mut Ui, table: Table, budget: &mut LinkBudget) {
    let tooltip = "Half-power width of an element: what it sends and hears falls as a power of the cosine of the angle off broadside. It changes \
                   the samples";
    let text = match budget.pattern() {
        None => "alike in all directions".to_owned(),
        Some(pattern) => {
            let lost = -40.0 * pattern.amplitude(0.5).log10();
            format!("cos^{:.1} of the angle; {lost:.1} dB are lost there and back at 60°", pattern.exponent())
        }
    };
    table.row(ui, ("element's width", tooltip), &text, |ui, label| {
        ui.horizontal(|ui| {
            let mut has = budget.half_power_width_degrees.is_some();
            if ui.checkbox(&mut has, "").labelled_by(label).on_hover_text("Elements with a pattern").changed() {
                budget.half_power_width_degrees = has.then_some(USUAL_WIDTH_DEGREES);
            }
            match &mut budget.half_power_width_degrees {
                Some(degrees) => {
                    let field = NumberField::new(degrees).range(1.0..=179.0).speed(0.5).max_decimals(1).suffix("°");
                    ui.add(field).labelled_by(label).on_hover_text(tooltip);
                }
                None => _ = ui.weak("isotropic"),
            }
        });
    });
}

/// Draws SNR against range, for an object of a cross section that is chosen above it.
fn curve(ui: &mut Ui, radar: &Radar) {
    let id = ui.scope_id().with("cross section");
    let mut dbsm = ui.data(|d| d.get_temp(id)).unwrap_or(CAR_CROSS_SECTION_DBSM);
    ui.horizontal(|ui| {
        let tooltip =
            "Radar cross section of the object whose SNR is drawn. A car has about 10 dBsm, a person 0, a post −10";
        let field = NumberField::new(&mut dbsm).range(-100.0..=100.0).speed(0.2).max_decimals(1).suffix(" dBsm");
        if labelled(ui, "cross section", tooltip, field).changed() {
            ui.data_mut(|d| d.insert_temp(id, dbsm));
        }
    });
    let at_one_metre = radar.link(dbsm, 1.0, 1.0);
    let falls = range_of_snr_metres(DETECTION_SNR, at_one_metre.array, 1.0);
    ui.label(format!("By the whole array its SNR falls to {:.0} dB at {falls:.1} m.", DETECTION_SNR.0));
    let most = 1.25 * falls.max(radar.max_range_metres());
    let at = |range: f64, of: f64| of - 40.0 * range.log10();
    let [sample, array] = [at_one_metre.sample.0, at_one_metre.array.0];
    let high = at(most / 20.0, array).max(MIN_DRAWN_SNR_DB + 10.0);
    let size = vec2(ui.available_width().min(CHART_SIZE_POINTS[1]), CHART_SIZE_POINTS[0]);
    let (area, _) = ui.allocate_exact_size(size, Sense::hover());
    let (x, y) = (Axis::new(0.0, most, "range, m"), Axis::new(MIN_DRAWN_SNR_DB, high, "SNR, dB"));
    let mut chart = Chart::new("SNR against range", x, y);
    let inks = Inks::of(ui.visuals());
    let points = |of: f64| {
        (1..=CURVE_POINTS)
            .map(move |i| f64::from(i) / f64::from(CURVE_POINTS) * most)
            .map(move |range| [range, at(range, of)])
    };
    let detection = HLine::new("", DETECTION_SNR.0).stroke(Stroke::new(1.0, inks.grid_text));
    chart.add(detection.style(LineStyle::dashed_dense()));
    chart.upright(radar.max_range_metres(), Stroke::new(1.0, inks.ends[0].gamma_multiply(0.6)));
    chart.line(points(sample), Stroke::new(1.5, inks.ends[1]), LineStyle::dashed_dense());
    chart.line(points(array), Stroke::new(2.0, inks.selected), LineStyle::Solid);
    chart.dot([falls, DETECTION_SNR.0], 4.0, inks.selected);
    chart.show(ui, area, Sense::hover()).tell(|[range, _]| {
        let range = range.max(most * 1e-3);
        let [received, sample, array] = [at_one_metre.received.0, sample, array].map(|of| plain(at(range, of), 1));
        Some(format!("{range:.1} m: {received} dBm\n{sample} dB a sample, {array} dB by the array"))
    });
    ui.weak("Line: by the whole array. Dashes: in a sample. Upright: where ranges wrap around.");
}

/// Text of the SNR of the selected object.
fn told(radar: &Radar, name: &str, object: &Object) -> String {
    let [x, y] = object.centre_metres();
    let (range, dbsm) = (x.hypot(y).max(1e-3), cross_section_dbsm(object.reflectivity()));
    let link = radar.link(dbsm, range, y / range);
    let levels = [dbsm, link.received.0, link.sample.0, link.range.0, link.end.0, link.array.0];
    let [dbsm, received, sample, bin, end, array] = levels.map(|level| plain(level, 1));
    format!(
        "{name}, {dbsm} dBsm at {range:.1} m: received with {received} dBm. SNR {sample} dB in a sample, {bin} dB in its range bin, {end} dB by one \
         end, {array} dB by the whole array."
    )
}
