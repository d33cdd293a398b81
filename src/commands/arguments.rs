//! Arguments that several subcommands share.

use crate::radar::Carrier;
use crate::signal::Floor;
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// What lies beneath the reflectors of the maps.
#[derive(Debug, Clone, clap::Args)]
pub struct FloorArgs {
    /// What lies beneath the reflectors: thesis (its f64 rounding noise), exact (nothing), snr=DB (thermal noise, DB from -100 to
    /// 300) or dbm=LEVEL (thermal noise of LEVEL dBm a sample whatever the scene, from -300 to 200; a reflector of sigma 1 at 20 m is
    /// +18 dBm)
    #[arg(long, value_name = "thesis|exact|snr=DB|dbm=LEVEL", default_value_t = Floor::Thesis)]
    pub floor: Floor,
}

/// Parses `one-way` or `two-way`.
pub fn carrier() -> impl TypedValueParser<Value = Carrier> {
    PossibleValuesParser::new(["one-way", "two-way"]).map(|name| match name.as_str() {
        "two-way" => Carrier::TwoWay,
        _ => Carrier::OneWay,
    })
}
