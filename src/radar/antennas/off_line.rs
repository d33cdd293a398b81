//! Antennas off the array's line, as on a bent bumper. An element's place along the line follows from x alone; y changes path lengths.

use super::Antennas;
use crate::radar::Radar;

const MAX_Y_METRES: f64 = 1.0;

impl Antennas {
    /// The same antennas with these y, metres, positive towards the scene.
    /// # Errors
    /// The fault, where a list has another length, or a value that is not finite or beyond 1 m.
    pub fn off_line(self, transmitter_y_metres: &[f64], receiver_y_metres: &[f64]) -> Result<Self, String> {
        check_off_line("transmitter_y_metres", transmitter_y_metres, self.transmitter_x_metres.len())?;
        check_off_line("receiver_y_metres", receiver_y_metres, self.receiver_x_metres.len())?;
        let (transmitter_y_metres, receiver_y_metres) = (transmitter_y_metres.into(), receiver_y_metres.into());
        Ok(Antennas { transmitter_y_metres, receiver_y_metres, ..self })
    }

    /// y of each transmitter, metres, positive towards the scene.
    pub fn transmitter_y_metres(&self) -> &[f64] {
        &self.transmitter_y_metres
    }

    /// y of each receiver, metres, positive towards the scene.
    pub fn receiver_y_metres(&self) -> &[f64] {
        &self.receiver_y_metres
    }

    /// Whether all of them stand on the line.
    pub fn is_on_line(&self) -> bool {
        self.transmitter_y_metres.iter().chain(&*self.receiver_y_metres).all(|y| *y == 0.0)
    }

    /// The hindmost and the foremost antenna, y in metres; the line itself counts.
    pub fn depth_metres(&self) -> [f64; 2] {
        let all = self.transmitter_y_metres.iter().chain(&*self.receiver_y_metres);
        all.fold([0.0; 2], |[low, high], y| [low.min(*y), high.max(*y)])
    }
}

fn check_off_line(list: &str, places: &[f64], expected: usize) -> Result<(), String> {
    if places.len() != expected {
        let found = places.len();
        return Err(format!("{list} has {found} numbers; expected {expected}, one for each antenna"));
    }
    match places.iter().position(|y| y.is_nan() || y.abs() > MAX_Y_METRES) {
        Some(index) => Err(format!(
            "number {} of {list} is {}; expected at most {MAX_Y_METRES} m off the line, either way",
            index + 1,
            places[index]
        )),
        None => Ok(()),
    }
}

impl Radar {
    /// Whether every antenna stands on the array's line, y = 0.
    pub fn is_on_line(&self) -> bool {
        self.antennas.as_ref().is_none_or(Antennas::is_on_line)
    }

    /// The hindmost and the foremost antenna, y in metres; the line itself counts.
    pub fn antenna_depth_metres(&self) -> [f64; 2] {
        self.antennas.as_ref().map_or([0.0; 2], Antennas::depth_metres)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn radar() -> Radar {
        Radar::default().of_pairs(3, 4).unwrap()
    }

    fn bent() -> Result<Antennas, String> {
        radar().antennas.unwrap().off_line(&[-0.01, 0.0, -0.02], &[0.0, 0.003, 0.0, 0.0])
    }

    #[test]
    fn places_along_the_line_stay() {
        let (straight, antennas) = (radar(), bent().unwrap());
        let radar = straight.clone().with_antennas(antennas);
        radar.validate().unwrap();
        let wanted = (straight.elements, straight.element_spacing_metres);
        assert_eq!((radar.elements, radar.element_spacing_metres), wanted);
        assert_eq!(radar.antenna_depth_metres(), [-0.02, 0.003]);
        assert!(straight.is_on_line() && !radar.is_on_line());
        let pair = radar.pair(5);
        assert_eq!((pair.transmitter_y_metres, pair.receiver_y_metres), (0.0, 0.003));
        assert_eq!(Radar { antennas: None, ..radar.clone() }.antenna_depth_metres(), [0.0; 2]);
        let wider = radar.clone().with_spacing(2.0 * radar.element_spacing_metres);
        assert_eq!(wider.antenna_depth_metres(), [-0.02, 0.003], "the bumper stays as bent as it is");
    }

    #[test]
    fn the_range_is_half_the_way_from_transmitter_to_receiver() {
        let radar = radar().with_antennas(bent().unwrap());
        for n in 0..12 {
            let ([[tx, ty], [rx, ry]], [x, y]) = (radar.pair(n).places_metres(), [1.3f64, 4.0f64]);
            let way = ((x - tx).powi(2) + (y - ty).powi(2)).sqrt() + ((x - rx).powi(2) + (y - ry).powi(2)).sqrt();
            assert!((radar.pair(n).range_metres(x, y) - way / 2.0).abs() < 1e-14, "element {n}");
        }
    }

    #[test]
    fn lists_that_fit_nothing_are_named() {
        let told = |t: &[f64], r: &[f64]| radar().antennas.unwrap().off_line(t, r).unwrap_err().to_string();
        assert_eq!(told(&[0.0], &[0.0; 4]), "transmitter_y_metres has 1 numbers; expected 3, one for each antenna");
        assert_eq!(told(&[0.0; 3], &[0.0; 5]), "receiver_y_metres has 5 numbers; expected 4, one for each antenna");
        let expected = "number 2 of receiver_y_metres is -1.5; expected at most 1 m off the line, either way";
        assert_eq!(told(&[0.0; 3], &[0.0, -1.5, 0.0, 0.0]), expected);
        assert!(told(&[0.0, 0.0, f64::NAN], &[0.0; 4]).contains("number 3 of transmitter_y_metres is NaN"));
    }
}
