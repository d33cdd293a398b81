//! Pages of help, each for a window of its own.

/// A page of help.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HelpPage {
    /// Every key, and the actions of the pointer.
    Keys,
    /// Origin of the figures on screen.
    Figures,
    /// Version, licence and description of the program.
    About,
}

impl HelpPage {
    /// Every page, in the order of the menu.
    pub const ALL: [HelpPage; 3] = [HelpPage::Keys, HelpPage::Figures, HelpPage::About];

    /// Title of the page, and its name in the menu.
    pub fn title(self) -> &'static str {
        match self {
            HelpPage::Keys => "Keys and pointer",
            HelpPage::Figures => "Where figures come from",
            HelpPage::About => "About apertura",
        }
    }

    /// The page's content in a sentence, for tooltips.
    pub fn describe(self) -> &'static str {
        match self {
            HelpPage::Keys => "Every key, and what the pointer does in the scene and the maps",
            HelpPage::Figures => "How Λ, P_D, P_FA, SE and the printed tables are computed, and by which command",
            HelpPage::About => "Version, licence and source",
        }
    }
}
