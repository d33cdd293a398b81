//! The columns that say what made a row: their names, and what should stand in them.

use std::fmt;

/// A named part of an [`Origin`](super::Origin), as it is written in its column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(missing_docs, reason = "the fields of `Origin` say what they are")]
pub enum Part {
    Version,
    Program,
    Floor,
    Normalisation,
    Purpose,
    Reading,
    Carrier,
    Radar,
    Scenes,
    Weights,
    Optimiser,
    Shard,
    Whole,
    Methods,
    Cfar,
}

impl Part {
    /// Every part, in the order of the file's columns.
    pub const ALL: [Part; 15] = [
        Part::Version,
        Part::Program,
        Part::Floor,
        Part::Normalisation,
        Part::Purpose,
        Part::Reading,
        Part::Carrier,
        Part::Radar,
        Part::Scenes,
        Part::Weights,
        Part::Optimiser,
        Part::Shard,
        Part::Whole,
        Part::Methods,
        Part::Cfar,
    ];

    /// Name of the column.
    pub fn name(self) -> &'static str {
        match self {
            Part::Version => "version",
            Part::Program => "program",
            Part::Floor => "floor",
            Part::Normalisation => "normalisation",
            Part::Purpose => "purpose",
            Part::Reading => "reading",
            Part::Carrier => "carrier",
            Part::Radar => "radar",
            Part::Scenes => "scenes",
            Part::Weights => "weights",
            Part::Optimiser => "optimiser",
            Part::Shard => "shard",
            Part::Whole => "whole",
            Part::Methods => "methods",
            Part::Cfar => "cfar",
        }
    }

    /// What should stand in the column, for messages.
    pub(super) fn expected(self) -> &'static str {
        match self {
            Part::Version => "1, the format of rows that this program reads",
            Part::Program => "the version of the program that made the row",
            Part::Floor => "thesis, exact, or another name that --floor takes",
            Part::Normalisation => "min-max or db=RANGE",
            Part::Purpose => "training, validation or test",
            Part::Reading => "program, text or file",
            Part::Carrier => "one-way, two-way or file",
            Part::Shard => "I/N with I from 0 to N - 1",
            Part::Whole => "the sets of the whole run with their numbers of scenes, as in 1 x 100; 2 x 100",
            Part::Methods => "the methods of the whole run, as in live; nomp",
            Part::Cfar => "a detector as --cfar takes it, as in ca:guard=4x0:training=16x0:rate=0.0001, or nothing",
            Part::Radar | Part::Scenes | Part::Weights | Part::Optimiser => "text",
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
