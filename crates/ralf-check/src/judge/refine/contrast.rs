//! Where a detection lies on something rather than beside it.
//!
//! Clutter is denser near a radar than farther out, so a shift outwards brings more of it onto anything. What counts is
//! therefore how much more lies on a thing than a metre beside it, on all sides: of a density that rises evenly this is
//! nothing.

use crate::plan_field::{CELL, PlanField, SIDE};

/// Detections lie on what reflected them within this, m: the radar's noise and the LiDAR's grid.
const SIGMA: f64 = 0.2;
/// Cells to the places beside: 1 m.
const BESIDE: usize = 5;

/// By place in plan about the vehicle: 1 on a thing that stands alone, below 0 beside it.
pub(super) struct Contrast {
    /// Row by row, as the field.
    values: Vec<f32>,
}

impl Contrast {
    pub(super) fn of(field: &PlanField) -> Self {
        let on = |distance: f64| (-distance * distance / (2.0 * SIGMA * SIGMA)).exp() as f32;
        let near: Vec<f32> = field.distances().map(on).collect();
        let mut values = vec![0.0; SIDE * SIDE];
        for row in BESIDE..SIDE - BESIDE {
            for column in BESIDE..SIDE - BESIDE {
                let at = row * SIDE + column;
                let across = near[at - BESIDE] + near[at + BESIDE];
                let along = near[at - BESIDE * SIDE] + near[at + BESIDE * SIDE];
                values[at] = near[at] - 0.25 * (across + along);
            }
        }
        Self { values }
    }

    /// At a place, m; linear between the middles of cells. 0 beyond 50 m.
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        let half = (SIDE / 2) as f64;
        let [column, row] = [x, y].map(|value| value / CELL + half);
        let last = (SIDE - 1) as f64;
        if !(0.0..last).contains(&column) || !(0.0..last).contains(&row) {
            return 0.0;
        }
        let (right, up) = (column.fract(), row.fract());
        let first = row as usize * SIDE + column as usize;
        let value = |i: usize| f64::from(self.values[first + i]);
        let lower = value(0) * (1.0 - right) + value(1) * right;
        let upper = value(SIDE) * (1.0 - right) + value(SIDE + 1) * right;
        lower * (1.0 - up) + upper * up
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pole_stands_out_and_a_metre_beside_it_less_than_nothing_does() {
        let contrast = Contrast::of(&PlanField::new([[10.0, -4.0, 1.0]]));
        assert!((contrast.at(10.0, -4.0) - 1.0).abs() < 1e-3);
        assert!((contrast.at(11.0, -4.0) + 0.25).abs() < 1e-3);
        assert_eq!(
            (contrast.at(20.0, 5.0), contrast.at(80.0, 0.0), contrast.at(f64::NAN, 0.0)),
            (0.0, 0.0, 0.0)
        );
    }

    #[test]
    fn clutter_that_thins_out_evenly_pulls_nothing_across_a_wall() {
        let contrast = Contrast::of(&PlanField::new((-150..150).map(|i| [8.0, f64::from(i) * 0.1, 1.0])));
        // From 3 m before the wall to 3 m behind it.
        let score = |shift: f64| {
            let clutter = (0..6000).map(|i| (f64::from(i) + 0.5) * 0.001).map(|way| (5.0 + way, 7.0 - way));
            clutter.map(|(x, density)| density * contrast.at(x + shift, 0.0)).sum::<f64>()
        };
        let [nearer, there, farther] = [-0.5, 0.0, 0.5].map(score);
        let on_the_wall = 4000.0 * 0.5;
        assert!((farther - nearer).abs() < 0.02 * on_the_wall, "{nearer} {there} {farther}");
    }
}
