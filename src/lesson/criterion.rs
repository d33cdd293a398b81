//! Requirements of a challenge, measured and put into sentences: the wanted and the present value.

use super::challenge::{Challenge, Measure, Requirement};
use super::quantity::ObjectNumber;
use super::stage::Stage;
use crate::radar::capitalised;
use crate::scene::Scene;

/// Most decimals that tell a value from a bound that it misses, beyond the usual ones.
const MAX_MORE_DECIMALS: usize = 9;

#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The wanted value, as a sentence without its full stop.
    pub wanted: String,
    /// The present value, with its unit.
    pub found: String,
    pub holds: bool,
}

impl Challenge {
    /// Measures every requirement on what the learner made; `hidden` is the stage of [`Challenge::hidden_scene`].
    /// # Errors
    /// A sentence for a value that can't be measured: an object is gone, the method refuses.
    pub fn measure(&self, stage: &Stage, hidden: Option<&Stage>) -> Result<Vec<Measured>, String> {
        self.requirements.iter().map(|r| r.measure(stage, hidden)).collect()
    }
}

impl Requirement {
    fn measure(&self, stage: &Stage, hidden: Option<&Stage>) -> Result<Measured, String> {
        let value = self.measure.value(stage, hidden)?;
        let holds = self.at_least.is_none_or(|b| value >= b) && self.at_most.is_none_or(|b| value <= b);
        let (wanted, found) = (wanted(self, &stage.scene), found(self, value, holds));
        Ok(Measured { wanted, found, holds })
    }
}

/// A requirement as a sentence without its full stop: "A dip of at least 0.06 between the two in the target".
fn wanted(requirement: &Requirement, scene: &Scene) -> String {
    let (times, unit) = requirement.measure.unit();
    let bound = bound(requirement, times, unit);
    let object = |number: &ObjectNumber| named(*number, scene);
    let both = |pair: &[ObjectNumber; 2]| match scene.objects.len() {
        2 => "the two".to_owned(),
        _ => format!("{} and {}", object(&pair[0]), object(&pair[1])),
    };
    let text = match &requirement.measure {
        Measure::Lambda { map, object: number } => format!("Λ of {bound} at {} in {}", object(number), map.words()),
        Measure::Dip { map, objects } => format!("a dip of {bound} between {} in {}", both(objects), map.words()),
        Measure::SquaredError => format!("a squared error of {bound} of the output"),
        Measure::Unexplained => format!("a squared error of {bound} against the map to reproduce"),
        Measure::UnexplainedOverMethod => format!("a squared error of {bound} times the method's"),
        Measure::Objects if requirement.at_most == Some(1.0) => format!("{bound} object"),
        Measure::Objects => format!("{bound} objects"),
        Measure::Distance { objects } => format!("{bound} between {}", both(objects)),
        Measure::BandwidthGigahertz => format!("a bandwidth of {bound}"),
        Measure::Range { object: number } => format!("a range of {bound} for {}", object(number)),
        Measure::Reflectivity { object: number } => format!("a reflectivity of {bound} for {}", object(number)),
        Measure::BrightPart { map, above } => format!("{bound} of the cells of {} above Λ {above}", map.words()),
        Measure::Quantity { quantity, object: None } => format!("{} of {bound}", quantity.name()),
        Measure::Quantity { quantity, object: Some(number) } => {
            format!("{} of {bound} for {}", quantity.name(), object(number))
        }
    };
    capitalised(&text)
}

/// A measured value with its unit. Where it doesn't hold, it has as many digits as tell it from its bounds.
fn found(requirement: &Requirement, value: f64, holds: bool) -> String {
    let (times, unit) = requirement.measure.unit();
    let bounds = || requirement.at_least.into_iter().chain(requirement.at_most).map(|bound| times * bound);
    let told = |more: usize| digits(times * value, more);
    let is_apart =
        |more: &usize| holds || bounds().all(|bound| with_decimals(bound, times * value, *more) != told(*more));
    let more = (0..=MAX_MORE_DECIMALS).find(is_apart).unwrap_or(MAX_MORE_DECIMALS);
    with_unit(&told(more), unit)
}

impl Measure {
    /// Factor and unit of a value in sentences.
    fn unit(&self) -> (f64, &'static str) {
        match self {
            Measure::Distance { .. } | Measure::Range { .. } => (1.0, "m"),
            Measure::BandwidthGigahertz => (1.0, "GHz"),
            Measure::BrightPart { .. } => (100.0, "%"),
            Measure::Quantity { quantity, .. } => (1.0, quantity.unit()),
            _ => (1.0, ""),
        }
    }
}

/// "at least 0.06", "9.5 to 10.5 m".
fn bound(requirement: &Requirement, times: f64, unit: &str) -> String {
    let told = |value: f64| plain(times * value);
    let text = match (requirement.at_least, requirement.at_most) {
        (Some(low), Some(high)) if low == high => format!("exactly {}", told(low)),
        (Some(low), Some(high)) => format!("{} to {}", told(low), told(high)),
        (Some(low), None) => format!("at least {}", told(low)),
        (None, Some(high)) => format!("at most {}", told(high)),
        (None, None) => "anything".to_owned(),
    };
    with_unit(&text, unit)
}

fn with_unit(text: &str, unit: &str) -> String {
    format!("{text} {unit}").trim_end().to_owned()
}

/// A bound with its author's digits, also after multiplication by 100.
fn plain(value: f64) -> String {
    format!("{}", (value * 1e9).round() / 1e9)
}

/// A number to three digits, with at most four decimals and `more`.
fn digits(value: f64, more: usize) -> String {
    with_decimals(value, value, more)
}

/// A number with the decimals that [`digits`] gives `like`.
fn with_decimals(value: f64, like: f64, more: usize) -> String {
    let decimals = more
        + match like.abs() {
            v if v >= 100.0 || v == v.trunc() => 0,
            v if v >= 10.0 => 1,
            v if v >= 1.0 => 2,
            v if v >= 0.1 => 3,
            _ => 4,
        };
    format!("{value:.decimals$}").replace('-', "−")
}

fn named(number: ObjectNumber, scene: &Scene) -> String {
    let index = number.index(scene.objects.len());
    index.map_or_else(|_| format!("object {}", number.0), |index| scene.objects[index].called(index))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lesson::shipped;
    use crate::radar::Radar;

    /// The criteria of a shipped lesson's last step.
    fn of(id: &str) -> Vec<String> {
        let lesson = shipped::ALL.iter().find(|file| file.id == id).unwrap().load().unwrap();
        let step = lesson.steps.last().unwrap();
        step.challenge.as_ref().unwrap().requirements.iter().map(|r| wanted(r, &step.scene())).collect()
    }

    #[test]
    fn criteria_read_as_sentences() {
        let expected = [
            "A dip of at least 0.06 between the two in the target",
            "A bandwidth of at most 1 GHz",
            "At most 0.601 m between the two",
        ];
        assert_eq!(of("range-and-bandwidth"), expected);
        let bright = "At least 0.3 % of the cells of the target above Λ 0.5";
        assert_eq!(of("smooth-and-rough"), [bright, "At most 1 object"]);
        assert_eq!(of("folding-and-wrapping")[1], "An apparent range of 9.5 to 10.5 m for point 1");
        assert_eq!(of("two-ends-and-the-comb")[1], "Exactly 1 object");
        assert_eq!(of("the-floor")[1], "A reflectivity of at least 0.05 for point 2");
    }

    #[test]
    fn what_was_measured_has_its_unit() {
        let of = |measure, at_least, value: f64| {
            found(&Requirement { measure, at_least: Some(at_least), at_most: None }, value, value >= at_least)
        };
        let bright = Measure::BrightPart { map: crate::lesson::MapName::Target, above: 0.5 };
        assert_eq!(of(bright, 0.1, 0.00213), "0.213 %");
        assert_eq!(of(Measure::BandwidthGigahertz, 0.5, 0.2), "0.200 GHz");
        assert_eq!(of(Measure::Objects, 3.0, 2.0), "2");
        assert_eq!(of(Measure::BandwidthGigahertz, 2.0, 1.99994), "1.9999 GHz", "2.00 would look met");
        assert_eq!(of(Measure::BandwidthGigahertz, 2.0, 2.00001), "2.00 GHz", "it is met");
    }

    #[test]
    fn half_of_the_shown_spacing_leaves_no_grating_lobe() {
        let lesson = shipped::ALL.iter().find(|file| file.id == "grating-lobes").unwrap().load().unwrap();
        let step = lesson.steps.last().unwrap();
        let radar = Radar { element_spacing_metres: 0.961e-3, elements: 1024, ..step.radar.clone() };
        let stage = Stage::new(&radar, &step.scene(), &step.view, false).unwrap();
        let measured = step.challenge.as_ref().unwrap().measure(&stage, None).unwrap();
        assert!(measured.iter().all(|measured| measured.holds), "{measured:?}");
    }
}
