//! Radars that the thesis never had, in the app: maps, every model-based method, lists.

use crate::session::*;
use apertura::radar::{SPEED_OF_LIGHT, presets};

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

#[test]
fn every_map_follows_the_chosen_radar() {
    let mut s = Session::start();
    for (what, radar) in radars() {
        s.ask(RadarCommand::Set(Box::new(radar.clone())));
        assert_eq!((s.state().radar(), s.state().messages()), (&radar, 0), "{what}");
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
