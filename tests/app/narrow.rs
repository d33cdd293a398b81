//! A window as narrow as a telephone.

use crate::session::*;
use eframe::egui::Rect;

fn narrow() -> Session {
    let folder = tempdir().unwrap();
    let scene = "[radar]\nelements = 128\nsamples = 64\nbandwidth_hz = 2.5e8\n\n\
                 [[object]]\nkind = \"point\"\nx_metres = 0.0\ny_metres = 20.0\n";
    std::fs::write(folder.path().join("scene.toml"), scene).unwrap();
    Session::opened(folder, Some("scene.toml"), baseline(), [390.0, 844.0])
}

#[test]
fn a_narrow_window_has_scene_output_and_target_in_one_column() {
    let session = narrow();
    let titles: Vec<Rect> =
        ["Scene", "Output", "Target"].map(|title| session.app.get_by_role_and_label(Role::Label, title).rect()).into();
    assert!(titles.windows(2).all(|pair| pair[1].min.y - pair[0].max.y > 200.0), "{titles:?}");
    assert!(titles[2].max.y + 150.0 < 844.0, "all three are on screen: {titles:?}");
}
