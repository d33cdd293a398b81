//! Text in the title bar of a map's panel.

use crate::app::state::{MapKind, Units, View};
use crate::app::widgets::{level, percent, with_unit};
use crate::evaluate::{Metrics, eta_text};

/// Figures that the caption is made of.
pub struct Caption<'a> {
    pub kind: MapKind,
    pub view: &'a View,
    pub method: Option<&'static str>,
    /// Text on a map of an earlier scene or of another method, with a space behind it.
    pub updating: &'a str,
    /// Verdict on the objects in the output that is shown, in a few words.
    pub verdict: Option<String>,
    /// The verdict with the distance of found points.
    pub with_distance: Option<String>,
    /// Figures of the output that is shown, against the target of the same scene.
    pub metrics: Option<Metrics>,
    pub output_eta: f32,
    /// Part of a recording's power that the reflectors laid over it explain.
    pub explained: Option<f64>,
    /// Decibels that the target's Lambda spans, where its scale is known.
    pub range_db: Option<f64>,
}

/// Text in the title bar of a map's panel, from its longest form to its shortest, which is the verdict where there is one.
pub fn caption(input: Caption<'_>) -> Vec<String> {
    let Caption { view, updating, method, verdict, .. } = &input;
    let method = method.unwrap_or_default();
    let threshold = |name: &str, eta: f32| match view.cfar {
        Some(cfar) => cfar.statistic.short_name().to_owned(),
        None => format!("{name} = {}", threshold(&input, eta)),
    };
    let text = match input.kind {
        MapKind::TargetAbove => format!("{} {updating}", threshold("η'", view.target_eta)),
        MapKind::OutputAbove | MapKind::SecondAbove => {
            let eta = threshold("η", input.output_eta);
            let Some(m) = input.metrics else { return vec![format!("{eta} {updating}")] };
            let verdict_before = verdict.as_deref().map_or_else(String::new, |verdict| format!("{verdict} · "));
            let detection = m.detection.map_or("–".to_owned(), percent);
            // With a verdict without η, which the settings show: both would be cut off.
            let eta = if verdict.is_some() && view.cfar.is_none() { String::new() } else { format!(" · {eta}") };
            format!("{verdict_before}P_D {detection} · P_FA {}{eta} {updating}", percent(m.false_alarm))
        }
        MapKind::Output | MapKind::Second => {
            let told = input.with_distance.as_ref().or(verdict.as_ref());
            let told = told.map_or_else(String::new, |told| format!(": {told}"));
            format!("{method}{told} {updating}")
        }
        MapKind::Doubt => format!("{method} {updating}"),
        MapKind::Difference | MapKind::SecondDifference => {
            let figures = input.metrics.map_or_else(String::new, |m| format!("SE {:.0} ", m.squared_error));
            format!("{figures}{updating}")
        }
        MapKind::Unexplained => input.explained.map_or_else(String::new, |explained| {
            format!("{:.1} % of the power explained {updating}", 100.0 * explained)
        }),
        _ => (*updating).to_owned(),
    };
    let named = verdict.as_ref().filter(|_| input.with_distance.is_some()).map(|told| format!("{method}: {told}"));
    let has_verdict =
        matches!(input.kind, MapKind::Output | MapKind::Second | MapKind::OutputAbove | MapKind::SecondAbove);
    let shorter = named.into_iter().chain(input.verdict).filter(|_| has_verdict);
    let forms = std::iter::once(text.trim_end().to_owned()).chain(shorter);
    forms.filter(|form| !form.is_empty()).collect()
}

/// Text of a threshold in Lambda, or in decibels relative to the target's peak where these are chosen and the scale is known.
fn threshold(input: &Caption<'_>, eta: f32) -> String {
    match input.range_db.filter(|_| input.view.units == Units::Decibels) {
        Some(range_db) => with_unit(&level(range_db * (f64::from(eta) - 1.0), range_db)),
        None => eta_text(eta),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The caption of a map above η' without an output.
    fn bare(view: &View) -> Caption<'_> {
        Caption {
            kind: MapKind::TargetAbove,
            view,
            method: None,
            updating: "",
            verdict: None,
            with_distance: None,
            metrics: None,
            output_eta: 0.8,
            explained: None,
            range_db: None,
        }
    }

    #[test]
    fn the_verdict_of_objects_comes_before_that_of_cells() {
        let of = |kind| {
            let metrics = Some(Metrics { squared_error: 120.0, detection: Some(0.5), false_alarm: 0.01 });
            let verdict = Some("5 of 5 found, 0 false".to_owned());
            let with_distance =
                verdict.as_ref().map(|told| format!("{told}, <1 mm off")).filter(|_| kind == MapKind::Output);
            let view = View::default();
            caption(Caption { kind, method: Some("live"), verdict, with_distance, metrics, ..bare(&view) })
        };
        let [whole, named, short] = &of(MapKind::Output)[..] else { panic!("three forms") };
        assert_eq!(whole.trim(), "live: 5 of 5 found, 0 false, <1 mm off");
        assert_eq!([named, short], ["live: 5 of 5 found, 0 false", "5 of 5 found, 0 false"]);
        let [whole, short] = &of(MapKind::OutputAbove)[..] else { panic!("two forms") };
        assert_eq!(whole.trim(), "5 of 5 found, 0 false · P_D 50.00 % · P_FA 1.00 %");
        assert_eq!(short, "5 of 5 found, 0 false");
    }

    #[test]
    fn thresholds_are_told_in_the_chosen_units() {
        let of = |units, range_db| {
            let view = View { units, target_eta: 0.9, ..View::default() };
            caption(Caption { range_db, ..bare(&view) }).remove(0)
        };
        assert_eq!(of(Units::Lambda, Some(320.0)).trim(), "η' = 0.90");
        assert_eq!(of(Units::Decibels, Some(320.0)).trim(), "η' = −32.0 dB");
        assert_eq!(of(Units::Decibels, None).trim(), "η' = 0.90", "no map is there yet");
    }
}
