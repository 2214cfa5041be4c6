//! Where places lie in the grid, and how far they are from its cells.

use super::{NeighborIndex, REACH, SLACK};

/// Where a point lies in the grid or beyond it, in cells; points farther away than a grid reaches are clamped.
pub(super) struct GridPoint {
    pub(super) x: f32,
    pub(super) y: f32,
    /// Column and row of the nearest cell.
    pub(super) cell: [usize; 2],
    is_inside: bool,
}

impl NeighborIndex {
    /// The square of a distance, m^2: no point of this ring or a later one lies nearer. Sides beyond the grid hold no
    /// points, and a query beyond it is farther from all of them.
    pub(super) fn bound_squared(&self, at: &GridPoint, ring: usize) -> f32 {
        let x = to_ring(at.x, at.cell[0], self.columns, ring);
        let y = to_ring(at.y, at.cell[1], self.rows, ring);
        if at.is_inside {
            return self.squared(x.min(y));
        }
        let beyond = |place: f32, cells: usize| self.squared((-place).max(place - cells as f32));
        let (beyond_x, beyond_y) = (beyond(at.x, self.columns), beyond(at.y, self.rows));
        (self.squared(x) + beyond_y).min(self.squared(y) + beyond_x)
    }

    /// The square of so many cells, m^2, and a hair less.
    fn squared(&self, cells: f32) -> f32 {
        (cells * self.cell - SLACK).max(0.0).powi(2)
    }

    /// No point of this ring or a later one lies nearer than this, m, to the place in the grid that is nearest to the
    /// query.
    pub(super) fn bound_within(&self, at: &GridPoint, ring: usize) -> f32 {
        let side =
            |place: f32, cell, cells: usize| to_ring(place.clamp(0.0, cells as f32), cell, cells, ring);
        let nearest = side(at.x, at.cell[0], self.columns).min(side(at.y, at.cell[1], self.rows));
        (nearest * self.cell - SLACK).max(0.0)
    }

    /// Where a query lies.
    pub(super) fn place_of(&self, x: f32, y: f32) -> GridPoint {
        let [x, y] = [self.place_along(x, 0), self.place_along(y, 1)];
        let cell = [cell_of(x, self.columns), cell_of(y, self.rows)];
        let is_inside = x >= 0.0 && y >= 0.0 && x <= self.columns as f32 && y <= self.rows as f32;
        GridPoint { x, y, cell, is_inside }
    }

    /// The column of a place along x, axis 0, or the row of one along y, axis 1.
    pub(super) fn cell_along(&self, value: f32, axis: usize) -> usize {
        cell_of(self.place_along(value, axis), [self.columns, self.rows][axis])
    }

    /// In cells.
    fn place_along(&self, value: f32, axis: usize) -> f32 {
        (value.clamp(-REACH, self.ends[axis]) - self.origin[axis]) / self.cell
    }

    /// The cell that each point lies in, as [`Self::place_of`] has it, in numbers that the compiler turns into vectors.
    pub(super) fn cells_of(&self, points: &[[f32; 3]]) -> Vec<u32> {
        let ([x0, y0], cell) = (self.origin, self.cell);
        let [last_column, last_row] = [self.columns, self.rows].map(|cells| (cells - 1) as f32);
        let along = |value: f32, origin: f32, last: f32| ((value - origin) / cell).clamp(0.0, last) as i32;
        let columns = self.columns as i32;
        points
            .iter()
            .map(|[x, y, _]| (along(*y, y0, last_row) * columns + along(*x, x0, last_column)) as u32)
            .collect()
    }
}

/// The nearest of so many cells.
fn cell_of(place: f32, cells: usize) -> usize {
    (place as i32).clamp(0, cells as i32 - 1) as usize
}

/// The least coordinates of the points, and how far they reach from there, m; clamped to [`REACH`].
pub(super) fn span(points: &[[f32; 3]]) -> [(f32, f32); 2] {
    let [mut low, mut high] = [[REACH; 2], [-REACH; 2]];
    for [x, y, _] in points {
        for (axis, value) in [*x, *y].into_iter().enumerate() {
            low[axis] = if value < low[axis] { value } else { low[axis] };
            high[axis] = if value > high[axis] { value } else { high[axis] };
        }
    }
    [0, 1].map(|axis| {
        let (low, high) = (low[axis].max(-REACH), high[axis].min(REACH));
        (low.min(high), (high - low).max(0.0))
    })
}

/// From a place along an axis, with its cell and how many there are, to the nearest cells at so many from its own, in
/// cells; infinite where there are none.
fn to_ring(place: f32, cell: usize, cells: usize, ring: usize) -> f32 {
    let below = if cell >= ring { place - (cell + 1) as f32 + ring as f32 } else { f32::INFINITY };
    let above = if cell + ring < cells { (cell + ring) as f32 - place } else { f32::INFINITY };
    below.min(above)
}
