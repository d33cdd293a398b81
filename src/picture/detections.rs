//! The output above its threshold: hits, misses and false alarms differ in brightness as well as in hue.

use super::colour::Rgb;

/// What a cell of a thresholded output is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detection {
    /// Neither map has it.
    Nothing,
    /// The target has it, the output doesn't.
    Miss,
    /// The output has it, the target doesn't.
    FalseAlarm,
    /// Both have it.
    Hit,
}

impl Detection {
    /// Those that are seen, in the order of a legend.
    pub const SEEN: [Detection; 3] = [Detection::Hit, Detection::FalseAlarm, Detection::Miss];

    /// Of a cell that the `target` has or not, and the `output`.
    pub fn of(target: bool, output: bool) -> Detection {
        match (target, output) {
            (true, true) => Detection::Hit,
            (false, true) => Detection::FalseAlarm,
            (true, false) => Detection::Miss,
            (false, false) => Detection::Nothing,
        }
    }

    /// Its name in legends.
    pub fn name(self) -> &'static str {
        match self {
            Detection::Nothing => "nothing",
            Detection::Miss => "miss",
            Detection::FalseAlarm => "false alarm",
            Detection::Hit => "hit",
        }
    }

    /// Its fill on a dark ground or on a light one. From nothing over misses and false alarms to hits each is at least twice as far from the
    /// ground as the one before, in WCAG contrast, also for whoever sees two primary colours only.
    pub fn fill(self, dark: bool) -> Rgb {
        match (self, dark) {
            (Detection::Nothing, true) => [18, 22, 30],
            (Detection::Miss, true) => [40, 92, 176],
            (Detection::FalseAlarm, true) => [232, 152, 40],
            (Detection::Hit, true) => [255, 255, 252],
            (Detection::Nothing, false) => [252, 253, 255],
            (Detection::Miss, false) => [130, 178, 234],
            (Detection::FalseAlarm, false) => [150, 72, 0],
            (Detection::Hit, false) => [12, 16, 22],
        }
    }

    /// The line around its cells: apart from its fill and from the ground.
    pub fn outline(self, dark: bool) -> Rgb {
        match (self, dark) {
            (Detection::Nothing, _) => self.fill(dark),
            (Detection::Miss, true) => [128, 180, 246],
            (Detection::FalseAlarm, true) => [138, 80, 12],
            (Detection::Hit, true) => [132, 140, 154],
            (Detection::Miss, false) => [40, 96, 168],
            (Detection::FalseAlarm, false) => [226, 160, 96],
            (Detection::Hit, false) => [128, 136, 150],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What common colour deficiencies make of linear red, green and blue, at full severity (Machado, Oliveira and Fernandes, 2009, table 1).
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

    /// Relative luminance of a colour as somebody sees it, 0 to 1.
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
        let all = [Detection::Nothing, Detection::Miss, Detection::FalseAlarm, Detection::Hit];
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
    fn every_outline_is_seen_beside_its_fill_under_common_colour_deficiencies() {
        for (name, vision) in &VISIONS {
            for (kind, dark) in Detection::SEEN.into_iter().flat_map(|kind| [(kind, true), (kind, false)]) {
                for beside in [kind.fill(dark), Detection::Nothing.fill(dark)] {
                    let contrast = contrast(kind.outline(dark), beside, vision);
                    assert!(contrast >= 1.6, "{kind:?} beside {beside:?}, {name}, dark {dark}: {contrast}");
                }
            }
        }
    }
}
