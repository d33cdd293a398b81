//! The parts of an object that can be grabbed.

use super::Place;
use std::borrow::Cow;

/// Part of an object that can be grabbed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Grip {
    Body,
    /// The end of a line that is nearest to the array.
    NearEnd,
    FarEnd,
    Spacing,
    /// The direction of a line.
    Turn,
    /// The standard deviation of a cluster along x.
    SpreadX,
    /// The standard deviation of a cluster along y.
    SpreadY,
    /// An end of a wall or a corner of an outline, by its number.
    Corner(usize),
    /// The direction of a body.
    Rotate,
    Radius,
}

impl Grip {
    /// The effect of dragging the grip, for tooltips and screen readers.
    pub fn describe(self) -> Cow<'static, str> {
        let effect = match self {
            Grip::Body => "move",
            Grip::NearEnd => "move the near end: more or fewer reflectors",
            Grip::FarEnd => "move the far end: more or fewer reflectors",
            Grip::Spacing => "spread the reflectors",
            Grip::Turn => "turn the line about its middle",
            Grip::SpreadX => "widen the cluster",
            Grip::SpreadY => "deepen the cluster",
            Grip::Corner(number) => return format!("move corner {}", number + 1).into(),
            Grip::Rotate => "turn it about its middle",
            Grip::Radius => "change the radius",
        };
        effect.into()
    }
}

/// A grip and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GripPlace {
    pub grip: Grip,
    pub place: Place,
}
