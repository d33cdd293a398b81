//! Detection by echo: the echoes that stand out in the target, and those of them that an output shows.
//!
//! P_D counts cells whose Lambda exceeds 0.9 in the target. The end of a wall lies 30 to 60 dB below its glint and never counts there, so that
//! a method that finds glints alone looks perfect. Here each echo counts once, in classes of 10 dB below the strongest.

use crate::maps::{LambdaScale, RangeAngleMap};
use crate::radar::{End, Pair, Radar};
use crate::scattering::{EchoKind, EchoSources, PathEcho, Sources, array_centre_echoes};
use crate::scene::Scene;
use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// Classes of 10 dB below the strongest echo; the last class also has all weaker echoes.
pub const CLASSES: usize = 6;

/// An echo counts if it stands out of its surroundings in the target by this much, in dB.
const STANDS_OUT_DB: f64 = 10.0;
/// An output shows an echo that stands out of its surroundings there by this much, in dB.
const SHOWN_DB: f64 = 3.0;
/// No scene has more echoes in one class; a table with a larger count is damaged.
const MAX_ECHOES_OF_CLASS: usize = 1 << 30;
/// Half a resolution cell, in range bins.
const HALF_BINS: f64 = 1.0;
/// Half a resolution cell, in columns, for an echo that no near field smears.
const HALF_COLUMNS: f64 = 1.5;
/// Width of an echo's surroundings beyond its cell, in rows and columns.
const SURROUNDING_CELLS: usize = 5;

/// Numbers of echoes, one a class of strength; tables of rows have spaces between them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct EchoCounts(pub [usize; CLASSES]);

impl fmt::Display for EchoCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.map(|count| count.to_string()).join(" "))
    }
}

impl FromStr for EchoCounts {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let counts: Result<Vec<usize>, _> = text.split_whitespace().map(str::parse).collect();
        let counts = counts.ok().and_then(|counts| <[usize; CLASSES]>::try_from(counts).ok());
        let counts = counts.filter(|counts| counts.iter().all(|count| *count <= MAX_ECHOES_OF_CLASS));
        counts.map(EchoCounts).ok_or_else(|| format!("\"{text}\" counts no echoes; expected six whole numbers from 0"))
    }
}

/// Numbers of echoes that stand out in targets, and of those that an output shows, by classes of strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct EchoTally {
    /// Echoes that stand out in the target, one number a class.
    pub there: [usize; CLASSES],
    /// Echoes among them that the output shows.
    pub found: [usize; CLASSES],
}

impl EchoTally {
    /// Adds the counts of `other`.
    pub fn add(&mut self, other: &EchoTally) {
        for class in 0..CLASSES {
            self.there[class] += other.there[class];
            self.found[class] += other.found[class];
        }
    }

    /// Part of all echoes that were found; `None` where there are none.
    pub fn part(&self) -> Option<f64> {
        let all: usize = self.there.iter().sum();
        (all > 0).then(|| self.found.iter().sum::<usize>() as f64 / all as f64)
    }
}

/// Place of an echo in a map: the centre of its peak, in range bins and columns, and the peak's half width in columns.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shown {
    bin: f64,
    column: f64,
    half_columns: f64,
    /// Level of the echo below the scene's strongest, in dB.
    below_db: f64,
}

/// Places of the echoes of `scene` in a map, without those of rough surfaces, which have no place of their own.
fn shown(radar: &Radar, scene: &Scene) -> Vec<Shown> {
    let echoing = EchoSources::of(radar, scene);
    let mut heard = Vec::new();
    Sources::from(&echoing).scattered(Pair::at(0.0), &mut heard);
    let points = echoing.points.iter().map(|r| {
        let range = r.x_metres.hypot(r.y_metres);
        let left = radar.pattern().map_or(1.0, |pattern| pattern.amplitude(r.y_metres / range).powi(2));
        let strength = left * radar.transmit_power_watts * r.reflectivity.abs() / (range * range);
        ([r.x_metres, r.y_metres], range, strength, false)
    });
    let bodies = heard.iter().filter(|e| e.is_heard() && e.kind != EchoKind::Diffuse);
    let of_body = |e: &PathEcho| (e.place_metres, e.range_metres, e.amplitude.norm(), e.kind == EchoKind::Glint);
    let all: Vec<_> = points.chain(bodies.map(of_body)).filter(|(_, _, strength, _)| *strength > 0.0).collect();
    let strongest = all.iter().map(|(_, _, strength, _)| *strength).fold(0.0, f64::max);
    all.into_iter()
        .map(|(place, range, strength, is_glint)| Shown {
            below_db: 20.0 * (strongest / strength).log10(),
            ..Shown::at(radar, place, range, is_glint)
        })
        .filter(|shown| shown.is_in_range(radar))
        .collect()
}

impl Shown {
    /// The place in a map of an echo from `[x, y]`, at a range in metres; the caller sets its level.
    fn at(radar: &Radar, [x, y]: [f64; 2], range: f64, is_glint: bool) -> Shown {
        let cos = |centre: f64| radar.blob_of(centre, x, y).cos_theta;
        let [first, last] = End::BOTH.map(|end| cos(radar.end_centre_metres(end)));
        let per_cos = radar.elements as f64 / radar.fold_period_cos();
        // The near field smears all but the glints of flat faces, whose direction is the same from every element.
        let smeared = if is_glint { 0.0 } else { (first - last).abs() * per_cos / 2.0 };
        Shown {
            bin: radar.bin_of_range(range),
            column: radar.column_of_cos(cos(0.0)),
            half_columns: HALF_COLUMNS + smeared,
            below_db: 0.0,
        }
    }

    fn is_in_range(&self, radar: &Radar) -> bool {
        self.bin + HALF_BINS < radar.samples as f64 - 1.0
    }

    /// The rows of the echo's place, and its first and last column, which may lie beyond the map's edge: columns wrap around.
    fn window(&self, [rows, columns]: [usize; 2]) -> (RangeInclusive<usize>, [i64; 2]) {
        let (low, high) = ((self.bin - HALF_BINS).round().max(0.0), (self.bin + HALF_BINS).round());
        let half = self.half_columns.min(columns as f64 / 4.0);
        let ends = [self.column - half, self.column + half].map(|column| column.round() as i64);
        (low as usize..=(high as usize).min(rows - 1), ends)
    }
}

/// For each object of `scene`, the cells in which its ends, corners and glints stand out in `target`, strongest first; empty for no body.
pub(super) fn of_bodies(
    radar: &Radar,
    scene: &Scene,
    target: &RangeAngleMap,
    scale: &LambdaScale,
) -> Vec<Vec<Vec<[usize; 2]>>> {
    let mut of = vec![Vec::new(); scene.objects.len()];
    if !scene.has_bodies() {
        return of;
    }
    let decibels_of_lambda = scale.decibels();
    let mut heard = array_centre_echoes(radar, scene);
    heard.retain(|(_, echo)| echo.kind != EchoKind::Diffuse);
    heard.sort_by(|a, b| b.1.amplitude.norm().total_cmp(&a.1.amplitude.norm()));
    for (index, echo) in heard {
        let shown = Shown::at(radar, echo.place_metres, echo.range_metres, echo.kind == EchoKind::Glint);
        let is_out = |shown: &Shown| {
            stands_out(target, shown, decibels_of_lambda).is_some_and(|decibels| decibels >= STANDS_OUT_DB)
        };
        if shown.is_in_range(radar) && is_out(&shown) {
            of[index].push(brightest(target, &shown, STANDS_OUT_DB / decibels_of_lambda));
        }
    }
    of
}

/// Cells of an echo's place that are at most `within` of Lambda below its brightest.
fn brightest(map: &RangeAngleMap, echo: &Shown, within: f64) -> Vec<[usize; 2]> {
    let (rows, columns) = map.lambda.dim();
    let (bins, [left, right]) = echo.window([rows, columns]);
    let across = |bin| (left..=right).map(move |column| [bin, column.rem_euclid(columns as i64) as usize]);
    let cells: Vec<[usize; 2]> = bins.flat_map(across).collect();
    let peak = cells.iter().map(|cell| map.lambda[*cell]).fold(0.0, f32::max);
    cells.into_iter().filter(|cell| f64::from(peak - map.lambda[*cell]) <= within).collect()
}

/// Level of the brightest cell of an echo's place above its surroundings, in dB; `None` where the cell is no peak.
fn stands_out(map: &RangeAngleMap, echo: &Shown, decibels_of_lambda: f64) -> Option<f64> {
    let (rows, columns) = map.lambda.dim();
    let value = |row: usize, column: i64| map.lambda[[row, column.rem_euclid(columns as i64) as usize]];
    let (within, [left, right]) = echo.window([rows, columns]);
    let cells = within.clone().flat_map(|row| (left..=right).map(move |column| (row, column)));
    let (row, column) = cells.max_by(|a, b| value(a.0, a.1).total_cmp(&value(b.0, b.1)))?;
    let peak = value(row, column);
    let near = row.saturating_sub(1)..=(row + 1).min(rows - 1);
    if near.flat_map(|r| (column - 1..=column + 1).map(move |c| (r, c))).any(|(r, c)| value(r, c) > peak) {
        return None;
    }
    let reach = SURROUNDING_CELLS as i64;
    let around = within.start().saturating_sub(SURROUNDING_CELLS)..=(within.end() + SURROUNDING_CELLS).min(rows - 1);
    let mut surroundings: Vec<f32> = around
        .flat_map(|r| (left - reach..=right + reach).map(move |c| (r, c)))
        .filter(|(r, c)| !within.contains(r) || !(left..=right).contains(c))
        .map(|(r, c)| value(r, c))
        .collect();
    let middle = surroundings.len() / 2;
    let (_, median, _) = surroundings.select_nth_unstable_by(middle, f32::total_cmp);
    Some(f64::from(peak - *median) * decibels_of_lambda)
}

/// Counts the echoes of `scene` that stand out in `target`, and those of them that `output` shows. `scale` is that between the target's decades and Lambda.
pub fn tally(
    radar: &Radar,
    scene: &Scene,
    target: &RangeAngleMap,
    output: &RangeAngleMap,
    scale: &LambdaScale,
) -> EchoTally {
    let decibels_of_lambda = scale.decibels();
    let mut tally = EchoTally::default();
    for echo in shown(radar, scene) {
        if stands_out(target, &echo, decibels_of_lambda).is_none_or(|decibels| decibels < STANDS_OUT_DB) {
            continue;
        }
        let class = ((echo.below_db / 10.0) as usize).min(CLASSES - 1);
        tally.there[class] += 1;
        let is_found = stands_out(output, &echo, decibels_of_lambda).is_some_and(|decibels| decibels >= SHOWN_DB);
        tally.found[class] += usize::from(is_found);
    }
    tally
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::maps::{LogMaps, Normalisation};
    use crate::scene::{Object, Wall};
    use crate::signal::{Floor, simulate};

    #[test]
    fn glints_alone_score_below_glints_and_walls_ends() {
        let radar = Radar::default();
        let objects = vec![Object::Wall(Wall::new(0.0, 10.0, 5.0, 0.0))];
        let scene = Scene { objects, ..Scene::default() };
        let signal = simulate(&radar, &scene, Floor::Thesis, 0).unwrap();
        let full = LogMaps::of_signal(&radar, &signal).full;
        let (target, scale) = (full.normalise(Normalisation::MinMax), full.scale(Normalisation::MinMax));
        let count = |output: &RangeAngleMap| tally(&radar, &scene, &target, output, &scale);
        let all = count(&target);
        assert_eq!(all.there, all.found);
        assert_eq!((all.there[0], all.there.iter().sum::<usize>()), (1, 3), "a glint and two ends: {all:?}");
        let mut glint = target.clone();
        let row = (10.0 / radar.range_resolution_metres()).round() as usize;
        for ((bin, column), lambda) in glint.lambda.indexed_iter_mut() {
            if bin.abs_diff(row) > 1 || column.abs_diff(radar.elements / 2) > 2 {
                *lambda = 0.0;
            }
        }
        let alone = count(&glint);
        assert_eq!((alone.there, alone.found[0], alone.found.iter().sum::<usize>()), (all.there, 1, 1), "{alone:?}");
        let silence = RangeAngleMap { lambda: ndarray::Array2::zeros(target.lambda.raw_dim()) };
        assert_eq!(count(&silence).part(), Some(0.0));
    }
}
