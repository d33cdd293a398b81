//! Rows of an evaluation in the window: tried, sorted, filtered, opened, dragged, made worse, kept, and there again after a restart.

use crate::session::*;
use apertura::evaluate::rows::Row;
use apertura::evaluate::sets::SceneFolder;
use apertura::evaluate::worsen::WorseningSearch;

fn tried() -> Session {
    let mut s = Session::with_methods(with_capon());
    s.ask_and_wait(RowsCommand::Try(choice(vec![Kind::Set2], false)));
    assert_eq!(s.state().rows().len(), 6);
    s
}

fn choice(kinds: Vec<Kind>, own: bool) -> FailureChoice {
    FailureChoice { methods: vec!["baseline", "capon"], kinds, own, count: 3, seed: 7 }
}

fn name(row: &Row) -> String {
    format!("set {}, scene {}, {}", row.set, row.index, row.method)
}

fn listed(s: &Session) -> Vec<String> {
    let top = |name: &str| s.app.query_by_label(name).map(|row| row.rect().top());
    let rows = s.state().rows().iter().map(name);
    let mut rows: Vec<(f32, String)> = rows.filter_map(|name| Some((top(&name)?, name))).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|(_, name)| name).collect()
}

fn worst(s: &Session) -> (usize, Row) {
    let rows = s.state().rows().iter().enumerate();
    let worst = rows.max_by(|a, b| a.1.squared_error.total_cmp(&b.1.squared_error)).unwrap();
    (worst.0, worst.1.clone())
}

#[test]
fn the_worst_row_can_be_found_changed_kept() {
    let mut s = tried();
    s.ask(WindowCommand::Maximise(Panel::Failures));
    s.click("Squared error");
    let (index, row) = worst(&s);
    assert_eq!((listed(&s).len(), &listed(&s)[0]), (6, &name(&row)));

    s.enter("Filter", "method = 'capon' & objcts > 1");
    let told = s.shows("column 20:");
    assert!(told && listed(&s).len() == 6, "a mistake is pointed at, and the rows stay");
    s.enter("Filter", "squared_error >= capon.squared_error & method = 'baseline'");
    let rows = s.state().rows();
    let of_capon = |row: &Row| rows.iter().find(|r| r.index == row.index && r.method == "capon").unwrap();
    let worse = |row: &&Row| row.method == "baseline" && row.squared_error >= of_capon(row).squared_error;
    assert_eq!(listed(&s).len(), rows.iter().filter(worse).count());
    s.press(Modifiers::COMMAND, Key::A);
    s.press(Modifiers::NONE, Key::Delete);

    let before = s.editor().document().clone();
    s.click(&name(&row));
    s.ask(WindowCommand::Maximise(Panel::Failures));
    let radar = s.state().radar().clone();
    let expected = Generator::new(&radar, Reading::Program, Purpose::Test, 7).scene(Kind::Set2, row.index);
    assert_eq!((s.state().opened_row(), &**s.editor().scene()), (Some(index), &expected));
    let m = s.state().metrics().unwrap();
    assert_eq!(s.state().shown_method(), Some(if row.method == "capon" { "capon" } else { "baseline" }));
    assert_eq!((m.squared_error, m.detection, m.false_alarm), (row.squared_error, row.detection, row.false_alarm));

    s.ask(WindowCommand::OpenPanel(Panel::Failures));
    let missed = format!("{} missed", row.missed);
    let verdicts = s.app.query_all_by_label_contains(&missed).count();
    assert!(row.missed == 0 || verdicts == 2, "those of the row, and those of now: {verdicts}");

    s.drag(s.handle("point 1: move"), vec2(25.0, 10.0), 5);
    assert!(s.editor().is_modified() && s.state().metrics() != Some(m));
    let file = s.editor().document().to_file();
    s.ask(RowsCommand::KeepScene("Moved a little.".to_owned()));
    let own = s.path("data/scenes");
    let kept = apertura::scene::file::load(SceneFolder::open(&own).unwrap().file(0).unwrap()).unwrap();
    assert_eq!((kept.scene.objects, kept.radar), (file.scene.objects, file.radar));
    assert_eq!(kept.scene.notes, "Moved a little.");
    s.ask_and_wait(RowsCommand::Try(choice(Vec::new(), true)));
    assert_eq!(s.state().rows().len(), 8, "it is a test set at once");

    s.ask(EditCommand::Undo);
    s.ask(EditCommand::Undo);
    assert_eq!(s.editor().document().id(), before.id(), "the scene from before the row");
}

#[test]
fn one_undo_takes_a_walk_through_rows_back() {
    let mut s = tried();
    let before = (s.editor().document().id(), s.state().settings.method.clone());
    s.ask(ViewCommand::SetFloor(Floor::Exact));
    s.ask(WindowCommand::OpenPanel(Panel::Failures));
    // By the pointer: the rows have the keys from then on.
    s.drag(s.handle(&name(&s.state().rows()[0])), vec2(0.0, 0.0), 1);
    assert_eq!(s.state().opened_row(), Some(0));
    for step in 1..4 {
        s.press(Modifiers::NONE, Key::ArrowDown);
        assert_eq!(s.state().opened_row(), Some(step));
        let row = &s.state().rows()[step];
        assert_eq!(s.state().metrics().unwrap().squared_error, row.squared_error);
        assert_eq!(s.state().settings.floor, Floor::Thesis, "as the rows were made");
    }
    assert!(s.editor().left().is_empty(), "a walk leaves nothing behind");
    s.ask(EditCommand::Undo);
    let after = (s.editor().document().id(), s.state().settings.method.clone());
    assert_eq!((after, s.state().settings.floor), (before, Floor::Exact));
}

#[test]
fn rows_outlive_a_restart() {
    let mut s = tried();
    let rows = s.state().rows().to_vec();
    let path = s.path("saved.csv");
    s.ask(RowsCommand::SaveTo(path.clone()));
    step_until(&mut s, "it is written", |s| s.path("saved.csv").exists());
    assert_eq!(read_rows(std::fs::File::open(&path).unwrap()).unwrap(), rows);
    s.ask(RowsCommand::Clear);
    assert!(s.state().rows().is_empty());
    s.ask(RowsCommand::BringBack);
    assert_eq!(s.state().rows(), rows);
    s.ask(RowsCommand::Clear);
    s.ask(RowsCommand::OpenTable(path.clone()));
    assert_eq!(s.state().rows(), rows, "as when the file is dropped on the window");
    let (index, row) = worst(&s);
    s.ask(RowsCommand::Show(index));
    s.ask(WindowCommand::ClosePanel(Panel::Failures));
    assert_eq!(s.state().metrics().unwrap().squared_error, row.squared_error, "the radar is that of the rows");
    std::fs::write(&path, "not,rows\n1,2\n").unwrap();
    let messages = s.state().notices.list.len();
    s.ask(RowsCommand::OpenFile(path));
    assert!(s.state().notices.list.len() > messages && s.state().rows() == rows, "it is told, and the rows stay");
    step_until(&mut s, "they are kept", |s| s.state().jobs.failures.is_kept());
    let s = s.reopened(Some("scene.toml"), with_capon());
    assert_eq!(s.state().rows(), rows);
}

#[test]
fn what_a_search_finds_is_one_undo_step() {
    let mut s = tried();
    // The row of the least error has the most to make worse.
    let rows = s.state().rows().iter().enumerate();
    let best = rows.min_by(|a, b| a.1.squared_error.total_cmp(&b.1.squared_error)).unwrap().0;
    s.ask(WindowCommand::OpenPanel(Panel::Failures));
    s.ask(RowsCommand::Show(best));
    let before = s.editor().scene().clone();
    let search = |tries| RowsCommand::Search(Box::new(WorseningSearch { tries, ..WorseningSearch::default() }));
    s.ask_and_wait(search(48));
    let path = s.state().jobs.failures.search.job.rows().to_vec();
    assert!(path.len() > 1, "something near is worse");
    let (start, found) = (&path[0].metrics, &path[path.len() - 1]);
    assert!(found.metrics.squared_error > start.squared_error);
    assert_eq!(s.objects(), found.scene.objects);
    assert_eq!(s.state().metrics().unwrap().squared_error, found.metrics.squared_error);
    assert!(s.app.query_by_label_contains("baseline: SE").or(s.app.query_by_label_contains("capon: SE")).is_some());
    s.ask(EditCommand::Undo);
    assert_eq!(s.editor().scene(), &before);
    s.app.state_mut().ask(search(100_000));
    step_until(&mut s, "it starts", |s| s.state().is_at_work());
    s.ask(RowsCommand::CancelSearch);
    step_until(&mut s, "it can be stopped", |s| !s.state().is_at_work());
}
