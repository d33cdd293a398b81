//! Types of cells: writing, reading, comparing and sharing.

use super::super::echoes::EchoCounts;
use crate::evaluate::shard::Shard;
use crate::maps::Normalisation;
use crate::radar::Carrier;
use crate::scene::generate::{Purpose, Reading};
use crate::signal::Floor;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::borrow::Cow;
use std::collections::HashSet;
use std::fmt;
use std::ops::Deref;
use std::sync::Arc;

/// A text that many rows share.
#[derive(Clone, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Deserialize)]
#[serde(from = "String")]
pub struct Text(Arc<String>);

impl Deref for Text {
    type Target = str;

    fn deref(&self) -> &str {
        &self.0
    }
}

impl Serialize for Text {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self)
    }
}

impl<T: Into<String>> From<T> for Text {
    fn from(text: T) -> Self {
        Text(Arc::new(text.into()))
    }
}

impl PartialEq<&str> for Text {
    fn eq(&self, other: &&str) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        (**self).fmt(f)
    }
}

impl fmt::Display for Text {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self)
    }
}

/// The type of a column's cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellKind {
    /// A text.
    Text,
    /// A whole number from 0.
    Whole,
    /// A finite number.
    Real,
}

/// The content of a cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Value<'a> {
    /// A number.
    Number(f64),
    /// A text.
    Text(Cow<'a, str>),
    /// Nothing: the figure doesn't exist for this scene.
    Missing,
}

impl Value<'_> {
    /// The number; `None` for a text and a missing figure.
    pub fn number(&self) -> Option<f64> {
        match self {
            Value::Number(number) => Some(*number),
            _ => None,
        }
    }
}

impl fmt::Display for Value<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Number(number) => number.fmt(f),
            Value::Text(text) => f.write_str(text),
            Value::Missing => Ok(()),
        }
    }
}

pub(super) trait CellValue {
    const KIND: CellKind;

    fn value(&self) -> Value<'_>;

    /// Replaces the text by its equal in `texts`, or adds it there: equal texts of many rows take memory once.
    fn share(&mut self, _texts: &mut HashSet<Text>) {}
}

impl CellValue for Text {
    const KIND: CellKind = CellKind::Text;

    fn value(&self) -> Value<'_> {
        if self.is_empty() { Value::Missing } else { Value::Text(Cow::Borrowed(self)) }
    }

    fn share(&mut self, texts: &mut HashSet<Text>) {
        match texts.get(self) {
            Some(text) => *self = text.clone(),
            None => _ = texts.insert(self.clone()),
        }
    }
}

impl<T: CellValue> CellValue for Option<T> {
    const KIND: CellKind = T::KIND;

    fn value(&self) -> Value<'_> {
        self.as_ref().map_or(Value::Missing, T::value)
    }
}

impl CellValue for EchoCounts {
    const KIND: CellKind = CellKind::Text;

    fn value(&self) -> Value<'_> {
        Value::Number(self.0.iter().sum::<usize>() as f64)
    }
}

macro_rules! cells {
    ($($kind:ident: $($type:ty),+ => |$cell:ident| $value:expr;)+) => {
        $($(impl CellValue for $type {
            const KIND: CellKind = CellKind::$kind;

            fn value(&self) -> Value<'_> {
                let $cell = self;
                $value
            }
        })+)+
    };
}

cells! {
    Whole: u32 => |v| Value::Number(f64::from(*v));
    Whole: u64 => |v| Value::Number(*v as f64);
    Whole: usize => |v| Value::Number(*v as f64);
    Real: f32 => |v| Value::Number(f64::from(*v));
    Real: f64 => |v| Value::Number(*v);
    Text: Floor, Normalisation, Shard => |v| Value::Text(v.to_string().into());
    Text: Purpose, Reading, Carrier => |v| Value::Text(serde_name(v).into());
}

fn serde_name(value: impl Serialize) -> String {
    serde_json::to_value(value).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

/// Serialisation of cells by their `Display` and `FromStr`.
pub(super) mod by_text {
    use super::{Deserialize, Deserializer, Serializer, de, fmt};
    use std::str::FromStr;

    pub fn serialize<T: fmt::Display, S: Serializer>(cell: &Option<T>, serializer: S) -> Result<S::Ok, S::Error> {
        match cell {
            Some(value) => serializer.collect_str(value),
            None => serializer.serialize_none(),
        }
    }

    pub fn deserialize<'de, T, D>(deserializer: D) -> Result<Option<T>, D::Error>
    where
        T: FromStr<Err: fmt::Display>,
        D: Deserializer<'de>,
    {
        let text = Option::<String>::deserialize(deserializer)?.filter(|text| !text.is_empty());
        text.map(|text| text.parse().map_err(de::Error::custom)).transpose()
    }
}

/// A cell that is empty for the scenes of a folder; format 1 wrote "file" in it.
pub(super) fn unless_file<'de, T, D>(deserializer: D) -> Result<Option<T>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    let text = Option::<String>::deserialize(deserializer)?.filter(|text| !matches!(text.as_str(), "" | "file"));
    text.map(|text| T::deserialize(de::IntoDeserializer::into_deserializer(text))).transpose()
}
