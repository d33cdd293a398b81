//! `apertura budget`: SNR by the radar equation.

use super::arguments::{decibels, usable};
use super::{CommandError, print, print_json};
use crate::radar::budget::{DETECTION_SNR, cross_section_dbsm, range_of_snr_metres};
use crate::radar::{Decibels, LinkBudget, LinkFigures, Radar};
use crate::scene::Object;
use crate::scene::file::{SceneFile, load};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Print the link budget of a radar: how strong an object is received by the radar equation, and over how much noise
///
/// The numbers are those of [radar.budget] in the scene: transmit_power_dbm, antenna_gain_dbi, noise_figure_db, and half_power_width_degrees
/// where elements have a pattern. Without that table they are the usual ones: 12 dBm, 10 dBi, 12 dB, isotropic. Noise is kTBF at 290 K in the
/// bandwidth samples / chirp_seconds. The SNR of each object of the scene that is made of points follows, where it stands. Ends
/// and array add their elements in phase, as a map does beyond the far field. The loss of an echo between two cells is left out. Levels in dBm are powers in
/// the receiver. `--floor dbm=LEVEL` of other commands is such a level where the scene has a table [radar.budget], and else that of a sample.
///
/// --json prints one object: budget, sample_rate_hz, object and objects (name, cross_section_dbsm, range_metres, angle_degrees, received_dbm,
/// noise_dbm, and SNR as sample_snr_db, range_snr_db in a range bin, end_snr_db and array_snr_db by one end and by the whole array), and
/// detected_to_metres (the range at which array_snr_db falls to 13 dB).
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene (.toml) whose radar and objects are taken [default: table 3.1, no object]
    scene: Option<PathBuf>,

    /// Radar cross section of the object, dBsm
    #[arg(long, value_name = "DBSM", default_value = "10", value_parser = decibels, allow_hyphen_values = true)]
    cross_section_dbsm: Decibels,

    /// Its range, metres
    #[arg(long, value_name = "METRES", default_value = "50", value_parser = metres, allow_hyphen_values = true)]
    range: f64,

    /// Its angle off broadside, degrees
    #[arg(long, value_name = "DEGREES", default_value = "0", value_parser = degrees, allow_hyphen_values = true)]
    angle: f64,

    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
}

fn metres(text: &str) -> Result<f64, String> {
    usable(text, |m| (1e-3..=1e9).contains(&m), "expected metres from 0.001 to 1e9")
}

fn degrees(text: &str) -> Result<f64, String> {
    usable(text, |a| (-90.0..=90.0).contains(&a), "expected degrees off broadside, -90 to 90")
}

#[derive(Debug, Serialize)]
struct Row {
    name: String,
    cross_section_dbsm: f64,
    range_metres: f64,
    angle_degrees: f64,
    #[serde(flatten)]
    link: LinkFigures,
}

#[derive(Debug, Serialize)]
struct Report {
    budget: LinkBudget,
    sample_rate_hz: f64,
    object: Row,
    detected_to_metres: f64,
    objects: Vec<Row>,
}

impl Row {
    fn new(radar: &Radar, name: String, dbsm: f64, range_metres: f64, angle_degrees: f64) -> Row {
        let link = radar.link(dbsm, range_metres, angle_degrees.to_radians().cos());
        Row { name, cross_section_dbsm: dbsm, range_metres, angle_degrees, link }
    }

    fn of(radar: &Radar, (index, object): (usize, &Object)) -> Option<Row> {
        if object.body().is_some() || object.reflectivity() == 0.0 {
            return None;
        }
        let [x, y] = object.centre_metres();
        let name = object.called(index);
        let dbsm = cross_section_dbsm(object.reflectivity());
        Some(Row::new(radar, name, dbsm, x.hypot(y).max(1e-3), x.atan2(y).to_degrees()))
    }
}

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        let file = match &self.scene {
            Some(path) => load(path)?,
            None => SceneFile::default(),
        };
        let radar = &file.radar;
        let object = Row::new(radar, "object".to_owned(), self.cross_section_dbsm.0, self.range, self.angle);
        let report = Report {
            budget: radar.budget_or_usual(),
            sample_rate_hz: radar.sample_rate_hz(),
            detected_to_metres: range_of_snr_metres(DETECTION_SNR, object.link.array, self.range),
            object,
            objects: file.scene.objects.iter().enumerate().filter_map(|o| Row::of(radar, o)).collect(),
        };
        if self.json { print_json(&report) } else { print(&report.text(radar.budget.is_some())) }
    }
}

impl Report {
    fn text(&self, is_own: bool) -> String {
        let LinkBudget { transmit_power_dbm, antenna_gain_dbi, noise_figure_db, half_power_width_degrees } =
            self.budget;
        let whose = if is_own { "" } else { " (the usual ones: the radar has no budget)" };
        let elements = half_power_width_degrees.map_or("isotropic".to_owned(), |width| format!("of {width} degrees"));
        let mut text = format!(
            "transmit power {transmit_power_dbm} dBm, antenna gain {antenna_gain_dbi} dBi, elements {elements}, noise figure {noise_figure_db} \
             dB{whose}\nbandwidth of the noise {:.3} MHz: {:.2} dBm in a sample\n\n",
            self.sample_rate_hz * 1e-6,
            self.object.link.noise.0
        );
        let head = ["dBsm", "range m", "angle", "dBm", "sample dB", "range dB", "end dB", "array dB"];
        _ = write!(text, "{:<14}", "");
        head.iter().for_each(|name| _ = write!(text, "{name:>10}"));
        for row in std::iter::once(&self.object).chain(&self.objects) {
            _ = write!(text, "\n{:<14}{:>10.1}{:>10.2}", row.name, row.cross_section_dbsm, row.range_metres);
            let LinkFigures { received, sample, range, end, array, .. } = row.link;
            _ = write!(text, "{:>10.1}{:>10.1}{:>10.1}", row.angle_degrees, received.0, sample.0);
            _ = write!(text, "{:>10.1}{:>10.1}{:>10.1}", range.0, end.0, array.0);
        }
        let (least, to) = (DETECTION_SNR.0, self.detected_to_metres);
        _ = write!(text, "\n\nSNR by the whole array falls to {least:.0} dB at {to:.1} m");
        text
    }
}
