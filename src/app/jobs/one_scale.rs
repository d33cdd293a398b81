//! Maps of one frame on a common scale, so that a weaker map is darker.

use super::memo::Memo;
use crate::app::shared::Shared;
use crate::app::state::MapKind;
use crate::engine::{EngineFrame, ReadyMap};
use crate::maps::{LambdaScale, RangeAngleMap};
use std::collections::BTreeMap;
use std::sync::Arc;

/// A map, its own scale and the common one.
type Rescaling = (Shared<RangeAngleMap>, LambdaScale, LambdaScale);

#[derive(Default)]
pub struct OneScale(BTreeMap<MapKind, Memo<Rescaling, ReadyMap>>);

impl OneScale {
    /// The inputs, the target and the outputs on a common scale. It ends at the highest peak of inputs and target and spans as many decibels as the widest of
    /// them. An output's own scale is the target's.
    pub fn of(
        &mut self,
        frame: &EngineFrame,
        outputs: [Option<&Shared<RangeAngleMap>>; 2],
    ) -> BTreeMap<MapKind, ReadyMap> {
        let ready = |map: &ReadyMap| (Shared::from(&map.lambda), map.scale);
        let of_frame =
            [(MapKind::Input0, &frame.first), (MapKind::Input1, &frame.last), (MapKind::Target, &frame.full)];
        let of_frame = of_frame.into_iter().filter_map(|(kind, map)| Some((kind, ready(map.as_ref()?))));
        let scale = frame.full.as_ref().map(|full| full.scale);
        let of_methods = [MapKind::Output, MapKind::Second].into_iter().zip(outputs);
        let of_methods = of_methods.filter_map(|(kind, map)| Some((kind, (map?.clone(), scale?))));
        let common = common([&frame.first, &frame.last, &frame.full].into_iter().flatten().map(|map| map.scale));
        let mut kept = std::mem::take(&mut self.0);
        let all = of_frame.chain(of_methods).map(|(kind, (map, own))| {
            let mut memo = kept.remove(&kind).unwrap_or_default();
            let made = memo.of((map, own, common), rescaled).clone();
            self.0.insert(kind, memo);
            (kind, made)
        });
        all.collect()
    }
}

/// The scale that ends at the highest peak and spans as much as the widest.
fn common(scales: impl Iterator<Item = LambdaScale> + Clone) -> LambdaScale {
    let peak = scales.clone().map(|scale| scale.peak).fold(f64::NEG_INFINITY, f64::max);
    let span = scales.map(|scale| scale.peak - scale.floor).fold(0.0, f64::max);
    LambdaScale { peak, floor: peak - span }
}

fn rescaled((map, own, scale): &Rescaling) -> ReadyMap {
    let decades = |lambda: f32| own.floor + f64::from(lambda) * (own.peak - own.floor);
    let lambda = map.lambda.mapv(|lambda| scale.lambda(decades(lambda)) as f32);
    ReadyMap { lambda: Arc::new(RangeAngleMap { lambda }), scale: *scale }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ndarray::array;

    #[test]
    fn a_weaker_map_is_darker_on_one_scale() {
        let [strong, weak] = [2.0, 1.0].map(|peak| LambdaScale { peak, floor: peak - 4.0 });
        let scale = common([weak, strong].into_iter());
        let map = Shared::new(RangeAngleMap { lambda: array![[1.0f32, 0.5, 0.0]] });
        let [of_strong, of_weak] = [strong, weak].map(|own| rescaled(&(map.clone(), own, scale)));
        assert_eq!(of_strong.lambda.lambda, map.lambda, "the strongest stays as it is");
        assert_eq!(of_weak.lambda.lambda, array![[0.75f32, 0.25, 0.0]], "20 dB of 80 dB");
    }
}
