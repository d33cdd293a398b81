//! Numbers of objects in lesson files, from 1.

use crate::scene::{Object, Scene};
use serde::{Deserialize, Serialize};

/// Index of an object in a file, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct ObjectNumber(pub usize);

impl ObjectNumber {
    /// The index from 0, where there is such an object.
    pub fn index(self, objects: usize) -> Result<usize, String> {
        match self.0 {
            number if (1..=objects).contains(&number) => Ok(number - 1),
            number => Err(format!("object {number} is asked for; the scene has objects 1 to {objects}")),
        }
    }

    pub fn of(self, scene: &Scene) -> Result<&Object, String> {
        self.index(scene.objects.len()).map(|index| &scene.objects[index])
    }
}
