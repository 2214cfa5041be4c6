//! Where things begin, as a radar looks at them.
//!
//! A LiDAR sees the near side of a hedge or of a row of cars; a radar sees it best, and also what lies within and
//! behind. So there are LiDAR points and detections behind a front and few before it, and a measure that takes any
//! point near a detection pulls a radar outwards, into them. What tells its place is how far detections lie behind or
//! before the nearest front along their own ray: on both sides of a front alike, clutter is spread evenly.

use crate::plan_field::{CELL, PlanField};
use ralf::space::Vector;
use std::f64::consts::TAU;

/// Detections lie on the front that reflected them within this, m: the radar's noise and the LiDAR's grid.
const SIGMA: f64 = 0.2;
/// Width of a bin of range, m, and how many there are: 42 m.
const STEP: f64 = 0.1;
const STEPS: usize = 420;
/// Rays about a radar: half a degree, a third of what its azimuths are known by.
const RAYS: usize = 720;
/// A thing begins where so many bins before it are empty: 0.4 m.
const EMPTY: usize = 4;
/// A ray meets the first cell of a thing so much before its points, m: the mean over walls at all angles up to 60
/// degrees, whose points lie anywhere in their cells.
const BEFORE: f64 = 0.75 * CELL;
/// A front is felt within this, m: three standard deviations.
const FELT: f64 = 3.0 * SIGMA;

/// Where things begin, by direction from a radar. Most rays meet few things: a table by direction and range would be
/// looked up in memory a thousand times as large.
pub(super) struct Fronts {
    origin: Vector,
    /// Distances of all fronts, m, ray by ray.
    ranges: Vec<f64>,
    /// Where each ray's begin among these, and where the last one's end.
    begins: Vec<usize>,
}

impl Fronts {
    /// The fronts of a LiDAR's obstacles as seen from a place among them.
    pub(super) fn of(field: &PlanField, origin: Vector) -> Self {
        let (mut ranges, mut begins) = (Vec::new(), vec![0]);
        for ray in 0..RAYS {
            let (sin, cos) = (ray as f64 * TAU / RAYS as f64).sin_cos();
            let mut begun = 0;
            for bin in 0..STEPS {
                let range = (bin as f64 + 0.5) * STEP;
                if field.is_obstacle(origin.x + range * cos, origin.y + range * sin) {
                    if bin >= begun + EMPTY {
                        ranges.push(bin as f64 * STEP + BEFORE);
                    }
                    begun = bin + 1;
                }
            }
            begins.push(ranges.len());
        }
        Self { origin, ranges, begins }
    }

    /// How much a place, so far before itself along its ray, m, lies on a front: 1 on it, 0 where there is none; linear
    /// between rays.
    pub(super) fn before(&self, behind: f64, x: f64, y: f64) -> f64 {
        let (x, y) = (x - self.origin.x, y - self.origin.y);
        let range = (x * x + y * y).sqrt() - behind;
        if !range.is_finite() {
            return 0.0;
        }
        let azimuth = y.atan2(x).rem_euclid(TAU) * RAYS as f64 / TAU;
        let (right, left) =
            (self.felt(azimuth as usize % RAYS, range), self.felt((azimuth as usize + 1) % RAYS, range));
        right + (left - right) * azimuth.fract()
    }

    /// How much a place on a ray lies on the nearest front.
    fn felt(&self, ray: usize, range: f64) -> f64 {
        let fronts = &self.ranges[self.begins[ray]..self.begins[ray + 1]];
        let off = fronts.iter().map(|front| (front - range).abs()).fold(f64::INFINITY, f64::min);
        if off < FELT { (-(off / SIGMA).powi(2) / 2.0).exp() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_is_felt_at_its_front_and_what_stands_behind_it_is_not() {
        // Two metres of hedge, or of points on the sides of cars, behind a front at 8 m.
        let points = (-150..150)
            .flat_map(|i| (0..10).map(move |j| [8.0 + 0.2 * f64::from(j), f64::from(i) * 0.1, 1.0]));
        let fronts = Fronts::of(&PlanField::new(points), Vector::new(0.0, 0.5, 0.0));
        assert!(fronts.before(0.0, 8.0, 0.5) > 0.9);
        assert!(fronts.before(0.0, 7.2, 0.5) < 0.01 && fronts.before(0.0, 9.0, 0.5) < 0.01);
        assert!(fronts.before(0.4, 8.4, 0.5) > 0.9, "0.4 m behind the front");
        assert_eq!((fronts.before(0.0, 60.0, 0.5), fronts.before(0.0, f64::NAN, 0.0)), (0.0, 0.0));
    }

    #[test]
    fn a_front_is_where_it_is_for_walls_at_any_place_in_a_cell_and_at_any_angle() {
        let mut off = 0.0;
        for i in 0..100 {
            let (wall, slope) =
                (8.0 + 0.01 * f64::from(i), (f64::from(i * 37 % 100) * 1.2 - 60.0).to_radians().tan());
            let points = (-150..150).map(|i| f64::from(i) * 0.05).map(|y| [wall + slope * y, y, 1.0]);
            let fronts = Fronts::of(&PlanField::new(points), Vector::zeros());
            let places = (0..600).map(|i| wall - 3.0 + 0.01 * f64::from(i));
            let found =
                places.max_by(|a, b| fronts.before(0.0, *a, 0.0).total_cmp(&fronts.before(0.0, *b, 0.0)));
            off += (found.unwrap_or(0.0) - wall) / 100.0;
        }
        assert!(off.abs() < 0.04, "{off}");
    }

    #[test]
    fn clutter_that_thins_out_evenly_pulls_nothing_across_a_front() {
        let fronts =
            Fronts::of(&PlanField::new((-150..150).map(|i| [8.0, f64::from(i) * 0.1, 1.0])), Vector::zeros());
        // Few detections on the wall among clutter, from 3 m before the wall to 3 m behind it.
        let score = |shift: f64| {
            let clutter =
                (0..6000).map(|i| (f64::from(i) + 0.5) * 0.001).map(|way| (5.0 + way, 1.5 - 0.1 * way));
            let on_the_wall = 1000.0 * fronts.before(0.0, 8.0 + shift, 0.0);
            on_the_wall
                + clutter.map(|(x, density)| density * fronts.before(0.0, x + shift, 0.0)).sum::<f64>()
        };
        let best = (-50..=50).map(|i| f64::from(i) * 0.01).max_by(|a, b| score(*a).total_cmp(&score(*b)));
        assert!(best.is_some_and(|shift| shift.abs() < 0.07), "{best:?}");
    }
}
