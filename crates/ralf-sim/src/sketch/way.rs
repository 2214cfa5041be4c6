//! The line along which a place is built and driven through.

use crate::path::on_arc;
use crate::scenario::Leg;

/// Between places that are kept, m.
const STEP: f64 = 0.25;
/// From where on it is known, m before the start.
const BEFORE: f64 = 150.0;

/// A line of bends, by the length along it: 0 is where the drive starts, at the origin and along x.
#[derive(Debug, Clone)]
pub(super) struct Way {
    /// x, y (m) and heading (rad), from [`BEFORE`] on.
    places: Vec<[f64; 3]>,
}

impl Way {
    /// Straight before the first and after the last leg.
    pub(super) fn new(legs: &[Leg], length: f64) -> Self {
        let steps = ((BEFORE + length) / STEP) as usize;
        let mut places = Vec::with_capacity(steps);
        let [mut x, mut y, mut heading] = [-BEFORE, 0.0, 0.0_f64];
        for step in 0..steps {
            places.push([x, y, heading]);
            heading += curvature(legs, step as f64 * STEP - BEFORE) * STEP;
            x += heading.cos() * STEP;
            y += heading.sin() * STEP;
        }
        Self { places }
    }

    /// A line of constant curvature (1/m): it is known everywhere.
    pub(super) fn circle(curvature: f64, length: f64) -> Self {
        let place = |step: usize| {
            let along = step as f64 * STEP - BEFORE;
            on_arc([0.0; 3], along, along * curvature)
        };
        Self { places: (0..((BEFORE + length) / STEP) as usize).map(place).collect() }
    }

    /// x, y (m) and heading (rad) so far along it and so far to its left, m; beyond its ends it goes straight on.
    pub(super) fn at(&self, along: f64, left: f64) -> [f64; 3] {
        let [end, beyond] = self.until(along);
        let [x, y, heading] = self.within(end, left);
        if beyond == 0.0 {
            return [x, y, heading];
        }
        let (sin, cos) = heading.sin_cos();
        [x + beyond * cos, y + beyond * sin, heading]
    }

    /// A length along it as far as it is known, and what lies beyond, m.
    fn until(&self, along: f64) -> [f64; 2] {
        let end = along.clamp(-BEFORE, (self.places.len() - 2) as f64 * STEP - BEFORE);
        [end, along - end]
    }

    fn within(&self, along: f64, left: f64) -> [f64; 3] {
        let place = ((along + BEFORE) / STEP).clamp(0.0, (self.places.len() - 2) as f64);
        let (index, share) = (place as usize, place.fract());
        let [a, b] = [self.places[index], self.places[index + 1]];
        let between = |axis: usize| a[axis] + share * (b[axis] - a[axis]);
        let (sin, cos) = between(2).sin_cos();
        [between(0) - left * sin, between(1) + left * cos, between(2)]
    }

    /// 1/m, to the left.
    pub(super) fn curvature(&self, along: f64) -> f64 {
        (self.at(along + STEP, 0.0)[2] - self.at(along - STEP, 0.0)[2]) / (2.0 * STEP)
    }
}

fn curvature(legs: &[Leg], along: f64) -> f64 {
    let mut begin = 0.0;
    for leg in legs {
        if (begin..begin + leg.length).contains(&along) {
            return leg.turn_deg.to_radians() / leg.length;
        }
        begin += leg.length;
    }
    0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_starts_at_the_origin_and_its_left_is_left() {
        let ways = [
            Way::new(&[Leg { length: 5.0, turn_deg: 0.0 }, Leg { length: 20.0, turn_deg: 40.0 }], 100.0),
            Way::circle(1.0 / 600.0, 100.0),
        ];
        for way in ways {
            let [x, y, heading] = way.at(0.0, 3.0);
            assert!(x.abs() < 1e-6 && (y - 3.0).abs() < 1e-6 && heading.abs() < 1e-6);
            let [from, to] = [way.at(10.0, 0.0), way.at(11.0, 0.0)];
            assert!(((to[0] - from[0]).hypot(to[1] - from[1]) - 1.0).abs() < 1e-3);
        }
        let bend = Way::new(&[Leg { length: 20.0, turn_deg: 40.0 }], 100.0);
        // It never ends: who drives on for minutes drives straight on.
        for far in [-400.0, 97.0, 700.0] {
            let [from, to] = [bend.at(far, -2.0), bend.at(far + 6.0, -2.0)];
            assert!(((to[0] - from[0]).hypot(to[1] - from[1]) - 6.0).abs() < 1e-6, "{far}");
        }
        assert!((bend.curvature(10.0) - 40_f64.to_radians() / 20.0).abs() < 1e-6);
        assert!((bend.at(60.0, 0.0)[2].to_degrees() - 40.0).abs() < 0.6);
    }
}
