//! A MIMO array: every pair of a transmitter and a receiver is a virtual element, halfway between both.
//!
//! A range is half the path from transmitter to receiver ([`Pair`]). In the far field a pair receives what a single antenna at the midpoint
//! would. At range `R` its path is longer by up to `a^2 / 4R`, where `a` is the distance between both antennas.

mod off_line;

use super::{Convention, Pair, Radar};
use std::fmt;
use std::sync::Arc;

const MIN_ELEMENTS: usize = 2;
const MAX_ELEMENTS: usize = 65536;

/// Largest distance of a pair's midpoint from an evenly spaced line, as a fraction of the spacing.
const MAX_OFF_LINE_PART: f64 = 0.01;

/// Midpoints nearer to each other than this fraction of their mean distance count as one place.
const MAX_SAME_PLACE_PART: f64 = 0.02;

/// Largest number of spacings in the smallest distance of midpoints. Distances of 2 and 3 spacings alone need 2.
const MAX_SPACING_DIVISIONS: usize = 4;

/// The line is moved where its middle lies farther from x = 0 than this fraction of the spacing.
const MAX_OFF_CENTRE_PART: f64 = 1e-6;

/// Transmitters and receivers whose pairs form a uniform line of virtual elements along x, centred on x = 0.
///
/// Elements are numbered from the left. A place without a pair is a gap: its element receives nothing. Of several pairs at one place the
/// one with the lowest transmitter counts. Antennas may have a y of their own, which changes no place along x.
#[derive(Clone, PartialEq)]
pub struct Antennas {
    transmitter_x_metres: Arc<[f64]>,
    receiver_x_metres: Arc<[f64]>,
    transmitter_y_metres: Arc<[f64]>,
    receiver_y_metres: Arc<[f64]>,
    pairs: Arc<[Option<[usize; 2]>]>,
}

impl fmt::Debug for Antennas {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Antennas({:?}, {:?}", self.transmitter_x_metres, self.receiver_x_metres)?;
        if !self.is_on_line() {
            write!(f, ", y {:?}, {:?}", self.transmitter_y_metres, self.receiver_y_metres)?;
        }
        write!(f, ")")
    }
}

struct Midpoints {
    pairs: Vec<[usize; 2]>,
    x_metres: Vec<f64>,
}

impl Midpoints {
    fn of(transmitter_x_metres: &[f64], receiver_x_metres: &[f64]) -> Self {
        let midpoint = |[t, r]: [usize; 2]| (transmitter_x_metres[t] + receiver_x_metres[r]) / 2.0;
        let receivers = receiver_x_metres.len();
        let mut pairs: Vec<[usize; 2]> =
            (0..transmitter_x_metres.len()).flat_map(|t| (0..receivers).map(move |r| [t, r])).collect();
        pairs.sort_by(|a, b| midpoint(*a).total_cmp(&midpoint(*b)));
        Midpoints { x_metres: pairs.iter().map(|pair| midpoint(*pair)).collect(), pairs }
    }

    fn length_metres(&self) -> f64 {
        self.x_metres[self.x_metres.len() - 1] - self.x_metres[0]
    }

    /// The place of each midpoint on the line whose neighbouring places stand `spacing_metres` apart, from 0.
    fn places(&self, spacing_metres: f64) -> impl Iterator<Item = f64> {
        self.x_metres.iter().map(move |x| ((x - self.x_metres[0]) / spacing_metres).round())
    }

    /// The largest spacing of a line on which all midpoints stand.
    fn spacing_metres(&self) -> Result<f64, String> {
        let mean = self.length_metres() / (self.x_metres.len() - 1) as f64;
        let apart =
            self.x_metres.windows(2).map(|two| two[1] - two[0]).filter(|apart| *apart > MAX_SAME_PLACE_PART * mean);
        let smallest = apart.fold(f64::INFINITY, f64::min);
        if !(smallest.is_finite() && mean > 0.0) {
            return Err("all pairs have one midpoint; expected a line of them".to_owned());
        }
        let even = |divisions: usize| self.even(smallest / divisions as f64);
        (2..=MAX_SPACING_DIVISIONS)
            .fold(even(1), |found, divisions| found.or_else(|first| even(divisions).or(Err(first))))
    }

    /// `about_metres`, made to fit the whole line; the error names a pair off the line.
    fn even(&self, about_metres: f64) -> Result<f64, String> {
        let spacing_metres = self.length_metres() / (self.length_metres() / about_metres).round();
        for (i, place) in self.places(spacing_metres).enumerate() {
            let off_metres = (self.x_metres[i] - self.x_metres[0] - place * spacing_metres).abs();
            if off_metres > MAX_OFF_LINE_PART * spacing_metres {
                let [transmitter, receiver] = self.pairs[i];
                let millimetres = |metres: f64| format!("{:.3} mm", metres * 1e3);
                return Err(format!(
                    "the midpoint of transmitter {} and receiver {} stands {} off the even line, whose places are {} apart; expected at most {}",
                    transmitter + 1,
                    receiver + 1,
                    millimetres(off_metres),
                    millimetres(spacing_metres),
                    millimetres(MAX_OFF_LINE_PART * spacing_metres)
                ));
            }
        }
        Ok(spacing_metres)
    }
}

impl Antennas {
    /// Antennas at these places, metres along x. The middle of the line that their pairs make is moved to x = 0.
    /// # Errors
    /// The fault, where their pairs make no line of 2 to 65536 even places.
    pub fn new(transmitter_x_metres: &[f64], receiver_x_metres: &[f64]) -> Result<Self, String> {
        check_places("transmitter_x_metres", transmitter_x_metres)?;
        check_places("receiver_x_metres", receiver_x_metres)?;
        let (transmitters, receivers) = (transmitter_x_metres.len(), receiver_x_metres.len());
        let pairs = transmitters.saturating_mul(receivers);
        if !(MIN_ELEMENTS..=MAX_ELEMENTS).contains(&pairs) {
            return Err(format!(
                "{transmitters} transmitters and {receivers} receivers make {pairs} elements; expected {MIN_ELEMENTS} to {MAX_ELEMENTS}"
            ));
        }
        let midpoints = Midpoints::of(transmitter_x_metres, receiver_x_metres);
        let spacing_metres = midpoints.spacing_metres()?;
        let elements = (midpoints.length_metres() / spacing_metres).round() + 1.0;
        // Distinct transmitters and receivers form at least this many distinct midpoints.
        let fewest = (apart(transmitter_x_metres) + apart(receiver_x_metres) - 1).max(MIN_ELEMENTS);
        if !(fewest as f64..=MAX_ELEMENTS as f64).contains(&elements) {
            return Err(format!(
                "the pairs stand on a line of {} places; expected as many as such antennas make, {MIN_ELEMENTS} to {MAX_ELEMENTS}",
                elements as usize
            ));
        }
        let mut pairs = vec![None; elements as usize];
        for (pair, place) in midpoints.pairs.iter().zip(midpoints.places(spacing_metres)) {
            let at: &mut Option<[usize; 2]> = &mut pairs[place as usize];
            *at = at.map_or(Some(*pair), |first| Some(first.min(*pair)));
        }
        let middle = (midpoints.x_metres[0] + midpoints.x_metres[midpoints.x_metres.len() - 1]) / 2.0;
        let shift = if middle.abs() <= MAX_OFF_CENTRE_PART * spacing_metres { 0.0 } else { middle };
        let moved = |places: &[f64]| places.iter().map(|x| x - shift).collect();
        Ok(Antennas {
            transmitter_x_metres: moved(transmitter_x_metres),
            receiver_x_metres: moved(receiver_x_metres),
            transmitter_y_metres: vec![0.0; transmitters].into(),
            receiver_y_metres: vec![0.0; receivers].into(),
            pairs: pairs.into(),
        })
    }

    /// One line of `transmitters * receivers` elements: receivers two spacings apart, transmitters a whole row of receivers apart.
    /// # Errors
    /// The fault, where that is no array.
    pub fn filled(transmitters: usize, receivers: usize, spacing_metres: f64) -> Result<Self, String> {
        let line = |count: usize, apart: f64| -> Vec<f64> {
            (0..count.min(MAX_ELEMENTS)).map(|i| (i as f64 - (count as f64 - 1.0) / 2.0) * apart).collect()
        };
        let apart = 2.0 * spacing_metres;
        Antennas::new(&line(transmitters, receivers as f64 * apart), &line(receivers, apart))
    }

    /// Places of the transmitters, metres, in the order in which they were given.
    pub fn transmitter_x_metres(&self) -> &[f64] {
        &self.transmitter_x_metres
    }

    /// Places of the receivers, metres, in the order in which they were given.
    pub fn receiver_x_metres(&self) -> &[f64] {
        &self.receiver_x_metres
    }

    /// Numbers of transmitter and receiver of each element, the leftmost element first; nothing at a gap.
    pub fn pairs(&self) -> &[Option<[usize; 2]>] {
        &self.pairs
    }

    /// Number of places without a pair.
    pub fn gaps(&self) -> usize {
        self.pairs.iter().filter(|pair| pair.is_none()).count()
    }

    /// Number of pairs left out because another pair has their place.
    pub fn left_out(&self) -> usize {
        self.transmitter_x_metres.len() * self.receiver_x_metres.len() - (self.pairs.len() - self.gaps())
    }

    /// The antennas of element `n`; `None` at a gap and beyond the last element.
    pub fn pair(&self, n: usize) -> Option<Pair> {
        let [t, r] = (*self.pairs.get(n)?)?;
        Some(Pair {
            transmitter_x_metres: self.transmitter_x_metres[t],
            receiver_x_metres: self.receiver_x_metres[r],
            transmitter_y_metres: self.transmitter_y_metres[t],
            receiver_y_metres: self.receiver_y_metres[r],
        })
    }

    /// Distance between neighbouring elements, metres.
    pub fn spacing_metres(&self) -> f64 {
        let mut made = self.pairs.iter().flatten();
        let midpoint = |[t, r]: [usize; 2]| (self.transmitter_x_metres[t] + self.receiver_x_metres[r]) / 2.0;
        let [first, last] = [made.next(), made.next_back()].map(|pair| pair.map_or(0.0, |pair| midpoint(*pair)));
        (last - first) / (self.pairs.len() - 1) as f64
    }

    /// The leftmost and the rightmost antenna, metres.
    pub fn span_metres(&self) -> [f64; 2] {
        let all = self.transmitter_x_metres.iter().chain(&*self.receiver_x_metres);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
    }

    /// The same antennas with left and right exchanged.
    pub fn mirrored(&self) -> Self {
        Antennas { pairs: self.pairs.iter().rev().copied().collect(), ..self.scaled(-1.0) }
    }

    fn scaled(&self, factor: f64) -> Self {
        let scaled = |places: &[f64]| places.iter().map(|x| x * factor).collect();
        Antennas {
            transmitter_x_metres: scaled(&self.transmitter_x_metres),
            receiver_x_metres: scaled(&self.receiver_x_metres),
            ..self.clone()
        }
    }
}

fn apart(places: &[f64]) -> usize {
    let mut sorted = places.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.dedup();
    sorted.len()
}

/// Largest distance of an antenna from x = 0, metres, either way.
const MAX_PLACE_METRES: f64 = 1e12;

fn check_places(list: &str, places: &[f64]) -> Result<(), String> {
    let found = match places.iter().find(|x| x.is_nan() || x.abs() > MAX_PLACE_METRES) {
        Some(x) => format!("{x:?}"),
        None if places.is_empty() => "no numbers".to_owned(),
        None => return Ok(()),
    };
    Err(format!("{list} has {found}; expected numbers from -1e12 to 1e12 m, at least one"))
}

impl Radar {
    /// The same radar with these antennas. Elements and their spacing are those of the pairs; ends are at most half of the elements.
    pub fn with_antennas(self, antennas: Antennas) -> Self {
        let (elements, element_spacing_metres) = (antennas.pairs.len(), antennas.spacing_metres());
        let radar = Radar { elements, element_spacing_metres, antennas: Some(antennas), ..self };
        Radar { end_elements: radar.end_elements.min(radar.most_end_elements()), ..radar }
    }

    /// The same radar, its elements at that distance from each other; antennas move with them.
    pub fn with_spacing(self, element_spacing_metres: f64) -> Self {
        let factor = element_spacing_metres / self.element_spacing_metres;
        match &self.antennas {
            Some(antennas) if factor != 1.0 => {
                let antennas = antennas.scaled(factor);
                self.with_antennas(antennas)
            }
            _ => Radar { element_spacing_metres, ..self },
        }
    }

    /// Whether element `n` is a gap, which receives nothing.
    pub fn is_gap(&self, n: usize) -> bool {
        self.antennas.as_ref().and_then(|antennas| antennas.pairs.get(n)).is_some_and(Option::is_none)
    }

    /// Number of gaps.
    pub fn gaps(&self) -> usize {
        self.antennas.as_ref().map_or(0, Antennas::gaps)
    }

    /// Whether every element is a monostatic antenna.
    pub fn is_monostatic(&self) -> bool {
        self.antennas.is_none()
    }

    /// The leftmost and the rightmost place of an antenna, metres.
    pub fn antenna_span_metres(&self) -> [f64; 2] {
        match &self.antennas {
            Some(antennas) => antennas.span_metres(),
            None => [self.element_x_metres(0), self.element_x_metres(self.elements.saturating_sub(1))],
        }
    }

    /// The physical radar of `transmitters` and `receivers` whose pairs make one filled line, its other constants those of `self`.
    /// # Errors
    /// The fault, where that is no array.
    pub fn of_pairs(self, transmitters: usize, receivers: usize) -> Result<Self, String> {
        let radar = Radar { antennas: None, ..self }.in_convention(Convention::Physical);
        let antennas = Antennas::filled(transmitters, receivers, radar.element_spacing_metres)?;
        Ok(radar.with_antennas(antennas))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_by_four_make_a_line_of_twelve() {
        let radar = Radar::default().of_pairs(3, 4).unwrap();
        assert_eq!((radar.elements, radar.end_elements, radar.is_monostatic()), (12, 6, false));
        radar.validate().unwrap();
        for n in 0..12 {
            let pair = radar.pair(n);
            let midpoint = (pair.transmitter_x_metres + pair.receiver_x_metres) / 2.0;
            assert!((midpoint - radar.element_x_metres(n)).abs() < 1e-15, "element {n}: {pair:?}");
        }
        assert_eq!(radar.antennas.as_ref().unwrap().pairs()[5], Some([1, 1]));
        assert_eq!((radar.gaps(), radar.antennas.as_ref().unwrap().left_out()), (0, 0));
        assert!((radar.element_spacing_metres / radar.filled_spacing_metres() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_mirrored_array_is_the_one_of_mirrored_places() {
        let (transmitters, receivers) = ([-0.9, 0.0, 0.8], [0.1, 0.3, 0.5, 0.7]);
        let own = Antennas::new(&transmitters, &receivers).unwrap().off_line(&[0.0, -0.01, 0.0], &[0.0; 4]).unwrap();
        let other = Antennas::new(&transmitters.map(|x| -x), &receivers.map(|x| -x)).unwrap();
        let mirrored = own.mirrored();
        assert_eq!((mirrored.pairs(), mirrored.gaps()), (other.pairs(), own.gaps()));
        let off = mirrored.receiver_x_metres().iter().zip(other.receiver_x_metres()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12 && mirrored.transmitter_y_metres() == own.transmitter_y_metres());
        assert_eq!(mirrored.mirrored(), own);
    }

    #[test]
    fn the_middle_of_the_elements_is_moved_to_zero() {
        let moved = Antennas::new(&[1.0, 1.8], &[0.1, 0.3, 0.5, 0.7]).unwrap();
        assert!((moved.transmitter_x_metres()[0] - 0.1).abs() < 1e-12, "{moved:?}");
        let again = Antennas::new(moved.transmitter_x_metres(), moved.receiver_x_metres()).unwrap();
        assert_eq!(again, moved);
    }

    #[test]
    fn antennas_that_make_no_line_are_told() {
        let told = |t: &[f64], r: &[f64]| Antennas::new(t, r).unwrap_err().to_string();
        assert!(told(&[], &[1.0]).contains("transmitter_x_metres has no numbers"));
        assert!(told(&[0.0], &[f64::NAN]).contains("receiver_x_metres has NaN"));
        let huge = "transmitter_x_metres has 1e308; expected numbers from -1e12";
        assert!(told(&[0.0, 1e308], &[0.0, 1e308]).contains(huge));
        assert!(told(&[0.0], &[0.5]).contains("make 1 elements; expected 2 to 65536"));
        let uneven = told(&[0.0, 1.0], &[0.0, 0.2, 0.437]);
        assert!(uneven.contains("off the even line"), "{uneven}");
        assert!(told(&[1.0, 1.0], &[2.0; 3]).contains("one midpoint"));
        let far = told(&[0.0, 1e3], &[0.0, 1e-3, 2e-3, 3e-3]);
        assert!(far.contains("off the even line") || far.contains("2 to 65536"), "{far}");
    }

    #[test]
    fn a_place_that_no_pair_makes_is_a_gap() {
        let antennas = Antennas::new(&[0.0, 1.0], &[0.0, 0.2, 0.4]).unwrap();
        assert_eq!((antennas.pairs().len(), antennas.gaps(), antennas.left_out()), (8, 2, 0));
        assert!((antennas.spacing_metres() - 0.1).abs() < 1e-12);
        let twice = Antennas::new(&[0.0, 0.4], &[0.0, 0.2, 0.4, 0.6]).unwrap();
        assert_eq!((twice.pairs().len(), twice.gaps(), twice.left_out()), (6, 0, 2));
        assert_eq!(twice.pairs()[2], Some([0, 2]), "of pairs at one place the first counts");
        let apart = Antennas::new(&[0.0, 10.0], &[0.0, 4.0, 10.0]).unwrap();
        assert_eq!((apart.spacing_metres(), apart.pairs().len()), (1.0, 11), "distances of two and three spacings");
        assert_eq!(apart.pairs().iter().flatten().count() + apart.left_out(), 6);
        let radar = Radar::default().with_antennas(antennas);
        radar.validate().unwrap();
        assert_eq!([2, 3, 4, 5, 8].map(|n| radar.is_gap(n)), [false, true, true, false, false]);
        assert_eq!(radar.pair(3), Pair::at(radar.element_x_metres(3)));
    }

    #[test]
    fn another_spacing_moves_the_antennas() {
        let radar = Radar::default().of_pairs(3, 4).unwrap();
        let wide = radar.clone().with_spacing(2.0 * radar.element_spacing_metres);
        wide.validate().unwrap();
        assert_eq!(wide.pair(0).transmitter_x_metres, 2.0 * radar.pair(0).transmitter_x_metres);
        let thesis = radar.clone().in_convention(Convention::Thesis);
        thesis.validate().unwrap();
        assert!((thesis.element_spacing_metres / Radar::default().element_spacing_metres - 1.0).abs() < 1e-12);
    }

    #[test]
    fn counts_that_are_not_those_of_the_pairs_are_named() {
        let radar = Radar::default().of_pairs(3, 4).unwrap();
        let told = Radar { elements: 13, ..radar.clone() }.validate().unwrap_err();
        assert_eq!(told.field(), "elements");
        assert!(told.to_string().contains("3 transmitters and 4 receivers make 12"), "{told}");
        let told = Radar { element_spacing_metres: 1.0, ..radar }.validate().unwrap_err();
        assert_eq!(told.field(), "element_spacing_metres");
    }
}
