//! Kinds of random scenes with a share each, for training.

use super::Kind;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt;
use std::str::FromStr;

/// Kinds of scenes with their probabilities.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixture {
    shares: Vec<(Kind, f64)>,
}

impl Mixture {
    pub fn of(kind: Kind) -> Mixture {
        Mixture { shares: vec![(kind, 1.0)] }
    }

    /// The kinds and their shares, which need not add up to 1.
    pub fn shares(&self) -> &[(Kind, f64)] {
        &self.shares
    }

    /// The kind of scene `index`: a function of the mixture, `seed` and `index` alone.
    pub fn kind(&self, seed: u64, index: u32) -> Kind {
        let mut key = [0u8; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        // No purpose has this number, so the draw of a kind is independent of its scenes.
        key[8] = 4;
        let mut rng = ChaCha8Rng::from_seed(key);
        rng.set_stream(index.into());
        let total: f64 = self.shares.iter().map(|(_, share)| share).sum();
        let mut left = rng.random::<f64>() * total;
        for (kind, share) in &self.shares {
            left -= share;
            if left < 0.0 {
                return *kind;
            }
        }
        self.shares[self.shares.len() - 1].0
    }
}

impl FromStr for Mixture {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = |fault: String| {
            let expected =
                "kinds separated by commas, each with a share where they differ, as in 3 or 1=4,2=12,walls=8";
            format!("mixture \"{text}\": {fault}; expected {expected}")
        };
        let mut shares: Vec<(Kind, f64)> = Vec::new();
        for part in text.split(',') {
            let (kind, share) = part.split_once('=').unwrap_or((part, "1"));
            let kind = Kind::for_training(kind).map_err(wrong)?;
            let number = share.trim().parse::<f64>().ok().filter(|share| share.is_finite() && *share > 0.0);
            let share =
                number.ok_or_else(|| wrong(format!("the share of {kind} is \"{share}\", not a number above 0")))?;
            if shares.iter().any(|(there, _)| *there == kind) {
                return Err(wrong(format!("{kind} is given twice")));
            }
            shares.push((kind, share));
        }
        Ok(Mixture { shares })
    }
}

impl fmt::Display for Mixture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts: Vec<String> = self.shares.iter().map(|(kind, share)| format!("{kind}={share}")).collect();
        f.write_str(&parts.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_come_as_often_as_their_shares_say() {
        let mixture: Mixture = "1=1,walls=3".parse().unwrap();
        let walls = (0..4000).filter(|index| mixture.kind(5, *index) == Kind::Walls).count();
        assert!((2900..3100).contains(&walls), "{walls} of 4000");
        let expected = (0..64).map(|i| mixture.kind(6, i)).collect::<Vec<_>>();
        assert_ne!((0..64).map(|i| mixture.kind(5, i)).collect::<Vec<_>>(), expected, "another seed draws other kinds");
    }

    #[test]
    fn a_mixture_is_read_as_it_was_written() {
        for text in ["3=1", "1=4,2=12,clusters=0.5", "world=1"] {
            assert_eq!(text.parse::<Mixture>().unwrap().to_string(), text);
        }
        assert_eq!("3".parse::<Mixture>().unwrap(), "3=1".parse().unwrap());
    }

    #[test]
    fn a_mixture_that_makes_no_sense_is_told() {
        for (text, part) in [("", "\"\""), ("1=0", "above 0"), ("1=nan", "above 0"), ("1,1", "given twice"), ("7", "7")]
        {
            let told = text.parse::<Mixture>().unwrap_err().to_string();
            assert!(told.contains(part) && told.contains("as in 3 or"), "{told}");
        }
    }
}
