//! Commands that arrange the window.

use crate::app::state::{Arrangement, State, WindowCommand};
use crate::app::widgets::theme;
use crate::interact::SelectionMode;
use eframe::egui::{Context, ThemePreference, ViewportCommand};

/// Does a window command. The palette belongs to the app, which shows it.
pub fn apply(ctx: &Context, state: &mut State, command: WindowCommand) {
    let zoom = |by: f32| ctx.set_zoom_factor((ctx.zoom_factor() + by).clamp(0.5, 3.0));
    match command {
        WindowCommand::Escape => escape(state),
        WindowCommand::TogglePanel(panel) => state.arrangement.toggle(panel),
        WindowCommand::ClosePanel(panel) => state.arrangement.set_open(panel, false),
        WindowCommand::OpenPanel(panel) => state.arrangement.set_open(panel, true),
        WindowCommand::OpenView(panel) => state.arrangement.bring_to_front(panel),
        WindowCommand::Maximise(panel) => state.arrangement.toggle_maximised(panel),
        WindowCommand::ArrangeFor(task) => state.arrange_for(task),
        WindowCommand::ResetLayout => {
            state.stop_presenting();
            state.arrangement = Arrangement::default();
        }
        WindowCommand::Present => state.present(),
        WindowCommand::ToggleCaptions => state.captions = !state.captions,
        WindowCommand::Help(page) => state.help = Some(page),
        WindowCommand::CloseHelp => state.help = None,
        WindowCommand::CloseMessages => state.notices.list.clear(),
        WindowCommand::ToggleTheme => {
            state.settings.theme = if state.dark { ThemePreference::Light } else { ThemePreference::Dark };
            theme::apply(ctx, state.settings.theme);
        }
        WindowCommand::ZoomIn => zoom(0.1),
        WindowCommand::ZoomOut => zoom(-0.1),
        WindowCommand::ZoomReset => ctx.set_zoom_factor(1.0),
        WindowCommand::Palette => {}
        WindowCommand::Quit => ctx.send_viewport_cmd(ViewportCommand::Close),
    }
}

/// Ends a drag, else a maximised panel, else a presentation, else the selection.
fn escape(state: &mut State) {
    if state.editor.dragged().is_some() {
        state.editor.cancel_drag();
    } else if state.arrangement.maximised.take().is_none() && !state.stop_presenting() {
        state.editor.select([], SelectionMode::Replace);
    }
    state.scene_view.box_start = None;
}
