//! Each place by its nearest samples (the paper's local scaling).
//!
//! Places are asked for in an order in which neighbours follow each other, and the answer for the last one is nearly
//! that for the next: the distances of the last place's samples from the next one bound the search, so that it only
//! looks into a thin rim. The search itself goes through rows of buckets, from the place's own outward, and is exact.

use super::ScaleSample;
use crate::scene::camera::grid::PixelGrid;

/// The samples of a view, sorted into buckets.
#[derive(Debug)]
pub(in crate::scene::camera) struct LocalScale {
    grid: PixelGrid,
    /// `Z_lidar / depth_relative` of each sample.
    ratios: Vec<f64>,
    pixels: Vec<[f64; 2]>,
    neighbours: usize,
}

/// A sample and its squared distance, px^2. Equal distances are ordered by index.
#[derive(Debug, Clone, Copy)]
struct Neighbor {
    square: f64,
    index: usize,
}

impl Neighbor {
    fn is_before(&self, other: &Self) -> bool {
        self.square < other.square || (self.square == other.square && self.index < other.index)
    }
}

impl LocalScale {
    pub(super) fn new(samples: &[ScaleSample], neighbours: usize) -> Self {
        let pixels: Vec<[f64; 2]> = samples.iter().map(|sample| sample.pixel).collect();
        let ratios = samples.iter().map(ScaleSample::ratio).collect();
        Self { grid: PixelGrid::balanced(&pixels), ratios, pixels, neighbours: neighbours.min(samples.len()) }
    }

    /// The scale at each place: the mean of the nearest samples' ratios, weighted by `1 / (distance in px + 1)`.
    pub(super) fn sweep(&self, places: impl Iterator<Item = [f64; 2]>) -> impl Iterator<Item = f64> {
        let mut nearest: Vec<Neighbor> = Vec::with_capacity(self.neighbours);
        places.map(move |place| {
            self.update(&mut nearest, place);
            self.mean(&nearest)
        })
    }

    fn mean(&self, nearest: &[Neighbor]) -> f64 {
        let (sum, weights) = nearest.iter().fold((0.0, 0.0), |(sum, weights), neighbor| {
            let weight = 1.0 / (neighbor.square.sqrt() + 1.0);
            (sum + weight * self.ratios[neighbor.index], weights + weight)
        });
        sum / weights
    }

    /// Replaces the nearest samples of the last place by those of this one, nearest first.
    fn update(&self, nearest: &mut Vec<Neighbor>, place: [f64; 2]) {
        let last = nearest.iter().map(|neighbor| squared(self.pixels[neighbor.index], place));
        let bound = if nearest.is_empty() { f64::INFINITY } else { last.fold(0.0, f64::max) };
        // As many samples as are wanted lie within the bound, so the search will replace each of these.
        nearest.clear();
        nearest.resize(self.neighbours, Neighbor { square: bound, index: usize::MAX });
        let own = self.grid.row(place[1]);
        for row in (0..=own).rev() {
            if !self.search_row(nearest, place, row) && row < own {
                break;
            }
        }
        for row in own + 1..self.grid.rows() {
            if !self.search_row(nearest, place, row) {
                break;
            }
        }
    }

    /// Searches one row of buckets; `false` where it is too far away.
    fn search_row(&self, nearest: &mut [Neighbor], place: [f64; 2], row: usize) -> bool {
        let Some(worst) = nearest.last().map(|neighbor| neighbor.square) else { return false };
        let top = self.grid.top(row);
        let gap = (top - place[1]).max(place[1] - top - self.grid.cell()).max(0.0);
        // Borders of buckets are rounded, distances as well: nothing may be lost by that.
        let slack = 1e-9 * (1.0 + worst + place[0].abs() + place[1].abs());
        let rest = worst - gap * gap + slack;
        if rest < 0.0 {
            return false;
        }
        let reach = rest.sqrt() + slack;
        let buckets = self.grid.buckets(row, place[0] - reach, place[0] + reach);
        let mut worst = worst;
        for candidate in self.grid.places(buckets) {
            let square = squared(candidate.pixel, place);
            if square <= worst {
                insert(nearest, Neighbor { square, index: candidate.index });
                worst = nearest[nearest.len() - 1].square;
            }
        }
        true
    }
}

fn squared([u, v]: [f64; 2], [at_u, at_v]: [f64; 2]) -> f64 {
    (u - at_u) * (u - at_u) + (v - at_v) * (v - at_v)
}

/// Puts a neighbor into a sorted list of fixed length, if it is nearer than the last one.
#[inline]
fn insert(nearest: &mut [Neighbor], neighbor: Neighbor) {
    let mut at = nearest.len();
    while at > 0 && neighbor.is_before(&nearest[at - 1]) {
        // Those behind it move up by one as it passes; the last one drops out.
        if at < nearest.len() {
            nearest[at] = nearest[at - 1];
        }
        at -= 1;
    }
    if at < nearest.len() {
        nearest[at] = neighbor;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sample(pixel: [f64; 2]) -> ScaleSample {
        ScaleSample { pixel, depth: 1.0, relative: 1.0 }
    }

    fn brute_force(samples: &[ScaleSample], k: usize, place: [f64; 2]) -> Vec<usize> {
        let mut all: Vec<(f64, usize)> =
            samples.iter().enumerate().map(|(i, s)| (squared(s.pixel, place), i)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        all.iter().take(k).map(|(_, i)| *i).collect()
    }

    /// One kind of distribution: everywhere, a lattice with many equal distances, clusters far apart, a line, one
    /// place.
    fn samples() -> impl Strategy<Value = Vec<ScaleSample>> {
        let pixel = prop_oneof![
            (0.0..100.0, 0.0..80.0).prop_map(|(u, v)| [u, v]),
            (0..100, 0..80).prop_map(|(u, v)| [f64::from(u), f64::from(v)]),
            (0..2, 0.0..1.0, 0.0..1.0)
                .prop_map(|(c, u, v)| [97.0 * f64::from(c) + u, 70.0 * f64::from(c) + v]),
            (0.0..100.0).prop_map(|u| [u, 40.0]),
            Just([33.3, 44.4]),
        ];
        prop::collection::vec(pixel.prop_map(sample), 1..150)
    }

    proptest! {
        #[test]
        fn it_is_what_brute_force_gives(
            samples in samples(),
            k in 1_usize..8,
            jumps in prop::collection::vec((-5.0..105.0, -5.0..85.0), 0..10),
        ) {
            let local = LocalScale::new(&samples, k);
            let lattice = (0..10).flat_map(|row| (0..13).map(move |column| (4.0 + 8.0 * f64::from(column), 4.0 + 8.0 * f64::from(row))));
            let mut nearest = vec![];
            for (u, v) in lattice.chain(jumps) {
                local.update(&mut nearest, [u, v]);
                let found: Vec<usize> = nearest.iter().map(|neighbor| neighbor.index).collect();
                prop_assert_eq!(found, brute_force(&samples, k, [u, v]));
            }
        }
    }

    #[test]
    fn the_mean_is_weighted_by_distance() {
        let at = |u: f64, depth: f64, relative: f64| ScaleSample { pixel: [u, 0.0], depth, relative };
        let local = LocalScale::new(&[at(0.0, 10.0, 5.0), at(3.0, 12.0, 3.0), at(90.0, 99.0, 1.0)], 2);
        // Ratios 2 and 4 at distances 1 and 2: weights 1/2 and 1/3.
        let scale = local.sweep(std::iter::once([1.0, 0.0])).next().unwrap();
        assert!((scale - (2.0 / 2.0 + 4.0 / 3.0) / (1.0 / 2.0 + 1.0 / 3.0)).abs() < 1e-12);
    }

    #[test]
    fn fewer_samples_than_wanted_all_count() {
        let local = LocalScale::new(&[ScaleSample { pixel: [5.0, 5.0], depth: 6.0, relative: 2.0 }], 3);
        let scales: Vec<f64> = local.sweep([[0.0, 0.0], [90.0, 40.0]].into_iter()).collect();
        assert_eq!(scales, [3.0, 3.0]);
    }
}
