//! Colour maps as tables of 256 colours, for pictures and the window.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

/// Red, green and blue, 0 to 255.
pub type Rgb = [u8; 3];

/// How a number in [0, 1] becomes a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ColourMap {
    /// Black to white, as the thesis prints its maps.
    Grey,
    /// Violet over green to yellow; equal steps look equal, also without colour vision (Smith and van der Walt, 2015).
    Viridis,
    /// Black over red to pale yellow; dark where there is nothing (Smith and van der Walt, 2015).
    #[default]
    Inferno,
    /// Blue below 1/2, near white at 1/2, red above: for differences.
    Diverging,
}

impl ColourMap {
    /// Every colour map, in the order they are offered.
    pub const ALL: [ColourMap; 4] = [ColourMap::Inferno, ColourMap::Viridis, ColourMap::Grey, ColourMap::Diverging];

    /// Its name on the command line and in menus.
    pub fn name(self) -> &'static str {
        match self {
            ColourMap::Grey => "grey",
            ColourMap::Viridis => "viridis",
            ColourMap::Inferno => "inferno",
            ColourMap::Diverging => "diverging",
        }
    }

    /// The 256 colours from 0 to 1.
    pub fn table(self) -> &'static [Rgb; 256] {
        static TABLES: [OnceLock<[Rgb; 256]>; 4] = [const { OnceLock::new() }; 4];
        TABLES[self as usize].get_or_init(|| interpolate(self.anchors()))
    }

    /// The colour of `value`; values outside [0, 1] take the nearest end, NaN the lower.
    #[inline]
    pub fn colour(self, value: f32) -> Rgb {
        // A float cast saturates and takes NaN to 0.
        self.table()[(value * 255.0 + 0.5) as u8 as usize]
    }

    /// Equally spaced colours that the table runs through.
    fn anchors(self) -> &'static [Rgb] {
        match self {
            ColourMap::Grey => &[[0, 0, 0], [255, 255, 255]],
            ColourMap::Viridis => &[
                [68, 1, 84],
                [72, 24, 106],
                [71, 45, 123],
                [66, 64, 134],
                [59, 82, 139],
                [51, 99, 141],
                [44, 114, 142],
                [38, 130, 142],
                [33, 145, 140],
                [31, 159, 136],
                [39, 173, 129],
                [61, 188, 116],
                [92, 200, 99],
                [129, 211, 77],
                [170, 220, 50],
                [213, 226, 26],
                [253, 231, 37],
            ],
            ColourMap::Inferno => &[
                [0, 0, 4],
                [11, 7, 36],
                [33, 12, 74],
                [61, 9, 101],
                [87, 16, 110],
                [113, 25, 110],
                [138, 34, 106],
                [163, 44, 97],
                [188, 55, 84],
                [208, 69, 69],
                [227, 89, 51],
                [241, 113, 31],
                [249, 140, 10],
                [252, 170, 15],
                [249, 201, 50],
                [242, 232, 101],
                [252, 255, 164],
            ],
            ColourMap::Diverging => &[
                [16, 52, 110],
                [58, 122, 189],
                [154, 196, 226],
                [244, 243, 240],
                [240, 178, 140],
                [206, 88, 66],
                [118, 16, 36],
            ],
        }
    }
}

fn interpolate(anchors: &[Rgb]) -> [Rgb; 256] {
    let last = anchors.len() - 1;
    std::array::from_fn(|i| {
        let at = i as f32 / 255.0 * last as f32;
        let low = (at as usize).min(last - 1);
        let part = at - low as f32;
        std::array::from_fn(|c| {
            let (a, b) = (f32::from(anchors[low][c]), f32::from(anchors[low + 1][c]));
            (a + (b - a) * part).round() as u8
        })
    })
}

impl fmt::Display for ColourMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A colour map's name that is not known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("unknown colour map \"{0}\"; expected inferno, viridis, grey or diverging")]
pub struct UnknownColourMap(String);

impl FromStr for ColourMap {
    type Err = UnknownColourMap;

    fn from_str(s: &str) -> Result<Self, UnknownColourMap> {
        Self::ALL.into_iter().find(|c| c.name() == s).ok_or_else(|| UnknownColourMap(s.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn luminance(c: Rgb) -> f32 {
        0.2126 * f32::from(c[0]) + 0.7152 * f32::from(c[1]) + 0.0722 * f32::from(c[2])
    }

    #[test]
    fn strange_values_have_a_colour() {
        for map in ColourMap::ALL {
            assert_eq!(map.name().parse(), Ok(map));
            let (first, last) = (map.table()[0], map.table()[255]);
            assert_eq!((map.colour(0.0), map.colour(1.0)), (first, last));
            assert_eq!((map.colour(-3.0), map.colour(7.0), map.colour(f32::NAN)), (first, last, first));
        }
    }

    #[test]
    fn sequential_maps_only_get_brighter() {
        for map in [ColourMap::Grey, ColourMap::Viridis, ColourMap::Inferno] {
            for pair in map.table().windows(2) {
                let rounding = 1.0;
                assert!(luminance(pair[1]) >= luminance(pair[0]) - rounding, "{map}: {pair:?}");
            }
        }
    }
}
