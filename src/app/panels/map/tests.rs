impl<'a> Input<'a> {
    /// A map without a picture.
    pub fn bare(kind: MapKind, state: &'a State) -> Input<'a> {
        Input {
            kind,
            state,
            texture: None,
            pictured: state.settings.projection,
            end: 1.0,
            sentence: None,
            stale: false,
            old: EARLIER_SCENE_TEXT.to_owned(),
            cells: None,
            objects: &[],
            found: &[],
            kinds: None,
            told_apart: None,
            theory: None,
            error: None,
        }
    }
}

use super::*;
use crate::app::jobs::JudgedOutput;
use crate::app::state::{Cursor, Projection, State, Units};
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Carrier;
use crate::scene::Scene;
use eframe::egui::{Shape, TextureId};
use ndarray::Array2;
use std::sync::LazyLock;

static NO_CELLS: LazyLock<RangeAngleMap> = LazyLock::new(|| RangeAngleMap { lambda: Array2::zeros((2, 2)) });

fn state() -> State {
    State::of(Radar::default(), Scene::default())
}

fn input<'a>(state: &'a State, error: Option<Problem<'a>>) -> Input<'a> {
    Input { error, ..Input::bare(MapKind::Output, state) }
}

fn draw(ui: &mut Ui, error: Option<Problem<'_>>, asked: &mut Vec<Command>) {
    let mut state = state();
    state.pointer.now = Some(Cursor::at_cell(state.radar(), 200.0, 500.0));
    asked.extend(show(ui, input(&state, error), &mut MapView::default(), &mut HandMemory::default()));
}

fn drawn(size: [f32; 2], state: State, change: impl for<'a> Fn(Input<'a>) -> Input<'a> + 'static) -> Harness<'static> {
    Harness::builder().with_size(size).build_ui(move |ui| {
        _ = show(ui, change(input(&state, None)), &mut MapView::default(), &mut HandMemory::default());
    })
}

#[test]
fn the_pointer_is_told_in_cells() {
    let mut map = Harness::new_ui_state(|ui, asked| draw(ui, None, asked), Vec::new());
    map.step();
    let rect = map.get_by_label("Output map").rect();
    map.hover_at(rect.center());
    map.step();
    let Some(Command::View(ViewCommand::Hover(cursor))) = map.state().last() else { panic!("{:?}", map.state()) };
    assert!((cursor.bin - 255.5).abs() < 1.0 && (cursor.column - 511.5).abs() < 1.0, "{cursor:?}");
}

#[test]
fn a_refusal_is_told_in_place_of_the_map_with_another_method() {
    let problem = || Problem { reason: "trained on another radar", instead: Some("capon") };
    let mut map = Harness::new_ui_state(move |ui, asked| draw(ui, Some(problem()), asked), Vec::new());
    map.step();
    let _told = map.get_by_label("trained on another radar");
    assert!(!map.output().shapes.iter().any(|s| matches!(s.shape, Shape::Circle(_))), "no crosshair is drawn over it");
    let _one = map.get_by_label("Output map");
    map.clicks(&["Use capon"]);
    assert!(map.state().contains(&Command::View(ViewCommand::Method("capon"))), "{:?}", map.state());
}

#[test]
fn every_label_of_a_map_is_inside_its_panel() {
    for size in [[270.0, 130.0], [450.0, 270.0], [1400.0, 800.0]] {
        for (kind, units, bar) in [
            (MapKind::Target, Units::Lambda, Some("Λ, normalised")),
            (MapKind::Target, Units::Decibels, Some("−200")),
            (MapKind::Difference, Units::Lambda, Some("ΔΛ")),
            (MapKind::Difference, Units::Decibels, Some("Δ dB")),
            (MapKind::TargetAbove, Units::Lambda, None),
        ] {
            let mut state = state();
            state.settings.units = units;
            let map = drawn(size, state, move |input| {
                let scale = Some(LambdaScale { peak: 3.0, floor: -12.5 });
                let cells = Some(Cells { map: &NO_CELLS, minus: None, scale });
                Input { kind, cells, texture: Some(TextureId::default()), end: 0.05, ..input }
            });
            seen::assert_readable(map.output());
            assert!(map.reads("range, m") || size[1] < 200.0);
            assert!(bar.is_none_or(|bar| map.reads(bar)), "{bar:?} at {size:?}");
        }
    }
}

#[test]
fn every_map_has_the_same_margins() {
    for (size, projection) in [([330.0, 170.0], Projection::RangeAngle), ([700.0, 400.0], Projection::Cartesian)] {
        let rect = |kind: MapKind, units| {
            let mut state = state();
            (state.settings.units, state.settings.projection) = (units, projection);
            let map = drawn(size, state, move |input| {
                let told_apart =
                    Some(ToldApart { output: &NO_CELLS, target: &NO_CELLS, etas: [0.5, 0.9], ghosts: &[] });
                let told_apart = told_apart.filter(|_| kind == MapKind::OutputAbove);
                let (texture, pictured) = (Some(TextureId::default()), Projection::RangeAngle);
                Input { kind, pictured, texture, told_apart, ..input }
            });
            seen::assert_readable(map.output());
            let has_one = map.reads("1.0");
            assert!(has_one || projection == Projection::Cartesian, "{kind:?}: the end of the axis has its label");
            map.get_by_label(&format!("{} map", kind.title())).rect()
        };
        let of_input = rect(MapKind::Input0, Units::Lambda);
        for kind in MapKind::ALL {
            for units in [Units::Lambda, Units::Decibels] {
                assert_eq!(rect(kind, units), of_input, "{kind:?} in {units:?}");
            }
        }
    }
}

fn marking() -> State {
    let mut state = state();
    state.settings.show_kinds = true;
    state
}

static JUDGED_OUTPUT: LazyLock<JudgedOutput> = LazyLock::new(kinds::tests::judged);

#[test]
fn maps_beside_each_other_stay_aligned_while_objects_are_marked() {
    let rect = |kind: MapKind| {
        let map = drawn([500.0, 300.0], marking(), move |input| {
            let kinds = Some(Kinds { judged: &JUDGED_OUTPUT, current: true }).filter(|_| kind == MapKind::Output);
            Input { kind, kinds, texture: Some(TextureId::default()), ..input }
        });
        map.get_by_label(&format!("{} map", kind.title())).rect()
    };
    assert_eq!(rect(MapKind::Output), rect(MapKind::Input0));
}

#[test]
fn directions_rise_from_left_to_right_with_either_carrier() {
    let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
    let map = drawn([450.0, 270.0], State::of(radar, Scene::default()), |input| input);
    let texts = seen::texts(map.output());
    let left = |label: &str| texts.iter().find(|t| t.text == label).map(|t| t.rect.left());
    let places = ["−0.4", "−0.2", "0.0", "0.2", "0.4"].map(left);
    assert!(places[0].is_some() && places.is_sorted(), "{texts:?}");
    seen::assert_readable(map.output());
}

#[test]
fn a_map_of_an_earlier_scene_says_so_where_it_is_there() {
    for (stale, texture) in [(true, Some(TextureId::default())), (false, Some(TextureId::default())), (true, None)] {
        let after_first_start = State { captions: false, ..state() };
        let map = drawn([800.0, 600.0], after_first_start, move |input| Input { stale, texture, ..input });
        let says_so = seen::texts(map.output()).iter().any(|t| t.text.contains("Previous scene"));
        assert_eq!((says_so, map.reads("computing…")), (stale && texture.is_some(), texture.is_none()));
    }
}

fn judged(size: [f32; 2]) -> Harness<'static> {
    let mut map = drawn(size, marking(), |input| {
        let kinds = Some(Kinds { judged: &JUDGED_OUTPUT, current: true });
        let told_apart = Some(ToldApart { output: &NO_CELLS, target: &NO_CELLS, etas: [0.5, 0.9], ghosts: &[] });
        let texture = Some(TextureId::default());
        Input { kind: MapKind::OutputAbove, kinds, texture, told_apart, ..input }
    });
    map.step();
    seen::assert_readable(map.output());
    map
}

#[test]
fn verdicts_are_counted_above_the_map_and_named_under_it() {
    let legend =
        "Legend: hit, rim, false alarm, miss, 1 found, 1 missed, 1 merged, 1 wrong tooth, 1 false alarm, 1 hidden";
    assert!(judged([260.0, 140.0]).query_by_label_contains("Legend").is_none(), "not in a small panel");
    let mut map = judged([900.0, 500.0]);
    assert!(map.query_by_label(legend).is_some());
    let rect = map.get_by_label("Output > η map").rect();
    let blob = crate::theory::blob_cell(&Radar::default(), -4.0, 16.0, crate::maps::Aperture::Full);
    let at = pos2(
        rect.left() + rect.width() * ((blob.column + 0.5) / 1024.0) as f32,
        rect.bottom() - rect.height() * ((blob.bin + 0.5) / 512.0) as f32,
    );
    let said = |map: &Harness<'_>| seen::texts(map.output()).into_iter().find(|t| t.text.starts_with("point 2"));
    assert!(said(&map).is_none());
    map.hover_at(at);
    map.run_steps(2);
    assert!(said(&map).is_some_and(|t| t.text.contains("missed")));
}
