//! Exports of pictures, arrays and rows, written on threads of their own.

use super::background::Background;
use super::failures::{RowTable, write_rows_to};
use super::recorded::seen_by;
use crate::app::state::{Purpose, State};
use crate::files::write_bytes;
use crate::maps::RangeAngleMap;
use crate::maps::archive::{write_maps, write_recorded_maps};
use crate::picture::{PictureFormat, compose, compose_recording, maps_of};
use crate::radar::Radar;
use crate::reconstruct::{NoisePrior, Reconstructor, Request};
use crate::recording::Recording;
use crate::signal::{self, BeatSignal, TwoEnds};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Exports under way; each ends in a message for the user.
pub struct Exports(pub Background<Result<String, String>>);

/// Beginning of the message of an export under way, which the message of its end replaces.
pub const EXPORT_MESSAGE_START: &str = "Exporting ";

/// The message after an export to `path`, with a remark about a missing part where there is one.
///
/// # Errors
/// The message of an export that failed.
fn told(path: &Path, written: Result<Option<String>, String>) -> Result<String, String> {
    let path = path.display();
    match written {
        Ok(None) => Ok(format!("Exported {path}")),
        Ok(Some(but)) => Ok(format!("Exported {path}, {but}")),
        Err(error) => Err(format!("{path}: {error}\nNothing was written; choose another place.")),
    }
}

impl Exports {
    /// Draws the panels of `apertura maps` with the method and the settings on screen, as PNG or SVG. Returns the message for the user.
    ///
    /// # Errors
    /// The reason why it could not be begun.
    pub fn picture(&self, state: &State, path: PathBuf) -> Result<String, String> {
        let format = PictureFormat::of_path(&path).ok_or_else(|| Purpose::ExportPicture.unknown_ending(&path))?;
        let Some(method) = state.method().cloned() else {
            return Err("There is no method to draw the output of.".to_owned());
        };
        let (radar, scene) = (state.radar().clone(), state.editor.scene().clone());
        let (recording, style) = (seen_recording(state), state.settings.style(method.name()));
        self.begin(path, move |path| {
            let bytes = match recording {
                Some(recording) => compose_recording(&recording, method.as_ref(), &style, format),
                None => {
                    let seed = scene.noise_seed;
                    let signal = signal::simulate(&radar, &scene, style.floor, seed).map_err(|e| e.to_string())?;
                    compose(&radar, &scene, &signal, method.as_ref(), &style, format)
                }
            };
            let bytes = bytes.map_err(|e| e.to_string())?;
            write_bytes(path, &bytes).map(|()| None).map_err(|e| e.to_string())
        })
    }

    /// Writes samples and maps of the scene on screen, and the output of the method in use, as NumPy arrays. Returns the message for the user.
    ///
    /// # Errors
    /// The reason why it could not be begun.
    pub fn maps(&self, state: &State, path: PathBuf) -> Result<String, String> {
        let (radar, scene) = (state.radar().clone(), state.editor.scene().clone());
        let (floor, normalisation) = (state.settings.floor, state.settings.normalisation);
        let method = state.method().cloned();
        let layout = state.settings.layout_numbers(&radar);
        let hear = move |signal: &BeatSignal| layout.map(|layout| Arc::new(signal.of_layout(&layout)));
        if let Some(recording) = seen_recording(state) {
            let layout_samples = recording.signal().and_then(hear);
            let noise = NoisePrior::UNKNOWN;
            let snapshot_range_metres = recording.range_metres;
            let request = Request { noise, normalisation, snapshot_range_metres, layout_samples, ..Request::default() };
            return self.begin(path, move |path| write_recording(path, &recording, method.as_deref(), &request));
        }
        self.begin(path, move |path| {
            let signal = signal::simulate(&radar, &scene, floor, scene.noise_seed).map_err(|e| e.to_string())?;
            let layout_samples = hear(&signal);
            let request = Request {
                noise: floor.into(),
                normalisation,
                layout_samples: layout_samples.clone(),
                ..Request::default()
            };
            let (output, without) = output_of(method.as_deref(), &radar, &signal.two_ends(&radar), &request);
            let written = write_maps(path, &radar, &scene, &signal, layout_samples.as_deref(), output.as_ref());
            written.map_err(|e| e.to_string()).map(|_| without)
        })
    }

    /// Writes the rows of the panel Evaluate as CSV. Returns the message for the user.
    ///
    /// # Errors
    /// That there are no rows, or the reason why it could not be begun.
    pub fn rows(&self, table: &RowTable, path: PathBuf) -> Result<String, String> {
        if table.rows().is_empty() {
            return Err("There are no rows yet: try methods on scenes first.".to_owned());
        }
        let (rows, conditions) = (table.rows().clone(), table.conditions().clone());
        self.begin(path, move |path| write_rows_to(path, &rows, &conditions).map(|()| None))
    }

    /// Starts an export on a thread. Returns the message that it has begun.
    fn begin(
        &self,
        path: PathBuf,
        write: impl FnOnce(&Path) -> Result<Option<String>, String> + Send + 'static,
    ) -> Result<String, String> {
        let (name, of) = (path.display().to_string(), path.clone());
        let failed = move |why| told(&of, Err(format!("failed: {why}")));
        match self.0.begin("export", move || told(&path, write(&path)), failed) {
            Ok(()) => Ok(format!("{EXPORT_MESSAGE_START}{name}…")),
            Err(error) => Err(format!("{name}: the export could not be started: {error}")),
        }
    }
}

/// The recording on screen, as the radar and the elements of its document change it.
fn seen_recording(state: &State) -> Option<Recording> {
    let document = state.editor.document();
    document.recording().map(|r| seen_by(r, document.radar(), &document.scene().disturbances.elements))
}

/// Writes samples and maps of a recording, and the output of a method. Returns a remark about a missing output.
fn write_recording(
    path: &Path,
    recording: &Recording,
    method: Option<&dyn Reconstructor>,
    request: &Request,
) -> Result<Option<String>, String> {
    let (_, full) = maps_of(recording);
    let ends = recording.two_ends();
    let (output, without) = output_of(method, &recording.radar, &ends, request);
    let layout_samples = request.layout_samples.as_deref();
    let written = write_recorded_maps(path, &recording.radar, &ends, full.as_ref(), layout_samples, output.as_ref());
    written.map_err(|e| e.to_string()).map(|()| without)
}

/// The output of a method, and a remark where it gives none.
fn output_of(
    method: Option<&dyn Reconstructor>,
    radar: &Radar,
    ends: &TwoEnds,
    request: &Request,
) -> (Option<RangeAngleMap>, Option<String>) {
    match method.map(|method| method.reconstruct(radar, ends, request)).transpose() {
        Ok(found) => (found.map(|found| found.lambda), None),
        Err(why) => (None, Some(format!("without the output: {why}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_could_not_be_had_is_told() {
        let export = |written| told(Path::new("maps.npz"), written);
        assert_eq!(export(Ok(None)).unwrap(), "Exported maps.npz");
        assert!(export(Ok(Some("without the output: no".to_owned()))).unwrap().ends_with("without the output: no"));
        assert!(export(Err("disk full".to_owned())).unwrap_err().contains("Nothing was written"));
    }
}
