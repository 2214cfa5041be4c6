//! What the ground is like: how bright it is to the LiDAR, and how rough. Grass differs from asphalt in both.

use super::cells::Cells;
use super::ground::Floor;
use crate::space::Transform;
use nalgebra::{Isometry3, Point3};

/// Edge of a cell, m.
const CELL: f32 = 0.5;
/// Farther than this beams meet the ground too seldom, m.
const REACH: f32 = 40.0;
const CELLS: Cells = Cells::new(REACH, CELL);
/// A point lower than this above the lowest one near by is ground, m.
const GROUND_BAND: f32 = 0.15;
/// Brightness is told apart within rings of this width, m: it falls with range and with the angle of incidence.
const RING: f32 = 2.0;
/// Points that a ring needs at least.
const MIN_POINTS: usize = 20;
/// So many ranges from the median all is as bright: reflectors are not what the ground is like.
const BRIGHTEST: f32 = 5.0;
/// Points of one scan in a cell from which its roughness is told.
const MIN_ROUGH: f32 = 3.0;
/// Cells to each side that are taken together.
const AROUND: usize = 2;

/// The ground in a cell, as one scan saw it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Patch {
    place: [f32; 3],
    sums: Sums,
}

/// Sums over points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Sums {
    points: f32,
    /// Of the brightness, and of its square.
    bright: f32,
    bright_squared: f32,
    /// Points of cells whose roughness is known, and the sum of their squared height above the mean, m^2.
    rough_points: f32,
    rough: f32,
}

/// What the ground around a place is like.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Texture {
    /// Intensity less the median of all ground as far away, in that ring's interquartile ranges.
    pub brightness: f64,
    /// Standard deviation of the same.
    pub mottling: f64,
    /// Standard deviation of height within cells of half a metre, m; `None` where too few points tell.
    pub roughness: Option<f64>,
}

/// What the ground is like, as all scans of a window saw it.
#[derive(Debug)]
pub struct Terrain {
    cells: Vec<Sums>,
}

impl Terrain {
    /// The terrain of the patches of LiDAR scans, each with the way to one frame.
    pub(super) fn new<'a>(scans: impl Iterator<Item = (Transform, &'a [Patch])>) -> Self {
        let mut cells = vec![Sums::default(); CELLS.count()];
        for (to_from_scan, patches) in scans {
            let to_from_scan: Isometry3<f32> = to_from_scan.cast();
            for patch in patches {
                let place = to_from_scan * Point3::from(patch.place);
                if let Some(cell) = CELLS.at(place.x, place.y) {
                    cells[cell].add(&patch.sums);
                }
            }
        }
        Self { cells }
    }

    /// What the ground within about a metre of a place is like; `None` where it was not seen, or all of it is as
    /// bright.
    pub fn at(&self, x: f64, y: f64) -> Option<Texture> {
        let cell = CELLS.at(x as f32, y as f32)?;
        let (row, column) = (cell / CELLS.along, cell % CELLS.along);
        let mut sums = Sums::default();
        for row in row.saturating_sub(AROUND)..=(row + AROUND).min(CELLS.along - 1) {
            for column in column.saturating_sub(AROUND)..=(column + AROUND).min(CELLS.along - 1) {
                sums.add(&self.cells[row * CELLS.along + column]);
            }
        }
        sums.texture()
    }
}

impl Sums {
    fn add(&mut self, other: &Self) {
        self.points += other.points;
        self.bright += other.bright;
        self.bright_squared += other.bright_squared;
        self.rough_points += other.rough_points;
        self.rough += other.rough;
    }

    fn texture(&self) -> Option<Texture> {
        if self.points < 1.0 {
            return None;
        }
        let mean = self.bright / self.points;
        let variance = (self.bright_squared / self.points - mean * mean).max(0.0);
        let rough = (self.rough_points > 0.0).then(|| f64::from(self.rough / self.rough_points).sqrt());
        Some(Texture { brightness: mean.into(), mottling: f64::from(variance).sqrt(), roughness: rough })
    }
}

/// The ground that one LiDAR's scan saw, cell by cell. `points` are in the vehicle frame, m, with an intensity each.
pub(super) fn patches(points: &[[f32; 3]], intensity: &[f32], floor: &Floor) -> Vec<Patch> {
    let ground = ground_points(points, intensity, floor);
    let rings = Rings::new(&ground);
    let mut cells = vec![Cell::default(); CELLS.count()];
    for point in &ground {
        if let Some(brightness) = rings.brightness(point) {
            cells[point.cell].add(point.height, brightness);
        }
    }
    cells.iter().enumerate().filter_map(|(cell, sums)| sums.patch(cell)).collect()
}

struct GroundPoint {
    cell: usize,
    ring: usize,
    height: f32,
    intensity: f32,
}

fn ground_points(points: &[[f32; 3]], intensity: &[f32], floor: &Floor) -> Vec<GroundPoint> {
    let mut ground = Vec::new();
    for (&[x, y, z], &intensity) in points.iter().zip(intensity) {
        let Some((cell, below)) = CELLS.at(x, y).zip(floor.at(x, y)) else { continue };
        if (z - below).abs() < GROUND_BAND && intensity.is_finite() {
            ground.push(GroundPoint {
                cell,
                ring: ((x * x + y * y).sqrt() / RING) as usize,
                height: z,
                intensity,
            });
        }
    }
    ground
}

/// Median and interquartile range of the intensity of each ring, where it has any.
struct Rings(Vec<Option<[f32; 2]>>);

impl Rings {
    fn new(ground: &[GroundPoint]) -> Self {
        let mut rings: Vec<Vec<f32>> = Vec::new();
        for point in ground {
            if rings.len() <= point.ring {
                rings.resize(point.ring + 1, Vec::new());
            }
            rings[point.ring].push(point.intensity);
        }
        Self(rings.into_iter().map(middle_and_range).collect())
    }

    fn brightness(&self, point: &GroundPoint) -> Option<f32> {
        let [median, range] = self.0[point.ring]?;
        Some(((point.intensity - median) / range).clamp(-BRIGHTEST, BRIGHTEST))
    }
}

/// `None` of too few values, and of values most of which are equal.
fn middle_and_range(mut values: Vec<f32>) -> Option<[f32; 2]> {
    if values.len() < MIN_POINTS {
        return None;
    }
    let mut rank = |share: usize| {
        let place = (values.len() - 1) * share / 4;
        *values.select_nth_unstable_by(place, f32::total_cmp).1
    };
    let [low, median, high] = [rank(1), rank(2), rank(3)];
    (high > low).then_some([median, high - low])
}

/// Sums of one scan in a cell.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    points: f32,
    bright: f32,
    bright_squared: f32,
    /// Of the heights above the first one's, and of their squares.
    first: f32,
    height: f32,
    height_squared: f32,
}

impl Cell {
    fn add(&mut self, height: f32, brightness: f32) {
        if self.points == 0.0 {
            self.first = height;
        }
        let above = height - self.first;
        self.points += 1.0;
        self.bright += brightness;
        self.bright_squared += brightness * brightness;
        self.height += above;
        self.height_squared += above * above;
    }

    fn patch(&self, cell: usize) -> Option<Patch> {
        if self.points == 0.0 {
            return None;
        }
        let rough = self.points >= MIN_ROUGH;
        let squares = (self.height_squared - self.height * self.height / self.points).max(0.0);
        let middle = |cell: usize| (cell as f32 + 0.5) * CELL - REACH;
        let sums = Sums {
            points: self.points,
            bright: self.bright,
            bright_squared: self.bright_squared,
            rough_points: if rough { self.points - 1.0 } else { 0.0 },
            rough: if rough { squares } else { 0.0 },
        };
        Some(Patch { place: [middle(cell % CELLS.along), middle(cell / CELLS.along), self.first], sums })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::GroundSurface;

    #[test]
    fn a_patch_knows_the_mean_and_the_spread_of_its_points() {
        // A level road of intensity 10 or 12 by turns; a metre and a half of it is twice as bright and rough.
        let mut points = Vec::new();
        let mut intensity = Vec::new();
        for i in -100..100 {
            for j in -100..100 {
                let (x, y) = (i as f32 * 0.1 + 0.05, j as f32 * 0.1 + 0.05);
                let grass = (4.0..8.0).contains(&x) && (4.0..8.0).contains(&y);
                points.push([x, y, if grass && (i + j) % 2 == 0 { 0.1 } else { 0.0 }]);
                intensity.push(if grass { 20.0 } else { 10.0 + 2.0 * (i & 1) as f32 });
            }
        }
        let floor = GroundSurface::lowest_within_a_metre(&GroundSurface::lowest_points(&points));
        let patches = patches(&points, &intensity, &floor);
        let terrain = Terrain::new([(Transform::identity(), &patches[..])].into_iter());
        let road = terrain.at(-5.0, -5.0).unwrap();
        // Median 10 or 12, range 2: half a range to either side, or none and one; their spread is half.
        assert!((road.mottling - 0.5).abs() < 0.02 && road.brightness.abs() <= 1.0, "{road:?}");
        assert!(road.roughness.unwrap() < 1e-3);
        let grass = terrain.at(6.0, 6.0).unwrap();
        assert!(grass.brightness > 2.0 && grass.mottling < 0.6, "{grass:?}");
        // Heights of 0 and 0.1 by turns: 0.05, and a point less in the denominator.
        assert!((grass.roughness.unwrap() - 0.05).abs() < 0.003);
        assert!(terrain.at(30.0, 30.0).is_none() && terrain.at(f64::NAN, 0.0).is_none());
    }

    #[test]
    fn where_all_is_as_bright_nothing_is_told() {
        assert_eq!(middle_and_range(vec![3.0; 50]), None);
        assert_eq!(middle_and_range((0..19).map(|i| i as f32).collect()), None, "too few");
        assert_eq!(middle_and_range((0..41).map(|i| i as f32).collect()), Some([20.0, 20.0]));
    }
}
