//! One search: which cells are looked at, in which order, and the best points so far.

use super::{GridPoint, Neighbor, NeighborIndex, SLACK};
use std::ops::Range;

/// Cells to each side of the query's column that are searched first in a row.
const MIDDLE: usize = 2;
/// Distances are computed for this many points at a time.
const LANES: usize = 16;
/// Runs shorter than this are looked through one by one.
const FEW: usize = 8;

/// A search under way: the best points so far, in order.
pub(super) struct Search<'a> {
    pub(super) query: [f32; 3],
    /// How many are wanted: no more than there are.
    pub(super) k: usize,
    /// Edge of a cell, m.
    cell: f32,
    /// Only points at most this far can still enter, m^2.
    worst: f32,
    found: &'a mut Vec<Neighbor>,
}

impl<'a> Search<'a> {
    /// For the `k` points of an index nearest to a query.
    pub(super) fn new(
        index: &NeighborIndex,
        query: [f32; 3],
        k: usize,
        found: &'a mut Vec<Neighbor>,
    ) -> Self {
        found.clear();
        Self { query, k: k.min(index.len()), cell: index.cell, worst: f32::INFINITY, found }
    }

    /// The same among the points within a reach, m, and a hair more.
    pub(super) fn limited(mut self, reach: f32) -> Self {
        /// Squared distances are rounded by less.
        const ROUNDING: f32 = 1.000_01;
        self.worst = ROUNDING * reach * reach;
        self
    }

    /// Whether no better point can follow where all that are left lie at least `bound` away; or, with nothing found so
    /// far, beyond `reach`, m.
    pub(super) fn is_done(&self, bound: f32, reach: f32) -> bool {
        bound * bound > self.worst || (self.found.is_empty() && bound > reach)
    }

    /// Looks through the query's own cell and those around it, as three runs of points.
    pub(super) fn middle(&mut self, index: &NeighborIndex, at: &GridPoint) {
        let [column, row] = at.cell;
        let (left, right) = (column.saturating_sub(1), (column + 1).min(index.columns - 1));
        for row in row.saturating_sub(1)..=(row + 1).min(index.rows - 1) {
            self.scan(index, index.cells(row, left, right));
        }
    }

    /// Looks through the cells at so many cells, at least one, from the query's own.
    pub(super) fn ring(&mut self, index: &NeighborIndex, at: &GridPoint, ring: usize) {
        let [cx, cy] = at.cell;
        // The cells of a row lie side by side, so that the ring's lower and upper edge are one run of points each.
        if ring <= cy {
            self.row(index, at, ring, cy - ring);
        }
        if cy + ring < index.rows {
            self.row(index, at, ring, cy + ring);
        }
        if ring <= cx {
            self.column(index, at, ring, cx - ring);
        }
        if cx + ring < index.columns {
            self.column(index, at, ring, cx + ring);
        }
    }

    /// The ring's cells in a row, as far as they can hold a point that is near enough: the middle ones first, for what
    /// they hold leaves less of the others.
    fn row(&mut self, index: &NeighborIndex, at: &GridPoint, ring: usize, row: usize) {
        let away = distance_to_cell(at.y, row);
        let column = at.cell[0];
        let (first, last) = stretch(at.x, column, ring.min(MIDDLE), self.reach_beside(away), index.columns);
        if first <= last {
            self.scan(index, index.cells(row, first, last));
        }
        if ring <= MIDDLE {
            return;
        }
        let (left, right) = stretch(at.x, column, ring, self.reach_beside(away), index.columns);
        if left + MIDDLE < column {
            self.scan(index, index.cells(row, left, column - MIDDLE - 1));
        }
        if column + MIDDLE < right {
            self.scan(index, index.cells(row, column + MIDDLE + 1, right));
        }
    }

    /// The ring's cells in a column, its corners apart, from the middle outward.
    fn column(&mut self, index: &NeighborIndex, at: &GridPoint, ring: usize, column: usize) {
        let away = distance_to_cell(at.x, column);
        let (low, high) = stretch(at.y, at.cell[1], ring - 1, self.reach_beside(away), index.rows);
        let first = column * index.rows;
        if low > high || index.before[first + low] == index.before[first + high + 1] {
            return;
        }
        for step in 0..ring {
            if step as f32 > self.reach_beside(away) + 1.0 {
                break;
            }
            let row = at.cell[1];
            if step <= row {
                self.scan(index, index.cells(row - step, column, column));
            }
            if step > 0 && row + step < index.rows {
                self.scan(index, index.cells(row + step, column, column));
            }
        }
    }

    /// How far to the side, in cells, a point can still be near enough whose cell lies this many cells away.
    fn reach_beside(&self, cells_away: f32) -> f32 {
        let away = (cells_away * self.cell - SLACK).max(0.0);
        let left = self.worst - away * away;
        if left < 0.0 { -1.0 } else { (left.sqrt() + SLACK) / self.cell }
    }

    fn scan(&mut self, index: &NeighborIndex, run: Range<usize>) {
        if run.len() < FEW {
            return self.scan_few(index, run);
        }
        let points = index.xs[run.clone()].chunks(LANES).zip(index.ys[run.clone()].chunks(LANES));
        let points = points.zip(index.zs[run.clone()].chunks(LANES));
        for (((xs, ys), zs), ids) in points.zip(index.ids[run.clone()].chunks(LANES)) {
            self.scan_some(xs, ys, zs, ids);
        }
    }

    /// One point after the other: for runs too short for vector instructions.
    fn scan_few(&mut self, index: &NeighborIndex, run: Range<usize>) {
        for place in run {
            let distance_squared = self.distance_squared(index.xs[place], index.ys[place], index.zs[place]);
            if distance_squared <= self.worst {
                self.enter(Neighbor { id: index.ids[place], distance_squared });
            }
        }
    }

    fn distance_squared(&self, x: f32, y: f32, z: f32) -> f32 {
        let [dx, dy, dz] = [x - self.query[0], y - self.query[1], z - self.query[2]];
        dx * dx + dy * dy + dz * dz
    }

    /// At most [`LANES`] points: all distances first, which the compiler turns into vector instructions.
    fn scan_some(&mut self, xs: &[f32], ys: &[f32], zs: &[f32], ids: &[u32]) {
        let mut distances = [f32::INFINITY; LANES];
        for (distance, ((x, y), z)) in distances.iter_mut().zip(xs.iter().zip(ys).zip(zs)) {
            *distance = self.distance_squared(*x, *y, *z);
        }
        let hits = distances.iter().fold(0, |hits, distance| hits | u32::from(*distance <= self.worst));
        if hits == 0 {
            return;
        }
        for (distance_squared, id) in distances.into_iter().zip(ids) {
            if distance_squared <= self.worst {
                self.enter(Neighbor { id: *id, distance_squared });
            }
        }
    }

    fn enter(&mut self, candidate: Neighbor) {
        let before = |other: &Neighbor| {
            (other.distance_squared, other.id) < (candidate.distance_squared, candidate.id)
        };
        let place = self.found.partition_point(before);
        if place == self.k {
            return;
        }
        self.found.truncate(self.k - 1);
        self.found.insert(place, candidate);
        if self.found.len() == self.k {
            self.worst = self.found[self.k - 1].distance_squared;
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
