//! How far the nearest obstacle is from any place in plan: a grid, so that a question costs one look.

/// Width of a cell, m.
pub(crate) const CELL: f64 = 0.2;
/// Cells from the centre to the border: 50 m.
const REACH: usize = 250;
/// Cells of a side.
const SIDE: usize = 2 * REACH + 1;
/// Distances are known up to this many cells.
const DISC: i64 = 5;
/// The distance of what is farther from every obstacle, m.
pub(crate) const FAR: f64 = DISC as f64 * CELL;

/// Distances to the nearest obstacle, and the tops of obstacles, about the vehicle.
#[derive(Debug, Clone)]
pub(crate) struct PlanField {
    /// In steps of [`STEP`]; row by row, x along a row.
    distance: Vec<u8>,
    /// Highest point of the obstacle that is nearest, dm above the vehicle's origin. Same order.
    tops: Vec<i8>,
}

/// Of a distance, m.
const STEP: f64 = FAR / 250.0;

impl PlanField {
    /// Of obstacles at x, y (m, about the vehicle) and z (m above the vehicle's origin). Those farther than 50 m are
    /// left out.
    pub(crate) fn new(obstacles: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let mut own: Vec<Option<i8>> = vec![None; SIDE * SIDE];
        let mut occupied = Vec::new();
        for [x, y, z] in obstacles {
            let Some(cell) = cell(x, y) else { continue };
            let decimetres = (z * 10.0).clamp(-127.0, 127.0) as i8;
            match &mut own[cell] {
                Some(top) => *top = (*top).max(decimetres),
                empty => {
                    *empty = Some(decimetres);
                    occupied.push(cell);
                }
            }
        }
        let mut field = Self { distance: vec![u8::MAX; SIDE * SIDE], tops: vec![0; SIDE * SIDE] };
        let disc = disc();
        for cell in occupied {
            field.paint(cell, own[cell].unwrap_or_default(), &disc);
        }
        field
    }

    fn paint(&mut self, cell: usize, top: i8, disc: &[(i64, i64, u8)]) {
        let (column, row) = ((cell % SIDE) as i64, (cell / SIDE) as i64);
        for (dx, dy, distance) in disc {
            let (x, y) = (column + dx, row + dy);
            if (0..SIDE as i64).contains(&x) && (0..SIDE as i64).contains(&y) {
                let at = y as usize * SIDE + x as usize;
                if *distance < self.distance[at] {
                    self.distance[at] = *distance;
                    self.tops[at] = top;
                }
            }
        }
    }

    /// Distance from a place to the nearest obstacle, m, at most [`FAR`]; `None` beyond 50 m.
    pub(crate) fn distance(&self, x: f64, y: f64) -> Option<f64> {
        let distance = self.distance[cell(x, y)?];
        Some(if distance == u8::MAX { FAR } else { f64::from(distance) * STEP })
    }

    /// Whether there is an obstacle at a place.
    pub(crate) fn is_obstacle(&self, x: f64, y: f64) -> bool {
        cell(x, y).is_some_and(|cell| self.distance[cell] == 0)
    }

    /// The distance from a place, linear between the middles of cells, so that small moves are felt.
    pub(crate) fn smooth_distance(&self, x: f64, y: f64) -> Option<f64> {
        let [low_x, low_y] = [x, y].map(|value| (value / CELL).floor() * CELL);
        let [right, up] = [(x - low_x) / CELL, (y - low_y) / CELL];
        let at = |i: f64, j: f64| self.distance(low_x + i * CELL, low_y + j * CELL);
        let lower = at(0.0, 0.0)? * (1.0 - right) + at(1.0, 0.0)? * right;
        let upper = at(0.0, 1.0)? * (1.0 - right) + at(1.0, 1.0)? * right;
        Some(lower * (1.0 - up) + upper * up)
    }

    /// Highest point of the obstacle nearest to a place, m; `None` where there is none near.
    pub(crate) fn top(&self, x: f64, y: f64) -> Option<f64> {
        let at = cell(x, y)?;
        (self.distance[at] != u8::MAX).then(|| f64::from(self.tops[at]) * 0.1)
    }
}

fn cell(x: f64, y: f64) -> Option<usize> {
    let [column, row] = [x, y].map(|value| (value / CELL).round() + REACH as f64);
    let inside = |value: f64| value >= 0.0 && value < SIDE as f64;
    (inside(column) && inside(row)).then(|| row as usize * SIDE + column as usize)
}

/// Offsets of the cells about one, and their distances.
fn disc() -> Vec<(i64, i64, u8)> {
    let mut found = Vec::new();
    for dy in -DISC..=DISC {
        for dx in -DISC..=DISC {
            let distance = ((dx * dx + dy * dy) as f64).sqrt() * CELL;
            if distance < FAR {
                found.push((dx, dy, (distance / STEP).round() as u8));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_pole_is_as_far_as_it_is() {
        let field = PlanField::new([[10.0, -4.0, 1.0], [10.0, -4.0, 2.5], [900.0, 0.0, 1.0]]);
        assert_eq!(field.distance(10.0, -4.0), Some(0.0));
        assert!((field.distance(10.4, -4.0).unwrap() - 0.4).abs() < 0.01);
        assert_eq!(field.distance(12.0, -4.0), Some(FAR));
        assert_eq!(field.distance(51.0, 0.0), None);
        assert_eq!(field.distance(f64::NAN, 0.0), None);
        assert_eq!(field.top(10.4, -4.0), Some(2.5));
        assert_eq!(field.top(0.0, 0.0), None);
    }

    proptest! {
        #[test]
        fn distances_are_those_of_brute_force_within_a_cell(
            obstacles in proptest::collection::vec((-8.0..8.0_f64, -8.0..8.0_f64), 1..30),
            place in (-8.0..8.0_f64, -8.0..8.0_f64),
        ) {
            let field = PlanField::new(obstacles.iter().map(|(x, y)| [*x, *y, 1.0]));
            let nearest = obstacles.iter().map(|(x, y)| (x - place.0).hypot(y - place.1)).fold(FAR, f64::min);
            let found = field.distance(place.0, place.1).unwrap();
            let smooth = field.smooth_distance(place.0, place.1).unwrap();
            prop_assert!((smooth - nearest).abs() <= 2.0 * CELL * 2.0_f64.sqrt(), "{smooth} {nearest}");
            prop_assert!((found - nearest).abs() <= CELL * 2.0_f64.sqrt() + STEP, "{found} {nearest}");
        }
    }
}
