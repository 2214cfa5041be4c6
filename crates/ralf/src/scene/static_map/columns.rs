//! What stands above each place.

use super::REACH;

/// Edge of a column, m.
const CELL: f32 = 0.25;
/// Columns along an edge.
const CELLS: usize = (2.0 * REACH / CELL) as usize;

/// What fills a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Column {
    /// Height of the lowest voxel's point above the ground, m.
    pub bottom: f32,
    /// Height of the highest voxel's point above the ground, m.
    pub top: f32,
    /// How many voxels are filled; 0 in an empty column.
    pub voxels: u16,
}

/// Columns of 0.25 m over the horizontal plane of a frame.
#[derive(Debug)]
pub struct ColumnGrid {
    columns: Vec<Column>,
}

impl ColumnGrid {
    /// Edge of a column, m.
    pub const CELL: f64 = CELL as f64;
    const EMPTY: Column = Column { bottom: f32::INFINITY, top: f32::NEG_INFINITY, voxels: 0 };

    pub(super) fn empty() -> Self {
        Self { columns: vec![Self::EMPTY; CELLS * CELLS] }
    }

    /// Fills a voxel at a height above the ground, m.
    pub(super) fn add(&mut self, cell: usize, height: f32) {
        let column = &mut self.columns[cell];
        column.bottom = column.bottom.min(height);
        column.top = column.top.max(height);
        column.voxels = column.voxels.saturating_add(1);
    }

    /// What stands at a place; `None` beyond the map, and where nothing stands.
    pub fn at(&self, x: f64, y: f64) -> Option<&Column> {
        let column = &self.columns[cell_of(x as f32, y as f32)?];
        (column.voxels > 0).then_some(column)
    }

    /// Whether the map reaches to a place.
    pub fn covers(x: f64, y: f64) -> bool {
        cell_of(x as f32, y as f32).is_some()
    }

    /// The filled columns with their middle less than a distance from a place, m, along each axis, with the way there.
    pub fn around(&self, x: f64, y: f64, distance: f64) -> impl Iterator<Item = ([f64; 2], &Column)> {
        let span = |v: f64| {
            let place = |v: f64| ((v + f64::from(REACH)) / Self::CELL - 0.5).clamp(0.0, CELLS as f64);
            place(v - distance).ceil() as usize..place(v + distance).ceil() as usize
        };
        let columns = span(x);
        span(y).flat_map(move |row| {
            let filled = self.columns[row * CELLS..][columns.clone()].iter();
            let filled = filled.enumerate().filter(|(_, column)| column.voxels > 0);
            let first = columns.start;
            filled.map(move |(place, column)| ([middle(first + place) - x, middle(row) - y], column))
        })
    }
}

/// The middle of a row or column of cells, m.
fn middle(cell: usize) -> f64 {
    (cell as f64 + 0.5) * ColumnGrid::CELL - f64::from(REACH)
}

/// The column at a place; `None` beyond the map.
pub(super) fn cell_of(x: f32, y: f32) -> Option<usize> {
    let [column, row] = [x, y].map(|v| (v + REACH) / CELL);
    let inside = |v: f32| (0.0..CELLS as f32).contains(&v);
    (inside(column) && inside(row)).then(|| row as usize * CELLS + column as usize)
}
