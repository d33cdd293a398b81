//! Echoes at a block of elements: points, whose paths are computed on request, and bodies, whose paths are computed at the beginning.

use super::path::{PairBlocks, Path};
use super::phase::{EchoLanes, EchoModel};
use crate::radar::Pair;
use crate::scattering::{PathEcho, Sources};
use crate::scene::Reflector;

/// Echoes at a block of pairs, in a fixed order: the points first, then the paths.
pub(super) struct BlockEchoes<'a, const W: usize> {
    model: &'a EchoModel,
    pairs: PairBlocks<W>,
    points: &'a [Reflector],
    pub paths: Vec<Path<W>>,
}

impl<'a, const W: usize> BlockEchoes<'a, W> {
    /// The echoes of `sources` at the pairs of lanes 0, 1 and so on.
    pub fn new(model: &'a EchoModel, sources: Sources<'a>, pair: impl Fn(usize) -> Pair) -> Self {
        BlockEchoes { model, paths: paths(sources, &pair), pairs: PairBlocks::new(pair), points: sources.points }
    }

    #[inline(always)]
    pub fn len(&self) -> usize {
        self.points.len() + self.paths.len()
    }

    #[inline(always)]
    pub fn echo<const FMA: bool>(&self, index: usize) -> EchoLanes<W> {
        match self.points.get(index) {
            Some(point) => self.model.echo_lanes::<W, FMA>(self.pairs, point),
            None => self.model.of_path::<W, FMA>(self.paths[index - self.points.len()]),
        }
    }
}

/// The paths of the scatterers among `sources` to the pairs of lanes 0, 1 and so on, without those hidden from all of them.
fn paths<const W: usize>(sources: Sources<'_>, pair: impl Fn(usize) -> Pair) -> Vec<Path<W>> {
    if sources.scatterers.is_empty() {
        return Vec::new();
    }
    let lanes: [Vec<PathEcho>; W] = std::array::from_fn(|lane| {
        let mut echoes = Vec::new();
        sources.scattered(pair(lane), &mut echoes);
        echoes
    });
    let path = |index: usize| {
        let first = lanes.iter().find(|echoes| echoes[index].is_heard())?;
        // A lane without the echo has the range of another lane: similar ranges are cheaper.
        let range = |echo: &PathEcho| if echo.is_heard() { echo.range_metres } else { first[index].range_metres };
        let ranges = std::array::from_fn(|lane| range(&lanes[lane][index]));
        Some(Path::new(ranges, std::array::from_fn(|lane| lanes[lane][index].amplitude)))
    };
    (0..lanes[0].len()).filter_map(path).collect()
}
