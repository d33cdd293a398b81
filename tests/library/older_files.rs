//! Files of version 0.1.0 are read, with all their contents. They stand in `tests/data/program-0.1.0` and must never be rewritten. The program wrote
//! them, but for `recording.*`, which is a user's, and `shared-view.txt`, `settings.ron` and `autosave.toml`, which have the layout of its own files.

use crate::prelude::*;
use apertura::evaluate::echoes::EchoCounts;
use apertura::evaluate::rows::{merge, missing_rows};
use apertura::reconstruct::BARTLETT;
use apertura::scene::{Polygon, file};
use apertura::share::SharedScene;
use std::fs::File;

fn path(name: &str) -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/program-0.1.0")).join(name)
}

fn scene(name: &str) -> SceneFile {
    file::load(&path(name)).unwrap()
}

fn rows(name: &str) -> Vec<Row> {
    read_rows(File::open(path(name)).unwrap()).unwrap()
}

#[test]
fn a_scene_of_points_lines_clusters_and_disturbances_is_read() {
    let SceneFile { scene, radar } = scene("scene-thesis.toml");
    assert_eq!(scene.name, "Worse than Every \"kind\"");
    assert!(scene.notes.starts_with("SE 197.2, P_D 60.53 %"), "{}", scene.notes);
    assert_eq!((scene.noise_seed, scene.shadows), (2_357_846_794_805_116, false));
    assert_eq!((radar.elements, radar.end_elements, radar.samples), (64, 6, 128));
    assert_eq!((radar.bandwidth_hz, radar.transmit_power_watts), (1.5e9, 50.0));
    assert_eq!((radar.window, radar.carrier), (WindowFunction::Hamming, Carrier::OneWay));
    let point = Point {
        reflectivity: 0.38346251019252237,
        velocity_x_metres_per_second: 2.0,
        velocity_y_metres_per_second: -1.0,
        ..Point::new(-1.1145950794045416, 4.968054565416139)
    };
    assert_eq!(scene.objects[0], Object::Point(point));
    let line = Line {
        direction_degrees: 30.0,
        reflectivity: 0.6140281606452355,
        ..Line::vertical(2.1527616149167548, 3.2841005232769156, 0.1, 20)
    };
    assert_eq!(scene.objects[1], Object::Line(line));
    let cluster = GaussianCluster {
        seed: 9,
        reflectivity: 1.029206300305304,
        ..GaussianCluster::new([-1.803295222295814, 7.151105901163686], [0.5, 0.25], 40)
    };
    assert_eq!(scene.objects[2], Object::Gaussian(cluster));
    assert_eq!(scene.objects.len(), 4);
    let mirror = scene.disturbances.mirror.unwrap();
    assert_eq!((mirror.direction_degrees, mirror.reflection), (80.0, 0.25));
    assert_eq!(scene.disturbances.interferer.unwrap().crossing, 0.6);
    let elements = &scene.disturbances.elements;
    assert_eq!((elements.dead(), elements.element(17).dead), (1, true));
}

#[test]
fn a_scene_of_bodies_before_a_physical_radar_is_read() {
    let SceneFile { scene, radar } = scene("scene-bodies.toml");
    assert_eq!((radar.convention(), radar.elements, radar.carrier_hz), (Convention::Physical, 64, 77e9));
    assert_eq!((radar.chirps, radar.chirp_interval_seconds), (4, 25.6e-6));
    assert_eq!(radar.element_spacing_metres, radar.filled_spacing_metres());
    let budget = radar.budget.unwrap();
    assert_eq!((budget.noise_figure_db, budget.half_power_width_degrees), (12.0, Some(80.0)));
    let wall = Wall {
        reflectivity: 1.3788750669892385,
        roughness_millimetres: 0.3,
        seed: 2,
        ..Wall::new(1.9209016351181716, 9.291662040022494, 4.0, 7.147339442083556)
    };
    assert_eq!(scene.objects[0], Object::Wall(wall));
    let block = Block {
        reflectivity: 1.2628024258568682,
        velocity_y_metres_per_second: -3.0,
        ..Block::new([1.4533787998811358, 7.64929482017661], [2.5, 1.5], 51.13990195955402)
    };
    assert_eq!(scene.objects[1], Object::Box(block));
    let post = Post { reflectivity: 1.1073794140550692, ..Post::new(-2.860124342047323, 7.143181904970628, 0.1) };
    assert_eq!(scene.objects[2], Object::Post(post));
    let corners = [
        [-6.382175433708188, 9.05431276735128],
        [-5.392803848071652, 9.199722070819272],
        [-5.610917803273639, 10.683779449274077],
    ];
    let polygon = Polygon { reflectivity: 0.41589862424018603, ..Polygon::new(corners.to_vec()) };
    assert_eq!(scene.objects[3], Object::Polygon(polygon));
}

#[test]
fn a_scene_before_pairs_of_antennas_is_read() {
    let radar = scene("scene-pairs.toml").radar;
    assert_eq!((radar.elements, radar.end_elements, radar.is_monostatic()), (8, 3, false));
    let antennas = radar.antennas.as_ref().unwrap();
    assert_eq!((antennas.transmitter_x_metres().len(), antennas.receiver_x_metres()[1]), (2, -0.0014605));
}

#[test]
fn an_archive_of_points_is_read() {
    let scene = scene("scene-set-3.npz").scene;
    let reflectors: usize = scene.objects.iter().map(|object| object.marks().len()).sum();
    assert_eq!(reflectors, 227);
}

fn shared(name: &str) -> SharedScene {
    SharedScene::from_text(&fs::read_to_string(path(name)).unwrap()).unwrap()
}

#[test]
fn scenes_that_were_shared_as_text_are_read() {
    for name in ["thesis", "bodies", "pairs"] {
        let SharedScene { file, view } = shared(&format!("shared-{name}.txt"));
        assert_eq!(file, scene(&format!("scene-{name}.toml")));
        assert_eq!((view.floor.to_string(), view.normalisation.to_string()), ("dbm=-20".into(), "db=60".into()));
        assert_eq!((view.method.as_str(), view.eta, view.lesson), ("nomp", None, None));
    }
}

#[test]
fn all_that_a_shared_view_can_say_is_read() {
    let SharedScene { file, view } = shared("shared-view.txt");
    assert_eq!(file, scene("scene-thesis.toml"));
    assert_eq!((view.eta, view.target_eta), (Some(0.5), 0.85));
    assert_eq!((view.cartesian, view.marks, view.theory), (true, true, false));
    assert_eq!(view.cfar.unwrap().to_string(), "os:guard=2x2:training=4x8:rate=0.001");
    let lesson = view.lesson.unwrap();
    assert_eq!((lesson.id.as_str(), lesson.step, view.range_angle_part.left), ("near-field", 2, 0.25));
}

#[test]
fn a_recording_is_read() {
    let recording = recording::file::load(&path("recording.toml")).unwrap();
    assert_eq!((recording.name.as_str(), recording.radar.elements, recording.radar.samples), ("Two posts", 16, 32));
    assert_eq!((recording.radar.convention(), recording.radar.end_elements), (Convention::Physical, 4));
    let signal = recording.signal().unwrap();
    let energy_of = |element| signal.samples.row(element).iter().map(|sample| sample.norm_sqr()).sum::<f64>();
    let energy: f64 = (0..16).map(energy_of).sum();
    // The mean of both chirps, without element 5, and 1.5 dB taken off the last.
    assert!((energy / 109.38647350579211 - 1.0).abs() < 1e-9, "{energy}");
    assert_eq!((recording.missing.as_slice(), energy_of(5)), (&[5][..], 0.0));
}

#[test]
fn a_lesson_is_read() {
    let lesson = Lesson::load(&path("lesson.toml")).unwrap();
    assert_eq!((lesson.title.as_str(), lesson.steps.len()), ("What a network can and cannot know", 6));
    assert!(lesson.steps.iter().any(|step| step.predict.is_some()));
    assert!(lesson.steps.iter().any(|step| step.challenge.is_some()));
}

#[test]
fn rows_of_format_1_are_read_with_all_that_they_say() {
    let rows = rows("rows.csv");
    let keys: Vec<(&str, u32, &str)> = rows.iter().map(|row| (&*row.set, row.index, &*row.method)).collect();
    let scenes = ["1", "bodies", "noise"].map(|set| ["baseline", "live"].map(|method| (set, 0, method)));
    assert_eq!(keys, scenes.concat());
    for row in &rows {
        assert_eq!((row.version, &*row.program, row.seed), (Some(1), "0.1.0", 4));
        let expected = (Some(Purpose::Test), Some(Reading::Program), Some(Carrier::OneWay));
        assert_eq!((row.purpose, row.reading, row.carrier), expected);
        assert_eq!((row.normalisation, &*row.radar, &*row.scenes), (Some(Normalisation::MinMax), "", ""));
        assert_eq!(row.floor == Some(Floor::Thesis), row.set != "noise");
        assert_eq!(row.echoes.is_some(), row.set == "bodies");
        assert_eq!(row.doubt.is_some(), row.method == "live");
        assert_eq!(row.detection.is_none(), row.set == "noise");
    }
    assert_eq!((rows[1].squared_error, rows[1].eta, &*rows[1].weights), (191.90011058700802, 0.76, "cdda48614d9f"));
    assert_eq!((&*rows[1].optimiser, rows[1].within_doubt), ("AdamW", Some(0.9442481994628906)));
    assert_eq!(rows[2].echoes, Some(EchoCounts([1, 1, 3, 0, 1, 0])));
    assert_eq!(rows[2].echoes_found, Some(EchoCounts([0, 0, 1, 0, 0, 0])));
    assert_eq!((rows[4].floor.unwrap().to_string().as_str(), rows[4].min_range_metres), ("dbm=-20", None));
    assert_eq!(missing_rows(&rows), []);
}

#[test]
fn rows_of_a_detector_and_of_a_folder_are_read() {
    let detected = rows("rows-cfar.csv");
    assert_eq!(detected[0].cfar, "os:guard=2x2:training=4x8:rate=0.001");
    assert_eq!((detected[0].cfar_detection, detected[0].cfar_false_alarm), (Some(0.0), Some(0.005224453035258379)));
    assert_eq!(detected[0].floor, Some(Floor::Snr(Decibels(20.0))));
    let folder = rows("rows-folder.csv");
    assert_eq!((&*folder[0].set, folder[0].carrier, folder[0].purpose, folder[0].seed), ("own", None, None, 0));
    assert_eq!((&*folder[0].scenes, folder[0].is_generated()), ("e6c4f7abac18", false));
}

#[test]
fn shards_of_format_1_are_merged_with_each_other_alone() {
    let shards =
        || vec![("0.csv".to_owned(), rows("rows-shard-0.csv")), ("1.csv".to_owned(), rows("rows-shard-1.csv"))];
    let merged = merge(shards()).unwrap();
    assert_eq!((merged.len(), missing_rows(&merged)), (8, Vec::new()));
    assert_eq!(missing_rows(&rows("rows-shard-0.csv"))[0].to_string(), "set 1, baseline: 2 of 4 scenes (shard 1/2)");
    let sets = [SceneSet::Generated(Kind::Set1)];
    let now = Campaign { count: 4, ..Campaign::default() }.empty_rows(&sets, &[&Baseline, &BARTLETT]).unwrap();
    let with_now = [shards(), vec![("now.csv".to_owned(), now[0].clone())]].concat();
    let refused = merge(with_now).unwrap_err().to_string();
    assert!(refused.starts_with("version is 1 in 0.csv") && refused.contains("quieter from format 2 on"), "{refused}");
}
