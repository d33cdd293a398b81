//! Scenes built to break numerics.

use crate::radar::Radar;
use crate::scene::{MIN_ELEMENT_DISTANCE_METRES, Object, Point, Reflector, Scene};

#[derive(Debug, Clone, PartialEq)]
pub struct StressScene {
    pub name: &'static str,
    pub scene: Scene,
    /// Whether it must be refused instead of simulated.
    pub refused: bool,
}

/// Every scene, for this radar; `many` points where many coincide.
pub fn all(radar: &Radar, many: usize) -> Vec<StressScene> {
    let point = |x_metres: f64, y_metres: f64, reflectivity: f64| Reflector { x_metres, y_metres, reflectivity };
    let element = radar.element_x_metres(radar.elements / 3);
    let max = radar.max_range_metres();
    let far = max / 2.0;
    let beside = MIN_ELEMENT_DISTANCE_METRES * 1.001;
    let scenes = [
        ("empty", vec![]),
        ("one point", vec![point(0.3, far, 1.0)]),
        ("on an element", vec![point(element, 0.0, 1.0)]),
        ("a micrometre beside an element", vec![point(element, beside, 1.0), point(0.3, far, 1.0)]),
        ("in the line of the array", vec![point(element + radar.element_spacing_metres * 0.5, 0.0, 1.0)]),
        (
            "pairs that cancel",
            (0..8)
                .flat_map(|i| {
                    let y = far * (0.3 + 0.1 * f64::from(i));
                    [point(0.7, y, 1.0), point(0.7, y, -1.0)]
                })
                .collect(),
        ),
        ("coincident points", vec![point(-1.1, far, 1.0); many]),
        ("points 1e-12 m apart", (0..20).map(|i| point(2.0 + 1e-12 * f64::from(i), far, 1.0)).collect()),
        (
            "near cos = 1 and -1",
            [1e-300, 1e-9, 1e-3, 0.0].into_iter().flat_map(|y| [point(far, y, 1.0), point(-far, y, 1.0)]).collect(),
        ),
        ("behind the array", vec![point(1.0, -far, 1.0), point(-2.0, -0.1, 1.0)]),
        (
            "ranges that wrap",
            [1.0, 1.0 - 1e-9, 3.7, 1e3, 1e7, 1e10].into_iter().map(|m| point(0.1, m * max, m * m)).collect(),
        ),
        (
            "reflectivities from 1e-30 to 1e30",
            (-30..=30).map(|e| point(0.05 * f64::from(e), far * (1.0 + 0.01 * f64::from(e)), 10f64.powi(e))).collect(),
        ),
        ("reflectivities of 1e100 and -1e100", vec![point(0.1, far, 1e100), point(0.2, far, -1e100)]),
        ("reflectivity zero: all cells alike", vec![point(0.3, far, 0.0), point(0.4, far, -0.0)]),
        ("subnormal reflectivity: all cells alike", vec![point(0.3, far, 1e-310), point(0.4, far, 5e-324)]),
    ];
    let scene = |points: Vec<Reflector>| Scene { objects: points.iter().map(object).collect(), ..Scene::default() };
    scenes
        .into_iter()
        .map(|(name, points)| StressScene { name, scene: scene(points), refused: name == "on an element" })
        .collect()
}

fn object(r: &Reflector) -> Object {
    Object::Point(Point { reflectivity: r.reflectivity, ..Point::new(r.x_metres, r.y_metres) })
}

/// The scene of these reflectors, each moved along the array to the next number that f64 holds.
pub fn moved_by_one_ulp(reflectors: &[Reflector]) -> Scene {
    let moved = reflectors.iter().map(|r| object(&Reflector { x_metres: r.x_metres.next_up(), ..*r }));
    Scene { objects: moved.collect(), ..Scene::default() }
}
