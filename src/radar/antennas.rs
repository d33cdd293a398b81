//! Transmitters that stand apart from receivers: every pair of them is an element of the array.
//!
//! The element that a pair makes stands halfway between both (the convention is [`Pair`]'s: a range is half the way there and back). Far
//! away a pair hears what one antenna there would; near by its way is longer by up to `a^2 / 4R`, where `a` is their distance.

use super::{Convention, Pair, Radar};
use std::fmt;
use std::sync::Arc;

/// Fewest and most elements, as for every radar.
const FEWEST: usize = 6;
const MOST: usize = 65536;

/// How far the elements that pairs make may stand off an even line, as a part of the spacing.
const MOST_OFF: f64 = 0.01;

/// How far the middle of the line may lie off x = 0 without being moved there, as a part of the spacing.
const CENTRED: f64 = 1e-6;

/// Transmitters and receivers on the x axis whose pairs make a line of elements without gaps.
///
/// x = 0 is the middle of that line. Pairs are numbered from the leftmost element to the rightmost.
#[derive(Clone, PartialEq)]
pub struct Antennas {
    transmitter_x_metres: Arc<[f64]>,
    receiver_x_metres: Arc<[f64]>,
    /// Numbers of transmitter and receiver of each pair.
    pairs: Arc<[[usize; 2]]>,
}

impl fmt::Debug for Antennas {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Antennas({:?}, {:?})", self.transmitter_x_metres, self.receiver_x_metres)
    }
}

/// Why antennas make no array.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AntennasError {
    /// A list is empty or holds something that is no place.
    #[error("{list} has {found}; expected finite numbers, at least one")]
    Places {
        /// Which list.
        list: &'static str,
        /// What was found.
        found: String,
    },
    /// Too few or too many pairs.
    #[error("{transmitters} transmitters and {receivers} receivers make {} elements; expected {FEWEST} to {MOST}", transmitters.saturating_mul(*receivers))]
    Count {
        /// Transmitters.
        transmitters: usize,
        /// Receivers.
        receivers: usize,
    },
    /// The pairs make no even line.
    #[error(
        "the midpoints of pairs {} and {} stand {:.3} mm apart, those of all pairs {:.3} mm on average; expected one line of midpoints \
         without gaps: this program knows no other arrays of pairs",
        after + 1, after + 2, apart_metres * 1e3, spacing_metres * 1e3
    )]
    Gap {
        /// Number of the pair on the left.
        after: usize,
        /// Distance to the next.
        apart_metres: f64,
        /// Mean distance.
        spacing_metres: f64,
    },
}

impl Antennas {
    /// Antennas at these places, metres along x. The middle of the line that their pairs make is moved to x = 0.
    ///
    /// # Errors
    /// [`AntennasError`] where their pairs make no line of 6 to 65536 elements without gaps.
    pub fn new(transmitter_x_metres: &[f64], receiver_x_metres: &[f64]) -> Result<Self, AntennasError> {
        for (list, places) in [("transmitter_x_metres", transmitter_x_metres), ("receiver_x_metres", receiver_x_metres)]
        {
            let found = match places.iter().find(|x| !x.is_finite()) {
                Some(x) => x.to_string(),
                None if places.is_empty() => "no numbers".to_owned(),
                None => continue,
            };
            return Err(AntennasError::Places { list, found });
        }
        let (transmitters, receivers) = (transmitter_x_metres.len(), receiver_x_metres.len());
        if !(FEWEST..=MOST).contains(&transmitters.saturating_mul(receivers)) {
            return Err(AntennasError::Count { transmitters, receivers });
        }
        let midpoint = |[t, r]: [usize; 2]| (transmitter_x_metres[t] + receiver_x_metres[r]) / 2.0;
        let mut pairs: Vec<[usize; 2]> = (0..transmitters).flat_map(|t| (0..receivers).map(move |r| [t, r])).collect();
        pairs.sort_by(|a, b| midpoint(*a).total_cmp(&midpoint(*b)));
        let (first, last) = (midpoint(pairs[0]), midpoint(pairs[pairs.len() - 1]));
        let spacing_metres = (last - first) / (pairs.len() - 1) as f64;
        for (after, two) in pairs.windows(2).enumerate() {
            let apart_metres = midpoint(two[1]) - midpoint(two[0]);
            let is_even = (apart_metres - spacing_metres).abs() <= MOST_OFF * spacing_metres;
            if !(is_even && spacing_metres > 0.0) {
                return Err(AntennasError::Gap { after, apart_metres, spacing_metres });
            }
        }
        let middle = (first + last) / 2.0;
        let shift = if middle.abs() <= CENTRED * spacing_metres { 0.0 } else { middle };
        let moved = |places: &[f64]| places.iter().map(|x| x - shift).collect();
        Ok(Antennas {
            transmitter_x_metres: moved(transmitter_x_metres),
            receiver_x_metres: moved(receiver_x_metres),
            pairs: pairs.into(),
        })
    }

    /// Receivers two spacings apart and transmitters a whole row of receivers apart, so that the pairs make one line of
    /// `transmitters * receivers` elements.
    ///
    /// # Errors
    /// [`AntennasError`] where that is no array.
    pub fn filled(transmitters: usize, receivers: usize, spacing_metres: f64) -> Result<Self, AntennasError> {
        let line = |count: usize, apart: f64| -> Vec<f64> {
            (0..count.min(MOST)).map(|i| (i as f64 - (count as f64 - 1.0) / 2.0) * apart).collect()
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

    /// Numbers of transmitter and receiver of each element, the leftmost element first.
    pub fn pairs(&self) -> &[[usize; 2]] {
        &self.pairs
    }

    /// The antennas of element `n`; `None` beyond the last.
    pub fn pair(&self, n: usize) -> Option<Pair> {
        let [t, r] = *self.pairs.get(n)?;
        Some(Pair { transmitter_x_metres: self.transmitter_x_metres[t], receiver_x_metres: self.receiver_x_metres[r] })
    }

    /// Distance between neighbouring elements, metres.
    pub fn spacing_metres(&self) -> f64 {
        let midpoint = |[t, r]: [usize; 2]| (self.transmitter_x_metres[t] + self.receiver_x_metres[r]) / 2.0;
        let last = self.pairs.len() - 1;
        (midpoint(self.pairs[last]) - midpoint(self.pairs[0])) / last as f64
    }

    /// The leftmost and the rightmost antenna, metres.
    pub fn span_metres(&self) -> [f64; 2] {
        let all = self.transmitter_x_metres.iter().chain(&*self.receiver_x_metres);
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(*x), high.max(*x)])
    }

    /// The same antennas, all distances `factor` times as large.
    fn scaled(&self, factor: f64) -> Self {
        let scaled = |places: &[f64]| places.iter().map(|x| x * factor).collect();
        Antennas {
            transmitter_x_metres: scaled(&self.transmitter_x_metres),
            receiver_x_metres: scaled(&self.receiver_x_metres),
            pairs: self.pairs.clone(),
        }
    }
}

impl Radar {
    /// The same radar with these antennas. Elements and their spacing are those of the pairs; ends are at most half of the elements.
    pub fn with_antennas(self, antennas: Antennas) -> Self {
        let elements = antennas.pairs.len();
        let (element_spacing_metres, end_elements) = (antennas.spacing_metres(), self.end_elements.min(elements / 2));
        Radar { elements, end_elements, element_spacing_metres, antennas: Some(antennas), ..self }
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

    /// Whether every element sends and hears by itself.
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
    ///
    /// # Errors
    /// [`AntennasError`] where that is no array.
    pub fn of_pairs(self, transmitters: usize, receivers: usize) -> Result<Self, AntennasError> {
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
        assert_eq!(radar.antennas.as_ref().unwrap().pairs()[5], [1, 1]);
        assert!((radar.element_spacing_metres / radar.filled_spacing_metres() - 1.0).abs() < 1e-12);
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
        assert!(told(&[0.0, 1.0], &[0.0, 0.5]).contains("make 4 elements; expected 6 to 65536"));
        let gap = told(&[0.0, 1.0], &[0.0, 0.2, 0.4]);
        assert!(gap.contains("pairs 1 and 2 stand 100.000 mm apart") && gap.contains("without gaps"), "{gap}");
        assert!(told(&[0.0, 0.0], &[0.0, 0.2, 0.4]).contains("0.000 mm apart"));
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
