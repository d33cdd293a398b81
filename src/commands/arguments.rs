//! Arguments that several subcommands share.

use crate::radar::Carrier;
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
