//! Commands that arrange the window.

use super::effect::Effect;
use crate::app::state::{Arrangement, Brightness, State, WindowCommand};
use crate::interact::SelectionMode;

/// Does a window command; the effect is for the window itself.
pub fn apply(state: &mut State, command: WindowCommand) -> Option<Effect> {
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
        WindowCommand::CloseMessages => state.notices.clear(),
        WindowCommand::ToggleTheme => {
            state.settings.theme = if state.dark { Brightness::Light } else { Brightness::Dark };
            return Some(Effect::Brightness(state.settings.theme));
        }
        WindowCommand::ZoomIn => return Some(Effect::Zoom(Some(0.1))),
        WindowCommand::ZoomOut => return Some(Effect::Zoom(Some(-0.1))),
        WindowCommand::ZoomReset => return Some(Effect::Zoom(None)),
        WindowCommand::Palette => return Some(Effect::Palette),
        WindowCommand::Quit => return Some(Effect::Close),
    }
    None
}

/// Ends a drag, else a maximised panel, else a presentation, else the selection.
fn escape(state: &mut State) {
    if state.editor.dragged().is_some() {
        state.editor.cancel_drag();
    } else if state.arrangement.maximised().is_some() {
        state.arrangement.restore();
    } else if state.is_presenting() {
        state.stop_presenting();
    } else {
        state.editor.select([], SelectionMode::Replace);
    }
    state.scene_view.box_start = None;
}
