//! Frequencies of a chirp, its echoes and their beats over time.
//!
//! The samples depend on the bandwidth and on the number of samples alone: the beat turns `2 R B / c` times in a chirp, for any duration
//! (thesis section 2.1). The thesis' radar has no duration; [`Radar::chirp_seconds`] gives it one. The chirp here is the one that table 3.1
//! names, which rises from the carrier. That of the thesis' formula falls from half of it ([`crate::radar::Convention`]); its beats are as high.

use crate::radar::{Radar, SPEED_OF_LIGHT};
use crate::scene::{Interferer, Reflector, Scene};

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChirpShape {
    /// Frequency at its start, hertz.
    pub start_hz: f64,
    /// Swept bandwidth, hertz.
    pub bandwidth_hz: f64,
    pub duration_seconds: f64,
    pub samples: usize,
}

/// The beat of one object at one pair of antennas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeatTone {
    /// Index of the object in the scene.
    pub object: usize,
    /// Half the way from the transmitter to the object and on to the receiver, metres.
    pub range_metres: f64,
    pub amplitude: f64,
}

impl ChirpShape {
    pub fn of(radar: &Radar) -> ChirpShape {
        let Radar { carrier_hz: start_hz, bandwidth_hz, chirp_seconds: duration_seconds, samples, .. } = *radar;
        ChirpShape { start_hz, bandwidth_hz, duration_seconds, samples }
    }

    /// Slope of the frequency, hertz a second.
    pub fn slope_hz_per_second(&self) -> f64 {
        self.bandwidth_hz / self.duration_seconds
    }

    /// Frequency that is sent at a time since the start, hertz.
    pub fn sent_hz(&self, seconds: f64) -> f64 {
        self.start_hz + self.slope_hz_per_second() * seconds
    }

    /// The beat of an echo, hertz: slope times delay.
    pub fn beat_hz(&self, range_metres: f64) -> f64 {
        self.slope_hz_per_second() * delay_seconds(range_metres)
    }

    /// The range bin in which a beat shows: its turns in a chirp, wrapped around at the number of samples.
    pub fn range_bin(&self, beat_hz: f64) -> f64 {
        (beat_hz * self.duration_seconds).rem_euclid(self.samples as f64)
    }

    /// Frequency of an interferer above the sent one, hertz: 0 at its crossing, and one turn a sample further for every `duration` of a chirp.
    pub fn interferer_above_hz(&self, interferer: &Interferer, seconds: f64) -> f64 {
        let sample_hz = self.samples as f64 / self.duration_seconds;
        sample_hz * (seconds / self.duration_seconds - interferer.crossing) / interferer.duration
    }
}

/// Time from an antenna to an object and back, seconds.
pub fn delay_seconds(range_metres: f64) -> f64 {
    2.0 * range_metres / SPEED_OF_LIGHT
}

/// The beats of all objects at a pair of antennas, nearest first: one for each reflector of a line, a cluster or a body.
pub fn beat_tones(radar: &Radar, scene: &Scene, element: usize) -> Vec<BeatTone> {
    let pair = radar.pair(element);
    let tone = |(object, r): (usize, Reflector)| {
        let ways = pair.places_metres().map(|[x, y]| ((r.x_metres - x).hypot(r.y_metres - y), r.y_metres - y));
        let left = |(way, ahead): (f64, f64)| radar.pattern().map_or(1.0, |p| p.amplitude(ahead / way));
        let [(there, _), (back, _)] = ways;
        let amplitude = left(ways[0]) * left(ways[1]) * radar.transmit_power_watts * r.reflectivity / (there * back);
        BeatTone { object, range_metres: (there + back) / 2.0, amplitude }
    };
    let objects = scene.objects.iter().enumerate();
    let marks = objects.flat_map(|(object, o)| o.marks().into_iter().map(move |r| (object, r)));
    let mut all: Vec<BeatTone> = marks.map(tone).collect();
    all.sort_by(|a, b| a.range_metres.total_cmp(&b.range_metres));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::range_transform;
    use crate::signal::{Floor, simulate};

    #[test]
    fn a_beat_is_the_slope_times_the_way_there_and_back() {
        let radar = Radar::default();
        let chirp = ChirpShape::of(&radar);
        // 2 GHz in 25.6 us, 20 m away: 40 m of way are 133.4 ns.
        let beat = 2e9 / 25.6e-6 * (2.0 * 20.0 / 299_792_458.0);
        assert!((chirp.beat_hz(20.0) / beat - 1.0).abs() < 1e-12);
        assert!((chirp.range_bin(beat) - radar.bin_of_range(20.0)).abs() < 1e-9);
        let longer = ChirpShape::of(&Radar { chirp_seconds: 1e-3, ..radar.clone() });
        assert!((longer.range_bin(longer.beat_hz(20.0)) - radar.bin_of_range(20.0)).abs() < 1e-9);
        assert!((chirp.sent_hz(25.6e-6) - 79e9).abs() < 1.0);
    }

    #[test]
    fn the_spectrum_of_a_beat_peaks_in_its_range_bin() {
        let radar = Radar { elements: 64, ..Radar::default() };
        for (x, y) in [(0.0, 12.0), (-3.0, 20.0), (1.0, 50.0)] {
            let scene = Scene::of_points([(x, y)]);
            let profiles = range_transform(&radar, &simulate(&radar, &scene, Floor::Exact, 0).unwrap()).profiles;
            for element in [0, 40] {
                let chirp = ChirpShape::of(&radar);
                let [one] = beat_tones(&radar, &scene, element)[..] else { panic!("one object") };
                let bin = chirp.range_bin(chirp.beat_hz(one.range_metres));
                let row = profiles.row(element);
                let peak = (0..512).max_by(|a, b| row[*a].norm().total_cmp(&row[*b].norm())).unwrap();
                assert!((peak as f64 - bin).abs() <= 0.5 + 1e-9, "{x} {y}: {peak} {bin}");
            }
        }
    }

    #[test]
    fn an_interferer_crosses_when_it_says() {
        let chirp = ChirpShape::of(&Radar::default());
        let interferer = Interferer { crossing: 0.6, duration: 0.1, ..Interferer::default() };
        assert!(chirp.interferer_above_hz(&interferer, 0.6 * 25.6e-6).abs() < 1e-3);
        // Half a turn a sample, 10 MHz of 20, after half of its duration.
        let after = chirp.interferer_above_hz(&interferer, 0.65 * 25.6e-6);
        assert!((after / 10e6 - 1.0).abs() < 1e-9, "{after}");
    }
}
