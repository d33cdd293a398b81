//! Challenges: "now change it until ...", checked by the engine.

use super::fault::Fault;
use super::quantity::{ObjectNumber, Quantity};
use super::stage::{MapName, Stage};
use crate::evaluate::squared_error;
use crate::radar::Radar;
use crate::scene::{Object, Scene};
use serde::Deserialize;

/// A goal that the learner reaches by changing the scene or the radar.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Challenge {
    pub ask: String,
    /// Requirements, all of which must hold.
    #[serde(rename = "require")]
    pub requirements: Vec<Requirement>,
    /// Objects visible only in the maps, which the learner's objects should reproduce.
    #[serde(default)]
    pub hidden: Vec<Object>,
    /// A state that meets the challenge: checked before the lesson begins, and shown on request.
    pub solution: Solution,
}

/// A state of scene and radar that meets a challenge.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solution {
    /// The objects; those of the step where there are none.
    #[serde(default, rename = "object")]
    pub objects: Vec<Object>,
    /// The radar; that of the step where there is none.
    pub radar: Option<Radar>,
}

/// A bound on a measured quantity.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Requirement {
    pub measure: Measure,
    pub at_least: Option<f64>,
    pub at_most: Option<f64>,
}

/// A quantity measured on the maps or read from the radar.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Measure {
    /// Lambda of an object's blob.
    Lambda {
        map: MapName,
        object: ObjectNumber,
    },
    /// Fall of Lambda between two objects' blobs, below the weaker of the two.
    Dip {
        map: MapName,
        objects: [ObjectNumber; 2],
    },
    /// SE of the method's output.
    SquaredError,
    /// SE of the learner's whole-array map against that of the hidden objects.
    Unexplained,
    /// `Unexplained` over the SE of the method's output on both ends of the hidden objects: below 1 the learner is nearer than the method.
    UnexplainedOverMethod,
    /// Number of the scene's objects.
    Objects,
    /// Distance between two objects, metres.
    Distance {
        objects: [ObjectNumber; 2],
    },
    /// The radar's bandwidth.
    BandwidthGigahertz,
    /// Range of an object from the array's centre, metres.
    Range {
        object: ObjectNumber,
    },
    Reflectivity {
        object: ObjectNumber,
    },
    /// Part of a map's cells that are brighter than `above`.
    BrightPart {
        map: MapName,
        above: f32,
    },
    Quantity {
        quantity: Quantity,
        object: Option<ObjectNumber>,
    },
}

impl Challenge {
    /// Checks that the challenge can be set on a scene of `objects` objects.
    pub(super) fn check(&self, objects: usize) -> Result<(), Fault> {
        if self.requirements.is_empty() {
            let message = "the challenge requires nothing; expected [[step.challenge.require]]";
            return Err(Fault::at("[step.challenge]", message));
        }
        let solved = if self.solution.objects.is_empty() { objects } else { self.solution.objects.len() };
        for (number, requirement) in self.requirements.iter().enumerate() {
            requirement
                .check(objects.max(solved), !self.hidden.is_empty())
                .map_err(|message| Fault::at_number("[[step.challenge.require]]", number, message))?;
        }
        Ok(())
    }

    /// Whether a method's output is measured.
    pub fn needs_output(&self) -> bool {
        self.requirements.iter().any(|r| match &r.measure {
            Measure::Lambda { map, .. } | Measure::Dip { map, .. } => *map == MapName::Output,
            Measure::SquaredError => true,
            _ => false,
        })
    }

    /// Whether a method's output of the hidden objects is measured.
    pub fn needs_hidden_output(&self) -> bool {
        self.requirements.iter().any(|r| r.measure == Measure::UnexplainedOverMethod)
    }

    /// The scene whose maps are to be explained, where there is one.
    pub fn hidden_scene(&self) -> Option<Scene> {
        (!self.hidden.is_empty()).then(|| Scene { objects: self.hidden.clone(), ..Scene::default() })
    }
}

impl Requirement {
    /// Checks that the requirement can be measured on a scene of `objects` objects, and met by some number.
    fn check(&self, objects: usize, hides: bool) -> Result<(), String> {
        match (self.at_least, self.at_most) {
            (None, None) => return Err("a requirement has no bound; expected at_least or at_most".to_owned()),
            (Some(low), Some(high)) if low > high => {
                return Err(format!("at least {low} and at most {high} is required; no number is both"));
            }
            (low, high) if low.into_iter().chain(high).any(f64::is_nan) => {
                return Err("a bound is not a number".to_owned());
            }
            _ => {}
        }
        match &self.measure {
            Measure::Lambda { object, .. } | Measure::Range { object } | Measure::Reflectivity { object } => {
                object.index(objects).map(drop)
            }
            Measure::Dip { objects: pair, .. } | Measure::Distance { objects: pair } => {
                pair.iter().try_for_each(|o| o.index(objects).map(drop))
            }
            Measure::Unexplained | Measure::UnexplainedOverMethod if !hides => {
                Err("unexplained needs [[step.challenge.hidden]] objects".to_owned())
            }
            _ => Ok(()),
        }
    }
}

impl Measure {
    /// The value for the learner's scene; `hidden` is the stage of [`Challenge::hidden_scene`].
    pub(super) fn value(&self, stage: &Stage, hidden: Option<&Stage>) -> Result<f64, String> {
        let object = |number: &ObjectNumber| number.of(&stage.scene);
        let truth = || hidden.ok_or_else(|| "nothing is hidden".to_owned());
        Ok(match self {
            Measure::Lambda { map, object: number } => f64::from(stage.blob(stage.map(*map)?, object(number)?).1),
            Measure::Dip { map, objects } => {
                let shown = stage.map(*map)?;
                let [a, b] = stage.blobs_apart(shown, [object(&objects[0])?, object(&objects[1])?]);
                let steps = (a.0.bin - b.0.bin).abs().max((a.0.column - b.0.column).abs()).max(1.0) as usize;
                let between = (0..=steps).map(|i| {
                    let part = i as f64 / steps as f64;
                    let at = |from: f64, to: f64| (from + part * (to - from)).round() as usize;
                    shown.lambda[[at(a.0.bin, b.0.bin), at(a.0.column, b.0.column)]]
                });
                f64::from(a.1.min(b.1) - between.fold(f32::INFINITY, f32::min))
            }
            Measure::SquaredError => squared_error(stage.map(MapName::Target)?, stage.map(MapName::Output)?),
            Measure::Unexplained => squared_error(truth()?.map(MapName::Target)?, stage.map(MapName::Target)?),
            Measure::UnexplainedOverMethod => {
                let hidden = truth()?;
                let target = hidden.map(MapName::Target)?;
                let ours = squared_error(target, stage.map(MapName::Target)?);
                let theirs = squared_error(target, hidden.map(MapName::Output)?);
                ours / theirs.max(f64::MIN_POSITIVE)
            }
            Measure::Objects => stage.scene.objects.len() as f64,
            Measure::Distance { objects } => {
                let [a, b] = [object(&objects[0])?.centre_metres(), object(&objects[1])?.centre_metres()];
                (a[0] - b[0]).hypot(a[1] - b[1])
            }
            Measure::BandwidthGigahertz => stage.radar.bandwidth_hz / 1e9,
            Measure::Range { object: number } => {
                let [x, y] = object(number)?.centre_metres();
                x.hypot(y)
            }
            Measure::Reflectivity { object: number } => object(number)?.reflectivity().abs(),
            Measure::BrightPart { map, above } => {
                let shown = stage.map(*map)?;
                shown.above(*above).count() as f64 / shown.lambda.len() as f64
            }
            Measure::Quantity { quantity, object } => quantity.of(&stage.radar, &stage.scene, *object)?,
        })
    }
}

impl MapName {
    pub fn words(self) -> &'static str {
        match self {
            MapName::Input0 => "input 0",
            MapName::Input1 => "input 1",
            MapName::Target => "the target",
            MapName::Output => "the output",
        }
    }
}
