//! The only nearest-neighbour search: exact, over a bird's-eye grid that is cheap to build.
//!
//! A LiDAR scan is asked some thousand questions and thrown away, so the build decides. Points are sorted by counting into
//! square cells of the ground plane; a search looks at rings of cells around the query's until no nearer point can follow.
//!
//! Points beyond the grid are clamped into its border cells. Clamping to a box never lengthens a distance, so the bound that
//! ends a search holds for them too, and a few points far away cannot blow up the grid.

use std::ops::Range;

/// Edge of a cell, m, where there are enough points for cells so small.
const CELL: f32 = 1.0;
/// Cells per point at most: more would cost more to make than they save.
const CELLS_PER_POINT: usize = 1;
/// The grid covers at most this far from the frame's origin in x and in y, m.
const REACH: f32 = 256.0;
/// Rounding may put a point that lies on a cell's border into the next one; bounds are loosened by this, m.
const SLACK: f32 = 1e-3;
/// Cells to each side of the query's column that are searched first in a row.
const MIDDLE: usize = 2;
/// Distances are computed for this many points at a time.
const LANES: usize = 16;
/// Runs shorter than this are looked through one by one.
const FEW: usize = 8;

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
    /// Edge of a cell, m.
    cell: f32,
    columns: usize,
    rows: usize,
    /// Where each cell's points begin, row by row, and the end.
    starts: Vec<u32>,
    /// How many points lie in the cells before each one, column by column: tells at once that a stretch of a column is empty.
    before: Vec<u32>,
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
        let cells: Vec<u32> = points.iter().map(|[x, y, _]| index.cell_of(*x, *y)).collect();
        for &cell in &cells {
            index.starts[cell as usize + 1] += 1;
        }
        running_sum(&mut index.starts);
        index.count_columns();
        let mut next = index.starts.clone();
        for ((point, id), cell) in points.iter().zip(ids).zip(cells) {
            let place = next[cell as usize] as usize;
            next[cell as usize] += 1;
            [index.xs[place], index.ys[place], index.zs[place]] = *point;
            index.ids[place] = *id;
        }
        index
    }

    fn empty_grid(points: &[[f32; 3]]) -> Self {
        let n = points.len();
        let [(x, width), (y, height)] = [0, 1].map(|axis| span(points, axis));
        let cell = (width * height / (CELLS_PER_POINT * n).max(1) as f32).sqrt().max(CELL);
        let [columns, rows] = [width, height].map(|size| (size / cell) as usize + 1);
        Self {
            origin: [x, y],
            cell,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            before: vec![0; columns * rows + 1],
            xs: vec![0.0; n],
            ys: vec![0.0; n],
            zs: vec![0.0; n],
            ids: vec![0; n],
        }
    }

    fn count_columns(&mut self) {
        for row in 0..self.rows {
            for column in 0..self.columns {
                self.before[column * self.rows + row + 1] = self.run(row, column, column).len() as u32;
            }
        }
        running_sum(&mut self.before);
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there is nothing to find.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// The `k` points nearest to the query, nearest first, fewer when the cloud has fewer. Of equal distances the
    /// smaller identity is the nearer. `found` is overwritten, so that many searches share one allocation.
    pub fn nearest(&self, query: [f32; 3], k: usize, found: &mut Vec<Neighbor>) {
        self.nearest_within(query, k, f32::INFINITY, found);
    }

    /// As [`Self::nearest`], but finds nothing where it can tell that no point lies within `reach`, m.
    pub fn nearest_within(&self, query: [f32; 3], k: usize, reach: f32, found: &mut Vec<Neighbor>) {
        found.clear();
        if self.is_empty() || k == 0 {
            return;
        }
        let at = self.place_of(query[0], query[1]);
        let mut search = Search { query, k: k.min(self.len()), cell: self.cell, worst: f32::INFINITY, found };
        for ring in 0..self.columns.max(self.rows) {
            let bound = self.bound(&at, ring);
            if search.is_done(bound) || (bound > reach && search.found.is_empty()) {
                break;
            }
            self.search_ring(&mut search, &at, ring);
        }
    }

    fn search_ring(&self, search: &mut Search, at: &Place, ring: usize) {
        let [cx, cy] = at.cell;
        // The cells of a row lie side by side, so that the ring's lower and upper edge are one run of points each.
        if ring <= cy {
            self.search_row(search, at, ring, cy - ring);
        }
        if ring > 0 && cy + ring < self.rows {
            self.search_row(search, at, ring, cy + ring);
        }
        if ring > 0 && ring <= cx {
            self.search_column(search, at, ring, cx - ring);
        }
        if ring > 0 && cx + ring < self.columns {
            self.search_column(search, at, ring, cx + ring);
        }
    }

    /// The ring's cells in a row, as far as they can hold a point that is near enough: the middle ones first, for what they
    /// hold leaves less of the others.
    fn search_row(&self, search: &mut Search, at: &Place, ring: usize, row: usize) {
        let away = distance_to_cell(at.y, row);
        let column = at.cell[0];
        let (first, last) = stretch(at.x, column, ring.min(MIDDLE), search.reach_beside(away), self.columns);
        if first <= last {
            search.scan(self, self.run(row, first, last));
        }
        if ring <= MIDDLE {
            return;
        }
        let (left, right) = stretch(at.x, column, ring, search.reach_beside(away), self.columns);
        if left + MIDDLE < column {
            search.scan(self, self.run(row, left, column - MIDDLE - 1));
        }
        if column + MIDDLE < right {
            search.scan(self, self.run(row, column + MIDDLE + 1, right));
        }
    }

    /// The ring's cells in a column, its corners apart, from the middle outward.
    fn search_column(&self, search: &mut Search, at: &Place, ring: usize, column: usize) {
        let away = distance_to_cell(at.x, column);
        let (low, high) = stretch(at.y, at.cell[1], ring - 1, search.reach_beside(away), self.rows);
        let first = column * self.rows;
        if low > high || self.before[first + low] == self.before[first + high + 1] {
            return;
        }
        for step in 0..ring {
            if step as f32 > search.reach_beside(away) + 1.0 {
                break;
            }
            let row = at.cell[1];
            if step <= row {
                search.scan(self, self.run(row - step, column, column));
            }
            if step > 0 && row + step < self.rows {
                search.scan(self, self.run(row + step, column, column));
            }
        }
    }

    /// Points of the cells `left..=right` of a row.
    fn run(&self, row: usize, left: usize, right: usize) -> Range<usize> {
        let first = row * self.columns;
        self.starts[first + left] as usize..self.starts[first + right + 1] as usize
    }

    /// No point of this ring or a later one lies nearer than this, m. Sides beyond the grid hold no points.
    fn bound(&self, at: &Place, ring: usize) -> f32 {
        let side = |place: f32, cell: usize, cells: usize| {
            let below = if cell >= ring { place - (cell + 1) as f32 + ring as f32 } else { f32::INFINITY };
            let above = if cell + ring < cells { (cell + ring) as f32 - place } else { f32::INFINITY };
            below.min(above)
        };
        let nearest = side(at.x, at.cell[0], self.columns).min(side(at.y, at.cell[1], self.rows));
        (nearest * self.cell - SLACK).max(0.0)
    }

    fn place_of(&self, x: f32, y: f32) -> Place {
        let place = |value: f32, origin: f32, cells: usize| {
            let place = ((value - origin) / self.cell).clamp(0.0, cells as f32);
            (place, (place as usize).min(cells - 1))
        };
        let ((x, column), (y, row)) =
            (place(x, self.origin[0], self.columns), place(y, self.origin[1], self.rows));
        Place { x, y, cell: [column, row] }
    }

    fn cell_of(&self, x: f32, y: f32) -> u32 {
        let [column, row] = self.place_of(x, y).cell;
        (row * self.columns + column) as u32
    }
}

/// The least coordinate of the points along an axis, and how far they reach from there, m; clamped to [`REACH`].
fn span(points: &[[f32; 3]], axis: usize) -> (f32, f32) {
    let values = points.iter().map(|point| point[axis].clamp(-REACH, REACH));
    let (low, high) = values.fold((REACH, -REACH), |(low, high), v| (v.min(low), v.max(high)));
    (low.min(high), (high - low).max(0.0))
}

/// Where a point lies in the grid, in cells; points outside are clamped to its border.
struct Place {
    x: f32,
    y: f32,
    /// Column and row.
    cell: [usize; 2],
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

fn running_sum(counts: &mut [u32]) {
    let mut total = 0;
    for count in counts {
        total += *count;
        *count = total;
    }
}

/// A search under way: the best points so far, in order.
struct Search<'a> {
    query: [f32; 3],
    k: usize,
    /// Edge of a cell, m.
    cell: f32,
    /// Only points at most this far can still enter, m^2.
    worst: f32,
    found: &'a mut Vec<Neighbor>,
}

impl Search<'_> {
    fn is_done(&self, bound: f32) -> bool {
        self.found.len() == self.k && bound * bound > self.worst
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
        let mut begin = run.start;
        while begin < run.end {
            let end = (begin + LANES).min(run.end);
            self.scan_some(index, begin..end);
            begin = end;
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
    fn scan_some(&mut self, index: &NeighborIndex, run: Range<usize>) {
        let mut distances = [f32::INFINITY; LANES];
        let points = index.xs[run.clone()].iter().zip(&index.ys[run.clone()]).zip(&index.zs[run.clone()]);
        for (distance, ((x, y), z)) in distances.iter_mut().zip(points) {
            *distance = self.distance_squared(*x, *y, *z);
        }
        let hits = distances.iter().fold(0, |hits, distance| hits | u32::from(*distance <= self.worst));
        if hits == 0 {
            return;
        }
        for (distance_squared, id) in distances.into_iter().zip(&index.ids[run]) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute_force(points: &[[f32; 3]], query: [f32; 3], k: usize) -> Vec<Neighbor> {
        let distance = |p: &[f32; 3]| {
            let [dx, dy, dz] = [p[0] - query[0], p[1] - query[1], p[2] - query[2]];
            dx * dx + dy * dy + dz * dz
        };
        let all = points.iter().enumerate();
        let mut all: Vec<_> =
            all.map(|(id, p)| Neighbor { id: id as u32, distance_squared: distance(p) }).collect();
        all.sort_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.id.cmp(&b.id)));
        all.truncate(k);
        all
    }

    fn check(points: &[[f32; 3]], queries: &[[f32; 3]]) {
        let ids: Vec<u32> = (0..points.len() as u32).collect();
        let index = NeighborIndex::new(points, &ids);
        let mut found = Vec::new();
        for &query in queries {
            for k in [1, 3, 10] {
                index.nearest(query, k, &mut found);
                assert_eq!(found, brute_force(points, query, k), "query {query:?}, k {k}");
            }
        }
    }

    const QUERIES: [[f32; 3]; 7] = [
        [0.0, 0.0, 0.0],
        [10.0, -3.5, 1.0],
        [-80.2, 40.0, 0.3],
        [300.0, 300.0, 5.0],
        [-1e6, 0.0, 0.0],
        [255.99, -256.0, 0.0],
        [7.0, 7.0, -30.0],
    ];

    #[test]
    fn a_wall_with_many_points_in_one_plane() {
        let wall: Vec<_> = (0..4000).map(|i| [10.0, (i / 80) as f32 * 0.1, (i % 80) as f32 * 0.05]).collect();
        check(&wall, &QUERIES);
    }

    #[test]
    fn every_point_twice_and_all_equal() {
        let twice: Vec<_> =
            (0..500).map(|i| [(i / 2) as f32 * 0.37 - 40.0, (i / 2 % 13) as f32, 0.5]).collect();
        check(&twice, &QUERIES);
        check(&[[3.0, 4.0, 1.0]; 100], &QUERIES);
    }

    #[test]
    fn one_point_and_none() {
        check(&[[1.0, 2.0, 3.0]], &QUERIES);
        check(&[], &QUERIES);
    }

    #[test]
    fn far_away() {
        check(
            &[[5e3, 0.0, 0.0], [5e3, 1.0, 0.0], [-7e4, 2e5, 3.0], [0.0, 1.0, 0.0], [300.0, 300.0, 4.0]],
            &QUERIES,
        );
        let far: Vec<_> = (0..100).map(|i| [1e4 + i as f32, -1e4, 0.0]).collect();
        check(&far, &QUERIES);
    }

    proptest! {
        #[test]
        fn as_brute_force(
            points in prop::collection::vec(prop::array::uniform3(-60f32..60.0), 0..400),
            queries in prop::collection::vec(prop::array::uniform3(-90f32..90.0), 5),
        ) {
            check(&points, &queries);
        }

        #[test]
        fn as_brute_force_on_a_lattice(
            points in prop::collection::vec(prop::array::uniform3((-9i8..9).prop_map(|v| f32::from(v) * 0.5)), 0..300),
            query in prop::array::uniform3((-12i8..12).prop_map(|v| f32::from(v) * 0.5)),
        ) {
            check(&points, &[query]);
        }
    }
}
