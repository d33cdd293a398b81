//! A window as narrow as a telephone.

use crate::session::*;
use eframe::egui::Rect;

#[test]
fn a_narrow_window_has_scene_output_and_target_in_one_column() {
    let Session { app, folder } = Session::start();
    drop(app);
    let session = Session::opened(folder, Some("scene.toml"), baseline(), [390.0, 844.0]);
    let titles: Vec<Rect> =
        ["Scene", "Output", "Target"].map(|title| session.app.get_by_role_and_label(Role::Label, title).rect()).into();
    assert!(titles.windows(2).all(|pair| pair[1].min.y - pair[0].max.y > 200.0), "{titles:?}");
    assert!(titles[2].max.y + 150.0 < 844.0, "all three are on screen: {titles:?}");
}
