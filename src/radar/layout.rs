//! Element positions of a line array: the whole array, its two ends, random places, or the virtual elements of a MIMO radar.

use super::{End, Pair, Radar};
use rand::SeedableRng;
use rand::seq::index;
use rand_chacha::ChaCha8Rng;

/// Positions of an array's elements on the x axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// Position of each element, metres; in rising order but for [`Layout::of_numbers`].
    pub x_metres: Vec<f64>,
    pairs: Option<Vec<Pair>>,
}

/// Checks a layout that is a list of numbers of elements.
/// # Errors
/// The element that is not there or is given twice, and the values allowed.
pub fn check_layout(layout: &[usize], elements: usize) -> Result<(), String> {
    if layout.is_empty() {
        return Err("the layout has no element; expected at least one".to_owned());
    }
    let mut seen = vec![false; elements];
    for &element in layout {
        match seen.get_mut(element) {
            None => {
                let last = elements.saturating_sub(1);
                return Err(format!("the layout has element {element}; the radar has elements 0 to {last}"));
            }
            Some(true) => return Err(format!("the layout has element {element} twice; expected each once")),
            Some(seen) => *seen = true,
        }
    }
    Ok(())
}

impl Layout {
    /// The elements of `radar` that have these numbers, in this order.
    pub fn of_numbers(radar: &Radar, numbers: &[usize]) -> Self {
        let pairs = (!radar.is_monostatic()).then(|| numbers.iter().map(|n| radar.pair(*n)).collect());
        Layout { x_metres: numbers.iter().map(|n| radar.element_x_metres(*n)).collect(), pairs }
    }

    /// Every element of `radar` (thesis figure 1-1).
    pub fn uniform(radar: &Radar) -> Self {
        Layout::of_elements(radar, 0..radar.elements)
    }

    /// One end of `radar` alone.
    pub fn one_end(radar: &Radar, end: End) -> Self {
        Layout::of_elements(radar, radar.end_range(end))
    }

    /// Both ends of `radar`: the elements of the sparse sensor.
    pub fn two_ends(radar: &Radar) -> Self {
        Layout::of_elements(
            radar,
            (0..radar.elements).filter(|n| *n < radar.end_elements || radar.end_range(End::Last).contains(n)),
        )
    }

    /// `count` elements at random places of the half-wavelength grid with the outermost two among them. The same seed gives the same places.
    ///
    /// Places on the grid keep the array's unambiguous field of view, as in multi-coset sampling (thesis figures 1-2 and 1-3).
    /// # Errors
    /// The fault, for no element or for more than `radar` has.
    pub fn random(radar: &Radar, count: usize, seed: u64) -> Result<Self, String> {
        let places = radar.elements;
        if count == 0 || count > places {
            return Err(format!(
                "a random layout of {count} elements was asked for; the aperture has room for 1 to {places}"
            ));
        }
        let last = places - 1;
        let inner = index::sample(&mut ChaCha8Rng::seed_from_u64(seed), last - 1, count.saturating_sub(2));
        let mut chosen: Vec<usize> =
            [0, last].into_iter().take(count).chain(inner.into_iter().map(|i| i + 1)).collect();
        chosen.sort_unstable();
        Ok(Layout::of_elements(radar, chosen))
    }

    pub(super) fn of_elements(radar: &Radar, elements: impl IntoIterator<Item = usize>) -> Self {
        Layout::of_numbers(radar, &elements.into_iter().filter(|n| !radar.is_gap(*n)).collect::<Vec<_>>())
    }

    /// The virtual elements of a MIMO radar (thesis figure 1-4), in rising order: receivers at the radar's spacing and transmitters a
    /// whole receiver array apart make one gapless line centred on x = 0; 3 transmitters and 4 receivers give the 12 elements of one end.
    ///
    /// A far reflector delays the way out by `x_t cos(theta)` and the way back by `x_r cos(theta)`: the pair measures what one
    /// element at `x_t + x_r` would.
    pub fn mimo(radar: &Radar, transmitters: usize, receivers: usize) -> Self {
        let line =
            |count: usize, spacing: f64| (0..count).map(move |i| (i as f64 - (count as f64 - 1.0) / 2.0) * spacing);
        let spacing = radar.element_spacing_metres;
        let sums =
            line(transmitters, receivers as f64 * spacing).flat_map(|t| line(receivers, spacing).map(move |r| t + r));
        let mut x_metres: Vec<f64> = sums.collect();
        x_metres.sort_by(f64::total_cmp);
        Layout::at(x_metres)
    }

    /// Monostatic elements at these places in rising order, metres.
    pub fn at(x_metres: Vec<f64>) -> Self {
        Layout { x_metres, pairs: None }
    }

    /// Numbers of this layout's elements on `radar`; `None` where one stands between those of `radar`, or beside them.
    pub fn numbers(&self, radar: &Radar) -> Option<Vec<usize>> {
        let element = |x: &f64| {
            let n = (x - radar.element_x_metres(0)) / radar.element_spacing_metres;
            let on_grid = (n - n.round()).abs() < 1e-6 && (-0.5..radar.elements as f64 - 0.5).contains(&n);
            on_grid.then_some(n.round() as usize)
        };
        self.x_metres.iter().map(element).collect()
    }

    /// Each element as a pair of antennas.
    pub fn pairs(&self) -> Vec<Pair> {
        self.pairs.clone().unwrap_or_else(|| self.x_metres.iter().map(|x| Pair::at(*x)).collect())
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.x_metres.len()
    }

    /// Whether there is no element.
    pub fn is_empty(&self) -> bool {
        self.x_metres.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_layouts_hold_no_element_twice() {
        let radar = Radar::default();
        for count in [2, 3, 24, 1023, 1024] {
            let layout = Layout::random(&radar, count, 7).unwrap();
            assert_eq!(layout.len(), count);
            assert_eq!(layout, Layout::random(&radar, count, 7).unwrap());
            assert!(layout.x_metres.windows(2).all(|w| w[1] - w[0] > 0.9 * radar.element_spacing_metres));
            assert_eq!(layout.x_metres[count - 1] - layout.x_metres[0], radar.aperture_metres());
        }
        assert_ne!(Layout::random(&radar, 24, 7).unwrap(), Layout::random(&radar, 24, 8).unwrap());
        assert_eq!(Layout::random(&radar, 1, 7).unwrap().len(), 1);
        assert!(Layout::random(&radar, 0, 7).unwrap_err().to_string().contains("1 to 1024"));
        assert!(Layout::random(&radar, 1025, 7).is_err());
    }

    #[test]
    fn a_layout_knows_its_elements() {
        let radar = Radar::default();
        let heard = Layout::two_ends(&radar).numbers(&radar).unwrap();
        assert_eq!((heard.len(), heard[11], heard[12]), (24, 11, 1012));
        assert_eq!(Layout::at(vec![0.0]).numbers(&radar), None, "the centre lies between elements");
        assert_eq!(Layout::at(vec![2.0]).numbers(&radar), None, "beyond the last");
    }

    #[test]
    fn three_by_four_gives_the_twelve_elements_of_an_end() {
        let radar = Radar::default();
        let layout = Layout::mimo(&radar, 3, 4);
        let end = Layout::one_end(&radar, End::First);
        let centre = radar.end_centre_metres(End::First);
        assert_eq!(layout.len(), 12);
        for (v, e) in layout.x_metres.iter().zip(&end.x_metres) {
            assert!((v - (e - centre)).abs() < 1e-12);
        }
    }
}
