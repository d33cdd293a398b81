//! Questions and answers as bytes: a line of JSON, then NumPy arrays whose lengths the line says (`docs/own-network.md`).

use crate::files::Numbers;
use crate::files::npy::NpyHeader;
use crate::radar::Radar;
use crate::reconstruct::Request;
use crate::signal::TwoEnds;
use ndarray::{Array2, Axis, stack};
use ndarray_npy::WriteNpyExt;
use serde::{Deserialize, Serialize};
use std::io::{self, BufRead, Read};

/// Version of questions and answers.
pub const VERSION: u32 = 1;

const MAX_LINE_BYTES: u64 = 64 * 1024;

const HEADER_BYTES: u64 = 4096 + 16;

const MAX_ARRAYS: usize = 4;

#[derive(Debug, Default, Serialize)]
struct Question<'a> {
    apertura: u32,
    ask: &'static str,
    id: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    radar: Option<&'a Radar>,
    #[serde(skip_serializing_if = "Option::is_none")]
    noise: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    normalisation: Option<String>,
    snapshot_range_metres: Option<f64>,
    arrays: Vec<Sent>,
}

#[derive(Debug, Serialize)]
struct Sent {
    name: &'static str,
    axes: [&'static str; 3],
    bytes: usize,
}

/// The line of JSON of an answer; unknown fields are ignored, so that later versions can add some.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default)]
pub struct AnswerHeader {
    apertura: Option<u32>,
    pub id: u64,
    pub name: String,
    pub description: String,
    pub told: String,
    pub weights: String,
    pub eta: Option<f32>,
    pub error: Option<String>,
    arrays: Vec<Received>,
}

#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
struct Received {
    name: String,
    bytes: u64,
}

/// An answer: its line, and the files of its arrays by name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ExternalAnswer {
    pub line: AnswerHeader,
    arrays: Vec<(String, Vec<u8>)>,
}

/// The map of an answer, in one of two units.
#[derive(Debug, Clone, PartialEq)]
pub enum Map {
    Lambda(Array2<f32>),
    Decades(Array2<f64>),
}

/// The first question, which asks for the method's name and description.
pub fn hello() -> Vec<u8> {
    line_of(&Question { apertura: VERSION, ask: "hello", ..Question::default() })
}

pub fn question(id: u64, radar: &Radar, ends: &TwoEnds, request: &Request) -> Vec<u8> {
    let both = stack(Axis(0), &[ends.first.view(), ends.last.view()]).unwrap_or_default();
    let mut array = Vec::new();
    // Writing to a vector can't fail.
    let _written = both.as_standard_layout().write_npy(&mut array);
    let mut bytes = line_of(&Question {
        apertura: VERSION,
        ask: "map",
        id,
        // A method gets samples of one chirp.
        radar: Some(&radar.of_one_chirp()),
        noise: Some(request.noise.to_string()),
        normalisation: Some(request.normalisation.to_string()),
        snapshot_range_metres: request.snapshot_range_metres,
        arrays: vec![Sent { name: "ends", axes: ["end", "element", "sample"], bytes: array.len() }],
    });
    bytes.extend(array);
    bytes
}

fn line_of(question: &Question<'_>) -> Vec<u8> {
    let mut line = serde_json::to_vec(question).unwrap_or_default();
    line.push(b'\n');
    line
}

/// Longest array of an answer about a map of this radar, bytes: float64 with its header.
pub fn most_array_bytes(radar: &Radar) -> u64 {
    HEADER_BYTES + 8 * (radar.samples as u64) * (radar.elements as u64)
}

/// Reads one answer; its arrays have at most `most_bytes` each. `None` where the process closed its standard output between answers.
/// # Errors
/// [`io::ErrorKind::InvalidData`] quotes unexpected output; others are the pipe's.
pub fn read_answer(from: &mut impl BufRead, most_bytes: &dyn Fn() -> u64) -> io::Result<Option<ExternalAnswer>> {
    let mut bytes = Vec::new();
    (&mut *from).take(MAX_LINE_BYTES).read_until(b'\n', &mut bytes)?;
    if bytes.is_empty() {
        return Ok(None);
    }
    let line: AnswerHeader = serde_json::from_slice(&bytes).map_err(|error| rubbish(&bytes, &error.to_string()))?;
    let version = line.apertura.ok_or_else(|| rubbish(&bytes, "it lacks \"apertura\""))?;
    if version != VERSION {
        return Err(invalid(format!("it speaks version {version} of the protocol; expected {VERSION}")));
    }
    if line.arrays.len() > MAX_ARRAYS {
        return Err(invalid(format!("its answer has {} arrays; expected at most {MAX_ARRAYS}", line.arrays.len())));
    }
    let mut arrays = Vec::new();
    for Received { name, bytes } in &line.arrays {
        let most = most_bytes();
        if *bytes > most {
            return Err(invalid(format!("its array \"{name}\" has {bytes} bytes; expected at most {most}")));
        }
        let mut array = Vec::new();
        (&mut *from).take(*bytes).read_to_end(&mut array)?;
        if (array.len() as u64) < *bytes {
            let got = array.len();
            return Err(invalid(format!("it ended after {got} of {bytes} bytes of its array \"{name}\"")));
        }
        arrays.push((name.clone(), array));
    }
    Ok(Some(ExternalAnswer { line, arrays }))
}

fn invalid(message: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, message)
}

fn rubbish(bytes: &[u8], why: &str) -> io::Error {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(80)]).trim_end().escape_debug().to_string();
    let expected = format!("expected a line of JSON that begins with {{\"apertura\":{VERSION}");
    invalid(format!("it wrote \"{start}\" on its standard output ({why}); {expected}"))
}

impl ExternalAnswer {
    /// The answer's map, `[samples, elements]`, with finite cells.
    /// # Errors
    /// A sentence with the fault of the array.
    pub fn map(&self, radar: &Radar) -> Result<Map, String> {
        let (name, bytes) = match self.arrays.as_slice() {
            [(name, bytes)] if name == "lambda" || name == "decades" => (name, bytes),
            others => {
                let names: Vec<&str> = others.iter().map(|(name, _)| name.as_str()).collect();
                let found = if names.is_empty() { "no array".to_owned() } else { names.join(", ") };
                return Err(format!("its answer has {found}; expected one array, \"lambda\" or \"decades\""));
            }
        };
        let cells = numbers(name, bytes)?;
        let expected = [radar.samples, radar.elements];
        if cells.shape() != expected {
            let found = cells.shape();
            return Err(format!("its \"{name}\" has shape {found:?}; expected {expected:?}, range bins and columns"));
        }
        if let Some(((row, column), cell)) = cells.indexed_iter().find(|(_, v)| !v.is_finite()) {
            return Err(format!(
                "its \"{name}\" is {cell} in range bin {row}, column {column}; expected finite numbers only"
            ));
        }
        if name == "decades" {
            return Ok(Map::Decades(cells));
        }
        let far = |v: &&f64| !(-1.0..=2.0).contains(*v);
        if let Some(cell) = cells.iter().find(far) {
            return Err(format!("its \"lambda\" has a cell of {cell}; expected 0 to 1 (\"decades\" may be any)"));
        }
        Ok(Map::Lambda(cells.mapv(|v| v.clamp(0.0, 1.0) as f32)))
    }
}

fn numbers(name: &str, mut bytes: &[u8]) -> Result<Array2<f64>, String> {
    let damaged = |e: io::Error| format!("its array \"{name}\" can't be read: {e}");
    let header = NpyHeader::read(&mut bytes).map_err(damaged)?;
    let axes = header.shape.len();
    match header.numbers(bytes) {
        Some(Err(error)) => Err(damaged(error)),
        Some(Ok(Numbers::Real(cells))) if ["f4", "f8"].contains(&header.code()) => {
            cells.into_dimensionality().map_err(|_| format!("its \"{name}\" has {axes} axes; expected 2"))
        }
        _ => Err(format!("its \"{name}\" has the type {}; expected float32 or float64", header.descriptor)),
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::maps::Normalisation;
    use crate::radar::Decibels;
    use ndarray_npy::ReadNpyExt;
    use num_complex::Complex64;

    pub fn small() -> Radar {
        Radar { samples: 4, elements: 8, end_elements: 2, ..Radar::default() }
    }

    /// The bytes of an answer with this line and these arrays, with its length in the place of LENGTH.
    pub fn answer_bytes(line: &str, array: &[u8]) -> Vec<u8> {
        let mut bytes = line.replace("LENGTH", &array.len().to_string()).into_bytes();
        bytes.push(b'\n');
        bytes.extend(array);
        bytes
    }

    pub fn npy<A: WriteNpyExt>(array: &A) -> Vec<u8> {
        let mut bytes = Vec::new();
        array.write_npy(&mut bytes).unwrap();
        bytes
    }

    fn read(bytes: &[u8]) -> io::Result<Option<ExternalAnswer>> {
        read_answer(&mut io::BufReader::new(bytes), &|| most_array_bytes(&small()))
    }

    fn map_of(array: &str, bytes: &[u8]) -> Result<Map, String> {
        let line = format!(r#"{{"apertura":1,"id":3,"arrays":[{{"name":"{array}","bytes":LENGTH}}]}}"#);
        read(&answer_bytes(&line, bytes)).unwrap().unwrap().map(&small())
    }

    #[test]
    fn a_question_is_a_line_with_an_array() {
        let radar = small();
        let mut ends = crate::signal::BeatSignal::silence(&radar).two_ends(&radar);
        ends.last[[1, 3]] = Complex64::new(1.0, -2.0);
        let normalisation = Normalisation::DynamicRange(Decibels(40.0));
        let request = Request { normalisation, snapshot_range_metres: Some(3.5), ..Request::default() };
        let bytes = question(7, &radar, &ends, &request);
        let end = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
        let line: serde_json::Value = serde_json::from_slice(&bytes[..end]).unwrap();
        assert_eq!((&line["apertura"], &line["ask"], &line["id"]), (&1.into(), &"map".into(), &7.into()));
        assert_eq!((&line["noise"], &line["normalisation"]), (&"thesis".into(), &"db=40".into()));
        assert_eq!((&line["radar"]["samples"], &line["snapshot_range_metres"]), (&4.into(), &3.5.into()));
        assert_eq!(line["arrays"][0]["axes"], serde_json::json!(["end", "element", "sample"]));
        assert_eq!(line["arrays"][0]["bytes"], bytes.len() - end);
        let array = ndarray::Array3::<Complex64>::read_npy(&bytes[end..]).unwrap();
        assert_eq!((array.dim(), array[[1, 1, 3]]), ((2, 2, 4), Complex64::new(1.0, -2.0)));
    }

    #[test]
    fn maps_of_either_precision_order_and_kind_are_read() {
        let map = Array2::from_shape_fn((4, 8), |(r, c)| (r * 8 + c) as f32 / 32.0);
        let expected = Map::Lambda(map.clone());
        let columns_first = map.t().as_standard_layout().into_owned().reversed_axes();
        assert!(!columns_first.is_standard_layout());
        for bytes in [npy(&map), npy(&map.mapv(f64::from)), npy(&columns_first)] {
            assert_eq!(map_of("lambda", &bytes), Ok(expected.clone()));
        }
        let loud = Array2::from_elem((4, 8), 1.2f32);
        assert_eq!(map_of("lambda", &npy(&loud)), Ok(Map::Lambda(loud.mapv(|_| 1.0))), "a little off is clipped");
        let decades = Array2::from_elem((4, 8), -300.0);
        assert_eq!(map_of("decades", &npy(&decades)), Ok(Map::Decades(decades)));
    }

    #[test]
    fn wrong_maps_are_told() {
        let zeros = Array2::<f32>::zeros((4, 8));
        let mut nan = zeros.clone();
        nan[[2, 5]] = f32::NAN;
        for (array, bytes, part) in [
            ("lambda", npy(&Array2::<f32>::zeros((8, 4))), "shape [8, 4]; expected [4, 8]"),
            ("lambda", npy(&Array2::<i32>::zeros((4, 8))), "expected float32 or float64"),
            ("lambda", npy(&ndarray::Array3::<f32>::zeros((1, 4, 8))), "has 3 axes; expected 2"),
            ("lambda", npy(&nan), "is NaN in range bin 2, column 5"),
            ("lambda", npy(&Array2::from_elem((4, 8), -3.0)), "has a cell of -3; expected 0 to 1"),
            ("lambda", npy(&zeros)[..100].to_vec(), "can't be read"),
            ("picture", npy(&zeros), "has picture; expected one array"),
        ] {
            let told = map_of(array, &bytes).unwrap_err();
            assert!(told.contains(part), "{told}");
        }
        let told = ExternalAnswer::default().map(&small()).unwrap_err();
        assert!(told.contains("has no array"), "{told}");
    }

    #[test]
    fn what_is_no_answer_is_told() {
        let array = r#"{"apertura":1,"arrays":[{"name":"lambda","bytes":NUMBER}]}"#;
        for (bytes, part) in [
            ("Loading weights ...\n".to_owned(), "wrote \"Loading weights ...\" on its standard output"),
            ("{\"id\":3}\n".to_owned(), "lacks \"apertura\""),
            ("{\"apertura\":2}\n".to_owned(), "speaks version 2 of the protocol; expected 1"),
            ("x".repeat(100_000), "expected a line of JSON"),
            (array.replace("NUMBER", "99999999999") + "\n", "has 99999999999 bytes; expected at most"),
            (array.replace("NUMBER", "128") + "\nshort", "ended after 5 of 128 bytes"),
        ] {
            let told = read(bytes.as_bytes()).unwrap_err().to_string();
            assert!(told.contains(part), "{told}");
        }
        assert_eq!(read(b"").unwrap(), None);
    }
}
