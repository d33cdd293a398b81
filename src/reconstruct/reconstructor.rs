//! The trait of every reconstruction method, and the steps that all of them share.

use super::answer::halves;
use super::error::Result;
use super::noise_model::ends_noise_variance;
use super::significance::tested;
use super::{Family, ReconstructError, Reconstruction, Request, TrainedNoise};
use crate::radar::{End, Radar, check_layout};
use crate::signal::{LayoutSamples, TwoEnds};
use ndarray::{Array2, Array3};
use num_complex::Complex64;
use std::sync::Arc;

/// Name and description of a method.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MethodInfo {
    pub name: &'static str,
    /// One sentence for tooltips and help.
    pub description: &'static str,
    /// Knowledge of the method beside the samples and the radar: assumptions that a user's own scene may not meet, or that the scenes of the
    /// tables happen to.
    pub prior_knowledge: &'static str,
    /// Threshold that turns the output into detections, where an answer has none of its own ([`Reconstruction::eta`]). Chosen on validation
    /// scenes, never on test scenes, by one rule for all methods: the mean false-alarm rate over the three sets is that of the thesis, 0.65 %
    /// (`examples/choose_eta.rs`).
    pub eta: f32,
}

/// The identity of a method's learned weights.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Weights {
    /// The first 12 hexadecimal digits of the SHA-256 of the weights' values.
    pub sha256: String,
    /// The optimisers that trained the weights, in their order; empty where that isn't recorded.
    pub optimiser: String,
}

/// The way in which a method uses the samples of other elements than the two ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayoutSupport {
    TwoEnds,
    /// The method takes elements without samples for missing ones: the ends are the halves of the array, silent but for the elements of the layout.
    Halves,
    /// The method reads [`Request::layout_samples`].
    AnyLayout,
}

/// The reason why a method of samples can't answer to the input of the thesis' networks.
pub const NEEDS_SAMPLES: &str =
    "it needs sub0 and sub1; polar_partial_mag_phase is the input of the thesis' networks alone";

/// A method that computes a map of the whole array from the samples of the two ends.
///
/// A method implements [`Reconstructor::info`] and [`Reconstructor::estimate`]; users call [`Reconstructor::reconstruct`].
pub trait Reconstructor: Send + Sync {
    /// Name and description of the method.
    fn info(&self) -> MethodInfo;

    fn family(&self) -> Family {
        Family::Classical
    }

    /// Checks at once whether the method can work on samples of `radar`.
    /// # Errors
    /// [`ReconstructError::Unusable`] with the reason.
    fn check_radar(&self, _radar: &Radar) -> Result<()> {
        Ok(())
    }

    /// Whether the method accounts for transmitters apart from receivers: it takes ranges and amplitudes from each element's two antennas, or needs neither.
    fn knows_pairs(&self) -> bool {
        !matches!(self.family(), Family::Network | Family::Classical)
    }

    /// The way in which the method uses the samples of other elements than the two ends ([`Request::layout_samples`]).
    fn layout_support(&self) -> LayoutSupport {
        LayoutSupport::TwoEnds
    }

    /// [`Reconstructor::check_array`] where the ends are the `halves` of an array, of which so many elements have samples.
    /// # Errors
    /// [`ReconstructError::Unusable`] with the reason.
    fn check_halves(&self, halves: &Radar, _heard: usize) -> Result<()> {
        self.check_array(halves)
    }

    /// Whether the method's places on an array of few elements, whose columns are wide, are those of the echoes.
    fn lists_few_elements(&self) -> bool {
        true
    }

    fn fewest_end_elements(&self) -> usize {
        3
    }

    /// Checks at once whether the method can work on samples of `radar`: [`Reconstructor::check_radar`], whether the ends have enough elements,
    /// and whether the method accounts for such antennas.
    /// # Errors
    /// [`ReconstructError::Unusable`] with the reason.
    fn check_array(&self, radar: &Radar) -> Result<()> {
        let (fewest, found) = (self.fewest_end_elements(), radar.end_elements);
        if found < fewest {
            let reason = format!("it needs {fewest} elements of each end or more, and this radar's ends have {found}");
            return Err(self.unusable(reason));
        }
        if radar.is_monostatic() || self.knows_pairs() {
            return self.check_radar(radar);
        }
        let reason = "it takes every element for one antenna that sends and hears, but this radar's transmitters stand apart from its \
                      receivers: near by, ranges would be wrong";
        Err(self.unusable(reason.to_owned()))
    }

    /// Checks at once whether the method can make maps of the samples of these elements, in place of the two ends.
    /// # Errors
    /// [`ReconstructError::Unusable`] with the reason.
    fn check_elements(&self, radar: &Radar, layout: &[usize]) -> Result<()> {
        check_layout(layout, radar.elements).map_err(|reason| self.unusable(reason))?;
        match self.layout_support() {
            LayoutSupport::AnyLayout => self.check_array(radar),
            LayoutSupport::Halves => {
                let halves = halves(radar);
                self.check_halves(&halves, layout.len())?;
                let is_first = |n: &usize| *n < halves.end_elements;
                self.check_both_halves([!layout.iter().any(is_first), layout.iter().all(is_first)])
            }
            LayoutSupport::TwoEnds => {
                Err(self.unusable("it hears the two ends of an array, and no other layout".to_owned()))
            }
        }
    }

    /// Checks whether a method that joins the halves of the array can work where these halves are silent.
    /// # Errors
    /// [`ReconstructError::Unusable`] names a half that is silent while the other is not.
    fn check_both_halves(&self, is_silent: [bool; 2]) -> Result<()> {
        let half = match is_silent {
            [true, false] => "first",
            [false, true] => "last",
            _ => return Ok(()),
        };
        let reason = format!(
            "it joins the halves of the array, and no element of the {half} half heard anything; matched-filter takes any layout"
        );
        Err(self.unusable(reason))
    }

    /// Estimates the whole array's map from `ends`, which have the radar's shape, are finite, and whose largest real or imaginary
    /// part lies between 1 and 2. Reflectivities are relative to those samples.
    /// # Errors
    /// [`ReconstructError`] when cancelled, or where the method fails.
    fn estimate(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction>;

    /// Estimates the whole array's map from `ends`: checks them, scales them for [`Reconstructor::estimate`], removes the scale from the answer,
    /// and raises the answer's threshold above the noise (`significance`). The answer to silence is [`Reconstruction::silence`]. Where the
    /// request has the samples of a layout, those are used and `ends` are not read.
    /// # Errors
    /// [`ReconstructError`], on a radar or a layout the method can't work on, on samples of the wrong shape or not finite, when cancelled, or
    /// where the method fails.
    fn reconstruct(&self, radar: &Radar, ends: &TwoEnds, request: &Request) -> Result<Reconstruction> {
        request.task.check()?;
        if let Some(layout_samples) = &request.layout_samples {
            return reconstruct_layout(self, radar, layout_samples, request);
        }
        check_ends(radar, ends)?;
        self.check_array(radar)?;
        self.check_hearing(ends)?;
        answer(self, radar, (radar, ends), request)
    }

    /// The method with a memory, where that makes it faster on samples that change a little at a time: for a request with
    /// [`Request::may_follow`] it starts from its last answer, and otherwise it answers as without a memory.
    fn following(&self) -> Option<Arc<dyn Reconstructor>> {
        None
    }

    /// The learned weights that the method uses for samples of `radar`, if any.
    fn weights(&self, _radar: &Radar) -> Option<Weights> {
        None
    }

    /// Checks whether the method can work on ends of which one is silent: by default none can, as it joins both.
    /// # Errors
    /// [`ReconstructError::Unusable`] names the silent end.
    fn check_hearing(&self, ends: &TwoEnds) -> Result<()> {
        match End::BOTH.map(|end| is_silent(ends.end(end))) {
            [false, false] | [true, true] => Ok(()),
            [is_first, _] => {
                let end = if is_first { "first" } else { "last" };
                Err(self.unusable(format!("it joins both ends, and no element of the {end} end heard anything")))
            }
        }
    }

    /// Estimates the whole array's map from the thesis networks' own input, `[4, range bins, columns]`
    /// ([`mag_phase`](crate::maps::network_input::mag_phase)).
    /// # Errors
    /// [`ReconstructError::Unusable`] from every method that needs the samples themselves; [`ReconstructError::Shape`].
    fn reconstruct_mag_phase(&self, _: &Radar, _: &Array3<f64>) -> Result<Reconstruction> {
        Err(self.unusable(NEEDS_SAMPLES.to_owned()))
    }

    /// The noise beneath the scenes of the method's training; `None` for methods that aren't trained.
    fn trained_noise(&self) -> Option<TrainedNoise> {
        None
    }

    /// The method's [`MethodInfo::name`].
    fn name(&self) -> &'static str {
        self.info().name
    }

    /// The method's [`MethodInfo::description`].
    fn description(&self) -> &'static str {
        self.info().description
    }

    /// The method's [`MethodInfo::eta`].
    fn eta(&self) -> f32 {
        self.info().eta
    }

    /// Whether every answer has a threshold of its own; other methods' answers have one only where noise reaches the method's.
    fn reads_eta(&self) -> bool {
        false
    }

    /// Whether the method searches for places of echoes, which can be listed; other methods only make a map.
    fn finds_reflectors(&self) -> bool {
        !matches!(self.family(), Family::Own | Family::Network)
    }

    /// The threshold for an answer of this method: its own, or [`MethodInfo::eta`].
    fn eta_of(&self, answer: &Reconstruction) -> f32 {
        answer.eta.unwrap_or_else(|| self.eta())
    }

    /// The error with the method's name for a `reason` why it can't work.
    fn unusable(&self, reason: String) -> ReconstructError {
        ReconstructError::Unusable { method: self.name(), reason }
    }
}

fn reconstruct_layout<M: Reconstructor + ?Sized>(
    method: &M,
    radar: &Radar,
    layout_samples: &LayoutSamples,
    request: &Request,
) -> Result<Reconstruction> {
    check_layout(&layout_samples.layout, radar.elements).map_err(|reason| method.unusable(reason))?;
    let expected = [layout_samples.layout.len(), radar.samples];
    ReconstructError::check_shape("samples of the layout", layout_samples.samples.shape(), expected)?;
    if let Some(((place, sample), _)) = layout_samples.samples.indexed_iter().find(|(_, v)| !v.is_finite()) {
        return Err(
            method.unusable(format!("sample {sample} of element {} is not finite", layout_samples.layout[place]))
        );
    }
    let (halves, ends) = layout_samples.as_halves(radar);
    check_ends(&halves, &ends)?;
    method.check_elements(radar, &layout_samples.layout)?;
    if method.layout_support() == LayoutSupport::AnyLayout {
        return answer(method, radar, (&halves, &ends), request);
    }
    method.check_both_halves([is_silent(&ends.first), is_silent(&ends.last)])?;
    answer(method, &halves, (&halves, &ends), &Request { layout_samples: None, ..request.clone() })
}

/// The answer of `method` to checked samples, with a threshold above the noise of `ends`, which are those of the radar `ends_radar`.
fn answer<M: Reconstructor + ?Sized>(
    method: &M,
    radar: &Radar,
    (ends_radar, ends): (&Radar, &TwoEnds),
    request: &Request,
) -> Result<Reconstruction> {
    let Some((ends, gain)) = unit_gain(ends) else { return Ok(Reconstruction::silence(radar)) };
    let layout_samples = request.layout_samples.as_ref().map(|layout_samples| {
        Arc::new(LayoutSamples {
            layout: layout_samples.layout.clone(),
            samples: layout_samples.samples.mapv(|v| v * gain),
        })
    });
    let request = &Request { noise: request.noise.scaled(gain), layout_samples, ..request.clone() };
    // Inside the scope a parallel step goes to an idle thread; outside, the caller would sleep through each one.
    let found = rayon::scope(|_| method.estimate(radar, &ends, request))?;
    // An answer during which the task was cancelled may be incomplete.
    request.task.check()?;
    let noise_variance = ends_noise_variance(ends_radar, &ends, request.noise);
    let mut found = tested(ends_radar, &ends, noise_variance, method.eta(), found);
    found.reflectors.iter_mut().for_each(|r| r.reflectivity /= gain);
    let range = request.snapshot_range_metres.filter(|_| radar.samples == 1);
    Ok(match range {
        Some(range_metres) => found.moved_to(range_metres),
        None => found,
    })
}

fn is_silent(samples: &Array2<Complex64>) -> bool {
    samples.iter().all(|v| *v == Complex64::default())
}

/// Checks that both ends have the radar's shape and hold finite samples only.
/// # Errors
/// [`ReconstructError::Shape`] or [`ReconstructError::NotFinite`].
pub fn check_ends(radar: &Radar, ends: &TwoEnds) -> Result<()> {
    for (end, what, samples) in [("first", "first end", &ends.first), ("last", "last end", &ends.last)] {
        ReconstructError::check_shape(what, samples.shape(), [radar.end_elements, radar.samples])?;
        if let Some(((element, sample), _)) = samples.indexed_iter().find(|(_, v)| !v.is_finite()) {
            return Err(ReconstructError::NotFinite { end, element, sample });
        }
    }
    Ok(())
}

/// The samples of both ends scaled to a peak between 1 and 2, and the factor; `None` for silence.
pub(crate) fn unit_gain(ends: &TwoEnds) -> Option<(TwoEnds, f64)> {
    let peak = ends.first.iter().chain(&ends.last).fold(0.0f64, |m, v| m.max(v.re.abs()).max(v.im.abs()));
    if peak == 0.0 {
        return None;
    }
    // A power of two loses no bit, so that the gain changes not even the rounding noise of the floor.
    let gain = (-peak.log2().floor()).clamp(-1000.0, 1000.0).exp2();
    Some((TwoEnds { first: ends.first.mapv(|v| v * gain), last: ends.last.mapv(|v| v * gain) }, gain))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Reflector;

    /// A method that answers with one reflector as strong as the strongest sample.
    struct Echo;

    impl Reconstructor for Echo {
        fn info(&self) -> MethodInfo {
            MethodInfo { name: "echo", description: "for tests", prior_knowledge: "nothing", eta: 0.5 }
        }

        fn check_radar(&self, radar: &Radar) -> Result<(), ReconstructError> {
            if radar.samples > 8 { Err(self.unusable("too many samples".into())) } else { Ok(()) }
        }

        fn estimate(&self, radar: &Radar, ends: &TwoEnds, _: &Request) -> Result<Reconstruction, ReconstructError> {
            let reflectivity = ends.first.iter().fold(0.0, |m: f64, v| m.max(v.norm()));
            assert!((1.0..2.0).contains(&reflectivity));
            let reflector = Reflector { x_metres: 0.0, y_metres: 1.0, reflectivity };
            Ok(Reconstruction { reflectors: vec![reflector], ..Reconstruction::silence(radar) })
        }
    }

    #[test]
    fn what_all_methods_share_is_done_for_them() {
        let radar = Radar { samples: 8, elements: 8, end_elements: 3, ..Radar::default() };
        let mut ends = crate::signal::BeatSignal::silence(&radar).two_ends(&radar);
        let request = Request::default();
        assert_eq!(Echo.reconstruct(&radar, &ends, &request), Ok(Reconstruction::silence(&radar)));
        ends.first[[1, 2]] = Complex64::from(3e-7);
        let error = Echo.reconstruct(&radar, &ends, &request).unwrap_err().to_string();
        assert!(error.contains("echo") && error.contains("no element of the last end"), "{error}");
        ends.last[[0, 0]] = Complex64::from(1e-7);
        assert_eq!(Echo.reconstruct(&radar, &ends, &request).unwrap().reflectors[0].reflectivity, 3e-7);
        let long = Radar { samples: 16, ..radar.clone() };
        let error = Echo.reconstruct(&long, &crate::signal::BeatSignal::silence(&long).two_ends(&long), &request);
        assert_eq!(error.unwrap_err().to_string(), "echo: too many samples");
        request.task.cancel();
        assert_eq!(Echo.reconstruct(&radar, &ends, &request), Err(ReconstructError::Cancelled));
    }
}
