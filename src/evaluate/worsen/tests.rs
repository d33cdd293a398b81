use super::*;
use crate::maps::Normalisation;
use crate::radar::Radar;
use crate::reconstruct::{MethodInfo, ReconstructError, Reconstruction};
use crate::signal::TwoEnds;

fn radar() -> Radar {
    Radar { elements: 64, samples: 64, end_elements: 8, ..Radar::default() }
}

/// A method that answers with an empty map where the strongest echo comes from beyond half the range, and else with one end's map.
struct ShortSighted;

impl Reconstructor for ShortSighted {
    fn info(&self) -> MethodInfo {
        MethodInfo { name: "short-sighted", description: "sees near objects", prior_knowledge: "nothing", eta: 0.8 }
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, _: &Request) -> Result<Reconstruction, ReconstructError> {
        let map = crate::maps::channels_map(radar, ends.first.view()).log_magnitude();
        let (peak, _) = map.decades().indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
        if peak.0 > 32 {
            return Ok(Reconstruction::silence(radar));
        }
        Ok(Reconstruction::of_map(map.normalise(Normalisation::MinMax)))
    }
}

fn search(goal: WorseningGoal, measure: WorseningMeasure) -> WorseningSearch {
    WorseningSearch { radar: radar(), goal, measure, tries: 80, seed: 4, ..WorseningSearch::default() }
}

fn run(search: &WorseningSearch, y_metres: f64) -> WorseningOutcome {
    let scene = Scene::of_points([(0.0, y_metres)]);
    search.run(&scene, &ShortSighted, &Task::default(), |_, _| true).unwrap()
}

/// Half the range is at 2.4 m.
#[test]
fn a_search_finds_where_the_method_stops_seeing() {
    for measure in WorseningMeasure::ALL.into_iter().take(2) {
        let search = search(WorseningGoal::Worsen, measure);
        let found = run(&search, 1.7);
        let (start, worst) = found.ends().unwrap();
        let worst = worst.unwrap();
        assert!(worst.metrics.squared_error > start.metrics.squared_error);
        assert!(worst.scene.objects[0].centre_metres()[1] > 2.3 && worst.moved_metres <= 2.0 + 1e-9);
        assert!(found.path.is_sorted_by(|a, b| measure.of(a) < measure.of(b)));
        assert_eq!((found.tries, &found), (80, &run(&search, 1.7)), "the same seed gives the same search");
    }
}

#[test]
fn a_repair_is_the_smallest_move_that_helps() {
    let found = run(&search(WorseningGoal::Repair, WorseningMeasure::Missed), 3.0);
    let (start, end) = found.ends().unwrap();
    let end = end.unwrap();
    assert_eq!((start.verdicts.missed(), end.verdicts.missed()), (1, 0));
    // From 3.0 m to where the bin's middle is nearer than that of half the range, 2.44 m.
    assert!((0.5..0.75).contains(&end.moved_metres), "{}", end.moved_metres);
    assert!(found.path[1..].is_sorted_by(|a, b| a.moved_metres > b.moved_metres));
    assert_eq!(run(&search(WorseningGoal::Repair, WorseningMeasure::Missed), 1.7).tries, 0, "nothing to repair");
}

#[test]
fn a_stopped_search_keeps_what_it_has() {
    let refuse = |search: &WorseningSearch, scene: &Scene| {
        search.run(scene, &ShortSighted, &Task::default(), |_, _| true).unwrap_err()
    };
    let worsen = search(WorseningGoal::Worsen, WorseningMeasure::SquaredError);
    assert!(refuse(&worsen, &Scene::default()).contains("the scene is empty"));
    let far = WorseningSearch { within_metres: f64::NAN, ..worsen.clone() };
    assert!(refuse(&far, &Scene::of_points([(0.0, 2.0)])).contains("a reach of NaN m"));
    let scene = Scene::of_points([(0.0, 1.7)]);
    let stopped = worsen.run(&scene, &ShortSighted, &Task::default(), |tries, _| tries < 16).unwrap();
    assert_eq!(stopped.tries, 16);
    assert_eq!(stopped.path, run(&WorseningSearch { tries: 16, ..worsen }, 1.7).path);
}

/// A method that answers with an empty map, and with a bright one while the last end sees a glint.
struct Dazzled;

impl Reconstructor for Dazzled {
    fn info(&self) -> MethodInfo {
        MethodInfo { name: "dazzled", description: "is dazzled by glints", prior_knowledge: "nothing", eta: 0.8 }
    }

    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction, ReconstructError> {
        let mut found = ShortSighted.estimate(radar, ends, request)?;
        let strongest = ends.last.iter().map(|sample| sample.norm()).fold(0.0, f64::max);
        found.lambda.lambda.fill(if strongest > 10.0 { 1.0 } else { 0.0 });
        Ok(found)
    }
}

#[test]
fn a_wall_is_turned_until_it_shines() {
    let wall = crate::scene::Wall::new(0.0, 1.6, 0.6, 25.0);
    let scene = Scene { objects: vec![crate::scene::Object::Wall(wall)], ..Scene::default() };
    let search =
        WorseningSearch { within_metres: 1e-3, ..search(WorseningGoal::Worsen, WorseningMeasure::SquaredError) };
    let found = search.run(&scene, &Dazzled, &Task::default(), |_, _| true).unwrap();
    let (start, worst) = found.ends().unwrap();
    let worst = worst.unwrap();
    assert!(worst.metrics.squared_error > start.metrics.squared_error);
    let turned = worst.scene.objects[0].turned_degrees(&scene.objects[0]);
    assert!((-45.0..-10.0).contains(&turned), "it faces the array: {turned}");
    let repair = WorseningSearch { goal: WorseningGoal::Repair, ..search };
    let path = repair.run(&worst.scene, &Dazzled, &Task::default(), |_, _| true).unwrap().path;
    let holds = path.iter().all(|f| f.scene.objects[0].turned_degrees(&worst.scene.objects[0]) == 0.0);
    assert!(holds, "repairs only move");
}
