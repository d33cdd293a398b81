//! Left in the scene is left in every map: in both conventions, and of a recording whose file lists the elements from the right.

use crate::session::*;
use apertura::picture::{PictureFormat, Style, compose, compose_recording};
use apertura::recording;
use apertura::scene::Reflector;
use apertura::scene::file::{SceneFile, save};
use apertura::signal::exact;

const POINT: [f64; 2] = [-8.0, 12.0];

const KINDS: [MapKind; 6] =
    [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output, MapKind::TargetAbove, MapKind::OutputAbove];

fn radar(convention: Convention) -> Radar {
    let table = Radar { elements: 128, samples: 64, bandwidth_hz: 2.5e8, ..Radar::default() };
    table.in_convention(convention)
}

fn scene() -> Scene {
    Scene::of_points([POINT.into()])
}

fn recording(folder: &Path) -> PathBuf {
    let radar = radar(Convention::Physical);
    let [x_metres, y_metres] = POINT;
    let mut heard = exact::beat_signal(&radar, &[Reflector { x_metres, y_metres, reflectivity: 1.0 }]).samples;
    heard.invert_axis(ndarray::Axis(0));
    ndarray_npy::write_npy(folder.join("recorded.npy"), &heard).unwrap();
    let Radar { carrier_hz, bandwidth_hz, element_spacing_metres, elements, end_elements, samples, .. } = radar;
    let text = format!(
        "format = 2\n[radar]\ncarrier = \"two-way\"\ncarrier_hz = {carrier_hz:?}\nbandwidth_hz = {bandwidth_hz:?}\n\
         element_spacing_metres = {element_spacing_metres:?}\nelements = {elements}\nend_elements = {end_elements}\n\
         samples = {samples}\n[recording]\nfile = \"recorded.npy\"\naxes = [\"element\", \"sample\"]\n\
         carrier_at = \"first-sample\"\nbeat_sign = \"+\"\nreverse_elements = true\n"
    );
    std::fs::write(folder.join("recorded.toml"), text).unwrap();
    folder.join("recorded.toml")
}

fn session(convention: Convention) -> Session {
    let folder = tempdir().unwrap();
    let file = SceneFile { scene: scene(), radar: radar(convention) };
    save(&folder.path().join("scene.toml"), &file).unwrap();
    Session::opened(folder, Some("scene.toml"), baseline(), USUAL_SIZE)
}

fn sessions() -> [(&'static str, Session); 3] {
    let mut recorded = session(Convention::Thesis);
    let path = recording(recorded.folder.path());
    recorded.ask(DocumentCommand::OpenPath(path));
    assert!(recorded.state().editor.document().recording().is_some());
    [("thesis", session(Convention::Thesis)), ("physical", session(Convention::Physical)), ("recording", recorded)]
}

/// Place of the brightest pixels of a picture, as parts of its width from the left and of its height from the top: the mean of equally bright ones.
fn brightest([width, height]: [usize; 2], level: impl Fn(usize) -> u32) -> [f64; 2] {
    let top = (0..width * height).map(&level).max().unwrap();
    let at: Vec<usize> = (0..width * height).filter(|i| level(*i) == top).collect();
    let mean = |of: &dyn Fn(usize) -> usize, side: usize| {
        at.iter().map(|i| of(*i) as f64 + 0.5).sum::<f64>() / (at.len() * side) as f64
    };
    [mean(&|i| i % width, width), mean(&|i| i / width, height)]
}

fn brightest_of_map(s: &mut Session, kind: MapKind) -> [f64; 2] {
    s.ask(WindowCommand::OpenPanel(Panel::Map(kind)));
    s.app.state_mut().ask(ExportCommand::CopyMap(kind));
    s.app.step();
    let commands = &s.app.output().platform_output.commands;
    let copied = commands.iter().find_map(|c| if let OutputCommand::CopyImage(image) = c { Some(image) } else { None });
    let image = copied.expect("a picture on the clipboard");
    brightest(image.size, |i| image.pixels[i].g().into())
}

fn blob(s: &mut Session) -> Pos2 {
    let [across, down] = brightest_of_map(s, MapKind::Target);
    let rect = s.app.get_by_label("Target map").rect();
    rect.left_top() + vec2(rect.width() * across as f32, rect.height() * down as f32)
}

#[test]
fn a_point_on_the_left_is_left_in_every_map() {
    for (name, mut s) in sessions() {
        for projection in ["range-angle", "Cartesian"] {
            for kind in KINDS {
                let [across, _] = brightest_of_map(&mut s, kind);
                // Both ends and the whole array see it at cos θ between -0.6 and -0.5.
                assert!((0.05..0.45).contains(&across), "{name}, {kind:?}, {projection}: at {across} of the width");
            }
            s.ask(ViewCommand::ToggleProjection);
        }
    }
}

#[test]
fn pointing_at_a_blob_reads_the_direction_of_its_object() {
    for (name, mut s) in sessions() {
        let at = blob(&mut s);
        s.app.hover_at(at);
        s.settle();
        assert!(s.shows("cos θ −0.5"), "{name}: the pointer reads another direction");
    }
}

fn files() -> [(&'static str, Vec<u8>); 3] {
    let folder = tempdir().unwrap();
    let recording = recording::file::load(&recording(folder.path())).unwrap();
    let style = Style { floor: Floor::Exact, ..Style::default() };
    let of_scene = |convention| {
        let (radar, scene) = (radar(convention), scene());
        let signal = simulate(&radar, &scene, style.floor, 0).unwrap();
        compose(&radar, &scene, &signal, &Baseline, &style, PictureFormat::Png).unwrap()
    };
    [
        ("thesis", of_scene(Convention::Thesis)),
        ("physical", of_scene(Convention::Physical)),
        ("recording", compose_recording(&recording, &Baseline, &style, PictureFormat::Png).unwrap()),
    ]
}

#[test]
fn a_point_on_the_left_is_left_in_every_map_of_a_file() {
    for (name, bytes) in files() {
        let picture = image::load_from_memory(&bytes).unwrap().to_rgb8();
        // The six maps, without titles, axes and bars.
        for (row, column) in [0, 1].into_iter().flat_map(|row| (0..3).map(move |column| (row, column))) {
            let (x, y) = (700 + 485 * column + 68, 84 + 510 * row + 46);
            let (width, height) = (485 - 62 - 74, 510 - 52 - 52);
            let pixel = |i: usize| picture.get_pixel((x + i % width) as u32, (y + i / width) as u32);
            let [across, _] = brightest([width, height], |i| pixel(i).0.map(u32::from).iter().sum());
            assert!((0.05..0.45).contains(&across), "{name}, map {row}, {column}: at {across} of the width");
        }
    }
}
