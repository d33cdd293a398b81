//! Text in the title bar of a map's panel.

use crate::app::state::{MapKind, Units};
use crate::app::widgets::{level, percent, with_unit};
use crate::evaluate::{Metrics, eta_text};
use crate::maps::cfar::Cfar;

/// Figures that the caption is made of.
pub struct Caption {
    pub kind: MapKind,
    /// The method whose output is shown.
    pub method: Option<&'static str>,
    /// Whether the map is of an earlier scene or of another method.
    pub updating: bool,
    /// The running method, while another method's output is shown.
    pub running: Option<&'static str>,
    /// Verdict on the objects in the output that is shown, in a few words.
    pub verdict: Option<String>,
    /// Figures of the output that is shown, against the target of the same scene.
    pub metrics: Option<Metrics>,
    /// Threshold of the target.
    pub target_eta: f32,
    /// Threshold of the output.
    pub output_eta: f32,
    /// The detector in place of both thresholds, if one is in use.
    pub cfar: Option<Cfar>,
    /// Part of a recording's power that the reflectors laid over it explain.
    pub explained: Option<f64>,
    /// Unit of the thresholds.
    pub units: Units,
    /// Decibels that the target's Lambda spans, where its scale is known.
    pub range_db: Option<f64>,
}

/// Text in the title bar of a map's panel.
pub fn caption(input: Caption) -> Option<String> {
    let updating = match input.running {
        Some(method) => &format!("({method} is running) "),
        None if input.updating => "(updating) ",
        None => "",
    };
    let verdict = input.verdict.as_deref().map_or_else(String::new, |verdict| format!("{verdict} · "));
    let text = match input.kind {
        MapKind::TargetAbove if let Some(cfar) = input.cfar => format!("{} {updating}", cfar.statistic.short_name()),
        MapKind::TargetAbove => format!("η' = {} {updating}", threshold(&input, input.target_eta)),
        MapKind::OutputAbove | MapKind::SecondAbove => {
            let figures = input.metrics.map(|m| {
                let detection = m.detection.map_or("–".to_owned(), percent);
                format!("{verdict}P_D {detection} · P_FA {}", percent(m.false_alarm))
            });
            match (input.cfar, figures) {
                (Some(cfar), Some(figures)) => format!("{figures} · {} {updating}", cfar.statistic.short_name()),
                (Some(cfar), None) => format!("{} {updating}", cfar.statistic.short_name()),
                // Without η, which the settings show: both would be cut off.
                (None, Some(figures)) if input.verdict.is_some() => format!("{figures} {updating}"),
                (None, Some(figures)) => format!("{figures} · η = {} {updating}", threshold(&input, input.output_eta)),
                (None, None) => format!("η = {} {updating}", threshold(&input, input.output_eta)),
            }
        }
        MapKind::Output | MapKind::Second => {
            // A narrow panel cuts off the end of the verdict, not the name.
            let told = input.verdict.as_deref().map_or_else(String::new, |verdict| format!(": {verdict}"));
            format!("{}{told} {updating}", input.method.unwrap_or_default())
        }
        MapKind::Doubt => format!("{} {updating}", input.method.unwrap_or_default()),
        MapKind::Difference | MapKind::SecondDifference => {
            let figures = input.metrics.map_or_else(String::new, |m| format!("SE {:.0} ", m.squared_error));
            format!("{figures}{updating}")
        }
        MapKind::Unexplained => input.explained.map_or_else(String::new, |explained| {
            format!("{:.1} % of the power explained {updating}", 100.0 * explained)
        }),
        _ => updating.to_owned(),
    };
    (!text.trim().is_empty()).then_some(text)
}

/// Text of a threshold in Lambda, or in decibels relative to the target's peak where these are chosen and the scale is known.
fn threshold(input: &Caption, eta: f32) -> String {
    match input.range_db.filter(|_| input.units == Units::Decibels) {
        Some(range_db) => with_unit(&level(range_db * (f64::from(eta) - 1.0), range_db)),
        None => eta_text(eta),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOTHING: Caption = Caption {
        kind: MapKind::TargetAbove,
        method: None,
        updating: false,
        running: None,
        verdict: None,
        metrics: None,
        target_eta: 0.9,
        cfar: None,
        output_eta: 0.8,
        explained: None,
        units: Units::Lambda,
        range_db: None,
    };

    #[test]
    fn the_verdict_of_objects_comes_before_that_of_cells() {
        let of = |kind| {
            let metrics = Some(Metrics { squared_error: 120.0, detection: Some(0.5), false_alarm: 0.01 });
            let verdict = Some("5 of 5 found, 0 false".to_owned());
            caption(Caption { kind, method: Some("live"), verdict, metrics, ..NOTHING }).unwrap()
        };
        assert_eq!(of(MapKind::Output).trim(), "live: 5 of 5 found, 0 false");
        assert_eq!(of(MapKind::OutputAbove).trim(), "5 of 5 found, 0 false · P_D 50.00 % · P_FA 1.00 %");
    }

    #[test]
    fn thresholds_are_told_in_the_chosen_units() {
        let of = |units, range_db| caption(Caption { units, range_db, ..NOTHING }).unwrap();
        assert_eq!(of(Units::Lambda, Some(320.0)).trim(), "η' = 0.90");
        assert_eq!(of(Units::Decibels, Some(320.0)).trim(), "η' = −32.0 dB");
        assert_eq!(of(Units::Decibels, None).trim(), "η' = 0.90", "no map is there yet");
    }
}
