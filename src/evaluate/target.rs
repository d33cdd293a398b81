//! Targets: maps of the whole array against which an estimate is compared, and which a network may learn.

use std::fmt;
use std::str::FromStr;

/// A map of the whole array.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Target {
    /// The map of the exact array, without noise.
    Ideal,
    /// The map of the samples of the whole array, with their noise and with the errors of its elements.
    Measured,
    /// The map of the samples of the exact array: with the noise, without errors of the elements. The measured one where no element is off.
    Calibrated,
}

impl Target {
    /// All targets.
    pub const ALL: [Target; 3] = [Target::Ideal, Target::Measured, Target::Calibrated];
    /// The targets in data unless others are asked for.
    pub const USUAL: [Target; 2] = [Target::Ideal, Target::Measured];

    /// Name of the target's array in data.
    pub fn array(self) -> &'static str {
        match self {
            Target::Ideal => "target_ideal",
            Target::Measured => "target_measured",
            Target::Calibrated => "target_calibrated",
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.array().trim_start_matches("target_"))
    }
}

impl FromStr for Target {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let is_called = |target: &Target| target.array() == name || target.to_string() == name;
        Target::ALL.into_iter().find(is_called).ok_or_else(|| match name {
            "target" => "a target has a name: target_ideal (the array as it should be, without noise) or target_measured (what the \
                         whole array heard)"
                .to_owned(),
            _ => format!("unknown target \"{name}\"; expected ideal, measured or calibrated"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bare_target_is_refused_with_both_names() {
        for target in Target::ALL {
            assert_eq!([target.array().parse(), target.to_string().parse()], [Ok(target), Ok(target)]);
        }
        let told = "target".parse::<Target>().unwrap_err();
        assert!(told.contains("target_ideal") && told.contains("target_measured"), "{told}");
    }
}
