//! Over how much noise a network was trained.

use crate::radar::Decibels;

/// The thermal noise beneath the scenes that a method was trained on. Rounding floors and none lie beneath all training scenes' noise and
/// count as trained.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrainedNoise {
    /// None.
    None,
    /// At signal-to-noise ratios from the first to the second, per sample over the whole array.
    Snr(Decibels, Decibels),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{DecibelMilliwatts, Radar};
    use crate::reconstruct::{
        About, Baseline, ReconstructError, Reconstruction, Reconstructor, Request, untrained_noise,
    };
    use crate::scene::Reflector;
    use crate::signal::{Floor, TwoEnds};

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
