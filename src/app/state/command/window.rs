//! Commands that arrange the window.

use crate::app::state::{HelpPage, Panel, Task};

/// A command that arranges the window.
#[derive(Debug, Clone, PartialEq)]
pub enum WindowCommand {
    /// End a drag, a maximised panel or a presentation, or select nothing.
    Escape,
    /// Hide a panel in sight, or show any other in front.
    TogglePanel(Panel),
    /// Hide a panel.
    ClosePanel(Panel),
    /// Show a panel, in front.
    OpenPanel(Panel),
    /// Bring a view to the front of its shared tile.
    OpenView(Panel),
    /// Let a panel fill the window, or end that.
    Maximise(Panel),
    /// Switch to the panels of a task, as the user left them.
    ArrangeFor(Task),
    /// Restore the default arrangement.
    ResetLayout,
    /// Begin or end a presentation of the scene and the maps in large type.
    Present,
    /// Switch the captions on the maps and the scene.
    ToggleCaptions,
    /// Show a page of help.
    Help(HelpPage),
    /// Close the page of help that is open.
    CloseHelp,
    /// Close every message.
    CloseMessages,
    /// Switch between light and dark.
    ToggleTheme,
    /// Enlarge the interface.
    ZoomIn,
    /// Shrink the interface.
    ZoomOut,
    /// Reset the interface to its normal size.
    ZoomReset,
    /// Show or hide the palette of commands.
    Palette,
    /// Close the window.
    Quit,
}
