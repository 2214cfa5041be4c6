//! Where the vehicle was, by a LiDAR alone.
//!
//! Each scan is laid onto the surfaces that those before it saw: point to plane (Chen and Medioni, 1992), or to line
//! where there is a pole, against the mean and the spread of the points in cubes of a metre (Magnusson's normal
//! distributions, 2009). Planes rather than points, for the rings that a LiDAR draws onto the road go along with the
//! vehicle, and points would hold on to them. From one scan to the next the speed is taken to stay (Vizzo et al.,
//! *KISS-ICP*, RA-L 2023).

mod registration;
mod voxels;

use ralf::sensors::{LidarScan, Source, SourceError, is_return};
use ralf::space::{EgoMotion, Point, PoseSample, Transform, going_on};
use registration::{Laid, lay};
use voxels::{Voxels, thinned};

/// Points nearer than this are the vehicle itself, and beyond it too sparse for surfaces, m.
const RANGES: std::ops::Range<f64> = 2.5..80.0;
/// Surfaces farther from the vehicle are forgotten, m.
const REMEMBERED: f64 = 100.0;
/// One point of each such cube is laid onto the surfaces, m, and one of each such becomes part of them.
const LAID: f64 = 0.6;
const KEPT: f64 = 0.15;
/// Speeds that are tried for the second scan, m/s: a recording may begin at any.
const SPEEDS: [f64; 10] = [0.0, 4.0, 8.0, 12.0, 16.0, 20.0, 25.0, 30.0, 35.0, -3.0];
/// A scan is laid well when this share of its points is near surfaces, and these lie on them so well. Of the second
/// scan few are: the first one's rings on the road are no surfaces yet.
const WELL: (f64, f64) = (0.1, 0.5);
/// Radar scans may come this much before the first and after the last LiDAR scan, ns.
const BEYOND_NS: i64 = 300_000_000;
/// So many steps from scan to scan the motion goes on at most.
const STEPS: i64 = 6;

/// The vehicle's motion from the scans of its first LiDAR with the most of them, a pose per scan: for recordings that
/// have neither odometry nor poses nor range rates.
///
/// The error says which scan can't be laid onto those before it, or that there are fewer than two. Scans that can't be
/// read are left out. Scans have to be motion-corrected: of others the poses are off by what the vehicle turns in a
/// revolution.
pub fn from_lidar(source: &dyn Source) -> Result<EgoMotion, SourceError> {
    let times = &source.sequence().times.lidars;
    let Some(lidar) = (0..times.len()).rev().max_by_key(|lidar| times[*lidar].len()) else {
        return Err("no motion from a LiDAR: expected one, found none".into());
    };
    let mount = source.sequence().rig.lidars[lidar].vehicle_from_lidar;
    let mut way = Way::default();
    for scan in 0..times[lidar].len() {
        // What can't be read is left out, and what nothing came back of; the next one finds its place as well.
        let Ok(read) = source.lidar_scan(lidar, scan) else { continue };
        let points = points(&read, &mount);
        if points.is_empty() {
            continue;
        }
        way.follow(read.t_ns, &points).map_err(|found| {
            format!(
                "no motion from a LiDAR: expected scan {scan} to lie on what those before it saw, with {:.0} % of its \
                 points near and {:.0} % of these on surfaces, found {:.0} % and {:.0} %",
                WELL.0 * 100.0,
                WELL.1 * 100.0,
                found.seen * 100.0,
                found.on * 100.0
            )
        })?;
    }
    let poses = way.poses();
    EgoMotion::new(vec![], poses)
        .ok_or_else(|| "no motion from a LiDAR: expected two scans that can be read, found fewer".into())
}

/// Returns of a scan that surfaces are made of, vehicle frame.
fn points(scan: &LidarScan, mount: &Transform) -> Vec<Point> {
    let mut found = Vec::with_capacity(scan.points.len());
    for [x, y, z] in scan.points.iter().filter(|point| is_return(point)) {
        let own = Point::new((*x).into(), (*y).into(), (*z).into());
        if RANGES.contains(&own.coords.norm()) {
            found.push(mount * own);
        }
    }
    thinned(&found, KEPT)
}

/// The poses so far, and what was seen from them.
#[derive(Default)]
struct Way {
    surfaces: Voxels,
    /// Of the vehicle at the first scan.
    poses: Vec<PoseSample>,
}

impl Way {
    /// Finds the place of the next scan (vehicle frame) and adds what it saw. The error is how it lies.
    fn follow(&mut self, t_ns: i64, points: &[Point]) -> Result<(), Laid> {
        let thin = thinned(points, LAID);
        let pose = match &self.poses[..] {
            [] => Transform::identity(),
            [first] => self.found(&thin, &starts(first, t_ns))?,
            [.., before, last] => self.found(&thin, &[ahead(before, last, t_ns)])?,
        };
        self.poses.push(PoseSample { t_ns, odom_from_vehicle: pose });
        self.surfaces.add(points.iter().map(|point| pose * point));
        self.surfaces.forget_beyond(&Point::from(pose.translation.vector), REMEMBERED);
        Ok(())
    }

    fn found(&self, points: &[Point], guesses: &[Transform]) -> Result<Transform, Laid> {
        let laid = guesses.iter().map(|guess| lay(points, &self.surfaces, guess));
        let best = laid.max_by(|a, b| (a.on * a.seen).total_cmp(&(b.on * b.seen)));
        match best {
            Some(Laid { pose, on, seen }) if seen > WELL.0 && on > WELL.1 => Ok(pose),
            Some(poor) => Err(poor),
            None => Ok(Transform::identity()),
        }
    }

    /// All poses, and one on either side by the speed at the ends. None of fewer than two.
    fn poses(self) -> Vec<PoseSample> {
        if self.poses.len() < 2 {
            return Vec::new();
        }
        going_on(self.poses, BEYOND_NS, STEPS)
    }
}

/// Where the second scan may be: straight on at any speed.
fn starts(first: &PoseSample, t_ns: i64) -> Vec<Transform> {
    let seconds = (t_ns - first.t_ns) as f64 * 1e-9;
    SPEEDS.iter().map(|speed| Transform::translation(speed * seconds, 0.0, 0.0)).collect()
}

/// The pose at a time when the motion between two others goes on. A gap in the recording says nothing of a turn that
/// goes on.
fn ahead(before: &PoseSample, last: &PoseSample, t_ns: i64) -> Transform {
    let most_ns = last.t_ns.saturating_sub(before.t_ns).saturating_mul(STEPS);
    last.going_on(before, t_ns.saturating_sub(last.t_ns).min(most_ns)).odom_from_vehicle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_motion_goes_on_before_the_first_and_after_the_last_scan() {
        for (step_ns, beyond_s) in [(100_000_000, 0.3), (50_000_000, 0.3), (10_000_000, 0.06)] {
            let pose = |i: i64| PoseSample {
                t_ns: i * step_ns,
                odom_from_vehicle: Transform::translation(10.0 * (i * step_ns) as f64 * 1e-9, 0.0, 0.0),
            };
            let poses = Way { surfaces: Voxels::default(), poses: (0..4).map(pose).collect() }.poses();
            assert_eq!(poses.len(), 6);
            for pose in poses {
                let way = 10.0 * pose.t_ns as f64 * 1e-9;
                assert!((pose.odom_from_vehicle.translation.x - way).abs() < 1e-9, "{pose:?}");
                assert!(
                    (-beyond_s - 1e-9..=3.0 * step_ns as f64 * 1e-9 + beyond_s + 1e-9)
                        .contains(&(way / 10.0))
                );
            }
        }
    }
}
