//! Elements from a list of numbers, as a spreadsheet copies it.

use super::{BuiltArray, Decibels, ElementError};

const COLUMNS: [&str; 4] = ["place in mm", "forward in mm", "gain in dB", "phase in degrees"];

/// Characters of a cell in an error message.
const MAX_SHOWN_CHARACTERS: usize = 20;

impl BuiltArray {
    /// The elements that `text` describes: a line an element, the leftmost first. A line holds up to four numbers, separated by
    /// tabs, semicolons, commas or spaces: offset along +x and towards the scene (millimetres), gain (decibels), phase (degrees). Missing
    /// numbers and empty cells are 0.
    /// # Errors
    /// The message names line and column.
    pub fn from_list(text: &str, elements: usize) -> Result<BuiltArray, String> {
        let lines = text.trim_end().lines();
        let found = lines.clone().count();
        if found != elements {
            return Err(format!(
                "{found} lines for {elements} elements; expected one line an element, the leftmost first"
            ));
        }
        let elements = lines.enumerate().map(|(i, line)| element(i + 1, line)).collect::<Result<_, _>>()?;
        Ok(BuiltArray { elements })
    }
}

/// The cells of a line. A spreadsheet puts tabs or semicolons between them; else they are commas or spaces.
fn cells(line: &str) -> Vec<&str> {
    let line = line.trim_end();
    if let Some(between) = ['\t', ';'].into_iter().find(|c| line.contains(*c)) {
        return line.split(between).map(str::trim).collect();
    }
    line.split([',', ' ']).map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

fn element(line: usize, text: &str) -> Result<ElementError, String> {
    let cells = cells(text);
    if cells.len() > COLUMNS.len() {
        let (found, expected) = (cells.len(), COLUMNS.join(", "));
        return Err(format!("line {line} has {found} columns; expected at most 4: {expected}"));
    }
    let mut numbers = [0.0; COLUMNS.len()];
    for ((number, cell), column) in numbers.iter_mut().zip(cells).zip(COLUMNS) {
        if !cell.is_empty() {
            let parsed = cell.parse::<f64>().ok().filter(|v| v.is_finite());
            let shown: String = cell.chars().take(MAX_SHOWN_CHARACTERS).collect();
            let problem = || format!("line {line}, {column}: \"{shown}\" is no number");
            *number = parsed.ok_or_else(problem)?;
        }
    }
    let [position_millimetres, forward_millimetres, gain, phase_degrees] = numbers;
    Ok(ElementError { gain: Decibels(gain), phase_degrees, position_millimetres, forward_millimetres, dead: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_from_a_spreadsheet_is_read() {
        let array = BuiltArray::from_list("0.1\t-2\t0.5\t10\n\t-1\n0.3\n", 3).unwrap();
        let of = |n: usize| {
            let e = array.element(n);
            [e.position_millimetres, e.forward_millimetres, e.gain.0, e.phase_degrees]
        };
        assert_eq!([of(0), of(1), of(2)], [[0.1, -2.0, 0.5, 10.0], [0.0, -1.0, 0.0, 0.0], [0.3, 0.0, 0.0, 0.0]]);
        assert_eq!(BuiltArray::from_list("1, 2\n3 4", 2).unwrap().element(1).forward_millimetres, 4.0);
        assert_eq!(BuiltArray::from_list("1;;3", 1).unwrap().element(0).gain.0, 3.0);
    }

    #[test]
    fn a_problem_names_line_with_column() {
        let told = |text: &str, elements| BuiltArray::from_list(text, elements).unwrap_err().to_string();
        assert_eq!(told("1\n2", 3), "2 lines for 3 elements; expected one line an element, the leftmost first");
        assert_eq!(told("1\n2\tabc", 2), "line 2, forward in mm: \"abc\" is no number");
        assert_eq!(told("nan", 1), "line 1, place in mm: \"nan\" is no number");
        assert!(told("1 2 3 4 5", 1).starts_with("line 1 has 5 columns; expected at most 4"));
    }
}
