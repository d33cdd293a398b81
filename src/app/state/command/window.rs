//! Commands that arrange the window.

use crate::app::state::{HelpPage, Panel, Task};

/// Commands that arrange the window.
#[derive(Debug, Clone, PartialEq)]
pub enum WindowCommand {
    /// Select nothing, end maximising, close the palette.
    Escape,
    /// Hide a panel that is in sight, or bring it into sight.
    TogglePanel(Panel),
    /// Hide a panel.
    ClosePanel(Panel),
    /// Show a panel, in front.
    OpenPanel(Panel),
    /// Put this view in front of the tile that it shares with others.
    OpenView(Panel),
    /// Let a panel fill the window, or end that.
    Maximise(Panel),
    /// Arrange the panels for a task, as they were left when it was on screen last.
    ArrangeFor(Task),
    /// Put all panels where they were at first.
    ResetLayout,
    /// The scene and the maps in large type, or everything as before.
    Present,
    /// Say on the maps and the scene what they show, or no longer.
    ToggleCaptions,
    /// Show a page of help.
    Help(HelpPage),
    /// Close the page of help that is open.
    CloseHelp,
    /// Close every message.
    CloseMessages,
    /// Light or dark.
    ToggleTheme,
    /// Larger interface.
    ZoomIn,
    /// Smaller interface.
    ZoomOut,
    /// Interface at its normal size.
    ZoomReset,
    /// Show or hide the palette of commands.
    Palette,
    /// Close the window.
    Quit,
}
