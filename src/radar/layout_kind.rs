//! Layouts by name, as the command line offers them.

use super::{End, Layout, Radar, check_layout};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

/// A layout that can be named: [`LayoutKind::NAMES`].
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
#[allow(missing_docs)] // Names of fields say what is in them.
pub enum LayoutKind {
    /// Every element.
    Full,
    TwoEnds,
    /// The first end alone.
    OneEnd,
    /// Neighbours, and as many elements as `apart` one more than the neighbours apart (Pal and Vaidyanathan 2010).
    Nested {
        neighbours: usize,
        apart: usize,
    },
    /// `many` elements `step` apart, and twice `step` elements `many` apart (Vaidyanathan and Pal 2011).
    Coprime {
        step: usize,
        many: usize,
    },
    /// Every `step`-th element.
    Thinned {
        step: usize,
    },
    /// Elements at random places of the whole aperture.
    Random {
        elements: usize,
        seed: u64,
    },
    /// The virtual elements of every pair of a transmitter and a receiver.
    Mimo {
        transmitters: usize,
        receivers: usize,
    },
    /// The elements of these numbers.
    Listed(Vec<usize>),
}

/// Most transmitters or receivers that a name may ask for.
const MAX_CHANNELS: usize = 64;

const MAX_LISTED_ELEMENTS: usize = 65_536;

impl LayoutKind {
    /// Names of layouts, for messages and help.
    pub const NAMES: &str = "full, two-ends, one-end, nested=AxB (A neighbours and B elements A + 1 apart), coprime=MxN (N elements M apart and 2 M elements N apart), \
                             thinned=K (every K-th element), random=N or random=N:SEED (the outermost two among them), mimo=TxR (up to 64 each), or numbers of \
                             elements as 0-11 1012-1023";

    /// The layout's elements on `radar`.
    /// # Errors
    /// The fault, for elements that `radar` has not.
    pub fn layout(&self, radar: &Radar) -> Result<Layout, String> {
        // One element too many is enough for an error.
        let steps = |count: usize, step: usize| (0..count.min(radar.elements + 1)).map(move |k| k.saturating_mul(step));
        let numbers: Vec<usize> = match self {
            LayoutKind::Full => return Ok(Layout::uniform(radar)),
            LayoutKind::TwoEnds => return Ok(Layout::two_ends(radar)),
            LayoutKind::OneEnd => return Ok(Layout::one_end(radar, End::First)),
            LayoutKind::Random { elements, seed } => return Layout::random(radar, *elements, *seed),
            LayoutKind::Mimo { transmitters, receivers } => {
                return Ok(Layout::mimo(radar, *transmitters, *receivers));
            }
            LayoutKind::Nested { neighbours: a, apart: b } => {
                steps(*a, 1).chain(steps(*b, a.saturating_add(1)).map(|n| n.saturating_add(*a))).collect()
            }
            LayoutKind::Coprime { step: m, many: n } => {
                let both: BTreeSet<usize> = steps(*n, *m).chain(steps(m.saturating_mul(2), *n)).collect();
                both.into_iter().collect()
            }
            LayoutKind::Thinned { step } => (0..radar.elements).step_by((*step).max(1)).collect(),
            LayoutKind::Listed(numbers) => numbers.clone(),
        };
        check_layout(&numbers, radar.elements)?;
        Ok(Layout::of_elements(radar, numbers))
    }

    /// Numbers of the elements of `radar`.
    /// # Errors
    /// The fault, as of [`LayoutKind::layout`], and for elements that stand between those of `radar`.
    pub fn numbers(&self, radar: &Radar) -> Result<Vec<usize>, String> {
        self.layout(radar)?
            .numbers(radar)
            .ok_or_else(|| format!("the elements of {self} don't stand on the radar's own grid"))
    }
}

impl fmt::Display for LayoutKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            LayoutKind::Full => f.pad("full"),
            LayoutKind::TwoEnds => f.pad("two-ends"),
            LayoutKind::OneEnd => f.pad("one-end"),
            LayoutKind::Nested { neighbours, apart } => f.pad(&format!("nested={neighbours}x{apart}")),
            LayoutKind::Coprime { step, many } => f.pad(&format!("coprime={step}x{many}")),
            LayoutKind::Thinned { step } => f.pad(&format!("thinned={step}")),
            LayoutKind::Random { elements, seed } => f.pad(&format!("random={elements}:{seed}")),
            LayoutKind::Mimo { transmitters, receivers } => f.pad(&format!("mimo={transmitters}x{receivers}")),
            LayoutKind::Listed(numbers) => f.pad(&ranges(numbers)),
        }
    }
}

/// Numbers as ranges: "0-11 1012-1023".
pub fn ranges(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let text = |run: &[usize]| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
        [] => String::new(),
    };
    runs.map(text).collect::<Vec<_>>().join(" ")
}

/// The numbers in a text of [`ranges`]; commas may stand between them too.
fn listed(text: &str) -> Option<Vec<usize>> {
    let mut numbers = Vec::new();
    for run in text.split([' ', ',']).filter(|run| !run.is_empty()) {
        let (first, last) = run.split_once('-').unwrap_or((run, run));
        let (first, last): (usize, usize) = (first.parse().ok()?, last.parse().ok()?);
        if first > last || last - first >= MAX_LISTED_ELEMENTS - numbers.len() {
            return None;
        }
        numbers.extend(first..=last);
    }
    (!numbers.is_empty()).then_some(numbers)
}

impl From<LayoutKind> for String {
    fn from(kind: LayoutKind) -> Self {
        kind.to_string()
    }
}

impl TryFrom<String> for LayoutKind {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        name.parse()
    }
}

impl FromStr for LayoutKind {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let unknown = || format!("there is no layout \"{name}\"; expected {}", LayoutKind::NAMES);
        let count = |text: &str| text.parse::<usize>().ok().filter(|count| *count > 0).ok_or_else(unknown);
        let two = |text: &str| -> Result<(usize, usize), String> {
            let (a, b) = text.split_once('x').ok_or_else(unknown)?;
            Ok((count(a)?, count(b)?))
        };
        Ok(match name.trim().split_once('=') {
            None => match name.trim() {
                "full" => LayoutKind::Full,
                "two-ends" => LayoutKind::TwoEnds,
                "one-end" => LayoutKind::OneEnd,
                numbers => LayoutKind::Listed(listed(numbers).ok_or_else(unknown)?),
            },
            Some(("nested", rest)) => two(rest).map(|(neighbours, apart)| LayoutKind::Nested { neighbours, apart })?,
            Some(("coprime", rest)) => two(rest).map(|(step, many)| LayoutKind::Coprime { step, many })?,
            Some(("thinned", rest)) => LayoutKind::Thinned { step: count(rest)? },
            Some(("random", rest)) => {
                let (elements, seed) = rest.split_once(':').unwrap_or((rest, "0"));
                let seed = seed.parse().map_err(|_| unknown())?;
                LayoutKind::Random { elements: count(elements)?, seed }
            }
            Some(("mimo", rest)) => {
                let (transmitters, receivers) = two(rest)?;
                if transmitters.max(receivers) > MAX_CHANNELS {
                    return Err(unknown());
                }
                LayoutKind::Mimo { transmitters, receivers }
            }
            Some(_) => return Err(unknown()),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layout_has_its_name() {
        let radar = Radar::default();
        let of_24 = [("two-ends", 24), ("random=24:7", 24), ("one-end", 12), ("mimo=3x4", 12)];
        for (name, elements) in of_24.into_iter().chain([("full", 1024), ("nested=12x78", 90), ("0-3 9", 5)]) {
            let kind: LayoutKind = name.parse().unwrap();
            assert_eq!(kind.to_string(), name);
            assert_eq!(kind.layout(&radar).unwrap().len(), elements);
        }
        assert_eq!("random=5".parse(), Ok(LayoutKind::Random { elements: 5, seed: 0 }));
        assert!(LayoutKind::Random { elements: 0, seed: 0 }.layout(&radar).is_err());
    }

    #[test]
    fn a_layout_is_a_list_of_numbers() {
        let radar = Radar { elements: 86, end_elements: 8, ..Radar::default() };
        let numbers = |name: &str| name.parse::<LayoutKind>().unwrap().numbers(&radar);
        let nested = numbers("nested=8x8").unwrap();
        assert_eq!(ranges(&nested), "0-8 17 26 35 44 53 62 71");
        assert_eq!(numbers("coprime=3x5").unwrap(), [0, 3, 5, 6, 9, 10, 12, 15, 20, 25]);
        assert_eq!(numbers("thinned=40").unwrap(), [0, 40, 80]);
        assert_eq!(ranges(&numbers("two-ends").unwrap()), "0-7 78-85");
        assert_eq!(numbers("mimo=2x2").unwrap(), [41, 42, 43, 44]);
        for text in ["0-8 17 26 35 44 53 62 71", "0-8,17,26,35,44,53,62,71"] {
            assert_eq!(numbers(text).unwrap(), nested);
        }
        for name in ["nested=40x40", "nested=1x99999999999999999999"] {
            let refused = name.parse::<LayoutKind>().map_err(|e| e.to_string());
            let told = refused.and_then(|kind| kind.numbers(&radar).map_err(|e| e.to_string())).unwrap_err();
            assert!(told.contains("the radar has elements 0 to 85") || told.contains("there is no layout"), "{told}");
        }
        let told = numbers("nested=18446744073709551615x18446744073709551615").unwrap_err().to_string();
        assert!(told.contains("the radar has elements 0 to 85"), "{told}");
        assert!(numbers("mimo=3x3").unwrap_err().to_string().contains("own grid"));
    }

    #[test]
    fn other_names_are_refused() {
        let names = "|fulll|random|random=x|random=3:y|mimo=3|mimo=0x4|mimo=3x65|none=3|nested=3|coprime=0x3|thinned=0|3-1|1 x|0-99999999";
        for name in names.split('|') {
            let error = name.parse::<LayoutKind>().unwrap_err().to_string();
            assert!(error.contains(&format!("\"{name}\"")) && error.contains("two-ends"), "{error}");
        }
    }
}
