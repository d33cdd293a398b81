//! Pictures, arrays and figures for other programs.

use super::application::App;
use crate::files::archive::write_maps;
use crate::files::write_bytes;
use crate::picture::{Format, Style, compose};
use crate::signal;
use crate::task::panic_message;
use eframe::egui::{ColorImage, Context};
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::Sender;

/// Writes a picture: what the window shows as PNG, or all panels of the scene drawn afresh as SVG.
pub(super) fn picture(app: &mut App, ctx: &Context, path: PathBuf) {
    match Format::of_path(&path) {
        Some(Format::Svg) => drawing(app, ctx, path),
        _ => window(app, ctx, path),
    }
}

/// Takes a picture of the window and writes it as PNG.
fn window(app: &mut App, ctx: &Context, mut path: PathBuf) {
    path.set_extension("png");
    let (done, wake) = (app.exports.0.clone(), ctx.clone());
    ctx.request_screenshot(move |picture| {
        // Compressing takes longer than a frame.
        if let Err(error) = in_background(done, wake, path, move |path| write_png(path, &picture)) {
            tracing::warn!("the picture could not be exported: {error}");
        }
    });
}

/// Draws the panels that `apertura maps` draws, with the method and the settings on screen.
fn drawing(app: &mut App, ctx: &Context, path: PathBuf) {
    let Some(method) = app.method() else { return app.error("There is no method to draw the output of.") };
    let (radar, scene) = (app.radar.clone(), app.editor.scene().clone());
    let style = Style {
        floor: app.settings.floor,
        normalisation: app.settings.normalisation,
        colours: app.settings.colours,
        eta: Some(app.output_eta()),
    };
    let seed = app.settings.seed;
    start(app, ctx, path, move |path| {
        let signal = signal::simulate(&radar, &scene, style.floor, seed).map_err(|e| e.to_string())?;
        let bytes =
            compose(&radar, &scene, &signal, method.as_ref(), &style, Format::Svg).map_err(|e| e.to_string())?;
        write_bytes(path, &bytes).map_err(|e| e.to_string())
    });
}

/// Starts an export that takes a moment, and says so.
fn start(
    app: &mut App,
    ctx: &Context,
    path: PathBuf,
    write: impl FnOnce(&Path) -> Result<(), String> + Send + 'static,
) {
    let name = path.display().to_string();
    match in_background(app.exports.0.clone(), ctx.clone(), path, write) {
        Ok(()) => app.info(format!("Exporting {name}…")),
        Err(error) => app.error(format!("{name}: the export could not be started: {error}")),
    }
}

/// Writes a file on a thread of its own; a panic there is an error like any other.
fn in_background(
    done: Sender<Export>,
    wake: Context,
    path: PathBuf,
    write: impl FnOnce(&Path) -> Result<(), String> + Send + 'static,
) -> std::io::Result<()> {
    let work = move || {
        let written = catch_unwind(AssertUnwindSafe(|| write(&path)))
            .unwrap_or_else(|panic| Err(format!("failed: {}", panic_message(panic.as_ref()))));
        // The window may be gone by now.
        let _closed = done.send(Export { path, written });
        wake.request_repaint();
    };
    std::thread::Builder::new().name("export".to_owned()).spawn(work).map(|_| ())
}

fn write_png(path: &Path, picture: &ColorImage) -> Result<(), String> {
    let [width, height] = picture.size;
    let bytes = picture.pixels.iter().flat_map(|p| p.to_array()).collect();
    let image = image::RgbaImage::from_raw(width as u32, height as u32, bytes).ok_or("the picture is incomplete")?;
    let mut png = Cursor::new(Vec::new());
    image.write_to(&mut png, image::ImageFormat::Png).map_err(|e| e.to_string())?;
    write_bytes(path, png.get_ref()).map_err(|e| e.to_string())
}

/// Writes samples and maps of the scene on screen as NumPy arrays, on a thread of its own: it takes a moment.
pub(super) fn maps(app: &mut App, ctx: &Context, mut path: PathBuf) {
    path.set_extension("npz");
    let (radar, scene) = (app.radar.clone(), app.editor.scene().clone());
    let (floor, seed) = (app.settings.floor, app.settings.seed);
    start(app, ctx, path, move |path| {
        let signal = signal::simulate(&radar, &scene, floor, seed).map_err(|e| e.to_string())?;
        write_maps(path, &radar, &scene, &signal).map_err(|e| e.to_string())
    });
}

/// What came of an export on another thread.
pub(super) struct Export {
    path: PathBuf,
    written: Result<(), String>,
}

/// Tells what came of exports on other threads.
pub(super) fn poll(app: &mut App) {
    while let Ok(export) = app.exports.1.try_recv() {
        report(app, &export.path, export.written);
    }
}

/// Writes the figures of the scene on screen as CSV.
pub(super) fn metrics(app: &mut App, path: &Path) {
    let Some(result) = &app.pipeline.result else { return app.error("There are no maps yet; try again in a moment.") };
    let Some(scores) = result.scores else {
        return app.error("There are no figures: show an output panel and place a reflector first.");
    };
    let m = scores.metrics;
    let detection = m.detection.map_or_else(String::new, |d| d.to_string());
    let scene = app.editor.scene().name.replace('"', "'");
    let method = app.pipeline.output.as_ref().map_or("", |o| o.method);
    let milliseconds = app.pipeline.output.as_ref().map_or(f64::NAN, |o| o.took.as_secs_f64() * 1e3);
    let text = format!(
        "scene,reflectors,method,floor,normalisation,eta,squared_error,detection,false_alarm,target_blobs,output_blobs,milliseconds\n\
         \"{scene}\",{},{method},{},{},{},{},{detection},{},{},{},{milliseconds:.3}\n",
        result.scene.reflector_count(),
        app.settings.floor,
        app.settings.normalisation,
        app.output_eta(),
        m.squared_error,
        m.false_alarm,
        scores.target_blobs,
        scores.output_blobs,
    );
    let written = write_bytes(path, text.as_bytes()).map_err(|e| e.to_string());
    report(app, path, written);
}

fn report(app: &mut App, path: &Path, written: Result<(), String>) {
    match written {
        Ok(()) => app.info(format!("Exported {}", path.display())),
        Err(error) => app.error(format!("{}: {error}\nNothing was written; choose another place.", path.display())),
    }
}
