//! Figures for a map's title bar.

use crate::app::state::MapKind;
use crate::app::widgets::numbers::percent;
use crate::evaluate::{Metrics, eta_text};

/// Figures for a map's title bar.
pub struct Caption {
    /// Which map.
    pub kind: MapKind,
    /// The method whose output is shown.
    pub method: Option<&'static str>,
    /// Whether the map is of an earlier scene.
    pub updating: bool,
    /// Figures of the output that is shown, against the target of the same scene.
    pub metrics: Option<Metrics>,
    /// eta'.
    pub target_eta: f32,
    /// eta.
    pub output_eta: f32,
    /// Part of a recording's power that the reflectors laid over it explain.
    pub explained: Option<f64>,
}

/// What stands in the title bar of a map's panel.
pub fn caption(input: Caption) -> Option<String> {
    let updating = if input.updating { "(updating) " } else { "" };
    let text = match input.kind {
        MapKind::TargetAbove => format!("η' = {} {updating}", eta_text(input.target_eta)),
        MapKind::OutputAbove | MapKind::SecondAbove => {
            let figures = input.metrics.map_or_else(String::new, |m| {
                let detection = m.detection.map_or("–".to_owned(), percent);
                format!("P_D {detection} · P_FA {} · ", percent(m.false_alarm))
            });
            format!("{figures}η = {} {updating}", eta_text(input.output_eta))
        }
        MapKind::Output | MapKind::Second => format!("{} {updating}", input.method.unwrap_or_default()),
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
