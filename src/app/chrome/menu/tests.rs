use super::*;
use crate::app::state::Methods;
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::radar::Radar;
use crate::recording::Recording;
use crate::scene::{Object, Point};
use crate::signal::BeatSignal;

/// The bar for a method that finds reflectors in a recording, or for a scene without methods.
fn bar_for(width: f32, finds_reflectors: bool, developer: bool) -> Harness<'static, Vec<Command>> {
    let mut state = match finds_reflectors {
        true => {
            let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
            let recording = Recording::of_signal(radar.clone(), BeatSignal::silence(&radar));
            let mut state = State { methods: Methods::new(crate::methods::all()), ..State::recorded(recording) };
            state.settings.method = "nomp".to_owned();
            state
        }
        false => State::new(Vec::new()),
    };
    state.settings.developer = developer;
    state.editor.add(Object::Point(Point::new(0.0, 9.0)));
    seen::asking([width, 800.0], move |ui| show(ui, &state))
}

fn bar(width: f32) -> Harness<'static, Vec<Command>> {
    bar_for(width, true, true)
}

#[test]
fn panels_for_developers_are_listed_where_their_switch_is_on() {
    let mut menu = bar_for(900.0, true, false);
    menu.clicks(&["Tools"]);
    let _tool = menu.get_by_label("Bounds");
    for panel in Panel::all().into_iter().filter(|panel| panel.is_developer()) {
        assert!(menu.query_by_label(panel.title()).is_none(), "{panel:?}");
    }
    let mut menu = bar(900.0);
    menu.clicks(&["Tools", "Training"]);
    assert_eq!(*menu.state(), [Command::Window(WindowCommand::OpenPanel(Panel::Training))]);
}

#[test]
fn every_tile_stands_in_one_menu() {
    let mut found: Vec<Panel> = Vec::new();
    for menus in [&["View", "Panels"][..], &["Tools"], &["Help"]] {
        let mut menu = bar(900.0);
        menu.clicks(menus);
        let listed = |panel: &Panel| {
            menu.query_all_by_role_and_label(egui::accesskit::Role::CheckBox, panel.tile_title()).next().is_some()
        };
        let before = found.len();
        found.extend(Panel::tiles().into_iter().filter(listed));
        assert!(found.len() > before, "{menus:?} has panels");
    }
    let all = Panel::tiles();
    assert!(all.iter().all(|panel| found.iter().filter(|p| *p == panel).count() == 1), "{found:?}");
}

#[test]
fn the_palette_names_the_menus_in_which_a_command_stands() {
    use crate::app::state::{listed, menu_path};
    let mut paths: Vec<&[&str]> = listed().iter().map(|e| menu_path(&e.command)).filter(|p| !p.is_empty()).collect();
    paths.sort();
    paths.dedup();
    assert!(paths.len() > 10, "{paths:?}");
    for path in paths {
        let mut menu = bar(900.0);
        menu.clicks(path);
        for entry in listed().iter().filter(|e| menu_path(&e.command) == path) {
            // Names in the palette begin with the menu's title. Presets are named as their scenes.
            let name = entry.name.split_once(": ").map_or(entry.name.as_ref(), |(_, rest)| rest);
            let is_preset = matches!(entry.command, Command::Document(DocumentCommand::Preset(_)));
            let stands = menu.query_all_by_label_contains(name).next().is_some() || is_preset;
            assert!(stands, "{} in {path:?}", entry.name);
        }
    }
}

#[test]
fn random_scenes_have_a_menu_of_their_own_with_their_seed() {
    let mut menu = bar(900.0);
    menu.clicks(&["Scene"]);
    let name = Kind::Walls.description();
    assert!(menu.query_by_label_contains(name).is_none());
    menu.clicks(&["Random scene"]);
    let is_listed = |kind: Kind| menu.query_all_by_label_contains(kind.description()).next().is_some();
    assert!(Kind::all().all(is_listed));
    menu.get_by_label_contains(name).click();
    menu.run();
    assert_eq!(*menu.state(), [Command::Document(DocumentCommand::RandomScene(Kind::Walls))]);
    assert!(menu.query_by_label("Fit scene").is_none(), "the menu has closed");
    menu.clicks(&["Scene", "Random scene"]);
    menu.enters("Next: seed", "7");
    let next = DocumentCommand::SetNextRandom { seed: 7, number: 0 };
    assert_eq!(menu.state().last(), Some(&Command::Document(next)));
}

#[test]
fn panels_with_nothing_to_show_are_not_listed() {
    for finds in [true, false] {
        let mut menu = bar_for(900.0, finds, true);
        menu.clicks(&["Tools"]);
        assert_eq!(menu.query_by_label("Found").is_some(), finds);
        let mut menu = bar_for(900.0, finds, true);
        menu.clicks(&["View", "Panels"]);
        assert_eq!(menu.query_by_label("Unexplained").is_some(), finds);
    }
}

#[test]
fn menus_ask_for_what_they_list() {
    let mut menu = bar(900.0);
    menu.clicks(&["+ Line", "Cartesian", "Scene", "Presets", "Four reflectors", "Help", "Keys and pointer"]);
    let add = Command::from(EditCommand::Add(NewObject::Line, None));
    let projection = Command::from(ViewCommand::SetProjection(Projection::Cartesian));
    let preset = DocumentCommand::Preset(presets::ALL.iter().position(|p| p.id == "four-reflectors").unwrap());
    assert_eq!(*menu.state(), [add, projection, preset.into(), WindowCommand::Help(HelpPage::Keys).into()]);
}

#[test]
fn no_button_stands_over_another_at_any_width() {
    for width in (360..1400).step_by(20) {
        let menu = bar(width as f32);
        let right = |label| menu.query_by_label(label).map(|node| node.rect().right());
        // In a narrow window the menus replace the buttons.
        assert!(right("Lessons").is_some() || (width as f32) < 1.1 * MAX_COLUMN_WIDTH_POINTS, "no Lessons at {width}");
        let Some(lessons) = right("Lessons").or(right("Help")) else { panic!("no menu at {width}") };
        for label in ["Commands", "Cartesian", "Range–angle"] {
            let Some(node) = menu.query_by_label(label) else { continue };
            assert!(node.rect().left() >= lessons, "{label} at {width}");
        }
    }
}

#[test]
fn every_kind_of_body_has_a_button_where_there_is_room() {
    let labels = ["+ Wall", "+ Box", "+ Post", "+ Polygon"];
    let mut wide = bar(1440.0);
    for label in labels {
        wide.clicks(&[label]);
    }
    let kinds = [NewObject::Wall, NewObject::Box, NewObject::Post, NewObject::Polygon];
    let wanted: Vec<Command> = kinds.map(|kind| Command::Edit(EditCommand::Add(kind, None))).to_vec();
    assert_eq!(*wide.state(), wanted);
    let mut medium = bar(1000.0);
    assert!(labels.iter().all(|label| medium.query_by_label(label).is_none()));
    medium.clicks(&["+ Body", "Add post"]);
    assert_eq!(*medium.state(), wanted[2..3]);
}
