//! The origin of a row beside its set, scene, seed and method: program, floor, radar, weights.

use super::MAX_ROWS;
use crate::evaluate::shard::Shard;
use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::radar::{Carrier, Radar};
use crate::reconstruct::Weights;
use crate::scene::generate::{Purpose, Reading};
use crate::signal::Floor;
use std::fmt;

/// Number of the format of rows. Tables from before it was counted have no such column, and don't say what made them.
pub const FORMAT: u32 = 1;

/// Most pairs of set and method that one run may have.
const MAX_PAIRS: usize = 10_000;

/// What stands for the carrier, the reading and the radar of scenes that say these themselves.
const OF_FILE: &str = "file";

/// What made a row. Rows of one table are compared and averaged, so they must be made alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// Version of the program.
    pub program: String,
    /// What lay beneath the reflectors.
    pub floor: Floor,
    /// How maps were normalised.
    pub normalisation: Normalisation,
    /// Where the scenes are from.
    pub scenes: Scenes,
    /// The weights of the method, if it has learned any.
    pub weights: Option<Weights>,
    /// Which scenes were this run's.
    pub shard: Shard,
    /// What all shards together are.
    pub whole: Whole,
    /// The detector that was tried on every output, if one was.
    pub cfar: Option<Cfar>,
}

/// Where the scenes of a row are from.
#[derive(Debug, Clone, PartialEq)]
pub enum Scenes {
    /// A generator made them.
    Generated {
        /// What for.
        purpose: Purpose,
        /// After which description.
        reading: Reading,
        /// How the carrier's phase was read.
        carrier: Carrier,
        /// [`radar_text`] of the radar.
        radar: String,
    },
    /// They are files, which say themselves which radar they are for.
    Files {
        /// What their names and contents are known by.
        fingerprint: String,
    },
}

/// All that a run was to find, shards of other machines included.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Whole {
    /// Name and number of scenes of each set.
    pub sets: Vec<(String, u32)>,
    /// Names of the methods.
    pub methods: Vec<String>,
}

/// A set or method that is named twice: its scenes would count twice.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what} \"{name}\" is given twice; expected each {what} once")]
pub struct GivenTwice {
    what: &'static str,
    name: String,
}

impl Whole {
    /// The run over these sets, each with its number of scenes, by these methods.
    ///
    /// # Errors
    /// [`GivenTwice`] names the first set or method that is there already.
    pub fn new(sets: Vec<(String, u32)>, methods: Vec<String>) -> Result<Whole, GivenTwice> {
        let names: Vec<&String> = sets.iter().map(|(name, _)| name).collect();
        if let Some(name) = first_repeated(&names) {
            return Err(GivenTwice { what: "set", name: name.clone() });
        }
        match first_repeated(&methods.iter().collect::<Vec<_>>()) {
            Some(name) => Err(GivenTwice { what: "method", name: name.clone() }),
            None => Ok(Whole { sets, methods }),
        }
    }
}

fn first_repeated<'a>(names: &[&'a String]) -> Option<&'a String> {
    names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)).map(|(_, name)| *name)
}

/// What a radar is known by in rows: each constant that differs from table 3.1, the carrier's reading left out. Empty for table 3.1.
pub fn radar_text(radar: &Radar) -> String {
    let fields = |radar: &Radar| match serde_json::to_value(radar) {
        Ok(serde_json::Value::Object(fields)) => fields,
        _ => serde_json::Map::new(),
    };
    let usual = fields(&Radar::default());
    // Rows are of one chirp.
    let mut differing: Vec<String> = fields(&radar.of_one_chirp())
        .iter()
        .filter(|(name, value)| *name != "carrier" && usual.get(*name) != Some(*value))
        .flat_map(|(name, value)| match value {
            serde_json::Value::String(text) => vec![format!("{name}={text}")],
            // Those of the budget.
            serde_json::Value::Object(numbers) => numbers.iter().map(|(key, v)| format!("{name}.{key}={v}")).collect(),
            value => vec![format!("{name}={value}")],
        })
        .collect();
    differing.sort();
    differing.join(" ")
}

/// A named part of an [`Origin`], as it is written in its column.
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
    fn expected(self) -> &'static str {
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

/// A name in a list whose names are separated by semicolons.
fn listed(name: &str) -> String {
    name.replace('%', "%25").replace(';', "%3B")
}

fn unlisted(name: &str) -> String {
    name.trim().replace("%3B", ";").replace("%25", "%")
}

/// A name that serde gives a value without fields, as scene files have it.
fn serde_name(value: impl serde::Serialize) -> String {
    serde_json::to_value(value).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

fn by_serde_name<T: serde::de::DeserializeOwned>(name: &str) -> Option<T> {
    serde_json::from_value(serde_json::Value::String(name.to_owned())).ok()
}

impl Origin {
    /// What stands in a part's column.
    pub fn text(&self, part: Part) -> String {
        let own = |of: fn(&Scenes) -> Option<String>| of(&self.scenes).unwrap_or_else(|| OF_FILE.to_owned());
        match part {
            Part::Version => FORMAT.to_string(),
            Part::Program => self.program.clone(),
            Part::Floor => self.floor.to_string(),
            Part::Normalisation => self.normalisation.to_string(),
            Part::Purpose => own(|s| match s {
                Scenes::Generated { purpose, .. } => Some(serde_name(purpose)),
                Scenes::Files { .. } => None,
            }),
            Part::Reading => own(|s| match s {
                Scenes::Generated { reading, .. } => Some(serde_name(reading)),
                Scenes::Files { .. } => None,
            }),
            Part::Carrier => own(|s| match s {
                Scenes::Generated { carrier, .. } => Some(serde_name(carrier)),
                Scenes::Files { .. } => None,
            }),
            Part::Radar => own(|s| match s {
                Scenes::Generated { radar, .. } => Some(radar.clone()),
                Scenes::Files { .. } => None,
            }),
            Part::Scenes => match &self.scenes {
                Scenes::Generated { .. } => String::new(),
                Scenes::Files { fingerprint } => fingerprint.clone(),
            },
            Part::Weights => self.weights.as_ref().map(|w| w.sha256.clone()).unwrap_or_default(),
            Part::Optimiser => self.weights.as_ref().map(|w| w.optimiser.clone()).unwrap_or_default(),
            Part::Shard => self.shard.to_string(),
            Part::Whole => {
                let sets = self.whole.sets.iter().map(|(name, count)| format!("{} x {count}", listed(name)));
                sets.collect::<Vec<_>>().join("; ")
            }
            Part::Cfar => self.cfar.map(|cfar| cfar.to_string()).unwrap_or_default(),
            Part::Methods => self.whole.methods.iter().map(|m| listed(m)).collect::<Vec<_>>().join("; "),
        }
    }

    /// Reads what [`Origin::text`] wrote; `None` where the version is missing, as in tables that were written before.
    ///
    /// # Errors
    /// The part that can't be read, and what was expected there.
    pub fn read<'a>(text: impl Fn(Part) -> &'a str) -> Result<Option<Origin>, (Part, &'static str)> {
        if text(Part::Version).is_empty() {
            return Ok(None);
        }
        let wrong = |part: Part| (part, part.expected());
        if text(Part::Version).parse() != Ok(FORMAT) {
            return Err(wrong(Part::Version));
        }
        let scenes = match text(Part::Carrier) {
            OF_FILE => Scenes::Files { fingerprint: text(Part::Scenes).to_owned() },
            carrier => Scenes::Generated {
                purpose: by_serde_name(text(Part::Purpose)).ok_or(wrong(Part::Purpose))?,
                reading: by_serde_name(text(Part::Reading)).ok_or(wrong(Part::Reading))?,
                carrier: by_serde_name(carrier).ok_or(wrong(Part::Carrier))?,
                radar: text(Part::Radar).to_owned(),
            },
        };
        let weights = |sha256: &str| Weights { sha256: sha256.into(), optimiser: text(Part::Optimiser).into() };
        Ok(Some(Origin {
            program: text(Part::Program).to_owned(),
            floor: text(Part::Floor).parse().map_err(|_| wrong(Part::Floor))?,
            normalisation: text(Part::Normalisation).parse().map_err(|_| wrong(Part::Normalisation))?,
            scenes,
            weights: Some(text(Part::Weights)).filter(|w| !w.is_empty()).map(weights),
            shard: text(Part::Shard).parse().map_err(|_| wrong(Part::Shard))?,
            whole: Whole {
                sets: sets(text(Part::Whole)).ok_or(wrong(Part::Whole))?,
                methods: methods(text(Part::Methods)).ok_or(wrong(Part::Methods))?,
            }
            .bounded()
            .ok_or(wrong(Part::Whole))?,
            cfar: match text(Part::Cfar) {
                "" => None,
                text => Some(text.parse().map_err(|_| wrong(Part::Cfar))?),
            },
        }))
    }

    /// The first part in which two rows of one table differ though they must not. Rows of the `same_method` have the same weights, made by
    /// the same program; rows of the `same_set` the same scenes.
    pub fn unlike(&self, other: &Origin, same_method: bool, same_set: bool) -> Option<Part> {
        let mut parts = vec![Part::Floor, Part::Normalisation, Part::Cfar];
        match (&self.scenes, &other.scenes) {
            (Scenes::Generated { .. }, Scenes::Generated { .. }) => {
                parts.extend([Part::Purpose, Part::Reading, Part::Carrier, Part::Radar]);
            }
            (Scenes::Files { .. }, Scenes::Files { .. }) if same_set => parts.push(Part::Scenes),
            _ if same_set => parts.push(Part::Carrier),
            _ => {}
        }
        if same_method {
            parts.extend([Part::Program, Part::Weights]);
        }
        parts.into_iter().find(|part| self.text(*part) != other.text(*part))
    }
}

impl Whole {
    /// The same, if no file asks for more work than a run can be.
    fn bounded(self) -> Option<Whole> {
        let scenes = self.sets.iter().all(|(_, count)| *count as usize <= MAX_ROWS);
        (scenes && self.sets.len().saturating_mul(self.methods.len()) <= MAX_PAIRS).then_some(self)
    }
}

fn sets(text: &str) -> Option<Vec<(String, u32)>> {
    let set = |text: &str| {
        let (name, count) = text.rsplit_once(" x ")?;
        Some((unlisted(name), count.trim().parse().ok()?)).filter(|(name, _)| !name.is_empty())
    };
    text.split(';').map(set).collect()
}

fn methods(text: &str) -> Option<Vec<String>> {
    let names: Vec<String> = text.split(';').map(unlisted).collect();
    names.iter().all(|name| !name.is_empty()).then_some(names)
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The origin of rows that a usual run makes.
    pub(in crate::evaluate) fn origin() -> Origin {
        Origin {
            program: "0.1.0".into(),
            floor: Floor::Thesis,
            normalisation: Normalisation::MinMax,
            scenes: Scenes::Generated {
                purpose: Purpose::Test,
                reading: Reading::Program,
                carrier: Carrier::OneWay,
                radar: String::new(),
            },
            weights: None,
            shard: Shard::default(),
            whole: Whole { sets: vec![("1".into(), 4)], methods: vec!["live".into()] },
            cfar: None,
        }
    }

    #[test]
    fn an_origin_is_read_as_it_was_written() {
        let radar = Radar { elements: 64, samples: 32, ..Radar::default() };
        let generated = Origin {
            floor: "snr=-3.5".parse().unwrap(),
            normalisation: "db=60".parse().unwrap(),
            cfar: Some(Cfar { false_alarm: 1e-7, ..Cfar::default() }),
            weights: Some(Weights { sha256: "0123456789ab".into(), optimiser: "AdamW, then Muon".into() }),
            shard: "1/4".parse().unwrap(),
            scenes: Scenes::Generated {
                purpose: Purpose::Validation,
                reading: Reading::Text,
                carrier: Carrier::TwoWay,
                radar: radar_text(&radar),
            },
            ..origin()
        };
        let sets = vec![("my; 5 x 5 % scenes".into(), 7), ("3".into(), 12)];
        let whole = Whole { sets, methods: vec!["live".into(), "nomp".into()] };
        let files = Origin { scenes: Scenes::Files { fingerprint: "ab".into() }, whole, ..origin() };
        for origin in [generated, files, origin()] {
            let texts = Part::ALL.map(|part| origin.text(part));
            assert_eq!(Origin::read(|part| &texts[part as usize]), Ok(Some(origin)));
        }
    }

    #[test]
    fn a_radar_is_known_by_what_differs_from_table_3_1() {
        assert_eq!(radar_text(&Radar { carrier: Carrier::TwoWay, ..Radar::default() }), "");
        let radar = Radar { elements: 64, window: crate::radar::WindowFunction::Blackman, ..Radar::default() };
        assert_eq!(radar_text(&radar), "elements=64 window=blackman");
        let radar = Radar { elements: 64, budget: Some(crate::radar::LinkBudget::default()), ..Radar::default() };
        let budget = "budget.antenna_gain_dbi=10.0 budget.noise_figure_db=12.0 budget.transmit_power_dbm=12.0";
        assert_eq!(radar_text(&radar), format!("{budget} elements=64"));
    }

    #[test]
    fn what_can_not_be_read_is_named() {
        let texts = Part::ALL.map(|part| origin().text(part));
        for (part, text) in [
            (Part::Version, "2"),
            (Part::Floor, "rock"),
            (Part::Normalisation, ""),
            (Part::Carrier, "three-way"),
            (Part::Shard, "4/4"),
            (Part::Whole, "1 times 4"),
            (Part::Whole, "1 x 4294967295"),
            (Part::Methods, "live;"),
            (Part::Cfar, "ca:rate=1"),
        ] {
            let read = Origin::read(|p| if p == part { text } else { &texts[p as usize] });
            assert_eq!(read.unwrap_err().0, part, "{text}");
        }
        assert_eq!(Origin::read(|_| ""), Ok(None), "a table from before");
    }

    #[test]
    fn unlike_origins_name_the_part_that_differs() {
        let other = Origin { floor: Floor::Exact, ..origin() };
        assert_eq!(origin().unlike(&other, false, false), Some(Part::Floor));
        let weights = |sha256: &str| Some(Weights { sha256: sha256.into(), optimiser: String::new() });
        let [a, b] = ["a", "b"].map(|w| Origin { weights: weights(w), ..origin() });
        assert_eq!((a.unlike(&b, true, true), a.unlike(&b, false, true)), (Some(Part::Weights), None));
        let [a, b] = ["a", "b"].map(|f| Origin { scenes: Scenes::Files { fingerprint: f.into() }, ..origin() });
        assert_eq!((a.unlike(&b, true, true), a.unlike(&b, true, false)), (Some(Part::Scenes), None));
        let shard = Origin { shard: "1/2".parse().unwrap(), ..origin() };
        assert_eq!(origin().unlike(&shard, true, true), None, "shards of one run are alike");
    }

    #[test]
    fn what_is_given_twice_is_refused() {
        let sets = |names: [&str; 2]| names.map(|n| (n.to_owned(), 3)).to_vec();
        let methods = |names: [&str; 2]| names.map(str::to_owned).to_vec();
        assert!(Whole::new(sets(["1", "2"]), methods(["live", "nomp"])).is_ok());
        let twice = Whole::new(sets(["1", "1"]), methods(["live", "nomp"])).unwrap_err();
        assert_eq!(twice.to_string(), "set \"1\" is given twice; expected each set once");
        let twice = Whole::new(sets(["1", "2"]), methods(["live", "live"])).unwrap_err();
        assert_eq!(twice.to_string(), "method \"live\" is given twice; expected each method once");
    }
}
