//! How far the nearest obstacle is from any place in plan: a grid, so that a question costs one look.

use std::ops::Range;
use std::sync::LazyLock;

/// Width of a cell, m.
pub(crate) const CELL: f64 = 0.2;
/// Cells from the centre to the border: 50 m.
const REACH: usize = 250;
/// Cells of a side.
const SIDE: usize = 2 * REACH + 1;
/// Distances are known up to this many cells.
const DISC: usize = 5;
/// The distance of what is farther from every obstacle, m.
pub(crate) const FAR: f64 = DISC as f64 * CELL;

/// Beside an obstacle: in plan, m. Five standard deviations of a radar's range, and half a car's flank; of LiDARs the
/// width of a thing that both see from two sides.
const BESIDE: f64 = 0.4;

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
    /// Which cells are beside an obstacle: a bit each, row by row. Small enough that most questions find it near.
    beside: Vec<u16>,
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
/// So many of them.
const BESIDE_STEPS: u8 = (BESIDE / STEP) as u8;

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
        let mut canvas = Canvas::empty();
        let is_occupied =
            |column: usize, row: usize| own.get(row * SIDE + column).is_some_and(Option::is_some);
        for [column, row] in occupied {
            // What lies behind a neighbour is nearer to that one.
            let below = row > 0 && is_occupied(column, row - 1);
            let above = is_occupied(column, row + 1);
            let rows = if below { DISC } else { 0 }..if above { DISC + 1 } else { 2 * DISC + 1 };
            canvas.paint([column, row], rows, own[row * SIDE + column].unwrap_or_default());
        }
        let tiles = canvas.tiles();
        let beside = beside(&tiles);
        Self { tiles, beside }
    }

    /// The distance at a place, in steps of [`STEP`], and the top of what is there; of what is far from every obstacle
    /// the largest number. `None` beyond 50 m.
    fn at(&self, x: f64, y: f64) -> Option<(u8, i8)> {
        cell(x, y).map(|cell| self.of_cell(cell))
    }

    fn of_cell(&self, cell: [usize; 2]) -> (u8, i8) {
        let (tile, at) = place(cell);
        self.tiles[tile].as_ref().map_or((u8::MAX, 0), |tile| (tile.distance[at], tile.tops[at]))
    }

    /// Distance from a cell to the nearest obstacle, m, at most [`FAR`].
    fn distance_of(&self, cell: [usize; 2]) -> f64 {
        match self.of_cell(cell) {
            (u8::MAX, _) => FAR,
            (distance, _) => f64::from(distance) * STEP,
        }
    }

    /// Distance from a place to the nearest obstacle, m, at most [`FAR`]; `None` beyond 50 m.
    pub(crate) fn distance(&self, x: f64, y: f64) -> Option<f64> {
        cell(x, y).map(|cell| self.distance_of(cell))
    }

    /// Whether a place is [`BESIDE`] an obstacle; `None` beyond 50 m.
    pub(crate) fn is_beside(&self, x: f64, y: f64) -> Option<bool> {
        let [column, row] = cell(x, y)?;
        Some(self.beside[row * TILES + column / TILE] >> (column % TILE) & 1 == 1)
    }

    /// Whether there is an obstacle at a place.
    pub(crate) fn is_obstacle(&self, x: f64, y: f64) -> bool {
        self.at(x, y).is_some_and(|(distance, _)| distance == 0)
    }

    /// The distance from a place, linear between the middles of cells, so that small moves are felt.
    pub(crate) fn smooth_distance(&self, x: f64, y: f64) -> Option<f64> {
        let along = |value: f64| value / CELL + REACH as f64;
        let inside = |low: f64| low >= 0.0 && low < (SIDE - 1) as f64;
        let (column, row) = (along(x), along(y));
        if !inside(column.floor()) || !inside(row.floor()) {
            return None;
        }
        let (right, up) = (column.fract(), row.fract());
        let (column, row) = (column as usize, row as usize);
        let at = |i: usize, j: usize| self.distance_of([column + i, row + j]);
        let lower = at(0, 0) * (1.0 - right) + at(1, 0) * right;
        let upper = at(0, 1) * (1.0 - right) + at(1, 1) * right;
        Some(lower * (1.0 - up) + upper * up)
    }

    /// Highest point of the obstacle nearest to a place, m; `None` where there is none near.
    pub(crate) fn top(&self, x: f64, y: f64) -> Option<f64> {
        let (distance, top) = self.at(x, y)?;
        (distance != u8::MAX).then(|| f64::from(top) * 0.1)
    }
}

/// The cells beside an obstacle.
fn beside(tiles: &[Option<Box<Tile>>]) -> Vec<u16> {
    let mut beside = vec![0; TILES * TILES * TILE];
    for (place, tile) in tiles.iter().enumerate() {
        let Some(tile) = tile else { continue };
        for (y, row) in tile.distance.as_chunks::<TILE>().0.iter().enumerate() {
            let bits =
                row.iter().rev().fold(0, |bits, distance| bits << 1 | u16::from(*distance <= BESIDE_STEPS));
            beside[(place / TILES * TILE + y) * TILES + place % TILES] = bits;
        }
    }
    beside
}

/// Cells painted at once: a disc's widest row, rounded up to what a vector register holds.
const ROW: usize = 16;
/// A canvas has room for a disc about every cell, and for whole rows of it.
const WIDTH: usize = SIDE + ROW - 1;
const HEIGHT: usize = SIDE + 2 * DISC;

/// What a field is painted on: distances and tops as in a [`Tile`], [`DISC`] cells more to each side.
struct Canvas {
    distance: Vec<u8>,
    tops: Vec<i8>,
    /// The tiles that something was painted on.
    painted: Vec<bool>,
}

impl Canvas {
    fn empty() -> Self {
        let cells = WIDTH * HEIGHT;
        Self { distance: vec![u8::MAX; cells], tops: vec![0; cells], painted: vec![false; TILES * TILES] }
    }

    /// An obstacle in a cell, in these rows of the disc about it: what was painted first stays where another one is as
    /// near.
    fn paint(&mut self, [column, row]: [usize; 2], rows: Range<usize>, top: i8) {
        for (dy, disc) in DISTANCES.iter().enumerate().skip(rows.start).take(rows.len()) {
            let begin = (row + dy) * WIDTH + column;
            let row = begin..begin + ROW;
            let (distance, tops) = (&mut self.distance[row.clone()], &mut self.tops[row]);
            // All bits or none: what is chosen by an `if` is written cell by cell.
            for ((distance, own), new) in distance.iter_mut().zip(tops).zip(disc) {
                let nearer = u8::from(new < distance).wrapping_neg();
                *distance = (new & nearer) | (*distance & !nearer);
                *own = (top & nearer.cast_signed()) | (*own & !nearer.cast_signed());
            }
        }
        let ends = |cell: usize| [cell.saturating_sub(DISC), (cell + DISC).min(SIDE - 1)];
        for row in ends(row) {
            for column in ends(column) {
                self.painted[place([column, row]).0] = true;
            }
        }
    }

    /// `None` for tiles that are far from every obstacle.
    fn tiles(&self) -> Vec<Option<Box<Tile>>> {
        let tiles = self.painted.iter().enumerate();
        tiles.map(|(tile, painted)| painted.then(|| self.tile(tile % TILES, tile / TILES))).collect()
    }

    /// The tile in a column and row of tiles.
    fn tile(&self, column: usize, row: usize) -> Box<Tile> {
        let mut tile = Box::new(Tile { distance: [u8::MAX; TILE * TILE], tops: [0; TILE * TILE] });
        let width = TILE.min(SIDE - column * TILE);
        for y in 0..TILE.min(SIDE - row * TILE) {
            let from = (row * TILE + y + DISC) * WIDTH + column * TILE + DISC;
            tile.distance[y * TILE..][..width].copy_from_slice(&self.distance[from..][..width]);
            tile.tops[y * TILE..][..width].copy_from_slice(&self.tops[from..][..width]);
        }
        tile
    }
}

/// The tile of a cell, and where the cell is in it.
fn place([column, row]: [usize; 2]) -> (usize, usize) {
    ((row / TILE) * TILES + column / TILE, (row % TILE) * TILE + column % TILE)
}

/// Column and row of a place; `None` beyond 50 m.
fn cell(x: f64, y: f64) -> Option<[usize; 2]> {
    let along = |value: f64| (value / CELL).round() + REACH as f64;
    let inside = |value: f64| value >= 0.0 && value < SIDE as f64;
    let (column, row) = (along(x), along(y));
    (inside(column) && inside(row)).then_some([column as usize, row as usize])
}

/// Distances from the cells about one, row by row; the largest number where they are not felt.
static DISTANCES: LazyLock<[[u8; ROW]; 2 * DISC + 1]> = LazyLock::new(|| {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let [dx, dy] = [column, row].map(|at| at as f64 - DISC as f64);
            let distance = dx.hypot(dy) * CELL;
            if distance < FAR { (distance / STEP).round() as u8 } else { u8::MAX }
        })
    })
});

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

    /// Mostly near each other and near the border of what is known.
    fn border() -> impl Strategy<Value = f64> {
        prop_oneof![3 => 48.5..50.3_f64, 1 => -50.3..-48.5_f64, 1 => -1.0..1.0_f64]
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
            prop_assert_eq!(field.is_beside(place.0, place.1), Some(found <= BESIDE));
        }

        #[test]
        fn every_cell_has_what_the_first_of_the_nearest_obstacles_gives_it(
            obstacles in proptest::collection::vec((border(), border(), -3.0..12.0_f64), 1..20),
            offset in (-1.2..1.2_f64, -1.2..1.2_f64),
        ) {
            let field = PlanField::new(obstacles.iter().map(|(x, y, z)| [*x, *y, *z]));
            // What lies in one cell is as high as its highest point, and comes when its first one came.
            let mut cells: Vec<([usize; 2], i8)> = Vec::new();
            for (x, y, z) in &obstacles {
                let (Some(cell), top) = (cell(*x, *y), (z * 10.0) as i8) else { continue };
                match cells.iter_mut().find(|(known, _)| *known == cell) {
                    Some((_, known)) => *known = top.max(*known),
                    None => cells.push((cell, top)),
                }
            }
            for (x, y, _) in &obstacles {
                let place = (x + offset.0, y + offset.1);
                let expected = cell(place.0, place.1).map(|[column, row]| {
                    let mut nearest = (u8::MAX, 0);
                    for ([own_column, own_row], top) in &cells {
                        let (dx, dy) = (own_column.abs_diff(column), own_row.abs_diff(row));
                        let distance = ((dx * dx + dy * dy) as f64).sqrt() * CELL;
                        let steps = if distance < FAR { (distance / STEP).round() as u8 } else { u8::MAX };
                        if steps < nearest.0 {
                            nearest = (steps, *top);
                        }
                    }
                    nearest
                });
                prop_assert_eq!(field.at(place.0, place.1), expected);
            }
        }
    }
}
