//! Parts of the search that an ablation leaves out, by name.

/// A part of the search beside its rungs: a source of candidates, or a rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Part {
    /// Source: lines over two neighbouring points.
    Strides,
    /// Source: lines from one point.
    Edges,
    /// Rule: lines are followed to their ends again once all are known.
    SettledEnds,
    /// Rule: points beside lines are joined before the next look for lines.
    PointsWithLines,
    /// Rule: pairs on whose strength the ends disagree are dropped.
    PairsAgree,
    /// Rule: new points on whose strength the ends disagree are dropped.
    PointsAgree,
    /// Rule: a fit that explains nearly all is brought to its end.
    NearlyThere,
    /// Rule: pairs are polished.
    PolishPairs,
    /// Rule: objects that the rest does without are taken away.
    Prune,
    /// Rule: a point is also tried one wrap of the range away.
    Wraps,
    /// Rule: growing ends where it goes slowly.
    LookBack,
    /// Rule: gains have a price where much is unexplained.
    Price,
    /// Rule: tied gains.
    Tied,
    /// Rule: neighbouring teeth are tried.
    Teeth,
    /// Rule: what is complete is fitted without a window.
    Unwindowed,
}

const PARTS: &[(&str, Part)] = &[
    ("strides", Part::Strides),
    ("edges", Part::Edges),
    ("settled-ends", Part::SettledEnds),
    ("points-with-lines", Part::PointsWithLines),
    ("pairs-agree", Part::PairsAgree),
    ("points-agree", Part::PointsAgree),
    ("nearly-there", Part::NearlyThere),
    ("polish-pairs", Part::PolishPairs),
    ("prune", Part::Prune),
    ("wraps", Part::Wraps),
    ("look-back", Part::LookBack),
    ("price", Part::Price),
    ("tied", Part::Tied),
    ("teeth", Part::Teeth),
    ("unwindowed", Part::Unwindowed),
];

/// Bits below this one are rungs.
const FIRST_PART: usize = 16;

/// Parts that are left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Without(u64);

impl Without {
    /// Without the source or rule of this name.
    pub(super) fn part(name: &str) -> Option<Self> {
        PARTS.iter().find(|(of, _)| *of == name).map(|(_, part)| Without(1 << (*part as usize + FIRST_PART)))
    }

    /// Without this rung of the ladder.
    pub(super) fn rung(number: usize) -> Self {
        Without(1 << number)
    }

    /// Names of sources and rules.
    pub(super) fn parts() -> impl Iterator<Item = &'static str> {
        PARTS.iter().map(|(name, _)| *name)
    }

    /// Without what either lacks.
    pub fn and(self, other: Self) -> Self {
        Without(self.0 | other.0)
    }

    /// Whether a part is left out.
    pub fn lacks(self, part: Part) -> bool {
        self.0 >> (part as usize + FIRST_PART) & 1 == 1
    }

    /// Whether this rung of the ladder is left out.
    pub(super) fn lacks_rung(self, number: usize) -> bool {
        self.0 >> number & 1 == 1
    }
}
