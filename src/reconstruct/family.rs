//! Families of methods, by which lists are grouped.

/// A family of methods.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Programs of the user.
    Own,
    /// Networks trained on scenes.
    Network,
    /// Searches that place reflectors one by one, off any grid.
    Search,
    /// Methods that explain the samples with few cells or directions.
    Sparse,
    /// Beamformers and subspace methods, row by row or cell by cell.
    Classical,
}

impl Family {
    /// All families, in the order of lists.
    pub const ALL: [Family; 5] = [Family::Own, Family::Network, Family::Search, Family::Sparse, Family::Classical];

    /// The family's name.
    pub fn name(self) -> &'static str {
        match self {
            Family::Own => "Your own",
            Family::Network => "Networks",
            Family::Search => "Search",
            Family::Sparse => "Sparse",
            Family::Classical => "Classical",
        }
    }

    /// A phrase on the family's common approach.
    pub fn describe(self) -> &'static str {
        match self {
            Family::Own => "computed by programs of your own (--method-command)",
            Family::Network => "learned from simulated scenes",
            Family::Search => "place reflectors one by one, off the grid",
            Family::Sparse => "explain the samples with few cells or directions",
            Family::Classical => "beamformers and subspace methods",
        }
    }
}
