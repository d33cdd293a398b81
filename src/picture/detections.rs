//! The output above its threshold: hits, misses and false alarms differ in brightness as well as in hue.

use super::colour::Rgb;
use crate::evaluate::verdict::Ghost;
use ndarray::{Array2, ArrayView2, Zip};

/// The verdict on a cell of a thresholded output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum CellVerdict {
    /// Below both thresholds.
    Nothing,
    /// Above the output's threshold alone, around an echo of the target.
    Rim,
    /// Above the target's threshold alone.
    Miss,
    /// Above the output's threshold, without an echo in the target.
    FalseAlarm,
    /// Above both thresholds.
    Hit,
}

impl CellVerdict {
    /// The visible verdicts, in the order of a legend.
    pub const VISIBLE_VERDICTS: [CellVerdict; 4] =
        [CellVerdict::Hit, CellVerdict::Rim, CellVerdict::FalseAlarm, CellVerdict::Miss];

    /// The verdict on a cell, by whether the `target` and the `output` exceed their thresholds there; a rim counts as a false alarm.
    pub fn of(target: bool, output: bool) -> CellVerdict {
        match (target, output) {
            (true, true) => CellVerdict::Hit,
            (false, true) => CellVerdict::FalseAlarm,
            (true, false) => CellVerdict::Miss,
            (false, false) => CellVerdict::Nothing,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            CellVerdict::Nothing => "nothing",
            CellVerdict::Rim => "rim",
            CellVerdict::Miss => "miss",
            CellVerdict::FalseAlarm => "false alarm",
            CellVerdict::Hit => "hit",
        }
    }

    /// Its fill on a dark ground or on a light one. From nothing over misses and false alarms to hits each is at least twice as far from the
    /// ground as the one before, in WCAG contrast, also for dichromats.
    pub fn fill(self, dark: bool) -> Rgb {
        self.colours(dark)[0]
    }

    /// The line around its cells: apart from its fill and from the ground.
    pub fn outline(self, dark: bool) -> Rgb {
        self.colours(dark)[1]
    }

    fn colours(self, dark: bool) -> [Rgb; 2] {
        match (self, dark) {
            (CellVerdict::Nothing, true) => [[18, 22, 30]; 2],
            (CellVerdict::Nothing, false) => [[252, 253, 255]; 2],
            // The fill of a rim is the line around hits, so that both are one quiet band.
            (CellVerdict::Rim, _) => [CellVerdict::Hit.outline(dark); 2],
            (CellVerdict::Miss, true) => [[40, 92, 176], [128, 180, 246]],
            (CellVerdict::Miss, false) => [[130, 178, 234], [40, 96, 168]],
            (CellVerdict::FalseAlarm, true) => [[232, 152, 40], [138, 80, 12]],
            (CellVerdict::FalseAlarm, false) => [[150, 72, 0], [226, 160, 96]],
            (CellVerdict::Hit, true) => [[255, 255, 252], [132, 140, 154]],
            (CellVerdict::Hit, false) => [[12, 16, 22], [128, 136, 150]],
        }
    }
}

/// The verdict on each cell of an output above `etas[0]` beside a target above `etas[1]`, both `[range bins, columns]`. The cells of `ghosts` are
/// false alarms; other cells that the target has not are the rim of an echo.
pub fn told_apart(
    output: ArrayView2<'_, f32>,
    target: ArrayView2<'_, f32>,
    etas: [f32; 2],
    ghosts: &[Ghost],
) -> Array2<CellVerdict> {
    let mut verdicts = Zip::from(output).and(target).map_collect(|&output, &target| {
        match CellVerdict::of(target > etas[1], output > etas[0]) {
            CellVerdict::FalseAlarm => CellVerdict::Rim,
            other => other,
        }
    });
    for cell in ghosts.iter().flat_map(|ghost| &ghost.cells) {
        if let Some(verdict) = verdicts.get_mut(*cell).filter(|verdict| **verdict == CellVerdict::Rim) {
            *verdict = CellVerdict::FalseAlarm;
        }
    }
    verdicts
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    /// Matrices of common colour deficiencies for linear red, green and blue, at full severity (Machado, Oliveira and Fernandes, 2009, table 1).
    const VISIONS: [(&str, [[f64; 3]; 3]); 4] = [
        ("all three cones", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        (
            "protanopia",
            [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
        ),
        (
            "deuteranopia",
            [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
        ),
        (
            "tritanopia",
            [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
        ),
    ];

    /// Relative luminance of a colour as it is perceived, 0 to 1.
    fn luminance(colour: Rgb, vision: &[[f64; 3]; 3]) -> f64 {
        let linear = colour.map(|c| match f64::from(c) / 255.0 {
            c if c <= 0.040_45 => c / 12.92,
            c => ((c + 0.055) / 1.055).powf(2.4),
        });
        let seen = vision.map(|row| row.iter().zip(linear).map(|(m, l)| m * l).sum::<f64>().clamp(0.0, 1.0));
        0.2126 * seen[0] + 0.7152 * seen[1] + 0.0722 * seen[2]
    }

    /// Contrast as the WCAG defines it, 1 to 21.
    fn contrast(a: Rgb, b: Rgb, vision: &[[f64; 3]; 3]) -> f64 {
        let [a, b] = [a, b].map(|c| luminance(c, vision));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_two_fills_differ_under_common_colour_deficiencies() {
        let all = [CellVerdict::Nothing, CellVerdict::Miss, CellVerdict::FalseAlarm, CellVerdict::Hit];
        for (name, vision) in &VISIONS {
            for dark in [true, false] {
                for (i, a) in all.iter().enumerate() {
                    for b in &all[i + 1..] {
                        let contrast = contrast(a.fill(dark), b.fill(dark), vision);
                        assert!(contrast >= 2.0, "{a:?} and {b:?}, {name}, dark {dark}: {contrast}");
                    }
                }
            }
        }
    }

    #[test]
    fn outlines_contrast_under_common_colour_deficiencies() {
        for (name, vision) in &VISIONS {
            let outlined = CellVerdict::VISIBLE_VERDICTS.into_iter().filter(|kind| *kind != CellVerdict::Rim);
            for (kind, dark) in outlined.flat_map(|kind| [(kind, true), (kind, false)]) {
                for beside in [kind.fill(dark), CellVerdict::Nothing.fill(dark)] {
                    let contrast = contrast(kind.outline(dark), beside, vision);
                    assert!(contrast >= 1.6, "{kind:?} beside {beside:?}, {name}, dark {dark}: {contrast}");
                }
            }
        }
    }

    #[test]
    fn cells_of_ghosts_alone_are_false_alarms() {
        let target = array![[0.95f32, 0.2, 0.95], [0.2, 0.2, 0.95]];
        let output = array![[1.0f32, 1.0, 0.0], [0.0, 1.0, 1.0]];
        let ghosts = [Ghost { cells: vec![[1, 1], [1, 2], [7, 7]] }];
        let verdicts = told_apart(output.view(), target.view(), [0.8, 0.9], &ghosts);
        use CellVerdict::{FalseAlarm, Hit, Miss, Nothing, Rim};
        assert_eq!(verdicts, array![[Hit, Rim, Miss], [Nothing, FalseAlarm, Hit]]);
    }
}
