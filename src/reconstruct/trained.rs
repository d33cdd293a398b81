//! Over how much noise a network was trained, and what is said where a scene has another amount.

use super::reconstructor::Reconstructor;
use crate::radar::{Decibels, Radar};
use crate::scene::Reflector;
use crate::signal::Floor;

/// The thermal noise beneath the scenes that a method was trained on. Rounding floors and none lie beneath all training scenes' noise and
/// count as trained.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrainedNoise {
    /// None.
    None,
    /// At signal-to-noise ratios from the first to the second, per sample over the whole array.
    Snr(Decibels, Decibels),
}

/// What is wrong with asking `method` of these reflectors over `floor`, if it was trained on other noise.
pub fn untrained_noise(
    method: &dyn Reconstructor,
    radar: &Radar,
    reflectors: &[Reflector],
    floor: Floor,
) -> Option<String> {
    let trained = method.trained_noise()?;
    if !floor.is_thermal() {
        return None;
    }
    let snr = floor.snr(radar, reflectors);
    let was = match trained {
        TrainedNoise::None => "without thermal noise".to_owned(),
        TrainedNoise::Snr(from, to) => {
            if snr.is_some_and(|snr| (from..=to).contains(&snr)) {
                return None;
            }
            format!("at SNRs of {:.0} to {:.0} dB", from.0, to.0)
        }
    };
    let is = snr.map_or("this scene is noise alone".to_owned(), |snr| format!("this scene has {:.0} dB", snr.0));
    Some(format!("{} was trained {was}; {is}", method.name()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::DecibelMilliwatts;
    use crate::reconstruct::{About, Baseline, ReconstructError, Reconstruction, Request};
    use crate::signal::TwoEnds;

    struct Network(TrainedNoise);

    impl Reconstructor for Network {
        fn about(&self) -> About {
            About { name: "network", description: "for tests", told: "nothing", eta: 0.5 }
        }

        fn trained_noise(&self) -> Option<TrainedNoise> {
            Some(self.0)
        }

        fn estimate(&self, radar: &Radar, _: &TwoEnds, _: &Request) -> Result<Reconstruction, ReconstructError> {
            Ok(Reconstruction::silence(radar))
        }
    }

    #[test]
    fn noise_that_a_network_never_met_is_told() {
        let radar = Radar::default();
        // +18 dBm a sample.
        let echo = [Reflector { x_metres: 0.0, y_metres: 20.0, reflectivity: 1.0 }];
        let live = Network(TrainedNoise::Snr(Decibels(10.0), Decibels(60.0)));
        let told =
            |of: &dyn Reconstructor, reflectors: &[Reflector], floor| untrained_noise(of, &radar, reflectors, floor);
        let level = |dbm| Floor::Level(DecibelMilliwatts(dbm));
        for floor in [Floor::Thesis, Floor::Exact, Floor::Snr(Decibels(10.0)), level(-20.0)] {
            assert_eq!(told(&live, &echo, floor), None, "{floor}");
        }
        let expected = "network was trained at SNRs of 10 to 60 dB; this scene has";
        assert_eq!(told(&live, &echo, Floor::Snr(Decibels(-10.0))), Some(format!("{expected} -10 dB")));
        assert_eq!(told(&live, &echo, level(-60.0)), Some(format!("{expected} 78 dB")));
        assert!(told(&live, &[], level(-20.0)).unwrap().ends_with("this scene is noise alone"));
        let thesis = Network(TrainedNoise::None);
        assert!(told(&thesis, &echo, Floor::Snr(Decibels(30.0))).unwrap().contains("without thermal noise"));
        assert_eq!(told(&thesis, &echo, Floor::Thesis), None);
        assert_eq!(told(&Baseline, &echo, Floor::Snr(Decibels(-10.0))), None, "it was not trained");
    }
}
