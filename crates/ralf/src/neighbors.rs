//! The only nearest-neighbour search: exact, over a bird's-eye grid that is cheap to build.
//!
//! A LiDAR scan is asked some thousand questions and thrown away, so the build decides. Points are sorted by counting into
//! square cells of the ground plane; a search looks at rings of cells around the query's until no nearer point can follow.
//!
//! Points beyond the grid are clamped into its border cells. Clamping to a box never lengthens a distance, so the bound that
//! ends a search holds for them too, and a few points far away cannot blow up the grid.

use std::ops::Range;

/// Edge of a cell, m.
const CELL: f32 = 1.0;
/// The grid covers at most this far from the frame's origin in x and in y, m.
const REACH: f32 = 256.0;
/// Rounding may put a point that lies on a cell's border into the next one; bounds are loosened by this, m.
const SLACK: f32 = 1e-3;
/// Distances are computed for this many points at a time.
const LANES: usize = 16;

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
    columns: usize,
    rows: usize,
    /// Where each cell's points begin, row by row, and the end.
    starts: Vec<u32>,
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
        let mut total = 0;
        for start in &mut index.starts {
            total += *start;
            *start = total;
        }
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
        let span = |axis: usize| {
            let values = points.iter().map(|point| point[axis].clamp(-REACH, REACH));
            let (low, high) = values.fold((REACH, -REACH), |(low, high), v| (v.min(low), v.max(high)));
            (low.min(high), ((high - low).max(0.0) / CELL) as usize + 1)
        };
        let ((x, columns), (y, rows)) = (span(0), span(1));
        let n = points.len();
        Self {
            origin: [x, y],
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            xs: vec![0.0; n],
            ys: vec![0.0; n],
            zs: vec![0.0; n],
            ids: vec![0; n],
        }
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
        found.clear();
        if self.is_empty() || k == 0 {
            return;
        }
        let mut search = Search { query, k: k.min(self.len()), worst: f32::INFINITY, found };
        let ([gx, gy], [cx, cy]) = self.place_of(query[0], query[1]);
        for ring in 0..self.columns.max(self.rows) {
            if search.is_done(self.bound([gx, gy], [cx, cy], ring)) {
                break;
            }
            self.search_ring(&mut search, [cx, cy], ring);
        }
    }

    fn search_ring(&self, search: &mut Search, [cx, cy]: [usize; 2], ring: usize) {
        let (left, right) = (cx.saturating_sub(ring), (cx + ring).min(self.columns - 1));
        // The cells of a row lie side by side, so that the ring's upper and lower edge are one run of points each.
        if ring <= cy {
            search.scan(self, self.run(cy - ring, left, right));
        }
        if ring > 0 && cy + ring < self.rows {
            search.scan(self, self.run(cy + ring, left, right));
        }
        if ring == 0 {
            return;
        }
        let (low, high) = ((cy + 1).saturating_sub(ring), (cy + ring).min(self.rows));
        for row in low..high {
            if ring <= cx {
                search.scan(self, self.run(row, cx - ring, cx - ring));
            }
            if cx + ring < self.columns {
                search.scan(self, self.run(row, cx + ring, cx + ring));
            }
        }
    }

    /// Points of the cells `left..=right` of a row.
    fn run(&self, row: usize, left: usize, right: usize) -> Range<usize> {
        let first = row * self.columns;
        self.starts[first + left] as usize..self.starts[first + right + 1] as usize
    }

    /// No point of this ring or a later one lies nearer than this, m. Sides beyond the grid hold no points.
    fn bound(&self, [gx, gy]: [f32; 2], [cx, cy]: [usize; 2], ring: usize) -> f32 {
        let mut bound = f32::INFINITY;
        let mut side = |exists: bool, distance: f32| {
            if exists {
                bound = bound.min(distance);
            }
        };
        side(cx >= ring, gx - (cx + 1) as f32 + ring as f32);
        side(cx + ring < self.columns, (cx + ring) as f32 - gx);
        side(cy >= ring, gy - (cy + 1) as f32 + ring as f32);
        side(cy + ring < self.rows, (cy + ring) as f32 - gy);
        (bound * CELL - SLACK).max(0.0)
    }

    /// Where a point lies in the grid, in cells, and in which cell; points outside are clamped.
    fn place_of(&self, x: f32, y: f32) -> ([f32; 2], [usize; 2]) {
        let place = |value: f32, origin: f32, cells: usize| {
            let place = ((value - origin) / CELL).clamp(0.0, cells as f32);
            (place, (place as usize).min(cells - 1))
        };
        let ((gx, cx), (gy, cy)) =
            (place(x, self.origin[0], self.columns), place(y, self.origin[1], self.rows));
        ([gx, gy], [cx, cy])
    }

    fn cell_of(&self, x: f32, y: f32) -> u32 {
        let (_, [cx, cy]) = self.place_of(x, y);
        (cy * self.columns + cx) as u32
    }
}

/// A search under way: the best points so far, in order.
struct Search<'a> {
    query: [f32; 3],
    k: usize,
    /// Only points at most this far can still enter, m^2.
    worst: f32,
    found: &'a mut Vec<Neighbor>,
}

impl Search<'_> {
    fn is_done(&self, bound: f32) -> bool {
        self.found.len() == self.k && bound * bound > self.worst
    }

    fn scan(&mut self, index: &NeighborIndex, run: Range<usize>) {
        let mut begin = run.start;
        while begin < run.end {
            let end = (begin + LANES).min(run.end);
            self.scan_some(index, begin..end);
            begin = end;
        }
    }

    /// At most [`LANES`] points: all distances first, which the compiler turns into vector instructions.
    fn scan_some(&mut self, index: &NeighborIndex, run: Range<usize>) {
        let [qx, qy, qz] = self.query;
        let mut distances = [f32::INFINITY; LANES];
        let points = index.xs[run.clone()].iter().zip(&index.ys[run.clone()]).zip(&index.zs[run.clone()]);
        for (distance, ((x, y), z)) in distances.iter_mut().zip(points) {
            let [dx, dy, dz] = [x - qx, y - qy, z - qz];
            *distance = dx * dx + dy * dy + dz * dz;
        }
        let nearest = distances.iter().fold(f32::INFINITY, |nearest, d| nearest.min(*d));
        if nearest > self.worst {
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
