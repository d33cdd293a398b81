//! Radars that the thesis never had, in the app.

use crate::session::*;
use apertura::radar::presets;

#[test]
fn every_map_follows_the_chosen_radar() {
    let mut s = Session::start();
    // The large ones take long in an unoptimised build.
    let small = |radar: &Radar| radar.elements * radar.samples <= 1 << 15;
    for (index, preset) in presets::ALL.iter().enumerate().filter(|(_, p)| small(&p.radar)) {
        s.ask(RadarCommand::Preset(index));
        assert_eq!((s.state().radar(), s.state().notices.list.len()), (&preset.radar, 0));
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
