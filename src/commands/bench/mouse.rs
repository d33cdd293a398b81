//! One reflector dragged with the mouse: from the pointer's move, through the editor and the worker's thread, until three Lambda maps
//! are back.

use crate::benchmark::front::{MapConvention, scattered};
use crate::commands::CommandError;
use crate::engine::{Engine, EngineFrame, MapRequest};
use crate::interact::{Editor, Place, Snap};
use crate::radar::Radar;
use crate::scene::{Scene, SceneError};
use crate::task::{Reply, Worker};
use serde::Serialize;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Instant;

const REFLECTORS: [usize; 2] = [10, 300];
const MOVES: usize = 100;
/// Moves before those: the reflector leaves the sum at rest.
const WARM_UP: usize = 4;
/// Metres of scene beneath a point of the view, as in a canvas of some 600 points.
const METRES_PER_POINT: f64 = 0.1;

const PAIRS: [usize; 2] = [12, 16];

#[derive(Debug, Serialize)]
pub struct MouseRow {
    elements: usize,
    of_pairs: bool,
    reflectors: usize,
    #[serde(flatten)]
    convention: MapConvention,
    moves: usize,
    median_ms: f64,
    worst_ms: f64,
}

impl MouseRow {
    /// A line of the table, times also as multiples of `bare_fft_ms`.
    pub fn line(&self, bare_fft_ms: f64) -> String {
        let [transmitters, receivers] = PAIRS;
        let radar = if self.of_pairs { format!(", {transmitters} x {receivers} pairs") } else { String::new() };
        format!(
            "dragging one of {:>3} by mouse{radar}, {}: {:.2} ms from the move to three maps ({:.1} x bare), {:.2} ms at worst of {}",
            self.reflectors,
            self.convention,
            self.median_ms,
            self.median_ms / bare_fft_ms,
            self.worst_ms,
            self.moves
        )
    }
}

type Asked = (Arc<Scene>, MapRequest);
type Answer = Result<EngineFrame, SceneError>;

/// Drags in small and large scenes, over no floor and over the thesis', with the thesis' radar and with one of pairs.
pub fn measure() -> Result<Vec<MouseRow>, CommandError> {
    let [transmitters, receivers] = PAIRS;
    let pairs = Radar::default().of_pairs(transmitters, receivers).map_err(CommandError::failed)?;
    let mut rows = drags(&Radar::default())?;
    rows.extend(drags(&pairs)?);
    Ok(rows)
}

fn drags(radar: &Radar) -> Result<Vec<MouseRow>, CommandError> {
    let (wake, woken) = channel();
    let own = radar.clone();
    let worker: Worker<Asked, Answer> = Worker::spawn(
        "maps",
        move || Engine::new(own.clone()),
        |engine, (scene, wanted): Asked, _| engine.update(&scene, &wanted),
        move || wake.send(()).unwrap_or_default(),
    );
    let mut rows = Vec::new();
    for reflectors in REFLECTORS {
        for convention in MapConvention::BOTH {
            let [median_ms, worst_ms] = drag(&worker, &woken, reflectors, convention)?;
            let (elements, of_pairs) = (radar.elements, !radar.is_monostatic());
            rows.push(MouseRow { elements, of_pairs, reflectors, convention, moves: MOVES, median_ms, worst_ms });
        }
    }
    Ok(rows)
}

/// Median and longest time of a move, milliseconds.
fn drag(
    worker: &Worker<Asked, Answer>,
    woken: &Receiver<()>,
    reflectors: usize,
    convention: MapConvention,
) -> Result<[f64; 2], CommandError> {
    let wanted = MapRequest {
        floor: convention.floor,
        normalisation: convention.normalisation,
        ends: false,
        ..MapRequest::default()
    };
    let mut editor = Editor::new(scattered(reflectors));
    let shown = || -> Result<(), CommandError> {
        woken.recv().map_err(CommandError::failed)?;
        for reply in worker.replies() {
            match reply {
                Reply::Done { result, .. } => drop(result.map_err(CommandError::failed)?),
                Reply::Panicked { message, .. } => return Err(CommandError::failed(message)),
            }
        }
        Ok(())
    };
    worker.request((editor.scene().clone(), wanted));
    shown()?;
    let start = editor.scene().objects.first().map(|o| Place::from(o.centre_metres()));
    let hit = start.and_then(|start| Some((start, editor.hit(start, METRES_PER_POINT)?)));
    let Some((start, hit)) = hit else { return Err(CommandError::failed("the scene has nothing to drag")) };
    editor.begin_drag(hit, start);
    let mut times = Vec::new();
    for step in 1..=WARM_UP + MOVES {
        let pointer = Place::new(start.x_metres + 0.01 * step as f64, start.y_metres + 0.005 * step as f64);
        let begin = Instant::now();
        editor.drag_to(pointer, Snap::Off);
        worker.request((editor.scene().clone(), wanted));
        shown()?;
        if step > WARM_UP {
            times.push(1e3 * begin.elapsed().as_secs_f64());
        }
    }
    times.sort_by(f64::total_cmp);
    Ok([times[MOVES / 2], times[MOVES - 1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_drag_is_timed() {
        let rows = measure().unwrap();
        assert_eq!(rows.len(), 8);
        assert_eq!(rows.iter().filter(|row| row.of_pairs && row.elements == 192).count(), 4);
        for row in rows {
            assert!(row.median_ms > 0.0 && row.median_ms <= row.worst_ms, "{row:?}");
            assert!(row.line(1.0).contains(&format!("one of {:>3}", row.reflectors)));
        }
    }
}
