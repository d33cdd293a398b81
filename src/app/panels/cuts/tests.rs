use super::*;
use crate::app::state::{Cursor, PinnedCut};
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::{Convention, Radar};
use eframe::egui::{Pos2, pos2};
use ndarray::Array2;
use std::sync::Arc;

struct Held {
    memory: CutsMemory,
    asked: Vec<Command>,
    state: State,
}

fn point(state: &mut State, bin: f64) {
    let radar = Radar::default();
    state.pointer.hover(Cursor::at_cell(&radar, bin, 700.0));
    state.pointer.turn(&radar);
}

/// A map with one lobe at bin 300 and column 700, on a scale of 100 dB.
fn lobe(kind: MapKind, radar: &Radar) -> CutMap {
    let level = |(k1, k2): (usize, usize)| {
        let (range, angle) = ((k1 as f32 - 300.0) / 20.0, (k2 as f32 - 700.0) / 40.0);
        1.0 - 0.03 * (range * range + angle * angle).min(30.0)
    };
    let lambda = Array2::from_shape_fn((radar.samples, radar.elements), level);
    CutMap { kind, map: Arc::new(RangeAngleMap { lambda }), scale: Some(LambdaScale { peak: 0.0, floor: -5.0 }) }
}

fn maps(radar: &Radar) -> [CutMap; 3] {
    let small =
        CutMap { kind: MapKind::Output, map: Arc::new(RangeAngleMap { lambda: Array2::zeros((8, 8)) }), scale: None };
    [lobe(MapKind::Input0, radar), lobe(MapKind::Target, radar), small]
}

fn panel(size: [f32; 2]) -> Harness<'static, Held> {
    let maps = maps(&Radar::default());
    let draw = move |ui: &mut Ui, Held { memory, asked, state }: &mut Held| {
        let commands = show(ui, state, &maps, memory);
        if commands.contains(&Command::View(ViewCommand::PinCuts)) {
            let (radar, cursor) = (state.radar().clone(), state.cut_cursor());
            state.pins.push(PinnedCut { radar, cursor, maps: maps.to_vec() });
        }
        asked.extend(commands);
    };
    let mut state = State::new(Vec::new());
    point(&mut state, 300.0);
    let held = Held { memory: CutsMemory::default(), asked: Vec::new(), state };
    let mut panel = Harness::builder().with_size(size).with_step_dt(0.02).build_ui_state(draw, held);
    panel.run_steps(2);
    panel
}

fn places(panel: &Harness<'_, Held>) -> [Option<f64>; 2] {
    panel.state().memory.views[&Cut::Range].markers.places
}

fn click(panel: &mut Harness<'_, Held>, at: Pos2) {
    panel.drags(&[at]);
    // Two clicks in quick succession would be a double click.
    panel.run_steps(40);
}

#[test]
fn maps_of_another_radar_are_left_out() {
    let (state, maps) = (State::new(Vec::new()), maps(&Radar::default()));
    for cut in Cut::ALL {
        let drawn: Vec<MapKind> = traces(&state, &maps, &BTreeSet::new(), cut).iter().map(|t| t.kind).collect();
        assert_eq!(drawn, [MapKind::Input0, MapKind::Target]);
    }
}

fn at(part: f32, rect: Rect) -> Pos2 {
    pos2(rect.left() + part * rect.width(), rect.center().y)
}

#[test]
fn clicks_place_markers_on_the_target() {
    let mut cuts = panel([700.0, 600.0]);
    assert!(cuts.state().asked.is_empty());
    assert_eq!(cuts.state().memory.read.map(|line| line.kind), Some(MapKind::Target), "without a choice");
    let chart = cuts.get_by_label("Range profile").rect();
    click(&mut cuts, at(0.25, chart));
    let chart = cuts.get_by_label("Range profile").rect();
    click(&mut cuts, at(0.5, chart));
    let extent = Radar::default().max_range_metres();
    let [Some(a), Some(b)] = places(&cuts) else { panic!("{:?}", places(&cuts)) };
    assert!((a / extent - 0.25).abs() < 5e-3 && (b / extent - 0.5).abs() < 5e-3, "{a} {b}");
}

/// The panel with markers at a quarter of the maximum range, and at `part` of it.
fn marked(part: f64) -> Harness<'static, Held> {
    let mut cuts = panel([700.0, 600.0]);
    let places = [0.25, part].map(|part| Some(part * Radar::default().max_range_metres()));
    cuts.state_mut().memory.views.entry(Cut::Range).or_default().markers.places = places;
    cuts.run_steps(2);
    cuts
}

#[test]
fn a_drag_moves_a_marker_and_their_difference_is_told() {
    let mut cuts = marked(0.5);
    let _difference = cuts.get_by_label_contains("B − A: +9.");
    let before = places(&cuts);
    let chart = cuts.get_by_label("Range profile").rect();
    cuts.drags(&[0.5, 0.75].map(|part| at(part, chart)));
    let [now, Some(moved)] = places(&cuts) else { panic!("{:?}", places(&cuts)) };
    assert_eq!(now, before[0]);
    assert!((moved / Radar::default().max_range_metres() - 0.75).abs() < 5e-3, "{moved}");
    assert!(cuts.state().memory.views[&Cut::Range].span.is_none(), "the cut itself was not dragged");
}

#[test]
fn the_width_of_the_peak_at_a_marker_is_told_and_drawn() {
    let cuts = marked(0.75);
    let _width = cuts.get_by_label_contains("3 dB width at B: ");
    let is_end = |shape: &egui::Shape| matches!(shape, egui::Shape::Circle(circle) if circle.radius == 3.0);
    let ends = cuts.output().shapes.iter().filter(|clipped| is_end(&clipped.shape)).count();
    assert!(ends >= 2 && ends % 2 == 0, "{ends}");
}

#[test]
fn a_pinned_cut_stays_while_the_cursor_moves_on() {
    let mut cuts = panel([900.0, 500.0]);
    cuts.clicks(&["Pin"]);
    assert_eq!(cuts.state().asked, [Command::View(ViewCommand::PinCuts)]);
    point(&mut cuts.state_mut().state, 400.0);
    cuts.state_mut().state.settings.units = Units::Decibels;
    cuts.run_steps(2);
    let held = cuts.state();
    let drawn = traces(&held.state, &held.state.pins[0].maps, &BTreeSet::from([MapKind::Input0]), Cut::Angle);
    let highest = |t: &Trace| t.lambda.iter().map(|p| p[1]).fold(0.0, f64::max);
    let lines: Vec<_> = drawn.iter().map(|t| (t.kind, t.pin)).collect();
    assert_eq!(lines, [(MapKind::Target, Some(0)), (MapKind::Target, None)]);
    assert!(highest(&drawn[0]) > 0.999 && highest(&drawn[1]) < 0.3, "one through the lobe, one beside it");
    cuts.get_by_label_contains("Unpin 1: ").click();
    cuts.step();
    assert_eq!(cuts.state().asked, [Command::View(ViewCommand::PinCuts), Command::View(ViewCommand::Unpin(0))]);
}

#[test]
fn decibels_have_an_axis_of_their_own() {
    let mut cuts = panel([900.0, 400.0]);
    cuts.clicks(&["dB"]);
    assert_eq!(cuts.state().asked, [Command::View(ViewCommand::SetUnits(Units::Decibels))]);
    cuts.state_mut().state.settings.units = Units::Decibels;
    cuts.run_steps(2);
    let texts = seen::texts(cuts.output());
    assert!(texts.iter().filter(|t| t.text == "relative to the peak, dB").count() == 2, "{texts:?}");
    assert!(texts.iter().any(|t| t.text == "−80" || t.text == "−50"), "{texts:?}");
}

#[test]
fn a_cut_has_several_labels_none_cut_off_at_any_size() {
    for size in [[290.0, 190.0], [480.0, 260.0], [480.0, 900.0], [1400.0, 800.0]] {
        let cuts = panel(size);
        seen::assert_readable(cuts.output());
        seen::assert_reads(cuts.output(), &["0.0", "10", "20", "30"]);
    }
}

#[test]
fn lines_differ_by_dash_and_not_by_their_hue_alone() {
    let styles = [MapKind::Input0, MapKind::Input1, MapKind::Target].map(style);
    assert!(styles[0] != styles[1] && !styles[..2].contains(&styles[2]), "{styles:?}");
}

#[test]
fn the_angle_cut_of_a_physical_radar_rises_along_its_axis_too() {
    let radar = Radar::default().in_convention(Convention::Physical);
    let whole = Cut::Angle.whole(&radar);
    assert!(whole.low < -0.99 && whole.high > 0.99, "{whole:?}");
    let cursor = Cursor::at_cell(&radar, 300.0, 700.0);
    let trace = Trace::of(&radar, &cursor, &lobe(MapKind::Target, &radar), Cut::Angle, None).unwrap();
    assert!(trace.lambda.windows(2).all(|pair| pair[0][0] < pair[1][0]));
    let brightest = trace.lambda.iter().max_by(|a, b| a[1].total_cmp(&b[1])).unwrap();
    assert_eq!(brightest[0], radar.cos_of_column(700.0));
}
