//! The rays of one LiDAR scan by their direction, to be asked which of them pass near a place.

use std::f32::consts::{FRAC_PI_2, PI, TAU};
use std::ops::Range;

/// Edge of a bin of directions, rad.
const BIN: f32 = 0.5 * PI / 180.0;
/// Bins of azimuth.
const COLUMNS: usize = 720;

/// The returns of one LiDAR scan, sorted into bins of half a degree of azimuth and elevation as seen from the LiDAR.
#[derive(Debug, Clone)]
pub struct RayTable {
    /// Bin of elevation of the first row.
    first_row: usize,
    rows: usize,
    /// Where each bin's returns begin, row by row, and the end.
    starts: Vec<u32>,
    /// Bin by bin.
    rays: Vec<TableRay>,
    /// m
    reach: f32,
}

/// A return as its LiDAR sees it. Its direction and range lie together, so that one load brings them, and no return
/// lies in two lines of a cache.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C, align(32))]
pub struct TableRay {
    /// rad, from -pi to pi.
    pub azimuth: f32,
    /// rad, positive up.
    pub elevation: f32,
    /// From the LiDAR, m.
    pub range: f32,
    /// Its place in the scan.
    pub id: u32,
    /// In the LiDAR's frame, m.
    pub point: [f32; 3],
}

/// Directions around a middle one, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// In the middle, from -pi to pi.
    pub azimuth: f32,
    /// In the middle.
    pub elevation: f32,
    /// To each side.
    pub half_azimuth: f32,
    /// Up and down.
    pub half_elevation: f32,
}

impl RayTable {
    /// No return that is found beside a cone lies farther beside it, rad.
    pub const BESIDE: f32 = 1.01 * BIN;

    /// Sorts the returns of a scan (LiDAR frame, m); points that are none are left out.
    pub fn new(points: &[[f32; 3]]) -> Self {
        let directions = Directions::of(points);
        let bins = directions.bins();
        let (mut first, mut last) = (NO_BIN, 0);
        for bin in &bins {
            first = first.min(*bin);
            last = last.max(if *bin == NO_BIN { 0 } else { *bin });
        }
        let first_row = first.min(last) as usize / COLUMNS;
        let rows = last as usize / COLUMNS - first_row + 1;
        let first_bin = (first_row * COLUMNS) as u32;
        let mut starts = vec![0u32; rows * COLUMNS + 1];
        // What is no return leads beyond the end.
        for bin in &bins {
            if let Some(start) = starts.get_mut(bin.wrapping_sub(first_bin).saturating_add(1) as usize) {
                *start += 1;
            }
        }
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        let mut next = starts.clone();
        let mut rays = vec![TableRay::default(); total as usize];
        let directions = directions.azimuth.iter().zip(&directions.elevation).zip(&directions.range);
        for (((id, bin), point), direction) in (0u32..).zip(&bins).zip(points).zip(directions) {
            let ((azimuth, elevation), range) = direction;
            if let Some(next) = next.get_mut(bin.wrapping_sub(first_bin) as usize) {
                rays[*next as usize] =
                    TableRay { azimuth: *azimuth, elevation: *elevation, range: *range, id, point: *point };
                *next += 1;
            }
        }
        let reach = reach_of(rays.iter().map(|ray| ray.range));
        Self { first_row, rows, starts, rays, reach }
    }

    /// How far the scan sees, m: so far away is the tenth farthest return, for a few are reflections of sun and lamps.
    /// 0 where there are fewer.
    pub fn reach(&self) -> f32 {
        self.reach
    }

    /// All returns, bin by bin.
    pub fn rays(&self) -> &[TableRay] {
        &self.rays
    }

    /// The returns of all bins that a cone touches, as stretches of [`Self::rays`] none of which is empty: every return
    /// within the cone is among them, and some beside it. `runs` is overwritten, so that many cones share one
    /// allocation.
    pub fn runs(&self, cone: &Cone, runs: &mut Vec<Range<usize>>) {
        runs.clear();
        // A row below or above all that there are stays outside, so that nothing is found in it.
        let row = |elevation: f32| {
            (row_of(elevation) as usize + 1).saturating_sub(self.first_row).min(self.rows + 1)
        };
        let low = row(cone.elevation - cone.half_elevation).max(1);
        let high = row(cone.elevation + cone.half_elevation).min(self.rows);
        let columns = columns_of(cone);
        let columns = if columns[1].is_empty() { &columns[..1] } else { &columns[..] };
        for row in low..=high {
            let starts = &self.starts[(row - 1) * COLUMNS..][..=COLUMNS];
            for columns in columns {
                let run = starts[columns.start] as usize..starts[columns.end] as usize;
                if !run.is_empty() {
                    runs.push(run);
                }
            }
        }
    }

    /// The returns in the bin of a direction.
    pub fn bin(&self, azimuth: f32, elevation: f32) -> &[TableRay] {
        let row = (row_of(elevation) as usize).checked_sub(self.first_row);
        let Some(row) = row.filter(|row| *row < self.rows) else { return &[] };
        let bin = row * COLUMNS + column_of(azimuth) as usize;
        &self.rays[self.starts[bin] as usize..self.starts[bin + 1] as usize]
    }

    /// How many returns there are.
    pub fn len(&self) -> usize {
        self.rays.len()
    }

    /// Whether nothing came back.
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }
}

/// The tenth largest of some ranges, 0 where there are fewer.
fn reach_of(ranges: impl Iterator<Item = f32>) -> f32 {
    // The nearest of them first.
    let mut farthest = [0.0f32; 10];
    for range in ranges {
        if range > farthest[0] {
            farthest[0] = range;
            farthest.sort_unstable_by(f32::total_cmp);
        }
    }
    farthest[0]
}

/// The bin of what is no return.
const NO_BIN: u32 = u32::MAX;
/// Directions that are worked out together.
const LANES: usize = 16;

/// Azimuth, elevation and range of many points, each apart; see [`direction_of`].
pub(super) struct Directions {
    azimuth: Vec<f32>,
    elevation: Vec<f32>,
    range: Vec<f32>,
}

impl Directions {
    /// Some at a time, which the compiler turns into vector instructions.
    pub(super) fn of(points: &[[f32; 3]]) -> Self {
        let room = || vec![0.0; points.len().next_multiple_of(LANES)];
        let mut all = Self { azimuth: room(), elevation: room(), range: room() };
        let [azimuths, elevations, ranges] = [&mut all.azimuth, &mut all.elevation, &mut all.range]
            .map(|column| column.as_chunks_mut::<LANES>().0.iter_mut());
        let columns = azimuths.zip(elevations).zip(ranges);
        for (points, ((azimuth, elevation), range)) in points.chunks(LANES).zip(columns) {
            let mut axes = [[0.0; LANES]; 3];
            for (lane, point) in points.iter().enumerate() {
                [axes[0][lane], axes[1][lane], axes[2][lane]] = *point;
            }
            let [x, y, z] = axes;
            let across: [f32; LANES] = std::array::from_fn(|lane| across_squared(x[lane], y[lane]));
            *azimuth = std::array::from_fn(|lane| arc_tangent(y[lane], x[lane]));
            *elevation = std::array::from_fn(|lane| elevation_of(z[lane], across[lane]));
            *range = std::array::from_fn(|lane| range_of(z[lane], across[lane]));
        }
        for column in [&mut all.azimuth, &mut all.elevation, &mut all.range] {
            column.truncate(points.len());
        }
        all
    }

    /// Azimuth, elevation and range of a point.
    pub(super) fn at(&self, point: usize) -> (f32, f32, f32) {
        (self.azimuth[point], self.elevation[point], self.range[point])
    }

    /// The bin of each.
    fn bins(&self) -> Vec<u32> {
        let directions = self.azimuth.iter().zip(&self.elevation).zip(&self.range);
        let bin = |((azimuth, elevation), range): ((&f32, &f32), &f32)| {
            // What is not finite fails the comparison, too.
            let came_back = *range > 0.0 && *range < f32::INFINITY;
            let bin = row_of(*elevation) * COLUMNS as u32 + column_of(*azimuth);
            if came_back { bin } else { NO_BIN }
        };
        directions.map(bin).collect()
    }
}

/// Azimuth and elevation, rad, to 1e-5, and range, m, of a point in the LiDAR's frame.
pub fn direction_of(x: f32, y: f32, z: f32) -> (f32, f32, f32) {
    let across = across_squared(x, y);
    (arc_tangent(y, x), elevation_of(z, across), range_of(z, across))
}

/// The squared distance from the LiDAR's axis, m^2.
fn across_squared(x: f32, y: f32) -> f32 {
    x * x + y * y
}

fn elevation_of(z: f32, across_squared: f32) -> f32 {
    arc_tangent(z, across_squared.sqrt())
}

fn range_of(z: f32, across_squared: f32) -> f32 {
    (across_squared + z * z).sqrt()
}

/// The bins of azimuth that a cone touches; the second stretch is empty unless it lies across the back.
fn columns_of(cone: &Cone) -> [Range<usize>; 2] {
    if cone.half_azimuth >= PI - BIN {
        return [0..COLUMNS, 0..0];
    }
    let [left, right] = [-1.0, 1.0].map(|side| {
        let azimuth = cone.azimuth + side * cone.half_azimuth;
        // Mostly it is no more than half a turn as it is.
        let turns = if azimuth.abs() < PI { 0.0 } else { (azimuth / TAU).round() };
        column_of(azimuth - TAU * turns) as usize
    });
    if left <= right { [left..right + 1, 0..0] } else { [0..right + 1, left..COLUMNS] }
}

// Casts to `i32` become vector instructions, unlike those to numbers without a sign.

fn column_of(azimuth: f32) -> u32 {
    (((azimuth + PI) / BIN) as i32).clamp(0, COLUMNS as i32 - 1) as u32
}

fn row_of(elevation: f32) -> u32 {
    (((elevation + FRAC_PI_2) / BIN) as i32).max(0) as u32
}

/// `atan2(y, x)` to 1e-5 rad, at a fraction of its cost: the polynomial of Abramowitz and Stegun, 4.4.49, on [0, 1].
fn arc_tangent(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let (small, large) = if ax < ay { (ax, ay) } else { (ay, ax) };
    let t = if large > 0.0 { small / large } else { 0.0 };
    let s = t * t;
    let series = 1.0
        + s * (-0.333_331_45
            + s * (0.199_935_51
                + s * (-0.142_089
                    + s * (0.106_562_64
                        + s * (-0.075_289_64
                            + s * (0.042_909_614 + s * (-0.016_165_737 + s * 0.002_866_225_7)))))));
    let first = t * series;
    let half = if ax < ay { FRAC_PI_2 - first } else { first };
    let turned = if x < 0.0 { PI - half } else { half };
    if y < 0.0 { -turned } else { turned }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn directions_are_those_of_the_library(x in -90.0f32..90.0, y in -90.0f32..90.0, z in -20.0f32..20.0) {
            let (azimuth, elevation, range) = direction_of(x, y, z);
            let expected = f64::from(y).atan2(f64::from(x));
            prop_assert!((f64::from(azimuth) - expected).abs() < 1e-5, "{azimuth} {expected}");
            let expected = f64::from(z).atan2(f64::from(x).hypot(f64::from(y)));
            prop_assert!((f64::from(elevation) - expected).abs() < 1e-5);
            prop_assert!((range - (x * x + y * y + z * z).sqrt()).abs() < 1e-3);
        }

        #[test]
        fn every_ray_of_a_cone_is_found_once(
            points in prop::collection::vec(prop::array::uniform3(-20.0f32..20.0), 0..200),
            azimuth in -PI..PI, elevation in -1.5f32..1.5, half_azimuth in 0.0f32..4.0, half_elevation in 0.0f32..1.0,
        ) {
            let table = RayTable::new(&points);
            let cone = Cone { azimuth, elevation, half_azimuth, half_elevation };
            let mut runs = Vec::new();
            table.runs(&cone, &mut runs);
            let mut found: Vec<u32> = runs.into_iter().flatten().map(|place| table.rays()[place].id).collect();
            found.sort_unstable();
            prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "none twice");
            for (id, &[x, y, z]) in (0u32..).zip(&points) {
                let (a, e, _) = direction_of(x, y, z);
                let beside = (a - azimuth).abs();
                let beside = beside.min(TAU - beside);
                if beside < half_azimuth - 1e-4 && (e - elevation).abs() < half_elevation - 1e-4 {
                    prop_assert!(found.binary_search(&id).is_ok(), "{a} {e}");
                }
                if beside > half_azimuth + BIN + 1e-4 || (e - elevation).abs() > half_elevation + BIN + 1e-4 {
                    prop_assert!(found.binary_search(&id).is_err(), "{a} {e}");
                }
            }
        }
    }

    #[test]
    fn what_did_not_come_back_is_no_ray() {
        let table =
            RayTable::new(&[[0.0; 3], [f32::NAN, 1.0, 1.0], [f32::INFINITY, 0.0, 0.0], [0.0, 0.0, -2.0]]);
        assert_eq!((table.len(), table.rays()[0].id, table.rays()[0].range), (1, 3, 2.0));
        let everywhere = Cone { azimuth: 0.0, elevation: 0.0, half_azimuth: 9.0, half_elevation: 9.0 };
        let mut runs = Vec::new();
        table.runs(&everywhere, &mut runs);
        assert!(runs.len() == 1 && runs[0] == (0..1), "{runs:?}");
        RayTable::new(&[]).runs(&everywhere, &mut runs);
        assert!(runs.is_empty());
    }
}
