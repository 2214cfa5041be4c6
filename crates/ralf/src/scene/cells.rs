//! Square cells over a square of the horizontal plane around a frame's origin.

/// Cells by their number, row by row; rows lie along x.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cells {
    /// From the origin to each border, m.
    reach: f32,
    /// Edge of a cell, m.
    edge: f32,
    /// Cells along an edge of the square.
    pub(super) along: usize,
}

impl Cells {
    pub(super) const fn new(reach: f32, edge: f32) -> Self {
        Self { reach, edge, along: (2.0 * reach / edge) as usize }
    }

    /// How many there are.
    pub(super) const fn count(&self) -> usize {
        self.along * self.along
    }

    /// The cell at a place, m; `None` beyond the border, and where the place is not finite.
    pub(super) fn at(&self, x: f32, y: f32) -> Option<usize> {
        let [column, row] = [x, y].map(|v| (v + self.reach) / self.edge);
        let inside = |v: f32| (0.0..self.along as f32).contains(&v);
        // By way of `i32`, which is a cast at half the cost.
        (inside(column) && inside(row)).then(|| row as i32 as usize * self.along + column as i32 as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_end_at_the_border() {
        let cells = Cells::new(2.0, 0.5);
        assert_eq!((cells.along, cells.count()), (8, 64));
        assert_eq!(cells.at(-2.0, -2.0), Some(0));
        assert_eq!(cells.at(1.99, -1.4), Some(15));
        for (x, y) in [(2.0, 0.0), (0.0, -2.01), (f32::NAN, 0.0), (0.0, f32::INFINITY)] {
            assert_eq!(cells.at(x, y), None);
        }
    }
}
