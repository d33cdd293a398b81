use super::*;
use crate::app::jobs::{Failures, THUMBNAIL_HEIGHT, THUMBNAIL_WIDTH, Thumbnail, some_row};
use crate::app::state::{Conditions, FailureChoice, OpenedRow, Purpose};
use crate::app::widgets::seen::{self, Harness, Queryable, User};
use crate::evaluate::rows::{Column, Row};
use crate::platform::Instant;
use crate::reconstruct::{Baseline, CAPON, Reconstructor};
use crate::scene::generate::Kind;
use eframe::egui::{Context, Key, Vec2, vec2};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

struct Drawn {
    state: State,
    job: Failures,
    memory: FailuresMemory,
    asked: Vec<Command>,
}

fn panel_of(rows: Vec<Row>, size: Vec2) -> Harness<'static, Drawn> {
    let draw = |ui: &mut Ui, Drawn { state, job, memory, asked }: &mut Drawn| {
        let new = show(ui, &Input { state, job, own: Some(Path::new("/own")), now: None }, memory);
        for command in &new {
            if let Command::Rows(RowsCommand::Show(index)) = *command {
                let (row, generation) = (job.table.rows()[index].clone(), job.table.generation());
                let document = state.editor.document().id();
                state.failures.opened = Some(OpenedRow { row, index, generation, document });
            }
        }
        asked.extend(new);
    };
    let mut state = State::new(vec![Arc::new(Baseline), Arc::new(CAPON)]);
    state.settings.method = CAPON.name().to_owned();
    let mut job = Failures::start(None, &Context::default());
    job.table.replace(rows, Conditions::default());
    let drawn = Drawn { state, job, memory: FailuresMemory::default(), asked: Vec::new() };
    let mut panel = Harness::builder().with_size(size).build_ui_state(draw, drawn);
    panel.run_steps(3);
    panel
}

fn panel(count: u32) -> Harness<'static, Drawn> {
    panel_of((0..count).map(|i| some_row(i, "capon")).collect(), vec2(900.0, 700.0))
}

#[test]
fn every_button_is_one_command() {
    let mut panel = panel(0);
    panel.clicks(&["Try", "Worse", "Keep", "Open…"]);
    let choice = FailureChoice { methods: vec!["capon"], kinds: vec![Kind::Set2], own: false, count: 20, seed: 0 };
    let asked = [
        Command::Rows(RowsCommand::Try(choice)),
        Command::Rows(RowsCommand::Search(Box::default())),
        Command::Rows(RowsCommand::KeepScene(String::new())),
        Command::AskFile(Purpose::OpenRows),
    ];
    assert_eq!(panel.state().asked, asked);
}

#[test]
fn keys_walk_through_the_rows_in_their_order() {
    let mut panel = panel(50);
    panel.clicks(&["Squared error"]);
    let rows = panel.state().job.table.rows().clone();
    let worst = (0..50).max_by(|a, b| rows[*a].squared_error.total_cmp(&rows[*b].squared_error)).unwrap();
    assert_eq!(panel.state().memory.table.in_sight[0], worst, "the title sorts the rows");
    panel.clicks(&[&format!("set 1, scene {worst}, capon")]);
    panel.presses(&[Key::ArrowDown, Key::ArrowDown, Key::End]);
    let shown = |c: &Command| if let Command::Rows(RowsCommand::Show(row)) = c { *row } else { panic!("{c:?}") };
    let opened: Vec<usize> = panel.state().asked.iter().map(shown).collect();
    let figures: Vec<f64> = opened.iter().map(|row| rows[*row].squared_error).collect();
    assert_eq!((opened.len(), opened[0]), (4, worst));
    assert!(figures.is_sorted_by(|a, b| a >= b), "{figures:?}");
    let smallest = rows.iter().map(|row| row.squared_error).reduce(f64::min);
    assert_eq!(figures.last().copied(), smallest);
    assert!(panel.state().memory.table.in_sight.contains(&opened[3]), "the row that was walked to is in sight");
}

#[test]
fn a_box_in_the_scatter_plot_selects_rows() {
    let apart = |i: u32| Row { nearest_pair_columns: Some(f64::from(i)), ..some_row(i, "capon") };
    let mut panel = panel_of((0..200).map(apart).collect(), vec2(900.0, 700.0));
    panel.clicks(&["Scatter"]);
    panel.state_mut().memory.sort = Some(Sort { column: Column::Index, descending: false });
    let chart = panel.get_by_label("Chart of rows").rect();
    let (from, to) = (chart.left_top() + vec2(2.0, 2.0), chart.center_bottom() - vec2(0.0, 2.0));
    panel.drags(&[0.0, 0.3, 0.6, 1.0].map(|part| from + (to - from) * part));
    panel.run_steps(2);
    let shown = panel.state().memory.order.shown.to_vec();
    let last = *shown.last().unwrap();
    assert!((90..110).contains(&last) && shown == (0..=last).collect::<Vec<_>>(), "the left half: {shown:?}");
    let name = format!("× {} in the box", shown.len());
    panel.clicks(&[&name]);
    assert_eq!(panel.state().memory.order.shown.len(), 200);
}

fn with_pictures(count: u32) -> Harness<'static, Drawn> {
    let mut panel = panel(count);
    let Failures { table, thumbnails, .. } = &panel.state().job;
    let bytes = || vec![99; THUMBNAIL_WIDTH * THUMBNAIL_HEIGHT].into_boxed_slice();
    let thumbnail = Arc::new(Thumbnail { target: bytes(), output: bytes() });
    table.rows().iter().for_each(|row| thumbnails.album.insert(table.generation(), row, Ok(thumbnail.clone())));
    panel.clicks(&["Missed"]);
    panel
}

#[test]
fn ten_thousand_rows_are_put_in_order_once() {
    let mut panel = with_pictures(10_000);
    let stamp = panel.state().memory.order.stamp;
    let began = Instant::now();
    for _ in 0..20 {
        panel.step();
    }
    let took = began.elapsed();
    assert_eq!(panel.state().memory.order.stamp, stamp, "nothing changed");
    assert!(took < Duration::from_secs(10), "20 frames took {took:?}");
}

#[test]
fn only_rows_in_sight_are_drawn_and_their_pictures_held() {
    let mut panel = with_pictures(1000);
    let in_sight = panel.state().memory.table.in_sight.len();
    assert!((5..30).contains(&in_sight), "{in_sight} rows in sight");
    assert!(seen::texts(panel.output()).len() < 700);
    panel.get_by_label("Rows").focus();
    panel.step();
    panel.presses(&[Key::End]);
    let last = *panel.state().memory.order.shown.last().unwrap();
    assert_eq!(panel.state().state.failures.opened.as_ref().map(|opened| opened.index), Some(last));
    assert!(panel.state().memory.table.in_sight.contains(&last));
    panel.presses(&[Key::PageUp]);
    let held = panel.state().memory.table.pictures.len();
    assert!(held <= panel.state().memory.table.in_sight.len(), "{held} pictures are held");
}

#[test]
fn an_opened_row_keeps_its_figures_beside_those_of_now() {
    let mut panel = panel(3);
    panel.clicks(&["set 1, scene 2, capon"]);
    let error = format!("{:.1}", panel.state().job.table.rows()[2].squared_error);
    // In the table, and beside the live ones.
    seen::assert_reads(panel.output(), &[&error, &format!("SE {error}"), "1 found, 2 missed"]);
}

/// Every scene by two methods; the second misses objects that have a near neighbour.
fn by_two_methods() -> Vec<Row> {
    let of = |i: u32, method: &str| {
        let near = f64::from(i / 2 % 10);
        let missed = usize::from(method == "nomp" && near < 3.0);
        Row { nearest_pair_columns: Some(near), missed, ..some_row(i, method) }
    };
    (0..80).flat_map(|i| ["live", "nomp"].map(|method| of(i, method))).collect()
}

#[test]
fn two_methods_are_compared_in_a_sentence() {
    let mut panel = panel_of(by_two_methods(), vec2(900.0, 700.0));
    panel.clicks(&["A against B"]);
    let texts = seen::texts(panel.output());
    let told = texts.iter().find(|t| t.text.starts_with("SE of live less that of nomp: +0.0")).unwrap();
    let verdict = "by live alone: 24 scenes, by nomp alone: 0 (McNemar p = below 0.0001)";
    assert!(told.text.contains(verdict), "{}", told.text);
}

#[test]
fn rows_are_sorted_and_filtered_and_drawn_by_doubt() {
    // Six scenes by a method without doubt and by one with it.
    let rows = (0..6).flat_map(|i| ["capon", "live"].map(|method| some_row(i, method))).collect();
    let mut panel = panel_of(rows, vec2(3000.0, 700.0));
    let rows = panel.state().job.table.rows().clone();
    let all: Vec<usize> = (0..rows.len()).collect();
    let axes = points::Subject::Columns(Column::Doubt, Column::SquaredError);
    let dots = points::Points::of(&panel.state().job.table, &all, &axes, Column::Method).dots;
    assert_eq!(dots.iter().map(|dot| dot.at[0]).collect::<Vec<_>>(), [90.0, 91.0, 92.0, 93.0, 94.0, 95.0]);
    panel.clicks(&["Doubt as SE"]);
    let in_sight = panel.state().memory.table.in_sight.clone();
    assert!(in_sight[..6].iter().all(|row| rows[*row].method == "live"), "those that say none come last");
    assert_eq!(in_sight[0], 11, "the largest comes first");
    assert!(panel.reads("95.0"), "and is shown");
    panel.state_mut().memory.filter.text = "squared_error > doubt".to_owned();
    panel.run_steps(3);
    let shown = &panel.state().memory.order.shown;
    assert!(!shown.is_empty() && shown.iter().all(|row| rows[*row].method == "live"));
}
