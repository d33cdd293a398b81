//! Layouts by name, as the command line offers them.

use super::{End, Layout, LayoutError, Mimo, Radar};
use std::fmt;
use std::str::FromStr;

/// A layout that can be named: `full`, `two-ends`, `one-end`, `random=N` or `random=N:SEED`, `mimo=TxR`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[allow(missing_docs)] // Names of fields say what is in them.
pub enum LayoutKind {
    /// Every element.
    Full,
    /// Both ends.
    TwoEnds,
    /// The first end alone.
    OneEnd,
    /// Elements at random places of the whole aperture.
    Random { elements: usize, seed: u64 },
    /// The virtual elements of every pair of a transmitter and a receiver.
    Mimo { transmitters: usize, receivers: usize },
}

/// Most transmitters or receivers that a name may ask for.
const MAX_CHANNELS: usize = 64;

impl LayoutKind {
    /// Where the elements stand on `radar`.
    /// # Errors
    /// [`LayoutError`] for a random layout of no element or of more than `radar` has.
    pub fn layout(self, radar: &Radar) -> Result<Layout, LayoutError> {
        Ok(match self {
            LayoutKind::Full => Layout::uniform(radar),
            LayoutKind::TwoEnds => Layout::two_ends(radar),
            LayoutKind::OneEnd => Layout::one_end(radar, End::First),
            LayoutKind::Random { elements, seed } => Layout::random(radar, elements, seed)?,
            LayoutKind::Mimo { transmitters, receivers } => Mimo::filled(radar, transmitters, receivers).layout(),
        })
    }
}

impl fmt::Display for LayoutKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LayoutKind::Full => f.pad("full"),
            LayoutKind::TwoEnds => f.pad("two-ends"),
            LayoutKind::OneEnd => f.pad("one-end"),
            LayoutKind::Random { elements, seed } => f.pad(&format!("random={elements}:{seed}")),
            LayoutKind::Mimo { transmitters, receivers } => f.pad(&format!("mimo={transmitters}x{receivers}")),
        }
    }
}

/// A name that stands for no layout.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "there is no layout \"{0}\"; expected full, two-ends, one-end, random=N, random=N:SEED or mimo=TxR with up to 64 each"
)]
pub struct UnknownLayout(String);

impl FromStr for LayoutKind {
    type Err = UnknownLayout;

    fn from_str(name: &str) -> Result<Self, UnknownLayout> {
        let unknown = || UnknownLayout(name.to_owned());
        let number = |text: &str| text.parse::<usize>().map_err(|_| unknown());
        match name.trim().split_once('=') {
            None => match name.trim() {
                "full" => Ok(LayoutKind::Full),
                "two-ends" => Ok(LayoutKind::TwoEnds),
                "one-end" => Ok(LayoutKind::OneEnd),
                _ => Err(unknown()),
            },
            Some(("random", rest)) => {
                let (elements, seed) = rest.split_once(':').unwrap_or((rest, "0"));
                let seed = seed.parse().map_err(|_| unknown())?;
                Ok(LayoutKind::Random { elements: number(elements)?, seed })
            }
            Some(("mimo", rest)) => {
                let (transmitters, receivers) = rest.split_once('x').ok_or_else(unknown)?;
                let (transmitters, receivers) = (number(transmitters)?, number(receivers)?);
                let allowed = 1..=MAX_CHANNELS;
                if !(allowed.contains(&transmitters) && allowed.contains(&receivers)) {
                    return Err(unknown());
                }
                Ok(LayoutKind::Mimo { transmitters, receivers })
            }
            Some(_) => Err(unknown()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layout_has_its_name() {
        let radar = Radar::default();
        for (name, elements) in
            [("full", 1024), ("two-ends", 24), ("one-end", 12), ("random=24:7", 24), ("mimo=3x4", 12)]
        {
            let kind: LayoutKind = name.parse().unwrap();
            assert_eq!(kind.to_string(), name);
            assert_eq!(kind.layout(&radar).unwrap().len(), elements);
        }
        assert_eq!("random=5".parse(), Ok(LayoutKind::Random { elements: 5, seed: 0 }));
        assert!(LayoutKind::Random { elements: 0, seed: 0 }.layout(&radar).is_err());
    }

    #[test]
    fn other_names_are_refused() {
        for name in ["", "fulll", "random", "random=x", "random=3:y", "mimo=3", "mimo=0x4", "mimo=3x65", "none=3"] {
            let error = name.parse::<LayoutKind>().unwrap_err().to_string();
            assert!(error.contains(&format!("\"{name}\"")) && error.contains("two-ends"), "{error}");
        }
    }
}
