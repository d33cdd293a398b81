//! One row or one column of a map, as a line.

use crate::app::state::{Cursor, CutMap, MapKind, Units};
use crate::app::widgets::{Span, direction};
use crate::maps::LambdaScale;
use crate::picture::finer;
use crate::radar::Radar;
use ndarray::s;

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Cut {
    /// All directions at one range.
    Angle,
    /// All ranges in one direction.
    Range,
}

impl Cut {
    pub const ALL: [Cut; 2] = [Cut::Angle, Cut::Range];

    pub fn name(self) -> &'static str {
        match self {
            Cut::Angle => "Angle cut",
            Cut::Range => "Range profile",
        }
    }

    /// Quantity and unit of the axis.
    pub fn unit(self) -> &'static str {
        match self {
            Cut::Angle => "cos θ",
            Cut::Range => "range, m",
        }
    }

    pub fn whole(self, radar: &Radar) -> Span {
        match self {
            Cut::Angle => {
                let [low, high] = [0.0, 1.0].map(|across| radar.cos_of_column(radar.column_across(across)));
                Span { low, high }
            }
            Cut::Range => Span { low: 0.0, high: radar.max_range_metres() },
        }
    }

    /// The cursor's place on the axis.
    pub fn position(self, radar: &Radar, cursor: &Cursor) -> f64 {
        match self {
            Cut::Angle => radar.cos_of_column(cursor.column),
            Cut::Range => cursor.range_metres,
        }
    }

    /// Title of the axis: its quantity, and the place of the cut.
    pub fn title(self, radar: &Radar, cursor: &Cursor) -> String {
        match self {
            Cut::Angle => format!("{}, at range {:.2} m", self.unit(), radar.range_of_bin_metres(cursor.bin.round())),
            Cut::Range => {
                format!("{}, at {}", self.unit(), direction(radar.cos_of_column(cursor.column.round()), 1))
            }
        }
    }
}

#[derive(Debug, Clone)]
pub struct Trace {
    pub kind: MapKind,
    /// Index of the pinned cut; `None` for the cut at the cursor.
    pub pin: Option<usize>,
    /// Place on the axis, rising, and Lambda, cell by cell.
    pub lambda: Vec<[f64; 2]>,
    scale: Option<LambdaScale>,
}

impl Trace {
    /// The line through a map; `None` where the map is of another radar and has no such cell.
    pub fn of(radar: &Radar, cursor: &Cursor, map: &CutMap, cut: Cut, pin: Option<usize>) -> Option<Trace> {
        let (bin, column) = cursor.cell(radar)?;
        let (rows, columns) = map.map.lambda.dim();
        let lambda = match cut {
            Cut::Angle if bin < rows => angle_cut(radar, map, bin),
            Cut::Range if column < columns => {
                let cells = map.map.lambda.column(column);
                cells.iter().enumerate().map(|(k, v)| [radar.range_of_bin_metres(k as f64), f64::from(*v)]).collect()
            }
            _ => return None,
        };
        Some(Trace { kind: map.kind, pin, lambda, scale: map.scale })
    }

    /// Decibels that Lambda spans; `None` where the scale is unknown or empty.
    pub fn range_db(&self) -> Option<f64> {
        self.scale.map(|s| s.decibels()).filter(|range| *range > 0.0)
    }

    /// Place on the axis and decibels below the map's peak, cell by cell.
    pub fn decibels(&self) -> Option<Vec<[f64; 2]>> {
        let range = self.range_db()?;
        Some(self.lambda.iter().map(|[x, lambda]| [*x, range * (lambda - 1.0)]).collect())
    }

    /// The drawn points: place on the axis, and level in `units`.
    pub fn points(&self, units: Units) -> Option<Vec<[f64; 2]>> {
        match units {
            Units::Lambda => Some(self.lambda.clone()),
            Units::Decibels => self.decibels(),
        }
    }
}

/// cos(theta), rising, and Lambda of one range bin; few columns are interpolated as in the map.
fn angle_cut(radar: &Radar, map: &CutMap, bin: usize) -> Vec<[f64; 2]> {
    let row = radar.left_to_right(&map.map.lambda).slice_move(s![bin..=bin, ..]);
    let fine = finer(radar, row);
    let cells = fine.as_ref().map_or(row, |fine| fine.view());
    let cos = |n: usize| radar.cos_of_column(radar.column_across((n as f64 + 0.5) / cells.ncols() as f64));
    cells.iter().enumerate().map(|(n, v)| [cos(n), f64::from(*v)]).collect()
}
