//! Parts of a campaign that several machines share.

use std::fmt;
use std::str::FromStr;

/// Every `of`-th scene, from scene `part` on: runs on several machines that together do all. Written and read as "0/4".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    part: u32,
    of: u32,
}

impl Default for Shard {
    fn default() -> Self {
        Shard { part: 0, of: 1 }
    }
}

impl Shard {
    /// Whether scene `index` is this shard's.
    pub fn contains(self, index: u32) -> bool {
        index % self.of == self.part
    }

    /// Number of shards of the whole campaign.
    pub fn of(self) -> u32 {
        self.of
    }

    /// All shards of the whole campaign.
    pub fn all(self) -> impl Iterator<Item = Shard> {
        (0..self.of).map(move |part| Shard { part, of: self.of })
    }

    /// Number of this shard's scenes among 0 to `count - 1`.
    pub fn size(self, count: u32) -> u32 {
        count.saturating_sub(self.part).div_ceil(self.of)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.part, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let parts = s.split_once('/').and_then(|(part, of)| Some((part.trim().parse().ok()?, of.trim().parse().ok()?)));
        match parts {
            Some((part, of)) if part < of => Ok(Shard { part, of }),
            _ => Err(format!("\"{s}\" is no part of a whole; expected I/N with I from 0 to N - 1, as in 0/4")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_all_scenes() {
        for (count, of) in [(10, 3), (2, 5), (0, 2), (7, 1)] {
            let shards: Vec<Shard> = (0..of).map(|part| Shard { part, of }).collect();
            assert_eq!(shards.iter().map(|s| s.size(count)).sum::<u32>(), count);
            for s in shards {
                assert_eq!((0..count).filter(|&n| s.contains(n)).count() as u32, s.size(count), "{s}");
            }
        }
        assert_eq!("1/4".parse(), Ok(Shard { part: 1, of: 4 }));
        for wrong in ["4/4", "1", "a/b", "0/0", "-1/2"] {
            assert!(wrong.parse::<Shard>().is_err_and(|e| e.contains(wrong)));
        }
    }
}
