//! One scene, one seed, the same settings: the same bits in the engine behind the app and from the command line.

use crate::cli::*;
use apertura::engine::{Engine, MapRequest};
use apertura::radar::End;

fn with_a_past(scene: &Scene) -> Engine {
    let mut engine = Engine::new(Radar::default());
    let wanted = MapRequest::default();
    let mut moved = scene.clone();
    engine.update(&Scene::of_points([(-4.0, 9.0)]), &wanted).unwrap();
    for _ in 0..3 {
        moved.objects[0].translate(0.3, 0.1);
        engine.update(&moved, &wanted).unwrap();
    }
    engine.update(&moved, &MapRequest { floor: Floor::Exact, ..wanted }).unwrap();
    engine.update(scene, &wanted).unwrap();
    engine
}

#[test]
fn a_scene_at_rest_has_the_bits_of_the_command_line() {
    let scene = Scene::of_points([(3.0, 12.0), (-4.0, 20.0), (7.5, 7.0), (0.2, 31.0), (1.0, 18.0)]);
    let folder = folder();
    let file = file::SceneFile { scene: scene.clone(), ..Default::default() };
    file::save(&folder.path().join("scene.toml"), &file).unwrap();
    call(&folder, "maps scene.toml -o maps.npz").assert().success();
    let mut written = Npz::open(&folder.path().join("maps.npz")).unwrap();

    let frame = with_a_past(&scene).settle(&scene, &MapRequest::default()).unwrap();
    let ends = frame.ends.unwrap();
    for (key, end) in [("sub0", End::First), ("sub1", End::Last)] {
        assert_eq!(written.complexes::<Ix2>(key).unwrap().t(), *ends.end(end), "{key}");
    }
    let full = written.reals::<Ix3>("polar_full").unwrap().remove_axis(ndarray::Axis(0));
    let lambda = LogMap::new(full).normalise(Normalisation::MinMax);
    assert_eq!(lambda, *frame.full.unwrap().lambda);
}
