//! Pages of help, each for a window of its own.

named! {
    /// A page of help. Its name is the title of the page, and its entry in the menu.
    #[derive(Debug, Clone, Copy, PartialEq, Eq)]
    pub enum HelpPage {
        /// Every key, and the actions of the pointer.
        Keys = "Keys and pointer",
        /// Origin of the figures on screen.
        Figures = "Where figures come from",
        /// Version, licence and description of the program.
        About = "About apertura",
    }
}

impl HelpPage {
    /// The page's content in a sentence, for tooltips.
    pub fn describe(self) -> &'static str {
        match self {
            HelpPage::Keys => "Every key, and what the pointer does in the scene and the maps",
            HelpPage::Figures => "How Λ, P_D, P_FA, SE and the printed tables are computed, and by which command",
            HelpPage::About => "Version, licence and source",
        }
    }
}
