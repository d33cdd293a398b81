//! Objects that move: the range-Doppler map, and the time at which the scene is looked at.

use crate::session::*;
use apertura::interact::{Field, FieldChange};

fn moving() -> Session {
    let mut s = Session::start();
    s.press(Modifiers::COMMAND, Key::A);
    s.ask(EditCommand::SetField(Field::VelocityY, FieldChange::To(10.0)));
    s.ask(RadarCommand::Set(Box::new(Radar { chirps: 64, ..s.state().radar().clone() })));
    s
}

#[test]
fn a_closed_range_doppler_map_or_one_chirp_costs_nothing() {
    let mut s = moving();
    let requests = |s: &Session| s.state().panels.requests(Panel::RangeDoppler);
    assert_eq!(requests(&s), 0, "a closed panel costs nothing");
    s.ask(WindowCommand::OpenPanel(Panel::RangeDoppler));
    let radar = s.state().radar().clone();
    let (_, column) = s.state().doppler_peak().expect("a map");
    let velocity = radar.velocity_of_column_metres_per_second(column as f64);
    // The nearer of the two is the louder one.
    let expected = s.objects()[1].radial_velocity_metres_per_second();
    assert!((velocity - expected).abs() < 0.6 * radar.velocity_resolution_metres_per_second(), "{velocity}");
    let asked = requests(&s);
    s.undo();
    assert_eq!((s.state().radar().chirps, requests(&s)), (1, asked), "chirps are undone");
    s.ask(RadarCommand::Set(Box::new(radar)));
    assert_eq!(s.state().radar().chirps, 64);
    s.ask(WindowCommand::TogglePanel(Panel::RangeDoppler));
    let asked = requests(&s);
    s.ask(EditCommand::SetField(Field::VelocityY, FieldChange::To(3.0)));
    assert_eq!(requests(&s), asked);
}

#[test]
fn maps_follow_time_but_the_document_stays() {
    let mut s = moving();
    let document = s.editor().scene().clone();
    let (requested, _) = s.state().work_done();
    let at = s.handle("point 1: move");
    s.ask(ViewCommand::SetTime(0.5));
    assert!(Arc::ptr_eq(s.editor().scene(), &document) && s.state().work_done().0 > requested);
    assert_eq!(s.state().scene().objects[0].centre_metres(), [0.0, 25.0]);
    s.drag(at, vec2(30.0, 0.0), 3);
    assert!(Arc::ptr_eq(s.editor().scene(), &document) && s.state().timeline.seconds == 0.0);
    s.ask(ViewCommand::SetTime(0.5));
    s.ask(EditCommand::Nudge { dx_metres: 1.0, dy_metres: 0.0 });
    assert_eq!((s.place(0), s.state().timeline.seconds), ([1.0, 20.0], 0.0));
}
