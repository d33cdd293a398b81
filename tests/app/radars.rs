//! Radars that the thesis never had, in the app: maps, every model-based method, lists.

use crate::session::*;
use apertura::methods;
use apertura::radar::{SPEED_OF_LIGHT, presets};
use apertura::reconstruct::Family;

fn array(elements: usize, end_elements: usize, carrier_hz: f64, wavelengths: f64) -> Radar {
    let element_spacing_metres = wavelengths * SPEED_OF_LIGHT / carrier_hz;
    Radar { elements, end_elements, carrier_hz, element_spacing_metres, samples: 32, ..Radar::default() }
}

fn radars() -> [(&'static str, Radar); 5] {
    [
        ("86 elements", array(86, 12, 77e9, 0.5)),
        ("8 elements, 3 of them an end", array(8, 3, 77e9, 0.5)),
        ("256 elements at 24 GHz", array(256, 12, 24e9, 0.5)),
        ("two-way carrier", Radar { carrier: Carrier::TwoWay, ..array(64, 12, 77e9, 0.5) }),
        ("one wavelength spacing", array(64, 8, 77e9, 1.0)),
    ]
}

fn recorded(s: &Session, radar: &Radar) -> PathBuf {
    let range = 0.5 * radar.max_range_metres();
    let scene = Scene::of_points([(0.28 * range, 0.96 * range)]);
    let heard = simulate(radar, &scene, Floor::Snr(Decibels(40.0)), 1).unwrap();
    write_recording(s.folder.path(), radar, &heard.samples, ["", ""])
}

#[test]
fn every_model_based_method_works_on_five_radars() {
    let model_based = methods::all().into_iter().filter(|m| m.family() != Family::Network);
    let mut s = Session::with_methods(model_based.collect());
    s.ask(ViewCommand::Normalise(Normalisation::DynamicRange(Decibels(40.0))));
    for (what, radar) in radars() {
        s.ask(DocumentCommand::OpenPath(recorded(&s, &radar)));
        assert_eq!(s.state().notices.list.len(), 0, "{what}");
        assert_eq!(s.state().radar(), &radar, "{what}");
        s.ask(WindowCommand::OpenPanel(Panel::Map(MapKind::Unexplained)));
        let mut works = 0;
        for method in methods::all().into_iter().filter(|m| m.family() != Family::Network) {
            let name = method.name();
            s.ask(ViewCommand::Method(name));
            let shown = s.state().pictures();
            assert!(shown.contains(&MapKind::Target) && shown.contains(&MapKind::Input0), "{name} on {what}");
            match s.state().refusal() {
                Some(reason) => {
                    let may_refuse = name.contains("nomp") || name == "hybrid";
                    assert!(may_refuse && !reason.is_empty(), "{name} on {what}: {reason}");
                }
                None => {
                    assert_eq!(s.state().shown_method(), Some(name), "{what}");
                    assert!(s.state().metrics().is_some() && s.state().found().is_some(), "{name} on {what}");
                    works += 1;
                }
            }
        }
        assert!(works >= 10, "{what}: {works} methods");
    }
}

#[test]
fn every_map_follows_the_chosen_radar() {
    let mut s = Session::start();
    for (what, radar) in radars() {
        s.ask(RadarCommand::Set(Box::new(radar.clone())));
        assert_eq!((s.state().radar(), s.state().notices.list.len()), (&radar, 0), "{what}");
        assert_eq!(s.state().shown_method(), Some("baseline"));
        assert!(s.state().refusal().is_none(), "{what}: {:?}", s.state().refusal());
    }
    // The large ones take long in an unoptimised build.
    let small = |radar: &Radar| radar.elements * radar.samples <= 1 << 15;
    for (index, preset) in presets::ALL.iter().enumerate().filter(|(_, p)| small(&p.radar)) {
        s.ask(RadarCommand::Preset(index));
        assert_eq!(s.state().radar(), &preset.radar);
        assert!(s.state().refusal().is_none() && s.state().metrics().is_some());
    }
}

#[test]
fn opened_weights_are_the_method_of_their_radar() {
    let mut s = Session::start();
    let weights = || DocumentCommand::OpenPath("tests/data/shape_reference_weights.safetensors".into());
    let usual = s.state().shown_method();
    s.ask(weights());
    assert_eq!(s.state().shown_method(), usual, "they are for another radar");
    let shape = Radar { elements: 86, end_elements: 8, samples: 72, ..Radar::default() };
    s.ask(RadarCommand::Set(Box::new(shape.in_convention(Convention::Physical))));
    s.ask(weights());
    assert_eq!(s.state().shown_method(), Some("live-shape_reference_weights"), "{:?}", s.state().refusal());
    assert!(s.state().metrics().is_some() && s.state().pictures().contains(&MapKind::Output));
    let damaged = s.path("damaged.safetensors");
    std::fs::write(&damaged, b"no weights").unwrap();
    s.ask(DocumentCommand::OpenPath(damaged));
    assert_eq!(s.state().shown_method(), Some("live-shape_reference_weights"), "what was used stays");
}
