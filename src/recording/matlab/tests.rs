use super::*;
use flate2::{Compression, write::ZlibEncoder};
use ndarray::array;
use std::io::Write;

fn element(kind: u32, bytes: &[u8]) -> Vec<u8> {
    let mut out = [kind.to_le_bytes(), (bytes.len() as u32).to_le_bytes()].concat();
    out.extend_from_slice(bytes);
    out.resize(out.len().next_multiple_of(8), 0);
    out
}

fn variable(name: &str, class: u32, shape: &[i32], parts: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let flags = class | if parts.len() == 2 { 0x800 } else { 0 };
    let parts: Vec<Vec<u8>> = parts.iter().map(|(kind, bytes)| element(*kind, bytes)).collect();
    array_of(name, flags, shape, &parts)
}

/// An array of these elements, or in which others stand, or one inside of it, which has no name.
fn array_of(name: &str, flags: u32, shape: &[i32], parts: &[Vec<u8>]) -> Vec<u8> {
    let shape: Vec<u8> = shape.iter().flat_map(|d| d.to_le_bytes()).collect();
    let mut body = element(6, &[flags.to_le_bytes(), [0; 4]].concat());
    body.extend(element(5, &shape));
    // Short names stand in the tag itself.
    let mut small = (1u32 | (name.len() as u32) << 16).to_le_bytes().to_vec();
    small.extend_from_slice(name.as_bytes());
    small.resize(8, 0);
    body.extend(if name.len() <= 4 { small } else { element(1, name.as_bytes()) });
    parts.iter().for_each(|part| body.extend(part));
    element(MATRIX, &body)
}

fn file(variables: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = vec![b' '; 124];
    bytes[..10].copy_from_slice(b"MATLAB 5.0");
    bytes.extend_from_slice(&[0, 1, b'I', b'M']);
    variables.iter().for_each(|v| bytes.extend(v));
    bytes
}

fn compressed(variable: &[u8]) -> Vec<u8> {
    let mut zip = ZlibEncoder::new(Vec::new(), Compression::default());
    zip.write_all(variable).unwrap();
    let zip = zip.finish().unwrap();
    [COMPRESSED.to_le_bytes().to_vec(), (zip.len() as u32).to_le_bytes().to_vec(), zip].concat()
}

fn doubles(values: &[f64]) -> (u32, Vec<u8>) {
    (9, values.iter().flat_map(|v| v.to_le_bytes()).collect())
}

fn sample() -> Vec<u8> {
    let complex = variable("data", 6, &[1, 2], &[doubles(&[1.0, 2.0]), doubles(&[-1.0, 0.5])]);
    let narrow =
        variable("narrow", 6, &[2, 2], &[(3, [1i16, -2, 3, 4].iter().flat_map(|v| v.to_le_bytes()).collect())]);
    file(&[variable("text", 4, &[1, 1], &[(4, vec![65, 0])]), compressed(&complex), narrow])
}

#[test]
fn every_number_format_is_read() {
    let complex = array![[Complex64::new(1.0, -1.0), Complex64::new(2.0, 0.5)]].into_dyn();
    assert_eq!(read_mat(sample().as_slice(), "data").unwrap(), Numbers::Complex(complex));
    let real = array![[1.0, 3.0], [-2.0, 4.0]].into_dyn();
    assert_eq!(read_mat(sample().as_slice(), "narrow").unwrap(), Numbers::Real(real), "columns first");
}

#[test]
fn high_byte_first() {
    let swap = |words: &[u32]| words.iter().flat_map(|w| w.to_be_bytes()).collect::<Vec<u8>>();
    let body = [
        swap(&[6, 8, 6, 0, 5, 8, 1, 1, 1 | 1 << 16]),
        b"a\0\0\0".to_vec(),
        swap(&[9, 8]),
        1.5f64.to_be_bytes().to_vec(),
    ]
    .concat();
    let mut bytes = vec![b' '; 124];
    bytes.extend_from_slice(&[1, 0, b'M', b'I']);
    bytes.extend(swap(&[MATRIX, body.len() as u32]));
    bytes.extend(body);
    assert_eq!(read_mat(bytes.as_slice(), "a").unwrap(), Numbers::Real(array![[1.5]].into_dyn()));
}

#[test]
fn faults_name_what_was_expected() {
    let told = |bytes: &[u8], key: &str, parts: [&str; 2]| {
        let message = read_mat(bytes, key).unwrap_err().to_string();
        assert!(parts.iter().all(|p| message.contains(p)), "{message}");
    };
    told(&sample(), "iq", ["\"iq\"", "text, data, narrow"]);
    told(&sample(), "text", ["\"text\" is text", "numbers"]);
    told(b"short", "a", ["version 5 or 7", "shorter"]);
    told(&[b'x'; 200], "a", ["version 5 or 7", "byte order"]);
    told(&file(&[variable("a", 6, &[-1, -1], &[doubles(&[1.0])])]), "a", ["\"a\"", "at most"]);
    told(&file(&[variable("a", 6, &[1, 3], &[doubles(&[1.0])])]), "a", ["\"a\"", "expected 24"]);
    told(&file(&[variable("a", 6, &[1, 1], &[doubles(&[1.0, 2.0])])]), "a", ["\"a\"", "at most 8"]);
    told(&file(&[element(9, &[0; 8])]), "a", ["kind 9", "no variable"]);
    let whole = file(&[variable("a", 6, &[1, 1], &[doubles(&[1.0])])]);
    told(&whole[..whole.len() - 4], "a", ["\"a\"", "too soon"]);
}

#[test]
fn what_inflates_without_end_takes_no_memory() {
    // 64 MiB of zeros behind an array that claims to be small.
    let mut bomb = variable("a", 6, &[1, 1], &[(9, vec![0; 64 << 20])]);
    bomb.truncate(64 << 20);
    let message = read_mat(file(&[compressed(&bomb)]).as_slice(), "a").unwrap_err().to_string();
    assert!(message.contains("at most 8"), "{message}");
}

#[test]
fn members_of_structs_and_cells_are_found() {
    let numbers = |values: &[f64]| variable("", 6, &[1, values.len() as i32], &[doubles(values)]);
    let members = [b"rate\0\0\0\0".as_slice(), b"adcData\0"].concat();
    let of_struct =
        vec![element(5, &8i32.to_le_bytes()), element(1, &members), numbers(&[5.0]), numbers(&[1.0, 2.0, 3.0])];
    let of_cells = vec![numbers(&[1.0, 2.0]), numbers(&[3.0, 4.0])];
    let odd = vec![numbers(&[1.0]), numbers(&[3.0, 4.0])];
    let bytes = file(&[
        compressed(&array_of("radar", STRUCT, &[1, 1], &of_struct)),
        array_of("frames", CELL, &[1, 2], &of_cells),
        array_of("odd", CELL, &[1, 2], &odd),
    ]);
    let found: Vec<(String, Vec<usize>)> = shapes(bytes.as_slice()).unwrap();
    let names: Vec<(&str, &[usize])> = found.iter().map(|(name, shape)| (name.as_str(), shape.as_slice())).collect();
    let expected: [(&str, &[usize]); 4] =
        [("radar.rate", &[1, 1]), ("radar.adcData", &[1, 3]), ("frames", &[2, 1, 2]), ("odd", &[2, 1, 1])];
    assert_eq!(names, expected);
    let member = read_mat(bytes.as_slice(), "radar.adcData").unwrap();
    assert_eq!(member, Numbers::Real(array![[1.0, 2.0, 3.0]].into_dyn()));
    let frames = read_mat(bytes.as_slice(), "frames").unwrap();
    assert_eq!(frames, Numbers::Real(array![[[1.0, 2.0]], [[3.0, 4.0]]].into_dyn()));
    let told = |key: &str| read_mat(bytes.as_slice(), key).unwrap_err().to_string();
    assert!(told("odd").contains("no arrays of one shape"), "{}", told("odd"));
    assert!(told("radar").contains("\"radar\" is a struct"), "{}", told("radar"));
    assert!(told("radar.b").contains("radar.rate, radar.adcData"), "{}", told("radar.b"));
}
