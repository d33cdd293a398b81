//! Colour maps as tables of 256 colours, for pictures and the window.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

/// Red, green and blue, 0 to 255.
pub type Rgb = [u8; 3];

/// A map from numbers in [0, 1] to colours.
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

    /// Equally spaced colours that the table runs through, 0xRRGGBB.
    fn anchors(self) -> &'static [u32] {
        match self {
            ColourMap::Grey => &[0x000000, 0xffffff],
            ColourMap::Viridis => &[
                0x440154, 0x48186a, 0x472d7b, 0x424086, 0x3b528b, 0x33638d, 0x2c728e, 0x26828e, 0x21918c, 0x1f9f88,
                0x27ad81, 0x3dbc74, 0x5cc863, 0x81d34d, 0xaadc32, 0xd5e21a, 0xfde725,
            ],
            ColourMap::Inferno => &[
                0x000004, 0x0b0724, 0x210c4a, 0x3d0965, 0x57106e, 0x71196e, 0x8a226a, 0xa32c61, 0xbc3754, 0xd04545,
                0xe35933, 0xf1711f, 0xf98c0a, 0xfcaa0f, 0xf9c932, 0xf2e865, 0xfcffa4,
            ],
            ColourMap::Diverging => &[0x10346e, 0x3a7abd, 0x9ac4e2, 0xf4f3f0, 0xf0b28c, 0xce5842, 0x761024],
        }
    }
}

fn interpolate(anchors: &[u32]) -> [Rgb; 256] {
    let anchors: Vec<[u8; 4]> = anchors.iter().map(|colour| (colour << 8).to_be_bytes()).collect();
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

impl FromStr for ColourMap {
    type Err = String;

    fn from_str(s: &str) -> Result<Self, String> {
        let unknown = || format!("unknown colour map \"{s}\"; expected inferno, viridis, grey or diverging");
        Self::ALL.into_iter().find(|c| c.name() == s).ok_or_else(unknown)
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
