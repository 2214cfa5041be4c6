//! The only nearest-neighbour search: exact, over a bird's-eye grid that is cheap to build.
//!
//! A LiDAR scan is asked some thousand questions and thrown away, so the build decides. Points are sorted by counting
//! into square cells of the ground plane; a search looks at rings of cells around the query's, from the first that may
//! hold a point, until no nearer one can follow.
//!
//! Points beyond the grid are clamped into its border cells. Clamping to a box never lengthens a distance, so the bound
//! that ends a search holds for them too, and a few points far away cannot blow up the grid. A query beyond the points
//! is as far from all of them as it is from the grid.

mod best;
mod grid;
mod occupancy;
mod search;

use best::{Best, Few, LANES, Many, One};
use grid::span;
use occupancy::Occupancy;
use search::Search;
use std::ops::Range;

/// Edge of a cell, m, where there are enough points for cells so small.
const CELL: f32 = 1.0;
/// Cells per point at most: more would cost more to make than they save.
const CELLS_PER_POINT: usize = 1;
/// A grid of so many cells along an edge has room for rings that are worth passing over.
const WIDE: usize = 24;
/// The grid covers at most this far from the frame's origin in x and in y, m.
const REACH: f32 = 256.0;
/// Rounding may put a point that lies on a cell's border into the next one; bounds are loosened by this, m.
const SLACK: f32 = 1e-3;
/// Of a way that leads along y by less than this for each metre along x, a row holds about all that it leads past.
const STEEP: f32 = 0.25;

/// A point found by a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Neighbor {
    /// The point's identity, as given to [`NeighborIndex::new`].
    pub id: u32,
    /// From the query, m^2.
    pub distance_squared: f32,
}

/// Points sorted for nearest-neighbour searches.
#[derive(Debug, Clone)]
pub struct NeighborIndex {
    origin: [f32; 2],
    /// What lies farther is clamped to here, m: [`REACH`], or the border of the grid where that lies beyond.
    ends: [f32; 2],
    /// Edge of a cell, m.
    cell: f32,
    columns: usize,
    rows: usize,
    /// Where each cell's points begin, row by row, and the end.
    starts: Vec<u32>,
    /// How many points lie in the cells before each one, column by column: tells at once that a stretch of a column is
    /// empty.
    before: Vec<u32>,
    /// Where searches may begin, of a wide grid.
    occupancy: Option<Occupancy>,
    /// How many points.
    points: usize,
    /// Where they lie, m, cell by cell; what pads the end is infinitely far.
    xs: Vec<f32>,
    ys: Vec<f32>,
    zs: Vec<f32>,
    ids: Vec<u32>,
}

impl NeighborIndex {
    /// An index over finite points, each with an identity. For a horizontal search give all points, and queries, z = 0.
    pub fn new(points: &[[f32; 3]], ids: &[u32]) -> Self {
        debug_assert_eq!(points.len(), ids.len());
        let mut index = Self::empty_grid(points);
        let cells = index.cells_of(points);
        for &cell in &cells {
            index.starts[cell as usize + 1] += 1;
        }
        running_sum(&mut index.starts);
        index.count_columns();
        if index.columns.max(index.rows) >= WIDE {
            let is_filled = |cell| index.starts[cell] < index.starts[cell + 1];
            index.occupancy = Some(Occupancy::new(index.columns, index.rows, is_filled));
        }
        index.sort(points, ids, cells);
        index
    }

    /// Puts the points in the order of their cells, those of a cell in the order in which they come.
    fn sort(&mut self, points: &[[f32; 3]], ids: &[u32], cells: Vec<u32>) {
        // The order first and then column by column: columns that are written here and there at once cost more.
        let mut order = self.order_of(cells);
        let column = |axis: usize| {
            let mut values = Vec::with_capacity(order.len() + LANES);
            values.extend(order.iter().map(|i| points[*i as usize][axis]));
            values.extend([f32::INFINITY; LANES]);
            values
        };
        [self.xs, self.ys, self.zs] = [0, 1, 2].map(column);
        order.iter_mut().for_each(|i| *i = ids[*i as usize]);
        order.extend([u32::MAX; LANES]);
        self.ids = order;
    }

    /// Which point stands at each place.
    fn order_of(&self, cells: Vec<u32>) -> Vec<u32> {
        let mut next = self.starts.clone();
        let mut order = Vec::with_capacity(cells.len() + LANES);
        order.resize(cells.len(), 0);
        for (i, cell) in (0u32..).zip(cells) {
            let place = &mut next[cell as usize];
            order[*place as usize] = i;
            *place += 1;
        }
        order
    }

    fn empty_grid(points: &[[f32; 3]]) -> Self {
        let n = points.len();
        let [(x, width), (y, height)] = span(points);
        let cell = (width * height / (CELLS_PER_POINT * n).max(1) as f32).sqrt().max(CELL);
        let [columns, rows] = [width, height].map(|size| (size / cell) as usize + 1);
        Self {
            origin: [x, y],
            ends: [(x, columns), (y, rows)].map(|(begin, cells)| REACH.max(begin + cells as f32 * cell)),
            cell,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            before: vec![0; columns * rows + 1],
            occupancy: None,
            points: n,
            xs: Vec::new(),
            ys: Vec::new(),
            zs: Vec::new(),
            ids: Vec::new(),
        }
    }

    fn count_columns(&mut self) {
        for row in 0..self.rows {
            for column in 0..self.columns {
                self.before[column * self.rows + row + 1] = self.cells(row, column, column).len() as u32;
            }
        }
        running_sum(&mut self.before);
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.points
    }

    /// Whether there is nothing to find.
    pub fn is_empty(&self) -> bool {
        self.points == 0
    }

    /// The `k` points nearest to the query, nearest first, fewer when the cloud has fewer. Of equal distances the
    /// smaller identity is the nearer. `found` is overwritten, so that many searches share one allocation.
    pub fn nearest(&self, query: [f32; 3], k: usize, found: &mut Vec<Neighbor>) {
        self.nearest_within(query, k, f32::INFINITY, found);
    }

    /// As [`Self::nearest`], but finds nothing where it can tell that no point lies within `reach`, m.
    pub fn nearest_within(&self, query: [f32; 3], k: usize, reach: f32, found: &mut Vec<Neighbor>) {
        self.search(query, k, [f32::INFINITY, reach], found);
    }

    /// As [`Self::nearest`], but finds nothing unless a point lies within `reach`, m, or a hair farther. That is told
    /// first, among what lies there alone.
    pub fn nearest_if_within(&self, query: [f32; 3], k: usize, reach: f32, found: &mut Vec<Neighbor>) {
        /// Squared distances are rounded by less.
        const ROUNDING: f32 = 1.000_01;
        self.search(query, k, [ROUNDING * reach * reach, reach], found);
        if !found.is_empty() && found.len() < k.min(self.len()) {
            self.nearest(query, k, found);
        }
    }

    /// The `k` nearest points of those at most as far as the limit, m^2; none where the first that is looked at would
    /// lie beyond the reach, m.
    fn search(&self, query: [f32; 3], k: usize, [limit, reach]: [f32; 2], found: &mut Vec<Neighbor>) {
        found.clear();
        match k.min(self.len()) {
            0 => (),
            1 => Search::new(self, query, One::within(limit)).run(reach).give(found),
            k @ 2..=3 => Search::new(self, query, Few::<3>::within(limit, k)).run(reach).give(found),
            k @ 4..=5 => Search::new(self, query, Few::<5>::within(limit, k)).run(reach).give(found),
            k @ 6..=10 => Search::new(self, query, Few::<10>::within(limit, k)).run(reach).give(found),
            k => Search::new(self, query, Many::within(limit, k)).run(reach).give(found),
        }
    }

    /// The identities of all points in the order in which they are searched: what lies side by side is mostly near.
    pub fn ids(&self) -> &[u32] {
        &self.ids[..self.points]
    }

    /// The identities of all points at most `radius`, m, from a place, seen from above, in an order that depends on the
    /// points alone. `found` is overwritten.
    pub fn beside(&self, place: [f32; 2], radius: f32, found: &mut Vec<u32>) {
        found.clear();
        let [x, y] = place;
        for run in self.runs_around(place, radius) {
            let points = self.xs[run.clone()].iter().zip(&self.ys[run.clone()]).zip(&self.ids[run]);
            for ((px, py), id) in points {
                let [dx, dy] = [px - x, py - y];
                if dx * dx + dy * dy <= radius * radius {
                    found.push(*id);
                }
            }
        }
    }

    /// How many points [`Self::beside`] finds whose kind counts: `kinds` are those of the points in the order of
    /// [`Self::ids`]. What is compared alone, and looked up nowhere, is asked of several points at once.
    pub fn count_beside_where(
        &self,
        [x, y]: [f32; 2],
        radius: f32,
        kinds: &[u32],
        counts: impl Fn(u32) -> bool,
    ) -> usize {
        let mut count = 0;
        for run in self.runs_around([x, y], radius) {
            let points = self.xs[run.clone()].iter().zip(&self.ys[run.clone()]).zip(&kinds[run]);
            let within = points.map(|((px, py), kind)| {
                let [dx, dy] = [px - x, py - y];
                u32::from((dx * dx + dy * dy <= radius * radius) & counts(*kind))
            });
            count += within.sum::<u32>() as usize;
        }
        count
    }

    /// How many points [`Self::beside`] finds.
    pub fn count_beside(&self, [x, y]: [f32; 2], radius: f32) -> usize {
        let mut count = 0;
        for run in self.runs_around([x, y], radius) {
            let points = self.xs[run.clone()].iter().zip(&self.ys[run]);
            let within = points.map(|(px, py)| {
                let [dx, dy] = [px - x, py - y];
                u32::from(dx * dx + dy * dy <= radius * radius)
            });
            count += within.sum::<u32>() as usize;
        }
        count
    }

    /// Stretches of [`Self::ids`], row by row, that hold all points within a distance, m, of a place, seen from above,
    /// and some beside them; none around what is no place.
    pub fn runs_around(&self, [x, y]: [f32; 2], radius: f32) -> impl Iterator<Item = Range<usize>> + use<'_> {
        let anywhere = !self.is_empty() && x.is_finite() && y.is_finite() && radius >= 0.0;
        let wide = radius + SLACK;
        let [left, bottom] = self.place_of(x - wide, y - wide).cell;
        let [right, top] = self.place_of(x + wide, y + wide).cell;
        let rows = if anywhere { bottom..top + 1 } else { 0..0 };
        rows.map(move |row| self.cells(row, left, right))
    }

    /// Stretches of [`Self::ids`], row by row, that hold all points within a distance, m, of the way from one place
    /// straight to another, seen from above, and some beside them; none where either is no place.
    pub fn runs_along(
        &self,
        [from, to]: [[f32; 2]; 2],
        radius: f32,
    ) -> impl Iterator<Item = Range<usize>> + use<'_> {
        let anywhere = !self.is_empty() && from.into_iter().chain(to).all(f32::is_finite) && radius >= 0.0;
        let wide = radius + SLACK;
        let [low, high] = [from[1].min(to[1]) - wide, from[1].max(to[1]) + wide];
        let [bottom, top] = [low, high].map(|y| self.cell_along(y, 1));
        let rows = if anywhere { bottom..top + 1 } else { 0..0 };
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        // A line along the way, for each metre of y; and how far along x what is near lies beside it.
        let (lean, beside) = (dx / dy, wide * dx.hypot(dy) / dy.abs());
        let is_steep = dy.abs() > STEEP * dx.abs();
        rows.map(move |row| {
            // Points beyond the grid lie in its border. A hair more, so that rounding never decides.
            let [below, above] = [row, row + 1].map(|row| self.origin[1] + row as f32 * self.cell);
            let below = if row == 0 { f32::NEG_INFINITY } else { below - SLACK };
            let above = if row + 1 == self.rows { f32::INFINITY } else { above + SLACK };
            // The part of the way that is near the row; of a way along the row all of it.
            let parts = [below - wide, above + wide].map(|y| ((y - from[1]) / dy).clamp(0.0, 1.0));
            let [a, b] = if dy == 0.0 { [0.0, 1.0] } else { parts }.map(|part| from[0] + part * dx);
            let (mut left, mut right) = (a.min(b) - wide, a.max(b) + wide);
            if is_steep {
                let [a, b] = [below, above].map(|y| from[0] + (y - from[1]) * lean);
                (left, right) = (left.max(a.min(b) - beside), right.min(a.max(b) + beside));
            }
            if left > right {
                return 0..0;
            }
            self.cells(row, self.cell_along(left, 0), self.cell_along(right, 0))
        })
    }

    /// Points of the cells `left..=right` of a row.
    fn cells(&self, row: usize, left: usize, right: usize) -> Range<usize> {
        let first = row * self.columns;
        self.starts[first + left] as usize..self.starts[first + right + 1] as usize
    }
}

fn running_sum(counts: &mut [u32]) {
    let mut total = 0;
    for count in counts {
        total += *count;
        *count = total;
    }
}

#[cfg(test)]
mod tests;
