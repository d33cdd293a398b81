//! Arguments that several subcommands share.

use crate::radar::Carrier;
use crate::scene::generate::Kind;
use crate::signal::Floor;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// What lies beneath the reflectors of the maps.
#[derive(Debug, Clone, clap::Args)]
pub struct FloorArgs {
    /// What lies beneath the reflectors: thesis (its f64 rounding noise), exact (nothing) or snr=DB (thermal noise)
    #[arg(long, value_name = "thesis|exact|snr=DB", default_value_t = Floor::Thesis)]
    pub floor: Floor,
}

/// Parses `one-way` or `two-way`.
pub fn carrier() -> impl TypedValueParser<Value = Carrier> {
    PossibleValuesParser::new(["one-way", "two-way"]).map(|name| match name.as_str() {
        "two-way" => Carrier::TwoWay,
        _ => Carrier::OneWay,
    })
}

/// One of the thesis' test sets, by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TestSet(u8);

impl TestSet {
    /// 1, 2 or 3.
    pub fn number(self) -> usize {
        usize::from(self.0)
    }

    /// The kind of its scenes.
    pub fn kind(self) -> Kind {
        Kind::TEST_SETS[self.number() - 1]
    }
}

impl std::str::FromStr for TestSet {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        match s.trim().parse() {
            Ok(number @ 1..=3) => Ok(TestSet(number)),
            _ => Err(format!("there is no test set \"{s}\"; expected 1, 2 or 3")),
        }
    }
}
