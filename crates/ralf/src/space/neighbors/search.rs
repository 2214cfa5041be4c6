//! One search: which cells are looked at, and in which order.

use super::best::{Best, LANES};
use super::grid::GridPoint;
use super::{NeighborIndex, SLACK};
use std::ops::Range;

/// Cells to each side of the query's column that are searched first in a row.
const MIDDLE: usize = 2;
/// Then so many times as many.
const WIDER: usize = 3;
/// So many points around a query are all looked at.
const FEW: usize = 48;

/// A search under way.
pub(super) struct Search<'a, B> {
    index: &'a NeighborIndex,
    query: [f32; 3],
    /// The nearest points so far.
    best: B,
}

impl<'a, B: Best> Search<'a, B> {
    /// For the points of an index nearest to a query.
    pub(super) fn new(index: &'a NeighborIndex, query: [f32; 3], best: B) -> Self {
        Self { index, query, best }
    }

    /// Looks at rings of cells until no nearer point can follow, or until all that are left lie beyond `reach`, m, with
    /// nothing found so far.
    pub(super) fn run(mut self, reach: f32) -> B {
        let index = self.index;
        let at = index.place_of(self.query[0], self.query[1]);
        let first = index.occupancy.as_ref().map_or(0, |occupancy| occupancy.first_ring(at.cell));
        if first == 0 {
            self.middle(&at);
            // A whole cell lies between the query's, or the one nearest to it, and the next ring.
            if (index.cell - SLACK).max(0.0).powi(2) > self.best.worst() {
                return self.best;
            }
        }
        for ring in first.max(2)..index.columns.max(index.rows) {
            let is_beyond_reach = || self.best.is_empty() && index.bound_within(&at, ring) > reach;
            if index.bound_squared(&at, ring) > self.best.worst() || is_beyond_reach() {
                break;
            }
            self.ring(&at, ring);
        }
        self.best
    }

    /// Looks through the query's own cell and those around it.
    fn middle(&mut self, at: &GridPoint) {
        let index = self.index;
        let [column, row] = at.cell;
        let (left, right) = (column.saturating_sub(1), (column + 1).min(index.columns - 1));
        let (bottom, top) = (row.saturating_sub(1), (row + 1).min(index.rows - 1));
        // A few points are looked through sooner than it is told which of them need not be.
        if (bottom..=top).map(|row| index.cells(row, left, right).len()).sum::<usize>() <= FEW {
            (bottom..=top).for_each(|row| self.scan(index.cells(row, left, right)));
        } else {
            self.scan(index.cells(row, column, column));
            self.ring(at, 1);
        }
    }

    /// Looks through the cells at so many cells, at least one, from the query's own.
    fn ring(&mut self, at: &GridPoint, ring: usize) {
        let (index, [cx, cy]) = (self.index, at.cell);
        // The cells of a row lie side by side, so that the ring's lower and upper edge are one run of points each.
        if ring <= cy {
            self.row(at, ring, cy - ring);
        }
        if cy + ring < index.rows {
            self.row(at, ring, cy + ring);
        }
        if ring <= cx {
            self.column(at, ring, cx - ring);
        }
        if cx + ring < index.columns {
            self.column(at, ring, cx + ring);
        }
    }

    /// The ring's cells in a row, as far as they can hold a point that is near enough, from the middle outward: what
    /// the middle holds leaves less of the others.
    fn row(&mut self, at: &GridPoint, ring: usize, row: usize) {
        let (index, column) = (self.index, at.cell[0]);
        // Most are empty, which is told sooner than how much of them can be near enough.
        let whole = (column.saturating_sub(ring), (column + ring).min(index.columns - 1));
        if index.cells(row, whole.0, whole.1).is_empty() {
            return;
        }
        let away = distance_to_cell(at.y, row);
        let (mut left, mut right) = stretch(at.x, column, ring, self.reach_beside(away), index.columns);
        if left > right {
            return;
        }
        // Columns that were looked at: none.
        let begin = left.max(column.saturating_sub(MIDDLE));
        let mut seen = begin..begin;
        let mut width = MIDDLE;
        loop {
            (left, right) = stretch(at.x, column, ring.min(width), self.reach_beside(away), index.columns);
            if left < seen.start {
                self.scan(index.cells(row, left, seen.start - 1));
            }
            if right >= seen.end {
                self.scan(index.cells(row, seen.end, right));
            }
            if width >= ring {
                return;
            }
            seen = left.min(seen.start)..seen.end.max(right + 1);
            width *= WIDER;
        }
    }

    /// The ring's cells in a column, its corners apart, from the middle outward.
    fn column(&mut self, at: &GridPoint, ring: usize, column: usize) {
        let index = self.index;
        let first = column * index.rows;
        let (low, high) = (at.cell[1].saturating_sub(ring - 1), (at.cell[1] + ring - 1).min(index.rows - 1));
        if index.before[first + low] == index.before[first + high + 1] {
            return;
        }
        let away = distance_to_cell(at.x, column);
        let (low, high) = stretch(at.y, at.cell[1], ring - 1, self.reach_beside(away), index.rows);
        if low > high {
            return;
        }
        let middle = at.cell[1];
        self.up_or_down(at, column, (low..=middle.min(high)).rev());
        self.up_or_down(at, column, (middle + 1).max(low)..=high);
    }

    /// Cells of a column, each farther from the query than the one before, as far as they can hold a point that is near
    /// enough.
    fn up_or_down(&mut self, at: &GridPoint, column: usize, rows: impl Iterator<Item = usize>) {
        let away = distance_to_cell(at.x, column);
        for row in rows {
            if !self.reaches(away, distance_to_cell(at.y, row)) {
                return;
            }
            self.scan(self.index.cells(row, column, column));
        }
    }

    /// Whether a point can still be near enough whose cell lies so many cells away in column and row.
    fn reaches(&self, columns: f32, rows: f32) -> bool {
        let [x, y] = [columns, rows].map(|cells| (cells * self.index.cell - SLACK).max(0.0));
        x * x + y * y <= self.best.worst()
    }

    /// How far to the side, in cells, a point can still be near enough whose cell lies this many cells away.
    fn reach_beside(&self, cells_away: f32) -> f32 {
        let away = (cells_away * self.index.cell - SLACK).max(0.0);
        let left = self.best.worst() - away * away;
        if left < 0.0 { -1.0 } else { (left.sqrt() + SLACK) / self.index.cell }
    }

    /// Looks at a run of points, so many at a time: what follows the run are points, too, or infinitely far.
    fn scan(&mut self, mut run: Range<usize>) {
        let NeighborIndex { xs, ys, zs, ids, .. } = self.index;
        let [x, y, z] = self.query;
        while !run.is_empty() {
            let some = run.start..run.start + LANES;
            let points = [xs, ys, zs].map(|values| values[some.clone()].first_chunk::<LANES>());
            let ([Some(xs), Some(ys), Some(zs)], Some(ids)) = (points, ids[some].first_chunk()) else {
                return;
            };
            let mut distances = [0.0; LANES];
            for (distance, ((px, py), pz)) in distances.iter_mut().zip(xs.iter().zip(ys).zip(zs)) {
                let [dx, dy, dz] = [px - x, py - y, pz - z];
                *distance = dx * dx + dy * dy + dz * dz;
            }
            self.best.take(&distances, ids, run.len());
            run.start += LANES;
        }
    }
}

/// From a place to a row or column of cells, across, in cells.
fn distance_to_cell(place: f32, cell: usize) -> f32 {
    (cell as f32 - place).max(place - (cell + 1) as f32).max(0.0)
}

/// The cells of a ring's edge that lie within a distance of a place, first and last; none if the first is the larger.
fn stretch(place: f32, cell: usize, ring: usize, within: f32, cells: usize) -> (usize, usize) {
    let first = (place - within).max(0.0) as usize;
    let last = (place + within).min((cells - 1) as f32) as usize;
    (first.max(cell.saturating_sub(ring)), last.min(cell + ring))
}
