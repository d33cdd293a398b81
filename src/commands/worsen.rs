//! `apertura worsen`: a search near a scene for one on which a method does worse, or for the smallest move after which it is right.

use super::arguments::{FloorArgs, chosen, real, seed, whole};
use super::network_args::NetworkArgs;
use super::{CommandError, print};
use crate::evaluate::worsen::{Finding, WorseningGoal, WorseningMeasure, WorseningOutcome, WorseningSearch, summary};
use crate::files::ends_in;
use crate::radar::counted;
use crate::scene::Scene;
use crate::scene::file::{self, SceneFile};
use crate::task::Task;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Search near a scene for one on which a method does worse, or for the smallest move after which it is right
///
/// Objects move by at most --within, and bodies turn by up to 45 degrees. Their echoes change by up to 6 dB against each other, and new noise is drawn. The same seed gives the same
/// scene if --tries ends the search, and not --minutes. With --repair only objects move. An output is right if no object is missed, merged or on a
/// wrong tooth (--measure missed), if it has no false alarm (ghosts), or else if it has a fifth of the squared error. Prints figures before and
/// after. Writes OUT.toml if the search succeeds.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene to start from (.toml or .npz)
    scene: PathBuf,

    /// Reconstruction method [default: that of --method-command]
    #[arg(long, value_name = "NAME", required_unless_present = "method_command")]
    method: Option<String>,

    /// The figure that should get worse
    #[arg(long, value_name = "squared-error|missed|ghosts", default_value_t)]
    measure: WorseningMeasure,

    /// Search for the smallest move after which the method is right instead
    #[arg(long)]
    repair: bool,

    /// How far objects may move, metres
    #[arg(long, value_name = "METRES", default_value_t = WorseningSearch::default().within_metres,
          value_parser = real(MIN_REACH_METRES..=1000.0))]
    within: f64,

    /// Scenes to try [default: 256; no limit with --minutes]
    #[arg(long, value_name = "N", value_parser = whole(1..=u32::MAX))]
    tries: Option<u32>,

    /// Stop after this many minutes [default: 10]
    #[arg(long, value_name = "T", value_parser = real(0.001..=MAX_MINUTES))]
    minutes: Option<f64>,

    /// Seed of the scenes that are tried
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = seed)]
    seed: u64,

    /// Scene file to write
    #[arg(short, long, value_name = "OUT.toml")]
    output: PathBuf,

    #[command(flatten)]
    network: NetworkArgs,

    #[command(flatten)]
    floor: FloorArgs,
}

/// Smallest reach of a search, metres: smaller moves change no visible cell of a map.
const MIN_REACH_METRES: f64 = 1e-6;

/// A year.
const MAX_MINUTES: f64 = 525_600.0;

impl Args {
    pub fn run(self) -> Result<(), CommandError> {
        if !ends_in(&self.output, &["toml"]) {
            return Err(CommandError::on(&self.output)("a scene is written as TOML; expected a name ending in .toml"));
        }
        let time = Duration::from_secs_f64(60.0 * self.minutes.unwrap_or(10.0));
        let SceneFile { scene, radar } = file::load(&self.scene)?;
        let own = self.network.start_own()?;
        let methods = self.network.methods(&chosen(self.method.as_slice(), &own, ""))?;
        let [method] = methods.as_slice() else { return Err(CommandError("--method takes one name".into())) };
        let search = WorseningSearch {
            radar: radar.clone(),
            floor: self.floor.floor(),
            goal: if self.repair { WorseningGoal::Repair } else { WorseningGoal::Worsen },
            measure: self.measure,
            within_metres: self.within,
            tries: self.most_tries(),
            seed: self.seed,
            ..WorseningSearch::default()
        };
        let begin = Instant::now();
        let by_clock = self.most_tries() == u32::MAX;
        let bar = indicatif::ProgressBar::new(if by_clock { time.as_secs().max(1) } else { search.tries.into() });
        let on_try = |tries: u32, _: &[Finding]| {
            bar.set_position(if by_clock { begin.elapsed().as_secs() } else { tries.into() });
            begin.elapsed() < time
        };
        let outcome =
            search.run(&scene, method.as_ref(), &Task::default(), on_try).map_err(CommandError::on(&self.scene))?;
        bar.finish_and_clear();
        let Some((start, end)) = outcome.ends() else { return Err(CommandError("nothing was tried".into())) };
        print(&format!("before: {}", self.figures(start)))?;
        let Some(end) = end else { return self.nothing(&outcome) };
        print(&format!("after:  {}", self.figures(end)))?;
        print(&changes(&scene, &end.scene))?;
        self.print_end(&outcome, end)?;
        let notes = format!("{} before, {} after, by {}", self.figures(start), self.figures(end), method.name());
        let name = format!("{} than {}", if self.repair { "Better" } else { "Worse" }, called(&scene, &self.scene));
        let found = SceneFile { scene: Scene { name, notes, ..end.scene.clone() }, radar };
        file::save(&self.output, &found)?;
        print(&format!("wrote {}", self.output.display()))
    }

    fn most_tries(&self) -> u32 {
        let otherwise = if self.minutes.is_some() { u32::MAX } else { WorseningSearch::default().tries };
        self.tries.unwrap_or(otherwise)
    }

    fn figures(&self, finding: &Finding) -> String {
        let m = &finding.metrics;
        let detection = m.detection.map_or("-".to_owned(), |d| format!("{:.2} %", 100.0 * d));
        let mut text = format!("SE {:.1}, P_D {detection}, P_FA {:.2} %", m.squared_error, 100.0 * m.false_alarm);
        if self.measure != WorseningMeasure::SquaredError {
            text += &format!("; {}", summary(&finding.verdicts));
        }
        text
    }

    fn print_end(&self, outcome: &WorseningOutcome, end: &Finding) -> Result<(), CommandError> {
        let WorseningOutcome { tries, .. } = outcome;
        print(&format!("try {} of {tries} with seed {}", end.tries, self.seed))?;
        if *tries < self.most_tries() {
            return print(&format!("ended by the clock; --tries {tries} repeats this search"));
        }
        Ok(())
    }

    fn nothing(&self, outcome: &WorseningOutcome) -> Result<(), CommandError> {
        if self.repair && outcome.tries == 0 {
            return print("nothing to repair");
        }
        let what = if self.repair { "on which the method is right" } else { "worse than this" };
        let message = format!(
            "no scene {what} within {} m in {}; try a larger --within, more --tries, or another --seed",
            self.within,
            counted(outcome.tries, "try", "tries")
        );
        Err(CommandError(message))
    }
}

fn called(scene: &Scene, path: &std::path::Path) -> String {
    if scene.name.is_empty() { path.display().to_string() } else { scene.name.clone() }
}

fn changes(before: &Scene, after: &Scene) -> String {
    let mut lines = Vec::new();
    for (i, (a, b)) in before.objects.iter().zip(&after.objects).enumerate() {
        let ([ax, ay], [bx, by]) = (a.centre_metres(), b.centre_metres());
        let (dx, dy) = (bx - ax, by - ay);
        let mut line =
            format!("object {} ({}): moved by {dx:+.3} m, {dy:+.3} m ({:.3} m)", i + 1, a.kind(), dx.hypot(dy));
        let turned = b.turned_degrees(a);
        if turned.abs() > 0.05 {
            line += &format!(", turned by {turned:+.1} degrees");
        }
        let db = 20.0 * (b.reflectivity() / a.reflectivity()).abs().log10();
        if db.abs() > 0.005 {
            line += &format!(", echo {db:+.2} dB");
        }
        lines.push(line);
    }
    if before.noise_seed != after.noise_seed {
        lines.push(format!("noise seed {} in place of {}", after.noise_seed, before.noise_seed));
    }
    lines.join("\n")
}
