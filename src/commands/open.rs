//! No subcommand: the app, or a picture where there is no display.

use super::input::InputArgs;
use super::own_method::OwnMethodArgs;
use super::{CommandError, print, write_file};
use crate::methods;
use crate::picture::{PictureFormat, Style, compose, compose_recording, is_our_png};
use crate::platform::console;
use crate::reconstruct::Reconstructor;
use crate::scene::file::SceneFile;
use crate::scene::presets;
use crate::signal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// What to open.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene (.toml or .npz), recording (.toml with [recording]) or text that was copied in the app (apertura:...) to open
    pub scene: Option<PathBuf>,

    /// Reconstruction to begin with in the app, or to draw where there is no display
    #[arg(long, value_name = "NAME")]
    pub method: Option<String>,

    /// Weights of the live network, as training/train_live.py writes them: a method called "live-" and the file's name without its ending.
    /// Several files are several methods
    #[cfg(feature = "live")]
    #[arg(long, value_name = "FILE")]
    weights: Vec<PathBuf>,

    #[command(flatten)]
    own: OwnMethodArgs,

    /// Write the app's time for every frame to this CSV file
    #[arg(long, value_name = "FILE")]
    pub frame_log: Option<PathBuf>,
}

/// Name of the picture drawn where there is no display.
const PICTURE_FILE: &str = "apertura.png";

impl Args {
    /// Opens the app; without one, or without a display, says so and draws the scene's panels to a picture.
    pub fn run(mut self) -> Result<(), CommandError> {
        let started = Instant::now();
        let own = self.own.start()?;
        #[cfg(feature = "live")]
        let own = own.into_iter().chain(self.networks()?).collect::<Vec<_>>();
        self.method = self.method.or_else(|| own.first().map(|name| (*name).to_owned()));
        let input = match &self.scene {
            Some(path) => InputArgs::load(path)?,
            None => InputArgs::Scene(Box::new(presets::default_scene())),
        };
        let method = self.method.as_deref().map(methods::by_name).transpose()?;
        let Some(reason) = self.open_window(started)? else { return Ok(()) };
        let reason = shortened(&reason);
        console::say(&format!("apertura: {reason}; drawing its panels to a picture instead"));
        draw_instead(&input, method)
    }

    /// Adds the networks of --weights to the methods; their names.
    #[cfg(feature = "live")]
    fn networks(&self) -> Result<Vec<&'static str>, CommandError> {
        let name = |path: &PathBuf| methods::add_weights(path).map(|method| method.name());
        self.weights.iter().map(name).collect::<Result<_, _>>().map_err(CommandError)
    }

    /// Opens the window until it is closed; the reason where there can be none.
    #[cfg(feature = "app")]
    fn open_window(self, started: Instant) -> Result<Option<String>, CommandError> {
        use crate::app::{self, AppError};
        let shared = self.scene.as_deref().and_then(super::input::shared_text);
        let shared = shared.map(|text| app::DocumentCommand::OpenShared(text.to_owned()).into());
        let options = app::Options {
            scene: self.scene.filter(|_| shared.is_none()),
            commands: shared.into_iter().collect(),
            method: self.method,
            frame_log: self.frame_log,
            started: Some(started),
            ..app::Options::default()
        };
        match app::run(options) {
            Ok(()) => Ok(None),
            Err(error @ AppError::Window(_)) => Ok(Some(error.to_string())),
            Err(error) => Err(error.into()),
        }
    }

    #[cfg(not(feature = "app"))]
    fn open_window(self, _: Instant) -> Result<Option<String>, CommandError> {
        Ok(Some("this build has no app".to_owned()))
    }
}

/// The window library's message without the line of its source and the list of backends that it tried.
fn shortened(message: &str) -> String {
    let plain = message.split_once("os error at ").and_then(|(before, after)| {
        let (_, place_and_reason) = after.split_once(".rs:")?;
        let (_, reason) = place_and_reason.split_once(": ")?;
        Some(format!("{before}{reason}"))
    });
    let plain = plain.or_else(|| {
        let (before, after) = message.split_once("Found no glutin configs")?;
        let (_, reason) = after.rsplit_once("Error: ")?;
        Some(format!("{before}there is no OpenGL here ({reason})"))
    });
    plain.as_deref().unwrap_or(message).trim_end_matches('.').to_owned()
}

fn draw_instead(input: &InputArgs, method: Option<Arc<dyn Reconstructor>>) -> Result<(), CommandError> {
    let style = Style::default();
    let bytes = match input {
        InputArgs::Scene(file) => {
            let SceneFile { scene, radar } = &**file;
            let signal = signal::simulate(radar, scene, style.floor, scene.noise_seed)?;
            let method = method.unwrap_or_else(|| methods::preferred_for(radar));
            compose(radar, scene, &signal, method.as_ref(), &style, PictureFormat::Png)
        }
        InputArgs::Recording(recording) => {
            let method = method.unwrap_or_else(|| methods::preferred_for(&recording.radar));
            compose_recording(recording, method.as_ref(), &style, PictureFormat::Png)
        }
    }?;
    let path = free_name(Path::new("."));
    write_file(&path, &bytes)?;
    print(&format!("wrote {}", path.display()))
}

/// `apertura.png`, or `apertura-2.png` and so on where that name is taken by a file that this program did not draw.
fn free_name(folder: &Path) -> PathBuf {
    let ours = |path: &Path| std::fs::read(path).is_ok_and(|bytes| is_our_png(&bytes));
    let path = |number: u32| {
        let name = if number == 1 { PICTURE_FILE.to_owned() } else { format!("apertura-{number}.png") };
        if folder == Path::new(".") { PathBuf::from(name) } else { folder.join(name) }
    };
    let is_free = |path: &PathBuf| std::fs::symlink_metadata(path).is_err() || ours(path);
    (1..u32::MAX).map(path).find(is_free).unwrap_or_else(|| path(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_short_sentences_that_name_no_source_file() {
        let message = "no window: winit EventLoopError: os error at /somewhere/linux/mod.rs:765: DISPLAY is not set.";
        assert_eq!(shortened(message), "no window: winit EventLoopError: DISPLAY is not set");
        assert_eq!(shortened("this build has no app"), "this build has no app");
        let message =
            "no window: Found no glutin configs matching the template: ConfigTemplate { api: None }. Error: not found";
        assert_eq!(shortened(message), "no window: there is no OpenGL here (not found)");
    }

    #[test]
    fn a_foreign_picture_keeps_its_name() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(free_name(folder.path()), folder.path().join("apertura.png"));
        std::fs::write(folder.path().join("apertura.png"), "my holiday").unwrap();
        assert_eq!(free_name(folder.path()), folder.path().join("apertura-2.png"));
    }
}
