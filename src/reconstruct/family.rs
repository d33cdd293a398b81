//! Which kind of method a method is: lists are grouped by it.

/// A kind of method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Family {
    /// Programs of one's own.
    Own,
    /// Learned from scenes.
    Network,
    /// Places reflectors one by one, off any grid.
    Search,
    /// Explains the samples with few cells or directions.
    Sparse,
    /// Beamformers and subspace methods, row by row or cell by cell.
    Classical,
}

impl Family {
    /// All, in the order in which lists show them.
    pub const ALL: [Family; 5] = [Family::Own, Family::Network, Family::Search, Family::Sparse, Family::Classical];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Family::Own => "Your own",
            Family::Network => "Networks",
            Family::Search => "Search",
            Family::Sparse => "Sparse",
            Family::Classical => "Classical",
        }
    }

    /// What its methods have in common.
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
