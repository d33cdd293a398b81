use super::*;
use crate::maps::{LogMaps, Normalisation, range_transform};
use crate::radar::Decibels;
use crate::scene::presets::Preset;
use crate::scene::{Object, Point, Post, Wall};
use crate::signal::{Floor, simulate};
use ndarray::s;

fn seen_by(radar: &Radar, scene: &Scene, normalisation: Normalisation) -> (RangeAngleMap, Footprints) {
    let full = LogMaps::of_signal(radar, &simulate(radar, scene, Floor::Thesis, 1).unwrap()).full;
    let target = full.normalise(normalisation);
    let footprints = Footprints::new(radar, scene, &target, full.scale(normalisation));
    (target, footprints)
}

fn seen(objects: Vec<Object>) -> (RangeAngleMap, Footprints) {
    seen_by(&Radar::default(), &Scene { objects, ..Scene::default() }, Normalisation::MinMax)
}

fn scene(points: &[(f64, f64)]) -> (RangeAngleMap, Footprints) {
    seen(Scene::of_points(points.iter().copied()).objects)
}

fn shifted(map: &RangeAngleMap, by: i32) -> RangeAngleMap {
    let columns = map.lambda.ncols();
    let source = |(r, c)| map.lambda[[r, shifted_column(c, -by, columns)]];
    RangeAngleMap { lambda: Array2::from_shape_fn(map.lambda.dim(), source) }
}

fn without(map: &RangeAngleMap, cells: &[CellIndex]) -> RangeAngleMap {
    let mut map = map.clone();
    for &[r, c] in cells {
        for c in c.saturating_sub(60)..(c + 60).min(1024) {
            map.lambda[[r, c]] = 0.0;
        }
    }
    map
}

const TWO: [(f64, f64); 2] = [(-4.0, 12.0), (5.0, 20.0)];

#[test]
fn an_object_that_the_output_lacks_is_missed() {
    let (target, footprints) = scene(&TWO);
    let output = without(&target, &footprints.cells()[1]);
    let found = footprints.judge(&target, &output, TARGET_ETA);
    assert_eq!((&found.objects[..], found.missed()), (&[ObjectVerdict::Found, ObjectVerdict::Missed][..], 1));
    assert!(found.ghosts.is_empty());
    assert!(found.covered[0] == 1.0 && found.covered[1] == 0.0, "{:?}", found.covered);
}

#[test]
fn a_shift_by_a_few_columns_is_the_wrong_tooth() {
    let (target, footprints) = scene(&[(5.0, 20.0)]);
    for by in [-3, 1, 6] {
        let found = footprints.judge(&target, &shifted(&target, by), TARGET_ETA);
        assert_eq!(found.objects, [ObjectVerdict::WrongTooth { columns: by }]);
        assert!(found.ghosts.is_empty());
    }
}

#[test]
fn a_blob_elsewhere_is_a_ghost() {
    let (target, footprints) = scene(&[(5.0, 20.0)]);
    let mut output = target.clone();
    output.lambda.slice_mut(s![100..104, 200..206]).fill(1.0);
    output.lambda[[50, 50]] = 1.0;
    let found = footprints.judge(&target, &output, TARGET_ETA);
    assert_eq!((found.objects[0], found.ghosts.len()), (ObjectVerdict::Found, 1), "one cell is no ghost");
    assert_eq!(found.ghosts[0].cells.len(), 24);
}

#[test]
fn one_blob_over_two_objects_is_a_merger() {
    let (target, footprints) = scene(&[(-2.0, 20.0), (2.0, 20.0)]);
    assert_eq!(footprints.judge(&target, &target, TARGET_ETA).objects, [ObjectVerdict::Found; 2]);
    let row = footprints.cells()[0][0][0];
    let mut output = target.clone();
    output.lambda.slice_mut(s![row..row + 2, 400..620]).fill(1.0);
    let found = footprints.judge(&target, &output, TARGET_ETA);
    assert_eq!(found.objects, [ObjectVerdict::Merged { with: 1 }, ObjectVerdict::Merged { with: 0 }]);
}

#[test]
fn the_ends_of_a_wall_are_the_wall_and_no_ghosts() {
    let objects = vec![Object::Wall(Wall::new(0.0, 10.0, 5.0, 0.0)), Object::Point(Point::new(-6.0, 20.0))];
    let (target, footprints) = seen(objects);
    assert_eq!(footprints.echoes.iter().map(Vec::len).collect::<Vec<_>>(), [3, 0], "a glint and two ends");
    let mut output = RangeAngleMap { lambda: Array2::zeros(target.lambda.raw_dim()) };
    let draw = |output: &mut RangeAngleMap, [row, column]: CellIndex| {
        output.lambda.slice_mut(s![row - 1..row + 2, column - 2..column + 3]).fill(1.0);
    };
    let middle = |cells: &[CellIndex]| cells[cells.len() / 2];
    for end in &footprints.echoes[0][1..] {
        draw(&mut output, middle(end));
    }
    draw(&mut output, middle(&footprints.cells()[1]));
    let judged = footprints.judge(&target, &output, 0.5);
    assert_eq!((judged.objects[0], judged.ghosts.len()), (ObjectVerdict::Found, 0), "two of its three echoes");
    output.lambda.fill(0.0);
    draw(&mut output, [300, 100]);
    let judged = footprints.judge(&target, &output, 0.5);
    assert_eq!((judged.objects[0], judged.ghosts.len()), (ObjectVerdict::Missed, 1));
    assert_eq!(judged.headline(), "0 of 2 found, 1 false");
}

/// The footprints of a shipped scene over 100 dB, and the verdicts on an output equal to the target above the threshold 0.7.
fn same_output(id: &str, elements: usize) -> (Footprints, OutputVerdicts) {
    let document = Preset::by_id(id).unwrap().load().unwrap();
    let radar = Radar { elements, end_elements: document.radar.end_elements.min(elements / 2), ..document.radar };
    let (target, footprints) = seen_by(&radar, &document.scene, Normalisation::DynamicRange(Decibels(100.0)));
    let judged = footprints.judge(&target, &target, 0.7);
    (footprints, judged)
}

#[test]
fn objects_below_the_targets_threshold_are_no_ghosts() {
    for (id, elements, hidden) in [("street", 1024, &[3, 4][..]), ("traffic", 8, &[0])] {
        let (footprints, judged) = same_output(id, elements);
        for &object in hidden {
            let is_hidden = footprints.objects[object].is_empty();
            assert_eq!((is_hidden, judged.objects[object]), (true, ObjectVerdict::Found), "{id}, object {object}");
        }
        assert!(judged.ghosts.is_empty(), "{id}: {}", judged.headline());
    }
    assert_eq!(same_output("street", 1024).1.headline(), "5 of 5 found, 0 false");
}

#[test]
fn an_object_in_neither_map_is_hidden_and_not_counted() {
    let point = |x_metres, reflectivity| Object::Point(Point { reflectivity, ..Point::new(x_metres, 15.0) });
    let (target, footprints) = seen(vec![point(-5.0, 1.0), point(5.0, 1e-6)]);
    let found = footprints.judge(&target, &target, TARGET_ETA);
    assert_eq!(found.objects, [ObjectVerdict::Found, ObjectVerdict::Hidden]);
    assert_eq!(found.headline(), "1 of 1 found, 0 false");
    let mut output = target.clone();
    let [row, column] = footprints.places[1][0];
    output.lambda.slice_mut(s![row - 2..row + 2, column - 2..column + 2]).fill(1.0);
    let found = footprints.judge(&target, &output, TARGET_ETA);
    assert_eq!(found.headline(), "2 of 2 found, 0 false", "the output shows it");
}

#[test]
fn a_footprint_has_the_loud_cells_of_the_whole_map() {
    let radar = Radar { elements: 128, end_elements: 12, samples: 96, ..Radar::default() };
    let objects = [
        Object::Point(Point::new(1.0, 5.0)),
        Object::Wall(Wall::new(-1.0, 4.0, 2.0, 10.0)),
        Object::Post(Post::new(0.5, 2.0, 0.2)),
    ];
    for object in objects {
        let seen = ObjectWithOccluders::from(object.clone());
        let echoing = EchoSources::of_objects(&radar, std::slice::from_ref(&seen));
        let plan = SynthesisPlan::cheapest(echoing.len(), amplitude_bound(&radar, &echoing), SIMULATION_TOLERANCE);
        let profiles = range_transform(&radar, &beat_signal(&radar, &echoing, &plan));
        let magnitudes = angle_transform(&radar, &profiles, Aperture::Full).cells.mapv(|cell| cell.norm());
        let peak = magnitudes.iter().fold(0.0, |a: f64, b| a.max(*b));
        for part in [0.0, 1e-6, 1e-3, 0.1, 0.7, 1.0] {
            let level = part * peak;
            let loud = magnitudes.indexed_iter().filter(|(_, magnitude)| **magnitude > level);
            let expected: Vec<CellIndex> = loud.map(|((bin, column), _)| [bin, column]).collect();
            assert!(footprint(&radar, &seen, level) == expected, "{object:?} above {part} of its peak");
            assert_eq!(expected.is_empty(), part >= 1.0, "{object:?} above {part} of its peak");
        }
    }
}

#[test]
fn many_objects_keep_their_order_and_their_footprints() {
    let radar = Radar { elements: 128, end_elements: 12, samples: 96, ..Radar::default() };
    let all = Scene::of_points((0..7).map(|i| (0.6 * f64::from(i) - 1.8, 3.0 + 0.4 * f64::from(i))));
    let full = LogMaps::of_signal(&radar, &simulate(&radar, &all, Floor::Thesis, 1).unwrap()).full;
    let (target, scale) = (full.normalise(Normalisation::MinMax), full.scale(Normalisation::MinMax));
    let cells_of = |objects: &[Object]| {
        let scene = Scene { objects: objects.to_vec(), ..Scene::default() };
        Footprints::new(&radar, &scene, &target, scale).objects
    };
    let alone: Vec<_> = all.objects.chunks(1).flat_map(cells_of).collect();
    assert!(cells_of(&all.objects) == alone && alone.iter().all(|cells| !cells.is_empty()));
}
