//! The origin of a row beside its set, scene, seed and method: program, floor, radar, weights.

use super::part::Part;
use super::whole::{Whole, methods, sets};
use crate::evaluate::shard::Shard;
use crate::maps::Normalisation;
use crate::maps::cfar::Cfar;
use crate::radar::{Carrier, Radar};
use crate::reconstruct::Weights;
use crate::scene::generate::{Purpose, Reading};
use crate::signal::Floor;

/// Number of the format of rows. Tables from before it was counted have no such column, and don't say what made them.
pub const FORMAT: u32 = 1;

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
            Part::Whole => self.whole.sets_text(),
            Part::Cfar => self.cfar.map(|cfar| cfar.to_string()).unwrap_or_default(),
            Part::Methods => self.whole.methods_text(),
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
}
