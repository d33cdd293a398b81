//! The algorithms by name.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// An algorithm that evaluates equation 3.3.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Algorithm {
    /// The formula as written ([`super::direct`]), rounding noise included.
    Direct,
    /// Phases reduced to turns ([`super::exact`]).
    Exact,
    /// Products of 16 + 32 phasors ([`super::split`]).
    Split,
    /// Spread on a range grid and transformed ([`super::gridded`]).
    Gridded,
    /// Range profiles from three Dirichlet kernels, on few rows ([`super::closed_form`]). For samples, [`Algorithm::Split`].
    ClosedForm,
}

impl Algorithm {
    pub const ALL: [Algorithm; 5] =
        [Algorithm::Direct, Algorithm::Exact, Algorithm::Split, Algorithm::Gridded, Algorithm::ClosedForm];

    /// Whether it computes in blocks of elements ([`super::synthesis`]), in either precision, as fast as a tolerance allows.
    pub fn is_fast(self) -> bool {
        !matches!(self, Algorithm::Direct | Algorithm::Exact)
    }

    /// Name in reports and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Algorithm::Direct => "direct",
            Algorithm::Exact => "exact",
            Algorithm::Split => "split",
            Algorithm::Gridded => "gridded",
            Algorithm::ClosedForm => "closed-form",
        }
    }
}

impl fmt::Display for Algorithm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Algorithm {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let unknown = || format!("unknown algorithm \"{s}\"; expected direct, exact, split, gridded or closed-form");
        Algorithm::ALL.into_iter().find(|a| a.name() == s).ok_or_else(unknown)
    }
}

/// Precision of all computations after that of the phase, which is in f64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    F32,
    F64,
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Precision::F32 => "f32",
            Precision::F64 => "f64",
        })
    }
}
