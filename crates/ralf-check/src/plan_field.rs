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

/// Cells of a tile's side.
const TILE: usize = 16;
/// Tiles of a side.
const TILES: usize = SIDE.div_ceil(TILE);

/// Distances to the nearest obstacle, and the tops of obstacles, about the vehicle. Most of the plan is far from every
/// obstacle and takes no room.
#[derive(Debug, Clone)]
pub(crate) struct PlanField {
    /// Row by row, x along a row.
    tiles: Vec<Option<Box<Tile>>>,
}

/// A square of cells; row by row, x along a row.
#[derive(Debug, Clone)]
struct Tile {
    /// In steps of [`STEP`].
    distance: [u8; TILE * TILE],
    /// Highest point of the obstacle that is nearest, dm above the vehicle's origin.
    tops: [i8; TILE * TILE],
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
            let Some([column, row]) = cell(x, y) else { continue };
            let decimetres = (z * 10.0).clamp(-127.0, 127.0) as i8;
            match &mut own[row * SIDE + column] {
                Some(top) => *top = (*top).max(decimetres),
                empty => {
                    *empty = Some(decimetres);
                    occupied.push([column, row]);
                }
            }
        }
        let mut field = Self { tiles: vec![None; TILES * TILES] };
        let disc = disc();
        for [column, row] in occupied {
            field.paint([column, row], own[row * SIDE + column].unwrap_or_default(), &disc);
        }
        field
    }

    fn paint(&mut self, [column, row]: [usize; 2], top: i8, disc: &[(i64, i64, u8)]) {
        for (dx, dy, distance) in disc {
            let (x, y) = (column as i64 + dx, row as i64 + dy);
            if (0..SIDE as i64).contains(&x) && (0..SIDE as i64).contains(&y) {
                let (tile, at) = place([x as usize, y as usize]);
                let tile = self.tiles[tile].get_or_insert_with(Tile::far);
                if *distance < tile.distance[at] {
                    tile.distance[at] = *distance;
                    tile.tops[at] = top;
                }
            }
        }
    }

    /// The distance at a place, in steps of [`STEP`], and the top of what is there; of what is far from every obstacle
    /// the largest number. `None` beyond 50 m.
    fn at(&self, x: f64, y: f64) -> Option<(u8, i8)> {
        let (tile, at) = place(cell(x, y)?);
        Some(self.tiles[tile].as_ref().map_or((u8::MAX, 0), |tile| (tile.distance[at], tile.tops[at])))
    }

    /// Distance from a place to the nearest obstacle, m, at most [`FAR`]; `None` beyond 50 m.
    pub(crate) fn distance(&self, x: f64, y: f64) -> Option<f64> {
        let (distance, _) = self.at(x, y)?;
        Some(if distance == u8::MAX { FAR } else { f64::from(distance) * STEP })
    }

    /// Whether there is an obstacle at a place.
    pub(crate) fn is_obstacle(&self, x: f64, y: f64) -> bool {
        self.at(x, y).is_some_and(|(distance, _)| distance == 0)
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
        let (distance, top) = self.at(x, y)?;
        (distance != u8::MAX).then(|| f64::from(top) * 0.1)
    }
}

impl Tile {
    fn far() -> Box<Self> {
        Box::new(Self { distance: [u8::MAX; TILE * TILE], tops: [0; TILE * TILE] })
    }
}

/// The tile of a cell, and where the cell is in it.
fn place([column, row]: [usize; 2]) -> (usize, usize) {
    ((row / TILE) * TILES + column / TILE, (row % TILE) * TILE + column % TILE)
}

/// Column and row of a place; `None` beyond 50 m.
fn cell(x: f64, y: f64) -> Option<[usize; 2]> {
    let [column, row] = [x, y].map(|value| (value / CELL).round() + REACH as f64);
    let inside = |value: f64| value >= 0.0 && value < SIDE as f64;
    (inside(column) && inside(row)).then_some([column as usize, row as usize])
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
