//! The output above its threshold, told apart by whether the target has that cell: by brightness and hatching as well as by hue.

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

    /// Its colour in pixel (x, y) of a picture on a dark ground or a light one: hits are plain, misses hatched closely, false alarms
    /// widely.
    pub fn colour(self, x: usize, y: usize, dark: bool) -> Rgb {
        let [stripe, gap] = self.inks(dark);
        let is_gap = match self {
            Detection::Miss => (x + y) % 4 >= 2,
            Detection::FalseAlarm => (x + 9 * y) % 10 >= 7,
            Detection::Nothing | Detection::Hit => false,
        };
        if is_gap { gap } else { stripe }
    }

    /// Colours of its stripes and of what is between them: the farther from the ground, the more of both maps has the cell.
    fn inks(self, dark: bool) -> [Rgb; 2] {
        match (self, dark) {
            (Detection::Nothing, true) => [[22, 26, 34]; 2],
            (Detection::Hit, true) => [[245, 245, 240]; 2],
            (Detection::Miss, true) => [[86, 164, 240], [30, 70, 120]],
            (Detection::FalseAlarm, true) => [[240, 130, 50], [110, 44, 10]],
            (Detection::Nothing, false) => [[252, 253, 255]; 2],
            (Detection::Hit, false) => [[24, 28, 36]; 2],
            (Detection::Miss, false) => [[52, 128, 210], [176, 212, 246]],
            (Detection::FalseAlarm, false) => [[186, 92, 12], [246, 206, 160]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance, 0 to 1: what is left of a colour without any hue.
    fn luminance([r, g, b]: Rgb) -> f64 {
        (0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)) / 255.0
    }

    #[test]
    fn kinds_differ_without_their_hue() {
        for dark in [true, false] {
            // How far from the ground, 0 to 1.
            let away = |colour| if dark { luminance(colour) } else { 1.0 - luminance(colour) };
            let pixels =
                |d: Detection| -> Vec<f64> { (0..400).map(|i| away(d.colour(i % 20, i / 20, dark))).collect() };
            let gaps = |d: Detection| {
                let all = pixels(d);
                let most = all.iter().copied().fold(0.0, f64::max);
                all.iter().filter(|v| **v < 0.7 * most).count() as f64 / all.len() as f64
            };
            assert_eq!(gaps(Detection::Hit), 0.0, "plain");
            assert!((gaps(Detection::Miss) - 0.5).abs() < 0.05 && (gaps(Detection::FalseAlarm) - 0.3).abs() < 0.05);
            let mean = |d: Detection| pixels(d).iter().sum::<f64>() / 400.0;
            assert!(mean(Detection::Hit) > 1.5 * mean(Detection::FalseAlarm), "dark: {dark}");
            assert!(mean(Detection::Miss) > 2.0 * mean(Detection::Nothing), "dark: {dark}");
        }
    }
}
