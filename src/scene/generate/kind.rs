//! Kinds of random scenes and their names.

use super::beyond::Beyond;
use crate::radar::{Radar, capitalised};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// A kind of random scene.
///
/// The named kinds beside the thesis' three sets cover other scenes. Where nothing else is said, a place lies anywhere in
/// the field: at a range between 2 m and 95 % of the maximum range, uniform in range and in angle, 5 degrees or more off the
/// array's axis, with reflectivity 1. A decibel of reflectivity is one of echo power: 20 dB are a factor of 10 in sigma.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    Set1,
    /// 3 to 6 points.
    Set2,
    /// 3 to 6 objects: always a line and a point near its range, the others points or lines.
    Set3,
    /// 1 to 3 Gaussian clusters of 15 to 40 points, each with a standard deviation of 0.2 to 1 m along x and along y, and 1 to 3 points.
    Clusters,
    /// 1 to 3 lines at any slant, each of 20 to 100 points at 0.5 to 3 range bins, and 1 to 3 points. Both ends lie in the field.
    Walls,
    /// 1 to 3 vertical lines of 20 to 100 points at 0.5 to 3 range bins, not at the 1 and 1.5 bins of the thesis' lines, and 1 to 3 points.
    Spacings,
    /// A corner: two perpendicular lines that share an end, each of 20 to 80 points at 0.5 to 2 range bins; a cluster of 15 to 40 points and one point.
    Corner,
    /// 12 to 40 points.
    Crowd,
    /// 5 points up to 40 dB apart: one at 0 dB, the others uniform in decibels down to -40 dB.
    Dynamic,
    /// 1 to 3 points near the array: ranges from 0.3 to 8 m, uniform in their logarithm, 15 degrees or more off the array's axis.
    Near,
    /// Two long parallel rows of points at irregular steps, along the road or nearly so: mean steps of 0.1 to 0.6 m, each off by up to 45 %; and up to 3 points.
    Fences,
    /// 60 to 240 weak points, uniform in decibels from -40 to -10 dB, and 1 to 4 points at 0 dB.
    Rain,
    /// 1 to 3 bodies (walls of 1 to 10 m, cars, posts, inner corners) turned anyhow, and at most one point.
    Bodies,
    /// Two cars along the road, two or three walls, two to four posts.
    Street,
    /// Guard rails left and right of the road, a car between them, one to three posts.
    Rails,
    /// A car or a wide post, and behind it two bodies and a point, hidden from some elements or all.
    Occlusion,
    /// One or two rough bodies (height deviation 0.2 to 1.5 mm) and a post.
    Rough,
    /// Points along curves, in clouds and scattered, and bodies, of every count, step and strength: for training and validation alone, in no menu.
    World,
    /// Scenes that no training and no choice has seen. No menu lists them, and they are for tests alone.
    Beyond(Beyond),
    /// No object: over thermal noise of a level of its own the samples are noise alone.
    Noise,
    /// Experiment 1: this many points (1 to 4).
    Points(u8),
    /// Experiment 2: this many objects (1 to 4), each a point or a line with equal chance.
    Mixed(u8),
}

impl Kind {
    /// The three test sets, in order.
    pub const TEST_SETS: [Kind; 3] = [Kind::Set1, Kind::Set2, Kind::Set3];

    /// The kinds beside the test sets.
    pub const VARIED_KINDS: [Kind; 7] =
        [Kind::Clusters, Kind::Walls, Kind::Spacings, Kind::Corner, Kind::Crowd, Kind::Dynamic, Kind::Near];

    /// Points in numbers or at steps that no other kind has.
    pub const IRREGULAR_KINDS: [Kind; 2] = [Kind::Fences, Kind::Rain];

    /// The kinds of bodies: they shine where they face the array, and hide what stands behind them.
    pub const BODY_KINDS: [Kind; 5] = [Kind::Bodies, Kind::Street, Kind::Rails, Kind::Occlusion, Kind::Rough];

    /// Every kind that has a name of its own: the test sets, varied and irregular points, bodies, and noise alone.
    pub fn all() -> impl Iterator<Item = Kind> {
        Kind::with_echoes().chain(Kind::IRREGULAR_KINDS).chain(Kind::BODY_KINDS).chain([Kind::Noise])
    }

    /// Names of [`Kind::all`], separated by commas, for help and messages.
    pub fn names() -> String {
        Kind::all().map(|kind| kind.to_string()).collect::<Vec<_>>().join(", ")
    }

    /// The test sets and the varied kinds: scenes of points with echoes to detect.
    pub fn with_echoes() -> impl Iterator<Item = Kind> {
        Kind::TEST_SETS.into_iter().chain(Kind::VARIED_KINDS)
    }

    /// The kind called `name`, where test scenes are not wanted: [`Kind::World`] is one of them, [`Kind::Beyond`] is not.
    /// # Errors
    /// As `name.parse::<Kind>()`.
    pub fn for_training(name: &str) -> Result<Kind, String> {
        if name.trim() == WORLD {
            return Ok(Kind::World);
        }
        match name.parse::<Kind>().map_err(|error| format!("{error}, or {WORLD}"))? {
            Kind::Beyond(kind) => {
                Err(format!("{} makes scenes for tests alone; expected another kind", kind.entry().0))
            }
            kind => Ok(kind),
        }
    }

    /// 1, 2 or 3 for the thesis' test sets, whose printed figures tables 4.1 to 4.3 hold.
    pub fn test_set(self) -> Option<usize> {
        Kind::TEST_SETS.iter().position(|&k| k == self).map(|i| i + 1)
    }

    /// Least maximum range of a radar before which the kind's objects have room, metres.
    pub fn needed_range_metres(self) -> f64 {
        match self {
            Kind::Street => 20.0,
            Kind::Fences => 19.0,
            Kind::Occlusion => 15.0,
            Kind::Rails => 13.5,
            Kind::Bodies | Kind::Rough => 6.0,
            Kind::Set1 | Kind::Set2 | Kind::Set3 | Kind::Noise | Kind::Points(_) | Kind::Mixed(_) => 0.0,
            _ => 2.5,
        }
    }

    /// The objects of such a scene, in a few words.
    pub fn description(self) -> &'static str {
        self.entry().2
    }

    /// Title of a generated scene, for example "Test set 3, seed 0, scene 7".
    pub fn scene_name(self, seed: u64, number: u32) -> String {
        let kind = match self.test_set() {
            Some(set) => format!("Test set {set}"),
            None => capitalised(self.description()),
        };
        format!("{kind}, seed {seed}, scene {number}")
    }

    pub(super) fn stream(self) -> u64 {
        self.entry().1
    }

    /// Its name, which a number follows where it has one; the number of its random stream; and its objects.
    fn entry(self) -> (&'static str, u64, &'static str) {
        match self {
            Kind::Set1 => ("1", 1, "one point"),
            Kind::Set2 => ("2", 2, "3 to 6 points"),
            Kind::Set3 => ("3", 3, "3 to 6 points and lines"),
            Kind::Clusters => ("clusters", 4, "Gaussian clusters and points"),
            Kind::Walls => ("walls", 5, "lines at any slant and points"),
            Kind::Spacings => ("spacings", 6, "vertical lines at other spacings and points"),
            Kind::Corner => ("corner", 7, "two perpendicular lines, a cluster and a point"),
            Kind::Crowd => ("crowd", 8, "12 to 40 points"),
            Kind::Dynamic => ("dynamic", 9, "5 points up to 40 dB apart"),
            Kind::Near => ("near", 10, "points from 0.3 m"),
            Kind::Noise => ("noise", 11, "noise alone"),
            Kind::Bodies => ("bodies", 12, "walls, cars, posts and corners"),
            Kind::Street => ("street", 13, "a street of cars, walls and posts"),
            Kind::Rails => ("rails", 14, "guard rails, a car and posts"),
            Kind::Occlusion => ("occlusion", 15, "bodies behind a car or a post"),
            Kind::Rough => ("rough", 16, "rough bodies and a post"),
            Kind::Fences => ("fences", 17, "two long rows of points at irregular steps"),
            Kind::Rain => ("rain", 18, "60 to 240 weak points and a few strong ones"),
            Kind::World => (WORLD, 19, "curves, clouds and bodies of every kind, for training"),
            Kind::Beyond(kind) => (kind.entry().0, 0x20 + kind as u64, kind.entry().1),
            Kind::Points(n) => ("points", 0x100 + u64::from(n), "points of experiment 1"),
            Kind::Mixed(n) => ("mixed", 0x200 + u64::from(n), "points and lines of experiment 2"),
        }
    }
}

const WORLD: &str = "world";

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Points(n) | Kind::Mixed(n) => write!(f, "{}-{n}", self.entry().0),
            _ => f.pad(self.entry().0),
        }
    }
}

impl FromStr for Kind {
    type Err = String;

    /// Reads the names of [`Display`](fmt::Display), but for [`Kind::World`]: callers make test scenes.
    fn from_str(s: &str) -> Result<Self, String> {
        let wanted = s.trim();
        if wanted == WORLD {
            return Err(format!(
                "{WORLD} makes no scenes for tests; expected another kind, or a purpose of training or validation"
            ));
        }
        let counted = (1..=4).flat_map(|n| [Kind::Points(n), Kind::Mixed(n)]);
        let beyond = Beyond::ALL.into_iter().map(Kind::Beyond);
        Kind::all().chain(counted).chain(beyond).find(|k| k.to_string() == wanted).ok_or_else(|| {
            let names: Vec<String> = Kind::all().skip(Kind::TEST_SETS.len()).map(|kind| kind.to_string()).collect();
            format!("there are no scenes called \"{s}\"; expected test set 1, 2 or 3, or {}", names.join(", "))
        })
    }
}

/// A kind of scenes whose objects find no room before a radar.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("scenes of {kind} need a radar that sees {needed_metres} m far; this one sees {found_metres:.1} m")]
pub struct NoRoom {
    pub kind: Kind,
    pub needed_metres: f64,
    pub found_metres: f64,
}

impl Kind {
    /// Checks that the objects of the kind's scenes have room before `radar`.
    /// # Errors
    /// [`NoRoom`] names the kind and both ranges.
    pub fn check_room(self, radar: &Radar) -> Result<(), NoRoom> {
        self.check_room_within(radar.max_range_metres())
    }

    /// [`Kind::check_room`] before every radar that sees this far.
    /// # Errors
    /// As [`Kind::check_room`].
    pub fn check_room_within(self, found_metres: f64) -> Result<(), NoRoom> {
        let needed_metres = self.needed_range_metres();
        if needed_metres > found_metres {
            return Err(NoRoom { kind: self, needed_metres, found_metres });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_named_in_words() {
        assert_eq!(Kind::Set3.scene_name(0, 7), "Test set 3, seed 0, scene 7");
        assert_eq!(Kind::Walls.scene_name(2, 1), "Lines at any slant and points, seed 2, scene 1");
    }

    #[test]
    fn every_name_leads_back_to_its_kind() {
        for kind in Kind::all().chain([Kind::Points(1), Kind::Mixed(4), Kind::Beyond(Beyond::Ring)]) {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        assert!("points-5".parse::<Kind>().is_err());
        assert_eq!(Kind::for_training("world"), Ok(Kind::World));
        assert!("world".parse::<Kind>().unwrap_err().contains("no scenes for tests"));
        assert!(!Kind::all().any(|k| k == Kind::World));
        assert!(Kind::for_training("hills").unwrap_err().ends_with("noise, or world"));
        assert!(Kind::for_training("beyond-ring").unwrap_err().contains("tests alone"));
        let error = "wall".parse::<Kind>().unwrap_err();
        assert!(error.contains("\"wall\"") && error.contains("walls, spacings"), "{error}");
    }

    #[test]
    fn no_two_kinds_share_a_stream() {
        let counted = (1..=4).flat_map(|n| [Kind::Points(n), Kind::Mixed(n)]);
        let beyond = Beyond::ALL.into_iter().map(Kind::Beyond);
        let mut streams: Vec<u64> =
            Kind::all().chain(counted).chain(beyond).chain([Kind::World]).map(Kind::stream).collect();
        let kinds = streams.len();
        streams.sort_unstable();
        streams.dedup();
        assert_eq!(streams.len(), kinds);
    }
}
