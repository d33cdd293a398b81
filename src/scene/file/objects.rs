//! The `[[object]]` tables of a scene's text, each with its kind.

use super::content::{SceneTextError, one_line};
use crate::radar::budget::reflectivity_of;
use crate::scene::{Block, GaussianCluster, Line, MAX_NAME_CHARACTERS, Object, Point, Polygon, Post, Wall};
use serde::Deserialize;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

pub(super) fn objects(text: &str, entries: Spanned<DeValue<'_>>) -> Result<Vec<Object>, SceneTextError> {
    let span = entries.span();
    let DeValue::Array(entries) = entries.into_inner() else {
        let message = "\"object\" is not a list; expected [[object]] tables".to_owned();
        return Err(SceneTextError::at(text, span.start, message));
    };
    let mut objects = Vec::new();
    for (index, entry) in entries.into_iter().enumerate() {
        let whole = entry.span();
        objects.push(object(entry).map_err(|(span, message)| {
            let start = span.unwrap_or(whole).start;
            SceneTextError::at(text, start, format!("object {}: {message}", index + 1))
        })?);
    }
    Ok(objects)
}

/// Reads one `[[object]]`. Its kind is taken off first, so that the other keys are read with their places known.
fn object(entry: Spanned<DeValue<'_>>) -> Result<Object, (Option<Range<usize>>, String)> {
    const KINDS: &str = "expected \"point\", \"line\", \"gaussian\", \"wall\", \"box\", \"post\" or \"polygon\"";
    let span = entry.span();
    let DeValue::Table(mut table) = entry.into_inner() else {
        return Err((Some(span), "not a table; expected [[object]] with a kind".to_owned()));
    };
    let Some(kind) = table.remove("kind") else {
        return Err((Some(span), format!("missing key \"kind\"; {KINDS}")));
    };
    let dbsm = cross_section(&mut table, kind.get_ref().as_str().unwrap_or_default())?;
    let rest = ValueDeserializer::from(Spanned::new(span, DeValue::Table(table)));
    let object = match kind.get_ref().as_str() {
        Some("point") => Point::deserialize(rest).map(Object::Point),
        Some("line") => Line::deserialize(rest).map(Object::Line),
        Some("gaussian") => GaussianCluster::deserialize(rest).map(Object::Gaussian),
        Some("wall") => Wall::deserialize(rest).map(Object::Wall),
        Some("box") => Block::deserialize(rest).map(Object::Box),
        Some("post") => Post::deserialize(rest).map(Object::Post),
        Some("polygon") => Polygon::deserialize(rest).map(Object::Polygon),
        Some(other) => return Err((Some(kind.span()), format!("unknown kind \"{other}\"; {KINDS}"))),
        None => return Err((Some(kind.span()), format!("\"kind\" is not a string; {KINDS}"))),
    };
    let mut object = object.map_err(|e| (e.span(), one_line(e.message())))?;
    let characters = object.name().chars().count();
    if characters > MAX_NAME_CHARACTERS || object.name().contains(char::is_control) {
        let expected = format!("expected one line of at most {MAX_NAME_CHARACTERS}");
        return Err((None, format!("name has {characters} characters; {expected}")));
    }
    if let Some(dbsm) = dbsm {
        object.set_reflectivity(reflectivity_of(dbsm));
    }
    Ok(object)
}

/// Largest radar cross section that is read, and the smallest below 0, dBsm: reflectivities of 1e100.
const MAX_DBSM: f64 = 2000.0;

/// Takes `cross_section_dbsm` off the table of an object of this kind and returns it as reflectivity.
fn cross_section(table: &mut DeTable<'_>, kind: &str) -> Result<Option<f64>, (Option<Range<usize>>, String)> {
    const KEY: &str = "cross_section_dbsm";
    let Some(value) = table.remove(KEY) else { return Ok(None) };
    let span = Some(value.span());
    if !["point", "line", "gaussian"].contains(&kind) {
        let message = format!("a {kind} has no {KEY}, since its echoes follow from its shape; expected reflectivity");
        return Err((span, message));
    }
    if table.contains_key("reflectivity") {
        return Err((span, format!("{KEY} stands beside reflectivity; expected one of the two, they say the same")));
    }
    let dbsm = f64::deserialize(ValueDeserializer::from(value)).map_err(|e| (span.clone(), one_line(e.message())))?;
    if dbsm.is_nan() || dbsm.abs() > MAX_DBSM {
        let expected = "expected -2000 to 2000 dBsm: 0 is 1 square metre, reflectivity 1";
        return Err((span, format!("{KEY} is {dbsm}; {expected}")));
    }
    Ok(Some(dbsm))
}
