//! Groups of atoms that are near each other in range at either end, so that their gains and places depend on each other.

use super::atom::Atom;
use crate::radar::{End, Radar};

/// The first and the last range bin of an atom at each end, not wrapped at the maximum range.
pub type BinSpans = [(f64, f64); 2];

/// The range bins of `atom`. Those of a row are of nine places along it.
pub fn bin_spans(radar: &Radar, atom: &Atom) -> BinSpans {
    End::BOTH.map(|end| {
        let centre = radar.end_centre_metres(end);
        let bin = |i: f64| {
            let [x, y] = atom.position_metres(i);
            radar.bin_of_range((x - centre).hypot(y))
        };
        let last = atom.reflector_count() as f64 - 1.0;
        let (mut low, mut high) = (bin(0.0), bin(0.0));
        for i in 1..=8 {
            let at = bin(last * f64::from(i) / 8.0);
            (low, high) = (low.min(at), high.max(at));
        }
        (low, high)
    })
}

/// Distance of two atoms in range, range bins, at the end where it is smaller; 0 where they overlap. The range wraps after `bins`.
pub fn distance_bins(bins: usize, a: &BinSpans, b: &BinSpans) -> f64 {
    let bins = bins as f64;
    (0..2)
        .map(|end| {
            let distance = (b[end].0 - a[end].1).max(a[end].0 - b[end].1);
            if distance <= 0.0 {
                return 0.0;
            }
            let wrapped = distance % bins;
            wrapped.min(bins - wrapped)
        })
        .fold(f64::INFINITY, f64::min)
}

/// Groups of atom numbers that contain a marked one, each within `link_bins` of another; at most `max_atoms`, the nearest to a marked one.
pub fn groups(bins: usize, spans: &[BinSpans], marked: &[bool], link_bins: f64, max_atoms: usize) -> Vec<Vec<usize>> {
    let n = spans.len();
    let mut seen = vec![false; n];
    let mut found = Vec::new();
    for start in 0..n {
        if !marked[start] || seen[start] {
            continue;
        }
        // Breadth first, so that the nearest come first.
        let mut group = vec![start];
        seen[start] = true;
        let mut at = 0;
        while at < group.len() && group.len() < max_atoms {
            let mut near: Vec<(f64, usize)> = (0..n)
                .filter(|&j| !group.contains(&j))
                .map(|j| (distance_bins(bins, &spans[group[at]], &spans[j]), j))
                .filter(|(d, _)| *d <= link_bins)
                .collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (_, j) in near.into_iter().take(max_atoms - group.len()) {
                group.push(j);
                seen[j] = true;
            }
            at += 1;
        }
        found.push(group);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_at_either_end_share_a_group() {
        let spans: Vec<BinSpans> =
            [(10.0, 30.0), (14.0, 90.0), (200.0, 34.0), (500.0, 400.0)].map(|(a, b)| [(a, a), (b, b)]).to_vec();
        let found = groups(512, &spans, &[true, false, false, false], 5.0, 10);
        assert_eq!(found, [vec![0, 1, 2]]);
        assert_eq!(groups(512, &spans, &[true, false, false, true], 30.0, 10).len(), 1, "ranges wrap");
        assert_eq!(groups(512, &spans, &[true, false, false, false], 5.0, 2)[0].len(), 2);
    }
}
