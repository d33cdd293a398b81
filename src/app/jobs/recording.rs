//! Pictures for slides: a drag as an animation, a lesson's steps as pictures. Both can be stopped, and say where they wrote.

use super::background::Background;
use super::camera::Camera;
use crate::app::state::State;
use crate::files::write_bytes;
use crate::lesson::Lesson;
use crate::methods;
use crate::picture::{ColourMap, PictureFormat, Style, compose};
use crate::platform::{self, Instant};
use crate::radar::counted;
use crate::scene::Scene;
use crate::signal;
use crate::task::{Reply, Task, Worker};
use eframe::egui::{ColorImage, Context};
use image::codecs::gif::{GifEncoder, Repeat};
use image::imageops::{FilterType, resize};
use image::{Delay, Frame, RgbaImage};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// Time from frame to frame.
const INTERVAL: Duration = Duration::from_millis(100);
/// Most frames of an animation: half a minute.
const MOST_FRAMES: usize = 300;
/// Widest animation, pixels.
const WIDEST: u32 = 960;
/// How long after a drag frames are still taken.
const LINGER: Duration = Duration::from_millis(700);
/// How long after a drag its last maps are waited for: they are the last frame.
const LAST_MAPS_WAIT: Duration = Duration::from_secs(60);
/// Frames that may wait to be packed; more are left out.
const WAITING: usize = 4;

/// Where it was written, or why not.
type Told = Result<String, String>;

/// An animation being recorded.
struct Recording {
    path: PathBuf,
    frames: SyncSender<Arc<ColorImage>>,
    task: Task,
    taken: usize,
    last: Option<Instant>,
    /// Whether the last frame shows the maps of the scene at rest.
    is_whole: bool,
    /// When something was last being dragged; `None` before the drag.
    dragged: Option<Instant>,
}

/// What the window shows in a frame.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    /// Whether something is being dragged.
    pub is_dragged: bool,
    /// Whether a map is dimmed, being of an earlier scene.
    pub is_dimmed: bool,
    /// Whether everything that is drawn is of the scene on screen at rest.
    pub is_whole: bool,
}

/// A lesson whose steps are to be drawn.
struct Steps {
    lesson: Arc<Lesson>,
    path: PathBuf,
    colours: ColourMap,
}

/// What records, and what was recorded.
pub struct Recorder {
    wake: Context,
    camera: Camera,
    recording: Option<Recording>,
    steps: Worker<Steps, Told>,
    recorded: Background<Told>,
}

impl Recorder {
    /// Starts the worker that draws lessons; `wake` draws another frame.
    pub fn start(wake: Context) -> Recorder {
        let work = |_: &mut (), steps: Steps, task: &Task| draw_steps(&steps, task);
        let steps = Worker::spawn("lesson pictures", || (), work, platform::waker(&wake));
        let recorded = Background::new(wake.clone());
        Recorder { camera: Camera::new(wake.clone()), wake, recording: None, steps, recorded }
    }

    /// Records the next drag into `path`, a GIF. Returns what to tell.
    ///
    /// # Errors
    /// Why it can't be begun.
    pub fn record_drag(&mut self, mut path: PathBuf) -> Result<String, String> {
        if !platform::has_threads() {
            return Err("Drags are recorded beside the window, which this page can't: open it in a page of its own, or use the desktop program.".to_owned());
        }
        path.set_extension("gif");
        let (frames, arriving) = sync_channel(WAITING);
        let task = Task::default();
        let (theirs, to) = (task.clone(), path.clone());
        let work = move || animate(&to, &arriving, &theirs);
        self.recorded
            .begin("recording", work, |why| Err(format!("failed: {why}")))
            .map_err(|e| format!("{}: the recording can't be started: {e}", path.display()))?;
        let said = format!(
            "Drag something now: it is recorded as {}, without frames in which a map is of an earlier scene. \"Stop recording\" gives it up.",
            path.display()
        );
        self.recording = Some(Recording { path, frames, task, taken: 0, last: None, is_whole: false, dragged: None });
        Ok(said)
    }

    /// Draws every step of the lesson being taken beside `path`, numbered. Returns what to tell.
    ///
    /// # Errors
    /// When no lesson is taken.
    pub fn draw_lesson(&self, state: &State, mut path: PathBuf) -> Result<String, String> {
        let run = state.lesson.as_ref().ok_or("Open a lesson before exporting its steps.")?;
        path.set_extension("png");
        let said = format!("Drawing {}…", counted(run.lesson.steps.len(), "step", "steps"));
        self.steps.request(Steps { lesson: run.lesson.clone(), path, colours: state.settings.colours });
        Ok(said)
    }

    /// Gives up what is recorded or drawn. Returns what to tell.
    pub fn cancel(&mut self) -> Option<String> {
        let drawing = self.steps.is_busy();
        self.steps.cancel();
        let recording = self.recording.take();
        recording.iter().for_each(|r| r.task.cancel());
        let what = recording.map(|r| format!("{} was not written.", r.path.display()));
        what.or_else(|| drawing.then(|| "The remaining steps are not drawn.".to_owned()))
    }

    /// Whether a drag is recorded or waited for, or a lesson is drawn.
    pub fn is_at_work(&self) -> bool {
        self.recording.is_some() || self.steps.is_busy()
    }

    /// Takes a picture of the window where one is due; called at the end of each frame.
    pub fn look(&mut self, window: Window, now: Instant) {
        let Some(recording) = &mut self.recording else { return };
        if window.is_dragged {
            recording.dragged = Some(now);
        }
        let Some(since) = recording.dragged.map(|at| now.duration_since(at)) else { return };
        if recording.taken >= MOST_FRAMES || since > if recording.is_whole { LINGER } else { LAST_MAPS_WAIT } {
            // Letting the frames go ends the thread that packs them.
            self.recording = None;
            return;
        }
        if !window.is_dimmed && recording.last.is_none_or(|last| now.duration_since(last) >= INTERVAL) {
            recording.last = Some(now);
            recording.taken += 1;
            recording.is_whole = window.is_whole && !window.is_dragged;
            let frames = recording.frames.clone();
            // A frame for which there is no room is left out.
            self.camera.take(now, move |picture| _ = frames.try_send(picture));
        }
        self.wake.request_repaint_after(INTERVAL);
    }

    /// Whether a drag is being recorded: no message may stand in its frames.
    pub fn hides_messages(&self, now: Instant) -> bool {
        let dragged = self.recording.as_ref().and_then(|r| r.dragged);
        self.camera.is_taking(now) || dragged.is_some_and(|at| now.duration_since(at) <= LINGER)
    }

    /// What was finished since the last call: where it was written, or why not.
    pub fn poll(&mut self) -> Vec<Told> {
        let mut told = self.recorded.finished();
        told.retain(|told| told.as_ref().err().is_none_or(|e| !e.is_empty()));
        told.extend(self.steps.replies().into_iter().map(|reply| match reply {
            Reply::Done { result, .. } => result,
            Reply::Panicked { message, .. } => Err(format!("Drawing the lesson failed ({message}).")),
        }));
        told
    }
}

/// Packs frames as they come, and writes them all when there are no more. Nothing to tell where it was given up.
fn animate(path: &Path, frames: &Receiver<Arc<ColorImage>>, task: &Task) -> Result<String, String> {
    let nothing = Err(String::new());
    let mut bytes = Vec::new();
    let mut count = 0usize;
    {
        let mut gif = GifEncoder::new_with_speed(&mut bytes, 20);
        gif.set_repeat(Repeat::Infinite).map_err(|e| e.to_string())?;
        let mut size = None;
        for picture in frames {
            if task.is_cancelled() {
                return nothing;
            }
            let frame = shrunk(&picture, &mut size).ok_or("a picture of the window is incomplete")?;
            let delay = Delay::from_saturating_duration(INTERVAL);
            gif.encode_frame(Frame::from_parts(frame, 0, 0, delay)).map_err(|e| e.to_string())?;
            count += 1;
        }
    }
    if task.is_cancelled() {
        return nothing;
    }
    if count == 0 {
        return Err(format!("{}: nothing was recorded, so nothing was written.", path.display()));
    }
    write_bytes(path, &bytes)
        .map_err(|e| format!("{}: {e}\nThe recording is lost; choose another place.", path.display()))?;
    Ok(format!("Recorded {} ({count} frames)", path.display()))
}

/// A frame no wider than [`WIDEST`], of the size of the first one.
fn shrunk(picture: &ColorImage, first: &mut Option<(u32, u32)>) -> Option<RgbaImage> {
    let [width, height] = picture.size.map(|v| v as u32);
    let bytes = picture.pixels.iter().flat_map(|p| p.to_array()).collect();
    let image = RgbaImage::from_raw(width, height, bytes)?;
    let part = f64::from(WIDEST.min(width)) / f64::from(width.max(1));
    let fit = || ((f64::from(width) * part) as u32, ((f64::from(height) * part) as u32).max(1));
    let (across, up) = *first.get_or_insert_with(fit);
    Some(if (across, up) == (width, height) { image } else { resize(&image, across, up, FilterType::Triangle) })
}

/// Draws every step's scene and maps, with the title and the number of the step in it.
fn draw_steps(Steps { lesson, path, colours }: &Steps, task: &Task) -> Result<String, String> {
    let mut written: Vec<PathBuf> = Vec::new();
    let stem = path.file_stem().map_or_else(|| "lesson".to_owned(), |s| s.to_string_lossy().into_owned());
    for (number, step) in (1..).zip(&lesson.steps) {
        if task.is_cancelled() {
            return Err(format!("Stopped: {}", told(&written)));
        }
        let picture = draw_step(lesson, number, step, *colours)?;
        let to = path.with_file_name(format!("{stem}-{number}.png"));
        write_bytes(&to, &picture).map_err(|e| format!("{}: {e}\n{}", to.display(), told(&written)))?;
        written.push(to);
        task.set_progress(number as f32 / lesson.steps.len() as f32);
    }
    Ok(told(&written))
}

fn told(written: &[PathBuf]) -> String {
    match written {
        [] => "no picture was written.".to_owned(),
        [only] => format!("wrote {}", only.display()),
        [first, .., last] => format!("wrote {} pictures, {} to {}", written.len(), first.display(), last.display()),
    }
}

fn draw_step(
    lesson: &Lesson,
    number: usize,
    step: &crate::lesson::Step,
    colours: ColourMap,
) -> Result<Vec<u8>, String> {
    let of_step = step.scene();
    let asks = step.predict.as_ref().map(|q| q.ask.clone()).or_else(|| step.challenge.as_ref().map(|c| c.ask.clone()));
    let scene = Scene {
        name: format!("{}, step {number}", lesson.title),
        notes: asks.unwrap_or_default(),
        noise_seed: step.view.seed,
        ..of_step
    };
    let method = methods::by_name(&step.view.method).unwrap_or_else(|_| methods::preferred_for(&step.radar));
    let style = Style { floor: step.view.floor, normalisation: step.view.normalisation, colours, eta: None };
    let signal = signal::simulate(&step.radar, &scene, style.floor, step.view.seed).map_err(|e| e.to_string())?;
    let draw = |method: &dyn crate::reconstruct::Reconstructor| {
        compose(&step.radar, &scene, &signal, method, &style, PictureFormat::Png).map_err(|e| e.to_string())
    };
    // A network draws nothing for a radar that it doesn't know: any radar has the method of `preferred_for`.
    draw(method.as_ref()).or_else(|_| draw(methods::preferred_for(&step.radar).as_ref()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::Color32;
    use image::AnimationDecoder;
    use image::codecs::gif::GifDecoder;

    fn picture(width: usize, grey: u8) -> Arc<ColorImage> {
        Arc::new(ColorImage::filled([width, 20], Color32::from_gray(grey)))
    }

    #[test]
    fn frames_become_an_animation_of_one_size() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("drag.gif");
        let (send, frames) = sync_channel(9);
        for (width, grey) in [(40, 10), (40, 200), (60, 90)] {
            send.send(picture(width, grey)).unwrap();
        }
        drop(send);
        let said = animate(&path, &frames, &Task::default()).unwrap();
        assert!(said.contains("drag.gif") && said.contains("3 frames"), "{said}");
        let gif = GifDecoder::new(std::io::Cursor::new(std::fs::read(&path).unwrap())).unwrap();
        let frames = gif.into_frames().collect_frames().unwrap();
        assert_eq!(frames.len(), 3);
        assert!(frames.iter().all(|f| f.buffer().dimensions() == (40, 20)), "a window that was resized");
        assert!(frames[1].buffer().get_pixel(3, 3).0[0] > 150 && frames[0].buffer().get_pixel(3, 3).0[0] < 60);
        let wide = shrunk(&picture(2000, 0), &mut None).unwrap();
        assert_eq!(wide.dimensions(), (WIDEST, 9));
    }

    /// Why an animation of these frames was not written.
    fn refusal(pictures: &[Arc<ColorImage>], task: &Task) -> String {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("drag.gif");
        let (send, frames) = sync_channel(9);
        pictures.iter().for_each(|picture| send.send(picture.clone()).unwrap());
        drop(send);
        let why = animate(&path, &frames, task).unwrap_err();
        assert!(!path.exists());
        why
    }

    #[test]
    fn a_recording_that_is_cancelled_writes_nothing() {
        let task = Task::default();
        task.cancel();
        assert_eq!(refusal(&[picture(40, 1)], &task), "");
    }

    #[test]
    fn an_empty_recording_is_told() {
        assert!(refusal(&[], &Task::default()).contains("nothing was recorded"));
    }

    #[test]
    fn no_frame_is_taken_while_a_map_is_dimmed() {
        let folder = tempfile::tempdir().unwrap();
        let mut recorder = Recorder::start(Context::default());
        recorder.record_drag(folder.path().join("a")).unwrap();
        let began = Instant::now();
        for (tenth, is_dimmed) in [false, true, true, false, true].into_iter().enumerate() {
            let window = Window { is_dragged: true, is_dimmed, is_whole: false };
            recorder.look(window, began + Duration::from_millis(110 * tenth as u64));
        }
        assert_eq!(recorder.recording.as_ref().unwrap().taken, 2);
        assert!(recorder.hides_messages(began + Duration::from_millis(500)));
    }

    #[test]
    fn a_recording_lasts_from_the_drag_until_its_maps_have_come() {
        let folder = tempfile::tempdir().unwrap();
        let mut recorder = Recorder::start(Context::default());
        recorder.record_drag(folder.path().join("a")).unwrap();
        let began = Instant::now();
        let at = |ms: u64| began + Duration::from_millis(ms);
        let look = |recorder: &mut Recorder, is_dragged: bool, is_whole: bool, ms: u64| {
            recorder.look(Window { is_dragged, is_dimmed: false, is_whole }, at(ms));
        };
        look(&mut recorder, false, true, 0);
        assert_eq!(recorder.recording.as_ref().unwrap().taken, 0, "nothing is dragged yet");
        for ms in [10, 50, 120, 130, 250] {
            look(&mut recorder, true, false, ms);
        }
        assert_eq!(recorder.recording.as_ref().unwrap().taken, 3, "one in a tenth of a second");
        look(&mut recorder, false, false, 600);
        assert_eq!(recorder.recording.as_ref().unwrap().taken, 4);
        look(&mut recorder, false, false, 5000);
        look(&mut recorder, false, true, 5110);
        assert_eq!(recorder.recording.as_ref().unwrap().taken, 6, "the last maps took five seconds");
        look(&mut recorder, false, true, 5220);
        assert!(recorder.recording.is_none() && !recorder.is_at_work());
        recorder.record_drag(folder.path().join("b")).unwrap();
        assert!(recorder.cancel().unwrap().contains("b.gif was not written"));
        assert_eq!(recorder.cancel(), None);
    }

    #[test]
    fn a_lesson_is_drawn_step_by_step_until_it_is_stopped() {
        let folder = tempfile::tempdir().unwrap();
        let text = "format = 1\ntitle = \"T\"\nabout = \"A.\"\n\n[[step]]\ntext = \"Look.\"\nradar = { elements = 64, samples = 32 }\n\
                    view = { method = \"baseline\" }\n[[step.object]]\nkind = \"point\"\nx_metres = 0.2\ny_metres = 1.5\n\
                    [step.predict]\nask = \"Which?\"\nright = \"Yes.\"\nwrong = \"No.\"\n\
                    answer = { kind = \"choice\", options = [\"a\", \"b\"], right = 1 }\n";
        let lesson = Arc::new(Lesson::from_toml(text).unwrap());
        let steps = Steps { lesson, path: folder.path().join("slides.png"), colours: ColourMap::Grey };
        let said = draw_steps(&steps, &Task::default()).unwrap();
        assert!(said.contains("slides-1.png"), "{said}");
        let drawn = image::open(folder.path().join("slides-1.png")).unwrap();
        assert!(drawn.width() > 400);
        let task = Task::default();
        task.cancel();
        assert!(draw_steps(&steps, &task).unwrap_err().contains("no picture was written"));
    }
}
