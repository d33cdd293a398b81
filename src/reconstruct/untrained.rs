//! The test for noise on which a method was not trained.

use super::{Reconstructor, TrainedNoise};
use crate::radar::Radar;
use crate::scattering::Sources;
use crate::signal::Floor;

/// A sentence on the difference between the noise of these sources over `floor` and that of training `method`; `None` without one or training.
pub fn untrained_noise<'a>(
    method: &dyn Reconstructor,
    radar: &Radar,
    sources: impl Into<Sources<'a>>,
    floor: Floor,
) -> Option<String> {
    let trained = method.trained_noise()?;
    let snr = floor.snr(radar, sources);
    let is = match (floor, snr) {
        (Floor::Thesis, _) => return None,
        (Floor::Exact, _) => "this scene has no noise".to_owned(),
        (_, None) => "this scene is noise alone".to_owned(),
        (_, Some(snr)) => format!("this scene has {:.0} dB", snr.0),
    };
    let was = match trained {
        TrainedNoise::Rounding => "alone".to_owned(),
        TrainedNoise::RoundingAndSnr(from, to) if snr.is_some_and(|snr| (from..=to).contains(&snr)) => return None,
        TrainedNoise::RoundingAndSnr(from, to) => format!("and at SNRs of {:.0} to {:.0} dB", from.0, to.0),
    };
    Some(format!("{} was trained over rounding noise {was}; {is}", method.name()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::radar::{DecibelMilliwatts, Decibels};
    use crate::reconstruct::{Baseline, MethodInfo, ReconstructError, Reconstruction, Request};
    use crate::scene::Reflector;
    use crate::signal::TwoEnds;

    struct Network(TrainedNoise);

    impl Reconstructor for Network {
        fn info(&self) -> MethodInfo {
            MethodInfo { name: "network", description: "for tests", prior_knowledge: "nothing", eta: 0.5 }
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
        let live = Network(TrainedNoise::RoundingAndSnr(Decibels(10.0), Decibels(60.0)));
        let told =
            |of: &dyn Reconstructor, reflectors: &[Reflector], floor| untrained_noise(of, &radar, reflectors, floor);
        let level = |dbm| Floor::Level(DecibelMilliwatts(dbm));
        for floor in [Floor::Thesis, Floor::Snr(Decibels(10.0)), level(-20.0)] {
            assert_eq!(told(&live, &echo, floor), None, "{floor}");
        }
        let expected = "network was trained over rounding noise and at SNRs of 10 to 60 dB; this scene has";
        assert_eq!(told(&live, &echo, Floor::Snr(Decibels(-10.0))), Some(format!("{expected} -10 dB")));
        assert_eq!(told(&live, &echo, level(-60.0)), Some(format!("{expected} 78 dB")));
        assert_eq!(told(&live, &echo, Floor::Exact), Some(format!("{expected} no noise")));
        assert!(told(&live, &[], level(-20.0)).unwrap().ends_with("this scene is noise alone"));
        let thesis = Network(TrainedNoise::Rounding);
        let expected = "network was trained over rounding noise alone; this scene has";
        assert_eq!(told(&thesis, &echo, Floor::Snr(Decibels(30.0))), Some(format!("{expected} 30 dB")));
        assert_eq!(told(&thesis, &echo, Floor::Exact), Some(format!("{expected} no noise")));
        assert_eq!(told(&thesis, &echo, Floor::Thesis), None);
        assert_eq!(told(&Baseline, &echo, Floor::Snr(Decibels(-10.0))), None, "it was not trained");
    }
}
