//! Tests of drawn maps: texts in the place of a picture, and labels that stay inside.

impl<'a> Input<'a> {
    /// A map without a picture.
    pub fn bare(
        kind: MapKind,
        radar: &'a Radar,
        look: &'a View,
        scene: &'a Scene,
        selection: &'a Selection,
    ) -> Input<'a> {
        Input {
            kind,
            radar,
            scene,
            selection,
            look,
            other_view: MapView::default(),
            texture: None,
            pictured: look.projection,
            end: 1.0,
            sentence: None,
            stale: false,
            old: EARLIER_SCENE.to_owned(),
            cells: None,
            marks: Marks { objects: &[], found: &[] },
            kinds: None,
            told_apart: None,
            theory: None,
            cursor: None,
            note: None,
            line: None,
            error: None,
            veil: None,
            axes: true,
            places: None,
        }
    }
}

use super::frame::Marks;
use super::*;
use crate::app::state::{Cursor, Projection, Units, View};
use crate::app::widgets::seen;
use crate::interact::Selection;
use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::Carrier;
use crate::scene::Scene;
use eframe::egui::{Shape, TextureId};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use ndarray::Array2;
use std::sync::LazyLock;

static NOTHING: LazyLock<(Scene, Selection)> = LazyLock::new(Default::default);

static LOOK: LazyLock<View> = LazyLock::new(View::default);

static NO_CELLS: LazyLock<RangeAngleMap> = LazyLock::new(|| RangeAngleMap { lambda: Array2::zeros((1, 1)) });

fn input<'a>(radar: &'a Radar, error: Option<Problem<'a>>) -> Input<'a> {
    let (scene, selection) = &*NOTHING;
    Input { error, ..Input::bare(MapKind::Output, radar, &LOOK, scene, selection) }
}

fn draw(ui: &mut Ui, error: Option<Problem<'_>>, asked: &mut Vec<Command>) {
    let radar = Radar::default();
    let input = Input { cursor: Some(Cursor::at_cell(&radar, 200.0, 500.0)), ..input(&radar, error) };
    asked.extend(show(ui, input, &mut MapView::default(), &mut HandMemory::default()));
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

/// A map whose method refuses, where another method works.
fn refused() -> Harness<'static, Vec<Command>> {
    let problem = || Problem { reason: "trained on another radar", instead: Some("capon") };
    let mut map = Harness::new_ui_state(move |ui, asked| draw(ui, Some(problem()), asked), Vec::new());
    map.step();
    map
}

#[test]
fn a_refusal_is_told_in_place_of_the_map() {
    let map = refused();
    let _told = map.get_by_label("trained on another radar");
    assert!(!map.output().shapes.iter().any(|s| matches!(s.shape, Shape::Circle(_))), "no crosshair is drawn over it");
    let _one = map.get_by_label("Output map");
}

#[test]
fn a_refusal_offers_another_method() {
    let mut map = refused();
    map.get_by_label("Use capon").click();
    map.step();
    assert!(map.state().contains(&Command::View(ViewCommand::Method("capon"))), "{:?}", map.state());
}

#[test]
fn every_label_of_a_map_is_inside_its_panel() {
    let lambda = RangeAngleMap { lambda: Array2::zeros((2, 2)) };
    for size in [[270.0, 130.0], [450.0, 270.0], [1400.0, 800.0]] {
        for (kind, units) in [
            (MapKind::Target, Units::Lambda),
            (MapKind::Target, Units::Decibels),
            (MapKind::Difference, Units::Lambda),
            (MapKind::Difference, Units::Decibels),
            (MapKind::TargetAbove, Units::Lambda),
        ] {
            let (lambda, radar) = (lambda.clone(), Radar::default());
            let map = Harness::builder().with_size(size).build_ui(move |ui| {
                let scale = Some(LambdaScale { peak: 3.0, floor: -12.5 });
                let cells = Some(Cells { map: &lambda, minus: None, scale });
                let texture = Some(TextureId::default());
                let look = View { units, ..View::default() };
                let input = Input { kind, look: &look, cells, texture, end: 0.05, ..input(&radar, None) };
                _ = show(ui, input, &mut MapView::default(), &mut HandMemory::default());
            });
            seen::assert_readable(map.output());
            let texts = seen::texts(map.output());
            assert!(texts.iter().any(|t| t.text == "range, m" || size[1] < 200.0), "{texts:?}");
            let bar = match (kind, units) {
                (MapKind::TargetAbove, _) => None,
                (MapKind::Difference, Units::Lambda) => Some("ΔΛ"),
                (MapKind::Difference, Units::Decibels) => Some("Δ dB"),
                (_, Units::Lambda) => Some("Λ, normalised"),
                (_, Units::Decibels) => Some("−200"),
            };
            assert!(bar.is_none_or(|bar| texts.iter().any(|t| t.text == bar)), "{bar:?} at {size:?}: {texts:?}");
        }
    }
}

#[test]
fn every_map_has_the_same_margins() {
    for (size, projection) in [([330.0, 170.0], Projection::RangeAngle), ([700.0, 400.0], Projection::Cartesian)] {
        let rect = |kind: MapKind, units| {
            let radar = Radar::default();
            let map = Harness::builder().with_size(size).build_ui(move |ui| {
                let told_apart =
                    Some(ToldApart { output: &NO_CELLS, target: &NO_CELLS, etas: [0.5, 0.9], ghosts: &[] });
                let told_apart = told_apart.filter(|_| kind == MapKind::OutputAbove);
                let texture = Some(TextureId::default());
                let look = View { units, projection, ..View::default() };
                let (look, pictured) = (&look, Projection::RangeAngle);
                let input = Input { kind, look, pictured, texture, told_apart, ..input(&radar, None) };
                _ = show(ui, input, &mut MapView::default(), &mut HandMemory::default());
            });
            seen::assert_readable(map.output());
            let has_one = seen::texts(map.output()).iter().any(|t| t.text == "1.0");
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

#[test]
fn maps_beside_each_other_stay_aligned_while_objects_are_marked() {
    let rect = |kind: MapKind| {
        let (radar, fates) = (Radar::default(), kinds::tests::fates());
        let map = Harness::builder().with_size([500.0, 300.0]).build_ui(move |ui| {
            let kinds = Some(Kinds { fates: &fates, current: true }).filter(|_| kind == MapKind::Output);
            let (texture, look) = (Some(TextureId::default()), View { show_kinds: true, ..View::default() });
            let input = Input { kind, kinds, look: &look, texture, ..input(&radar, None) };
            _ = show(ui, input, &mut MapView::default(), &mut HandMemory::default());
        });
        map.get_by_label(&format!("{} map", kind.title())).rect()
    };
    assert_eq!(rect(MapKind::Output), rect(MapKind::Input0));
}

#[test]
fn directions_rise_from_left_to_right_with_either_carrier() {
    let radar = Radar { carrier: Carrier::TwoWay, ..Radar::default() };
    let map = Harness::builder().with_size([450.0, 270.0]).build_ui(move |ui| {
        _ = show(ui, input(&radar, None), &mut MapView::default(), &mut HandMemory::default());
    });
    let texts = seen::texts(map.output());
    let left = |label: &str| texts.iter().find(|t| t.text == label).map(|t| t.rect.left());
    let places = ["−0.4", "−0.2", "0.0", "0.2", "0.4"].map(left);
    assert!(places[0].is_some() && places.is_sorted(), "{texts:?}");
    seen::assert_readable(map.output());
}

#[test]
fn a_map_that_was_never_there_is_not_of_an_earlier_scene() {
    let radar = Radar::default();
    let map = Harness::builder().build_ui(move |ui| {
        _ = show(ui, Input { stale: true, ..input(&radar, None) }, &mut MapView::default(), &mut HandMemory::default());
    });
    let texts = seen::texts(map.output());
    assert!(texts.iter().any(|t| t.text == "computing…"));
    assert!(!texts.iter().any(|t| t.text.contains("Previous scene")), "{texts:?}");
}

#[test]
fn a_map_of_an_earlier_scene_says_so() {
    let radar = Radar::default();
    let says_so = |stale| {
        let radar = radar.clone();
        let map = Harness::builder().build_ui(move |ui| {
            let input = Input { stale, texture: Some(TextureId::default()), ..input(&radar, None) };
            _ = show(ui, input, &mut MapView::default(), &mut HandMemory::default());
        });
        seen::texts(map.output()).iter().any(|t| t.text.contains("Previous scene"))
    };
    assert_eq!([true, false].map(says_so), [true, false]);
}

/// A map with marks for the verdicts on objects.
fn judged(size: [f32; 2]) -> Harness<'static> {
    let (radar, fates) = (Radar::default(), kinds::tests::fates());
    let mut map = Harness::builder().with_size(size).build_ui(move |ui| {
        let kinds = Some(Kinds { fates: &fates, current: true });
        let texture = Some(TextureId::default());
        let told_apart = Some(ToldApart { output: &NO_CELLS, target: &NO_CELLS, etas: [0.5, 0.9], ghosts: &[] });
        let (kind, look) = (MapKind::OutputAbove, View { show_kinds: true, ..View::default() });
        let input = Input { kinds, texture, told_apart, look: &look, kind, ..input(&radar, None) };
        _ = show(ui, input, &mut MapView::default(), &mut HandMemory::default());
    });
    map.step();
    seen::assert_readable(map.output());
    map
}

#[test]
fn fates_of_objects_are_counted_above_the_map() {
    let legend = "Legend: hit, rim, false alarm, miss, 1 found, 1 missed, 1 merged, 1 wrong tooth, 1 ghost, 1 hidden";
    assert!(judged([900.0, 500.0]).query_by_label(legend).is_some());
}

#[test]
fn a_small_panel_has_no_legend() {
    assert!(judged([260.0, 140.0]).query_by_label_contains("Legend").is_none());
}

#[test]
fn the_fate_of_an_object_is_told_under_the_pointer() {
    let mut map = judged([900.0, 500.0]);
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
