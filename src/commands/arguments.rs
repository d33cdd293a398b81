//! Arguments that several subcommands share.

use super::CommandError;
use crate::radar::{Carrier, Decibels};
use crate::signal::Floor;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::fmt::Display;
use std::ops::RangeInclusive;
use std::path::Path;
use std::str::FromStr;

/// The floor: the noise of the maps.
#[derive(Debug, Clone, clap::Args)]
pub struct FloorArgs {
    /// Noise: thesis (its f64 rounding noise), exact (none), thermal (that of the receivers by the link budget), snr=DB (thermal noise at a
    /// signal-to-noise ratio, -100 to 300) or dbm=LEVEL (thermal noise of LEVEL dBm a sample in every scene, -300 to 200). LEVEL counts the squared
    /// magnitude of a sample as watts: a reflector of sigma 1 at 20 m has +18 dBm. Where the radar has a link budget, LEVEL is the power in
    /// the receiver, as `apertura budget` prints it [default: thesis]
    #[arg(long, value_name = "thesis|exact|thermal|snr=DB|dbm=LEVEL")]
    floor: Option<Floor>,
}

impl FloorArgs {
    pub fn floor(&self) -> Floor {
        self.floor.unwrap_or(Floor::Thesis)
    }

    /// Refuses `--floor` and `--seed`, the noise of a simulation, beside the recording at `path`.
    pub fn check_unset(&self, seed: Option<u64>, path: &Path) -> Result<(), CommandError> {
        let given = [("--floor", self.floor.is_some()), ("--seed", seed.is_some())];
        given.into_iter().find(|(_, is_given)| *is_given).map_or(Ok(()), |(name, _)| {
            let message = format!("{name} is a scene's; the noise of a recording is that of its samples");
            Err(CommandError::on(path)(message))
        })
    }
}

/// The methods that were named, or else the programs of one's own, or else `usual`.
pub fn chosen(named: &[String], own: &[&'static str], usual: &str) -> Vec<String> {
    match (named, own) {
        ([], []) => vec![usual.to_owned()],
        ([], own) => own.iter().map(|name| (*name).to_owned()).collect(),
        (named, _) => named.to_vec(),
    }
}

/// Parses `one-way` or `two-way`.
pub fn carrier() -> impl TypedValueParser<Value = Carrier> {
    PossibleValuesParser::new(["one-way", "two-way"]).map(|name| match name.as_str() {
        "two-way" => Carrier::TwoWay,
        _ => Carrier::OneWay,
    })
}

/// Parses a whole number within `range`; the message to anything else says what is allowed.
pub fn whole<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    within("a whole number", range)
}

/// Parses a number within `range`; the message to anything else says what is allowed.
pub fn real(range: RangeInclusive<f64>) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    within("a number", range)
}

/// Parses decibels from -200 to 200.
pub fn decibels(text: &str) -> Result<Decibels, String> {
    usable(text, |db| (-200.0..=200.0).contains(&db), "expected decibels between -200 and 200").map(Decibels)
}

/// Parses a number of which `is_usable`; the message to anything else is `expected`.
pub fn usable(text: &str, is_usable: impl Fn(f64) -> bool, expected: &str) -> Result<f64, String> {
    text.trim().parse().ok().filter(|number| is_usable(*number)).ok_or_else(|| expected.to_owned())
}

fn within<T>(
    what: &'static str,
    range: RangeInclusive<T>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync + 'static
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync + 'static,
{
    move |text| {
        let value = text.trim().parse().ok().filter(|value| range.contains(value));
        value.ok_or_else(|| format!("expected {what} from {} to {}", range.start(), range.end()))
    }
}

pub fn seed(text: &str) -> Result<u64, String> {
    whole(0..=u64::MAX)(text)
}
