//! Which scans are looked at, and what is kept of them: enough to judge, far less than labelling reads.

use crate::ground::{self, GroundFit};
use crate::misread::{Misread, misread};
use crate::picture::{DepthEdge, FEWEST_IMAGES, Moment, Pictures, depth_edges};
use crate::plan_field::PlanField;
use crate::thinning::{returns, some};
use crate::velocity_fit::{TRUSTED, Told, VelocityFit, fit, told};
use ralf::scene::Doppler;
use ralf::sensors::{Elevation, LidarScan, Radar, RadarScan, Source, SourceError};
use ralf::space::{Point, Vector};
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};

/// Times at which two LiDAR scans, half a second apart, are compared with each other and with the radars.
const MOMENTS: usize = 16;
/// Between the two, ns.
pub(crate) const LAG_NS: i64 = 500_000_000;
/// Scans of a radar, besides those beside a LiDAR scan, in pairs.
const RADAR_SCANS: usize = 120;
/// Points kept of a LiDAR scan.
const LIDAR_POINTS: usize = 60_000;
/// Points of a scan whose numbers are looked at.
const SHAPE_POINTS: usize = 5000;
/// What stands between these heights above the ground is an obstacle that a radar sees as well, m.
const OBSTACLES: std::ops::Range<f64> = 0.4..3.0;
/// Which quantile of the beams' slopes counts as the steepest, so that a few odd points don't; of about so many points.
const STEEPEST: (f64, usize) = (0.98, 2000);
/// What a LiDAR sees nearer than this may be its own vehicle, m.
const VEHICLE: f64 = 3.0;
/// Points are put to one moment of a turn, from so much before or after at most, s: LiDARs turn ten times a second.
const TURN_S: f64 = 0.1;
/// Points kept to be sought in images.
const SEEN: usize = 6000;
/// Obstacles kept to be sought in another scan.
const PROBES: usize = 800;

/// A radar's scan.
#[derive(Debug, Clone)]
pub(crate) struct RadarLook {
    /// Number in its timeline.
    pub(crate) scan: usize,
    pub(crate) t_ns: i64,
    /// Detections with finite coordinates, radar frame, m.
    pub(crate) positions: Vec<Point>,
    /// Those that stand still by the scan's own range rates; all where these tell no velocity to be trusted.
    pub(crate) standing: Vec<Point>,
    /// The radar's own velocity by the range rates.
    pub(crate) fit: Option<VelocityFit>,
    /// The same by range rates that are said to be without the vehicle's motion: none, where they are.
    pub(crate) compensated: Option<VelocityFit>,
    /// Unit directions of detections with a finite range rate, radar frame.
    pub(crate) rays: Vec<Vector>,
    /// Their raw range rates, m/s.
    pub(crate) range_rates: Vec<f64>,
    /// Ranges, azimuths and elevations as measured, m and rad.
    pub(crate) spherical: Vec<[f64; 3]>,
    /// The same as the radar's own fields tell them, in whatever unit.
    pub(crate) told: Vec<[f64; 3]>,
    /// Rows of the scan, and those among them without finite coordinates.
    pub(crate) rows: usize,
    pub(crate) not_finite: usize,
    /// Of each column, how many values are finite.
    pub(crate) numbers: Vec<usize>,
    /// Of all columns: the same scan again has the same.
    pub(crate) digest: u64,
}

/// A LiDAR's scan.
#[derive(Debug, Clone)]
pub(crate) struct LidarLook {
    pub(crate) lidar: usize,
    /// Number in its timeline.
    pub(crate) scan: usize,
    pub(crate) t_ns: i64,
    /// Obstacles above the ground, vehicle frame as recorded, m.
    pub(crate) probes: Vec<Point>,
    /// The same, all of them, by distance.
    pub(crate) field: PlanField,
    pub(crate) ground: Option<GroundFit>,
    /// Where there is no ground: what the scan shows one as.
    pub(crate) misread: Vec<Misread>,
    /// The LiDAR's place (vehicle frame as recorded), and the distance from it in plan, m, at which its steepest beams
    /// come down to where obstacles begin.
    blind: (Point, f64),
    /// How steeply its points lie below it at least, but for some odd ones, where they are no returns from the vehicle
    /// itself, whose directions are off: a slope. A point that was put to one moment of the turn may lie nearer
    /// than it was seen by as much as the vehicle drove meanwhile. None where nothing came back.
    pub(crate) steepest: Option<f64>,
    /// Where things end, for images; empty where there are too few of them.
    pub(crate) edges: Vec<DepthEdge>,
    /// Some of all points, vehicle frame as recorded, m, for stored depth; none where there are too few images.
    seen: Vec<Point>,
    /// Figures of its numbers, which a wrong data type gives away.
    pub(crate) shape: CloudShape,
    pub(crate) digest: u64,
}

/// What the numbers of a point cloud look like.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct CloudShape {
    pub(crate) points: usize,
    /// Share of points that are finite and not the origin.
    pub(crate) returns: f64,
    /// Median distance, m.
    pub(crate) range: f64,
    /// Share of returns more than 45 degrees above or below the sensor.
    pub(crate) steep: f64,
    /// Share of coordinates that no LiDAR gives.
    pub(crate) absurd: f64,
}

/// What was read of a sequence.
#[derive(Debug, Clone, Default)]
pub(crate) struct Sample {
    /// Per radar, in time order.
    pub(crate) radars: Vec<Vec<RadarLook>>,
    /// Of all LiDARs, in the order of the rig and of time.
    pub(crate) lidars: Vec<LidarLook>,
    /// What was seen of images.
    pub(crate) pictures: Pictures,
    /// Why a scan could not be read, a sentence each.
    pub(crate) unreadable: Vec<String>,
}

impl Sample {
    /// Reads evenly spread scans.
    pub(crate) fn of(source: &dyn Source) -> Self {
        Self::with_scans_around(source, 0)
    }

    /// Reads evenly spread scans, and of each radar the scans before and after those beside a LiDAR's: what is seen in
    /// these as well is less often clutter.
    pub(crate) fn in_rows(source: &dyn Source) -> Self {
        Self::with_scans_around(source, 1)
    }

    fn with_scans_around(source: &dyn Source, around: usize) -> Self {
        let mut sample = Self::default();
        let times = &source.sequence().times;
        let mut wanted = vec![BTreeSet::new(); times.radars.len()];
        for (lidar, own) in times.lidars.iter().enumerate() {
            for scan in paired(own) {
                sample.read_lidar(source, lidar, scan);
                for (radar, times) in times.radars.iter().enumerate() {
                    if let Some(near) = nearest(times, own[scan]) {
                        wanted[radar].extend(near.saturating_sub(around)..=near + around);
                    }
                }
            }
        }
        for (radar, (own, mut scans)) in times.radars.iter().zip(wanted).enumerate() {
            scans.extend(spread(own.len(), RADAR_SCANS / 2).into_iter().flat_map(|scan| [scan, scan + 1]));
            let looks = scans.into_iter().filter(|scan| *scan < own.len());
            let looks = looks.filter_map(|scan| sample.read_radar(source, radar, scan)).collect();
            sample.radars.push(looks);
        }
        let first = sample.lidars.iter().filter(|look| look.lidar == 0);
        let moments: Vec<Moment> = first.map(LidarLook::moment).collect();
        sample.pictures = crate::picture::read(source, &moments);
        sample
    }

    fn read_lidar(&mut self, source: &dyn Source, lidar: usize, scan: usize) {
        match source.lidar_scan(lidar, scan) {
            Ok(read) => self.lidars.push(LidarLook::of(source, (lidar, scan), &read)),
            Err(error) => self.unreadable.push(error.to_string()),
        }
    }

    fn read_radar(&mut self, source: &dyn Source, radar: usize, scan: usize) -> Option<RadarLook> {
        match RadarLook::read(source, radar, scan) {
            Ok(look) => Some(look),
            Err(error) => {
                self.unreadable.push(error.to_string());
                None
            }
        }
    }
}

/// So many indices, evenly over a list; all of a short one.
fn spread(length: usize, count: usize) -> Vec<usize> {
    if length <= count {
        return (0..length).collect();
    }
    (0..count).map(|i| i * (length - 1) / (count - 1).max(1)).collect()
}

/// Scans evenly over a timeline, each with the one that comes [`LAG_NS`] later.
fn paired(times: &[i64]) -> BTreeSet<usize> {
    let later = |scan: usize| times.partition_point(|t| *t < times[scan].saturating_add(LAG_NS));
    let firsts = (0..times.len()).filter(|scan| later(*scan) < times.len()).count().max(1);
    let chosen = spread(firsts.min(times.len()), MOMENTS);
    chosen.into_iter().flat_map(|scan| [scan, later(scan)]).filter(|scan| *scan < times.len()).collect()
}

/// The measurement nearest to a time.
pub(crate) fn nearest(times: &[i64], t_ns: i64) -> Option<usize> {
    let after = times.partition_point(|t| *t < t_ns);
    let around = after.saturating_sub(1)..(after + 1).min(times.len());
    around.min_by_key(|i| times[*i].abs_diff(t_ns))
}

impl RadarLook {
    pub(crate) fn read(source: &dyn Source, radar: usize, scan: usize) -> Result<Self, SourceError> {
        let read = source.radar_scan(radar, scan)?;
        Ok(Self::of(&source.sequence().rig.radars[radar], scan, &read))
    }

    /// The same scan where what stands still is read as lying elsewhere.
    pub(crate) fn read_otherwise(&self, place: impl FnMut(&Point) -> Point) -> Self {
        Self { standing: self.standing.iter().map(place).collect(), ..self.clone() }
    }

    fn of(radar: &Radar, scan: usize, read: &RadarScan) -> Self {
        let mut hasher = DefaultHasher::new();
        read.columns.iter().flatten().for_each(|value| value.to_bits().hash(&mut hasher));
        let finite = |p: &Point| p.coords.iter().all(|v| v.is_finite());
        let positions: Vec<Point> = read.positions.iter().copied().filter(finite).collect();
        let (without, rates_without) = rays_and_rates(&told(radar, read, Doppler::COMPENSATED));
        let told = told(radar, read, Doppler::RAW);
        let (rays, range_rates) = rays_and_rates(&told);
        let fit_of = |rays: &[Vector], rates: &[f64]| fit(rays, rates, scan as u64);
        let fit = fit_of(&rays, &range_rates);
        let standing = match fit.filter(|fit| fit.inliers >= TRUSTED) {
            Some(fit) => told.iter().filter(|told| fit.agrees(told)).map(|told| told.place).collect(),
            None => positions.clone(),
        };
        Self {
            scan,
            t_ns: read.t_ns,
            rows: read.len(),
            not_finite: read.len() - positions.len(),
            numbers: read.columns.iter().map(|column| count_finite(column)).collect(),
            standing,
            positions,
            fit,
            compensated: fit_of(&without, &rates_without),
            rays,
            range_rates,
            spherical: read.spherical.iter().map(|s| [s.range, s.azimuth, s.elevation]).collect(),
            told: as_told(radar, read),
            digest: hasher.finish(),
        }
    }
}

fn rays_and_rates(told: &[Told]) -> (Vec<Vector>, Vec<f64>) {
    told.iter().map(|told| (told.ray, told.range_rate)).unzip()
}

/// Range, azimuth and elevation by the radar's fields of these names; of x, y and z what these make.
fn as_told(radar: &Radar, read: &RadarScan) -> Vec<[f64; 3]> {
    let is_used = |name: &&str| *name != "elevation" || radar.elevation == Elevation::Measured;
    let column = |name: &str| radar.column(name).map(|column| &read.columns[column]);
    let fields = ["range", "azimuth", "elevation"].map(|name| Some(name).filter(is_used).and_then(column));
    let value =
        |field: usize, row: usize, made: f64| fields[field].map_or(made, |column| f64::from(column[row]));
    let rows = read.spherical.iter().enumerate();
    rows.map(|(row, s)| [value(0, row, s.range), value(1, row, s.azimuth), value(2, row, s.elevation)])
        .collect()
}

fn count_finite(values: &[f32]) -> usize {
    values.iter().filter(|value| value.is_finite()).count()
}

impl LidarLook {
    /// Whether a thing at a place (vehicle frame as recorded) is so far away that no lower part of it, such as the nose
    /// of a car, is nearer than what the beams meet.
    pub(crate) fn sees_down_to_the_foot(&self, place: &Point) -> bool {
        let (lidar, blind) = &self.blind;
        (place - lidar).xy().norm() > *blind
    }

    fn moment(&self) -> Moment<'_> {
        Moment { lidar: self.lidar, t_ns: self.t_ns, points: &self.seen }
    }

    fn of(source: &dyn Source, (lidar, scan): (usize, usize), read: &LidarScan) -> Self {
        let mut hasher = DefaultHasher::new();
        read.points.iter().flatten().for_each(|value| value.to_bits().hash(&mut hasher));
        let mount = source.sequence().rig.lidars[lidar].vehicle_from_lidar;
        let returns = returns(read.points.iter().copied());
        let kept = some(&returns, LIDAR_POINTS);
        let points: Vec<Point> =
            kept.map(|[x, y, z]| mount * Point::new((*x).into(), (*y).into(), (*z).into())).collect();
        let lidar_at: Point = mount.translation.vector.into();
        let ground = ground::fit(&points, &lidar_at);
        let misread = if ground.is_some() { Vec::new() } else { misread(read, &mount) };
        let height = |p: &Point| ground.as_ref().map_or(p.z, |ground| ground.height(p));
        let obstacles: Vec<&Point> = points.iter().filter(|p| OBSTACLES.contains(&height(p))).collect();
        let images = source.sequence().times.cameras.iter().map(Vec::len).max().unwrap_or(0);
        let stands = |p: &Point| height(p) > OBSTACLES.start;
        let (edges, seen) = match images >= FEWEST_IMAGES {
            true => (depth_edges(&points, &mount, stands), every_so_many(&points, SEEN)),
            false => (Vec::new(), Vec::new()),
        };
        let moved = source.sequence().motion.twist(read.t_ns).0.norm() * TURN_S;
        let away: Vec<Point> = points.iter().filter(|p| (*p - lidar_at).norm() > VEHICLE).copied().collect();
        Self {
            lidar,
            scan,
            t_ns: read.t_ns,
            probes: some(&obstacles, PROBES).map(|p| **p).collect(),
            field: PlanField::new(obstacles.iter().map(|p| [p.x, p.y, p.z])),
            edges,
            seen,
            blind: (lidar_at, blind(steepest(&points, &lidar_at, 0.0), height(&lidar_at))),
            steepest: steepest(&away, &lidar_at, moved),
            ground,
            misread,
            shape: CloudShape::of(&returns, read.points.len()),
            digest: hasher.finish(),
        }
    }
}

/// About so many of the points, evenly. Rows of beams are powers of two: an odd step meets all of them.
fn every_so_many(points: &[Point], count: usize) -> Vec<Point> {
    points.iter().step_by(points.len().div_ceil(count) | 1).copied().collect()
}

/// The slope at which the points of a LiDAR lie below it, but for the steepest few, where each may have been seen from
/// so much farther away, m.
fn steepest(points: &[Point], lidar: &Point, moved: f64) -> Option<f64> {
    let looked = every_so_many(points, STEEPEST.1);
    let slopes: Vec<f64> =
        looked.iter().map(|p| (lidar.z - p.z) / ((p - lidar).xy().norm() + moved).max(1e-3)).collect();
    crate::statistics::quantile(&slopes, STEEPEST.0)
}

/// The distance at which the steepest beams of a LiDAR so high above the ground come down to where obstacles begin, m:
/// 0 where no beam looks down, for nothing is looked over then.
fn blind(steepest: Option<f64>, height: f64) -> f64 {
    match steepest {
        None => f64::INFINITY,
        Some(steepest) if steepest > 0.0 => (height - OBSTACLES.start).max(0.0) / steepest,
        Some(_) => 0.0,
    }
}

/// Whether a coordinate is none that a sensor gives: beyond 1000 km, or closer to 0 than a micrometre without being it.
pub(crate) fn is_absurd(value: &f64) -> bool {
    value.abs() > 1e6 || (*value != 0.0 && value.abs() < 1e-6)
}

impl CloudShape {
    /// Of what came back of so many points.
    fn of(returns: &[[f32; 3]], points: usize) -> Self {
        let looked: Vec<[f64; 3]> = some(returns, SHAPE_POINTS).map(|p| p.map(f64::from)).collect();
        let norm = |p: &[f64; 3]| p[0].hypot(p[1]).hypot(p[2]);
        let share = |count: usize, of: usize| if of == 0 { 0.0 } else { count as f64 / of as f64 };
        let ranges: Vec<f64> = looked.iter().map(norm).collect();
        let steep = |p: &&[f64; 3]| p[2].abs() > p[0].hypot(p[1]);
        Self {
            points,
            returns: share(returns.len(), points),
            range: crate::statistics::median(&ranges).unwrap_or(0.0),
            steep: share(looked.iter().filter(steep).count(), looked.len()),
            absurd: share(looked.iter().flatten().filter(|value| is_absurd(value)).count(), 3 * looked.len()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::sensors::Reliability;
    use ralf::space::Transform;

    #[test]
    fn scans_are_spread_from_the_first_to_the_last() {
        assert_eq!(spread(3, 5), [0, 1, 2]);
        assert_eq!(spread(101, 5), [0, 25, 50, 75, 100]);
        assert!(spread(0, 5).is_empty());
    }

    #[test]
    fn pairs_are_half_a_second_apart_and_a_lonely_scan_is_taken_too() {
        let times: Vec<i64> = (0..8).map(|i| i * 100_000_000).collect();
        assert_eq!(paired(&times), BTreeSet::from([0, 1, 2, 5, 6, 7]));
        assert_eq!(paired(&times[..1]), BTreeSet::from([0]));
        assert!(paired(&[]).is_empty());
    }

    #[test]
    fn what_a_lidar_drove_towards_was_seen_less_steeply() {
        let (lidar, ahead) = (Point::new(0.0, 0.0, 2.0), vec![Point::new(2.8, 0.0, 0.0); 10]);
        let degrees = |moved: f64| steepest(&ahead, &lidar, moved).unwrap().atan().to_degrees();
        // Seen from 4 m behind, at 26.6 degrees, and put where it lies 1.2 m later.
        assert!((degrees(0.0) - 35.5).abs() < 0.1 && (degrees(1.2) - 26.6).abs() < 0.1);
    }

    #[test]
    fn beams_that_reach_a_road_at_eight_metres_reach_the_height_of_obstacles_before() {
        // Wherever the vehicle frame has its zero.
        for road in [0.0, -2.0, 1.0] {
            let lidar = Point::new(0.0, 0.0, road + 2.0);
            let ring = |z: f64| {
                let angles = (0..2000).map(|i| f64::from(i) * 0.01);
                angles.map(|a| Point::new(8.0 * a.cos(), 8.0 * a.sin(), z)).collect::<Vec<_>>()
            };
            assert!((blind(steepest(&ring(road), &lidar, 0.0), 2.0) - 8.0 * 1.6 / 2.0).abs() < 1e-9);
            assert_eq!(blind(steepest(&ring(road + 2.0), &lidar, 0.0), 2.0), 0.0);
            assert_eq!(blind(steepest(&[], &lidar, 0.0), 2.0), f64::INFINITY);
        }
    }

    /// Things around a radar that drives at 30 m/s, and a lorry that follows it.
    #[test]
    fn what_moves_is_told_from_what_stands_by_the_scan_itself() {
        let radar = Radar {
            name: "radar_rear".into(),
            vehicle_from_radar: Transform::identity(),
            elevation: Elevation::None,
            sigma_range: 0.1,
            sigma_azimuth: 0.02,
            sigma_elevation: 0.02,
            fov_azimuth: 2.0,
            fov_elevation: 0.3,
            fields: ["range", "azimuth", "doppler"].map(str::to_owned).to_vec(),
            reliability: Reliability::default(),
        };
        let azimuths: Vec<f32> = (-9..=9).map(|i| 0.1 * i as f32).collect();
        let mut rates: Vec<f32> = azimuths.iter().map(|azimuth| -30.0 * azimuth.cos()).collect();
        rates[8..11].fill(0.5);
        let look = |rates: Vec<f32>| {
            let columns = vec![vec![20.0; azimuths.len()], azimuths.clone(), rates];
            RadarLook::of(&radar, 0, &RadarScan::new(&radar, 0, columns).unwrap())
        };
        let seen = look(rates);
        assert_eq!(seen.positions.len(), 19);
        assert_eq!(seen.standing, [&seen.positions[..8], &seen.positions[11..]].concat());
        let silent = look(vec![f32::NAN; 19]);
        assert_eq!(silent.standing, silent.positions, "range rates tell nothing");
    }

    #[test]
    fn the_nearest_measurement_is_found() {
        assert_eq!(nearest(&[0, 10, 20], 14), Some(1));
        assert_eq!(nearest(&[0, 10, 20], 99), Some(2));
        assert_eq!(nearest(&[], 0), None);
    }
}
