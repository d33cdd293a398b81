//! Left in the scene is left in every map: in the thesis' convention, in the physical one, and of a recording whose file lists the elements
//! from the right.

use crate::session::*;
use apertura::picture::{PictureFormat, Style, compose, compose_recording};
use apertura::recording;
use apertura::scene::Reflector;
use apertura::signal::exact;
use eframe::egui::ColorImage;

const POINT: [f64; 2] = [-8.0, 12.0];

const KINDS: [MapKind; 6] =
    [MapKind::Input0, MapKind::Input1, MapKind::Target, MapKind::Output, MapKind::TargetAbove, MapKind::OutputAbove];

fn radar(convention: Convention) -> Radar {
    let table = Radar { elements: 128, samples: 64, bandwidth_hz: 2.5e8, ..Radar::default() };
    table.in_convention(convention)
}

fn scene(folder: &Path, convention: Convention) {
    let [x, y] = POINT;
    let text = format!(
        "[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\nconvention = \"{}\"\n\n\
         [[object]]\nkind = \"point\"\nx_metres = {x:?}\ny_metres = {y:?}\n",
        convention.name()
    );
    std::fs::write(folder.join("scene.toml"), text).unwrap();
}

fn recording(folder: &Path) -> PathBuf {
    let radar = radar(Convention::Physical);
    let [x_metres, y_metres] = POINT;
    let mut samples = exact::beat_signal(&radar, &[Reflector { x_metres, y_metres, reflectivity: 1.0 }]).samples;
    samples.invert_axis(ndarray::Axis(0));
    let signs = "carrier_at = \"first-sample\"\nbeat_sign = \"+\"\nreverse_elements = true\n";
    write_recording(folder, &radar, &samples, ["format = 2\n", signs])
}

fn session(convention: Convention) -> Session {
    let folder = tempdir().unwrap();
    scene(folder.path(), convention);
    Session::opened(folder, Some("scene.toml"), baseline(), USUAL_SIZE)
}

fn sessions() -> [(&'static str, Session); 3] {
    let mut recorded = session(Convention::Thesis);
    let path = recording(recorded.folder.path());
    recorded.ask(DocumentCommand::OpenPath(path));
    assert!(recorded.state().editor.document().recording().is_some());
    [("thesis", session(Convention::Thesis)), ("physical", session(Convention::Physical)), ("recording", recorded)]
}

fn picture(s: &mut Session, kind: MapKind) -> Arc<ColorImage> {
    s.ask(WindowCommand::OpenPanel(Panel::Map(kind)));
    s.app.state_mut().ask(ExportCommand::CopyMap(kind));
    s.app.step();
    let commands = &s.app.output().platform_output.commands;
    let copied = commands.iter().find_map(|c| if let OutputCommand::CopyImage(image) = c { Some(image) } else { None });
    Arc::new(copied.expect("a picture on the clipboard").clone())
}

/// Place of the brightest pixels of a picture, as parts of its width from the left and of its height from the top: the mean of equally bright ones.
fn brightest(image: &ColorImage) -> [f64; 2] {
    let [width, height] = image.size;
    let level = |i: usize| image.pixels[i].g();
    let top = (0..image.pixels.len()).map(level).max().unwrap();
    let at: Vec<usize> = (0..image.pixels.len()).filter(|i| level(*i) == top).collect();
    let mean = |of: &dyn Fn(usize) -> usize, side: usize| {
        at.iter().map(|i| of(*i) as f64 + 0.5).sum::<f64>() / (at.len() * side) as f64
    };
    [mean(&|i| i % width, width), mean(&|i| i / width, height)]
}

fn blob(s: &mut Session) -> Pos2 {
    let [across, down] = brightest(&picture(s, MapKind::Target));
    let rect = s.app.get_by_label("Target map").rect();
    rect.left_top() + vec2(rect.width() * across as f32, rect.height() * down as f32)
}

#[test]
fn a_point_on_the_left_is_left_in_every_map() {
    for (name, mut s) in sessions() {
        for projection in ["range-angle", "Cartesian"] {
            for kind in KINDS {
                let [across, _] = brightest(&picture(&mut s, kind));
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
        let (radar, scene) = (radar(convention), Scene::of_points([POINT.into()]));
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
            let level = |x: u32, y: u32| picture.get_pixel(x, y).0.iter().map(|c| u32::from(*c)).sum::<u32>();
            let pixels = || (y..y + height).flat_map(|y| (x..x + width).map(move |x| (x, y)));
            let top = pixels().map(|(x, y)| level(x, y)).max().unwrap();
            let bright: Vec<u32> = pixels().filter(|at| level(at.0, at.1) == top).map(|at| at.0 - x).collect();
            let across = f64::from(bright.iter().sum::<u32>()) / (bright.len() as f64 * f64::from(width));
            assert!((0.05..0.45).contains(&across), "{name}, map {row}, {column}: at {across} of the width");
        }
    }
}
