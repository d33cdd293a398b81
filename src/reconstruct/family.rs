//! Families of methods, by which lists are grouped.

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
        self.words().0
    }

    /// A phrase on the family's common approach.
    pub fn describe(self) -> &'static str {
        self.words().1
    }

    fn words(self) -> (&'static str, &'static str) {
        match self {
            Family::Own => ("Your own", "computed by programs of your own (--method-command)"),
            Family::Network => ("Networks", "learned from simulated scenes"),
            Family::Search => ("Search", "place reflectors one by one, off the grid"),
            Family::Sparse => ("Sparse", "explain the samples with few cells or directions"),
            Family::Classical => ("Classical", "beamformers and subspace methods"),
        }
    }
}
