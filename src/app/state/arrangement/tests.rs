use super::*;

#[test]
fn tools_are_closed_at_first_and_settings_in_a_lesson() {
    let arrangement = Arrangement::default();
    for panel in Panel::tiles() {
        let closed = [MapKind::Doubt, MapKind::Unexplained].map(Panel::Map).contains(&panel) || panel.is_tool();
        assert_eq!(arrangement.is_open(panel), !closed, "{panel:?}");
    }
    let lesson = Arrangement::of_a_lesson();
    assert!([Panel::Lesson, Panel::Scene, Panel::Map(MapKind::Target)].iter().all(|p| lesson.is_open(*p)));
    assert!(!lesson.is_open(Panel::Controls) && !lesson.is_open(Panel::Cuts));
}

#[test]
fn only_a_panel_in_sight_is_closed_by_its_switch() {
    let mut arrangement = Arrangement::default();
    arrangement.toggle(Panel::Timing);
    arrangement.toggle(Panel::Cuts);
    assert!(arrangement.is_open(Panel::Cuts), "it was behind another tab");
    arrangement.shown.insert(Panel::Cuts);
    arrangement.toggle(Panel::Cuts);
    assert!(arrangement.is_open(Panel::Timing) && !arrangement.is_open(Panel::Cuts));
}

#[test]
fn the_map_that_is_asked_for_takes_the_largest_place() {
    let mut arrangement = Arrangement::of_a_lesson();
    let place = |arrangement: &Arrangement, kind| arrangement.tree.tiles.find_pane(&Panel::Map(kind));
    let largest = place(&arrangement, MapKind::Target);
    arrangement.put_large(Panel::Map(MapKind::Input1));
    assert_eq!(place(&arrangement, MapKind::Input1), largest);
    assert!(place(&arrangement, MapKind::Target).is_some_and(|target| Some(target) != largest));
    let mut arrangement = Arrangement::of_a_lesson();
    let largest = place(&arrangement, MapKind::Target);
    (0..2).for_each(|_| arrangement.put_large(Panel::RangeDoppler));
    assert!(arrangement.is_open(Panel::RangeDoppler), "also where it is asked for twice before a layout");
    assert_eq!(arrangement.tree.tiles.find_pane(&Panel::RangeDoppler.tile()), largest);
}

#[test]
fn one_tile_shows_the_view_that_was_opened_last() {
    let mut arrangement = Arrangement::default();
    arrangement.set_open(Panel::Elements, true);
    assert!(arrangement.is_open(Panel::Elements) && !arrangement.is_open(Panel::Radar));
    arrangement.toggle(Panel::Radar);
    assert!(arrangement.is_open(Panel::Radar) && !arrangement.is_open(Panel::Elements));
    arrangement.shown.insert(Panel::Radar);
    arrangement.toggle(Panel::Radar);
    assert!([Panel::Radar, Panel::Elements].iter().all(|view| !arrangement.is_open(*view)));
}

#[test]
fn older_tiles_become_views() {
    let mut arrangement = Arrangement::default();
    let [radar, chirp] = [Panel::Radar, Panel::Chirp].map(|p| arrangement.tree.tiles.find_pane(&p).unwrap());
    let older = |arrangement: &mut Arrangement, beside: TileId, panel: Panel| {
        let tabs = arrangement.tree.tiles.parent_of(beside).unwrap();
        let id = arrangement.tree.tiles.insert_pane(panel);
        arrangement.tree.move_tile_to_container(id, tabs, usize::MAX, false);
    };
    older(&mut arrangement, radar, Panel::Elements);
    older(&mut arrangement, chirp, Panel::RangeDoppler);
    arrangement.tree.tiles.set_visible(chirp, true);
    arrangement.join_views();
    assert!(arrangement.is_open(Panel::Elements), "it was open");
    assert!(arrangement.is_open(Panel::Chirp) && !arrangement.is_open(Panel::RangeDoppler), "both were open");
    let is_tile = |tile: &Tile<Panel>| if let Tile::Pane(panel) = tile { panel.tile() == *panel } else { true };
    assert!(arrangement.tree.tiles.tiles().all(is_tile));
}

fn tabs_of(arrangement: &Arrangement, panel: Panel) -> Option<TileId> {
    let tiles = &arrangement.tree.tiles;
    tiles.parent_of(tiles.find_pane(&panel)?)
}

#[test]
fn compare_opens_in_the_large_place_with_the_maps_it_needs() {
    let mut arrangement = Arrangement::default();
    arrangement.set_open(Panel::Compare, true);
    assert_eq!(arrangement.task, Task::Compare);
    let beside = [Panel::Compare, Panel::Scene, Panel::Map(MapKind::Target), Panel::Controls];
    assert!(beside.iter().all(|panel| arrangement.is_open(*panel)));
    assert!(!arrangement.is_open(Panel::Map(MapKind::Input0)), "it has the room of the other maps");
}

#[test]
fn closing_a_large_panel_gives_the_arrangement_back() {
    let mut arrangement = Arrangement::default();
    arrangement.set_open(Panel::Map(MapKind::Input1), false);
    for panel in [Panel::Compare, Panel::Failures] {
        arrangement.set_open(panel, true);
    }
    let tabs = tabs_of(&arrangement, Panel::Failures).unwrap();
    assert_eq!(arrangement.tree.tiles.parent_of(tabs), arrangement.tree.root(), "rows have the whole width");
    assert!([MapKind::Target, MapKind::Output].iter().all(|kind| arrangement.is_open(Panel::Map(*kind))));
    arrangement.set_open(Panel::Failures, false);
    assert_eq!(arrangement.task, Task::Explore);
    assert!(!arrangement.is_open(Panel::Map(MapKind::Input1)), "as the user left it");
    assert!(arrangement.is_open(Panel::Map(MapKind::Input0)) && !arrangement.is_open(Panel::Failures));
}

#[test]
fn every_task_keeps_its_panels_as_the_user_left_them() {
    let mut arrangement = Arrangement::default();
    for task in Task::ALL {
        arrangement.switch(task);
        arrangement.set_open(Panel::Scene, false);
    }
    let kept = serde_json::to_string(&arrangement).unwrap();
    let mut again: Arrangement = serde_json::from_str(&kept).unwrap();
    for task in Task::ALL {
        again.switch(task);
        assert!(!again.is_open(Panel::Scene), "{task:?}");
        assert_eq!(again.others.len(), 3);
    }
}

#[test]
fn the_guide_opens_beside_the_settings_in_an_older_layout_too() {
    let mut arrangement = Arrangement::default();
    let controls = tabs_of(&arrangement, Panel::Controls).unwrap();
    assert_ne!(tabs_of(&arrangement, Panel::Guide), Some(controls));
    let guide = arrangement.tree.tiles.find_pane(&Panel::Guide).unwrap();
    arrangement.tree.move_tile_to_container(guide, controls, 0, false);
    assert_eq!(tabs_of(&arrangement, Panel::Guide), Some(controls), "as older versions had it");
    arrangement.set_open(Panel::Guide, true);
    assert_ne!(tabs_of(&arrangement, Panel::Guide), Some(controls));
    assert!(arrangement.is_open(Panel::Guide) && arrangement.is_open(Panel::Controls));
}

#[test]
fn a_panel_that_a_kept_lesson_lacks_opens_beside_the_maps() {
    let mut arrangement = Arrangement::default();
    arrangement.switch(Task::Teach);
    let chirp = arrangement.tree.tiles.find_pane(&Panel::Chirp).unwrap();
    arrangement.tree.remove_recursively(chirp);
    let kept = serde_json::to_string(&arrangement).unwrap();
    let mut older: Arrangement = serde_json::from_str(&kept).unwrap();
    let large = older.tree.tiles.find_pane(&Panel::Map(MapKind::Target));
    older.set_open(Panel::RangeDoppler, true);
    assert!(older.is_open(Panel::RangeDoppler));
    assert_eq!(tabs_of(&older, Panel::Chirp), tabs_of(&older, Panel::Map(MapKind::Output)), "the scene stays in sight");
    older.put_large(Panel::RangeDoppler);
    assert_eq!(older.tree.tiles.find_pane(&Panel::RangeDoppler.tile()), large);
}
