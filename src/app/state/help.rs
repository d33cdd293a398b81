//! Pages of help that are short enough for a window of their own.

/// Which page.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum HelpPage {
    /// Every key, and what the pointer does.
    Keys,
    /// Where the figures on screen come from.
    Figures,
    /// What this program is.
    About,
}

impl HelpPage {
    /// Every page, in the order of the menu.
    pub const ALL: [HelpPage; 3] = [HelpPage::Keys, HelpPage::Figures, HelpPage::About];

    /// Its title, which is its name in the menu.
    pub fn title(self) -> &'static str {
        match self {
            HelpPage::Keys => "Keys and pointer",
            HelpPage::Figures => "Where figures come from",
            HelpPage::About => "About apertura",
        }
    }

    /// What it tells, for tooltips.
    pub fn describe(self) -> &'static str {
        match self {
            HelpPage::Keys => "Every key, and what the pointer does in the scene and the maps",
            HelpPage::Figures => "How Λ, P_D, P_FA, SE and the printed tables are computed, and by which command",
            HelpPage::About => "Version, licence and source",
        }
    }
}
